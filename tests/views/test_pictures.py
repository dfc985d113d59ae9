"""Pictures: drawn from data, labelled with units, without a screen."""

import pkgutil
from importlib import import_module
from io import BytesIO
from types import ModuleType

import numpy as np
import pytest
from matplotlib import rc_context, rcParams
from matplotlib.figure import Figure

import catenary_fe as cf
from catenary_fe import views


@pytest.fixture(scope="module")
def drawings(short, short_shape, short_run):
    return {
        "layout": views.plot_layout(short),
        "layout as hung": views.plot_layout(short, short_shape, spans=[2, 3]),
        "layout to scale": views.plot_layout(short, short_shape, to_scale=True),
        "static shape": short_shape.plot(),
        "elasticity": cf.elasticity(short_shape, points_per_span=6).plot(),
        "contact force": short_run.plot_contact_force(),
        "support uplift": short_run.plot_support_uplift(),
        "dropper forces": short_run.plot_dropper_forces(),
        "energy": short_run.plot_energy(),
    }


def test_axes_have_labels_with_units(drawings):
    for name, ax in drawings.items():
        for label in (ax.get_xlabel(), ax.get_ylabel()):
            assert label.endswith(("(m)", "(mm)", "(N)", "(s)", "(mm/N)", "(J)")), (name, label)
        assert ax.get_title(loc="left")


def test_every_picture_can_be_saved(drawings, tmp_path):
    for name, ax in drawings.items():
        path = tmp_path / f"{name}.png"
        ax.figure.savefig(path)
        assert path.stat().st_size > 8_000


def test_a_bar_beyond_100_percent_misses_its_criterion(short_run):
    rows = cf.criteria_rows(short_run, "AC", non_uniformity=0.4)
    ax = views.plot_criteria(rows, title="run")
    assert ax.get_xlabel().endswith("(%)")
    assert len(ax.patches) == len(rows)
    for row, bar, text in zip(rows, ax.patches, ax.texts, strict=True):
        assert row.value_text in text.get_text()
        assert ("recalled" in text.get_text()) == row.recalled
        if bar.get_width():
            assert row.passed == (bar.get_width() <= 100)
    assert sum(bar.get_width() > 0 for bar in ax.patches) == 6


def test_a_given_axes_is_drawn_on(short_run):
    ax = Figure().subplots()
    assert short_run.plot_contact_force(ax=ax) is ax


def test_the_force_curve_is_the_filtered_force(drawings, short_run):
    line = next(c for c in drawings["contact force"].lines if "0 to 20 Hz" in c.get_label())
    assert line.get_ydata() == pytest.approx(short_run.filtered_contact_force()[0])


def test_the_largest_uplift_is_named(drawings, short_run):
    texts = [t.get_text() for t in drawings["support uplift"].get_legend().get_texts()]
    largest = 1e3 * short_run.largest_support_uplift()
    assert any(f"{largest:.1f} mm" in text for text in texts)


def test_the_drawn_static_shape_touches_the_design_heights(drawings, short_shape):
    curve = next(c for c in drawings["static shape"].lines if c.get_label() == "contact wire")
    heights = np.interp(short_shape.catenary.dropper_positions, *curve.get_data())
    third = short_shape.catenary.dropper_spans == 3
    assert heights[third] == pytest.approx(0, abs=0.01)


def test_the_rays_of_a_run_are_waves(short_run):
    """Ahead at c to the next support, back to the pantograph; a wave pulse travels along the ray."""
    ax = views.plot_run_waves(short_run)
    x, t = next(line.get_data() for line in ax.lines if "ahead" in line.get_label())
    c, v = short_run.catenary.contact_wire.wave_speed, short_run.speed
    assert (x[1] - x[0]) / (t[1] - t[0]) == pytest.approx(c)
    assert (x[2] - x[1]) / (t[2] - t[1]) == pytest.approx(-c)
    assert x[2] == pytest.approx(np.interp(t[2], short_run.time, short_run.data["position"].values[0]))
    assert (x[2] - x[0]) / (t[2] - t[0]) == pytest.approx(v)


def test_the_energy_picture_shows_what_is_missing(drawings, short_run):
    curves = {c.get_label(): c.get_ydata() for c in drawings["energy"].lines}
    stored = curves["kinetic and stored, since the start"]
    lost, done = curves["lost in dampers"], curves["done by the contacts"]
    assert curves["missing"] == pytest.approx(stored - stored[0] + lost - done, abs=1e-12)
    assert 0 < np.abs(curves["missing"]).max() < 0.2


def test_a_run_without_energy_has_no_picture_of_it(short_shape, pantograph):
    run = cf.simulate(short_shape, [pantograph], speed=70.0, method="linearised")
    assert not run.has_energy
    with pytest.raises(cf.InputError, match="recorded no energy; run again with the method 'nonlinear'"):
        run.plot_energy()


ODD = {
    "text.usetex": True, "font.size": 30, "figure.dpi": 40, "savefig.dpi": 33, "savefig.bbox": "tight",
    "axes.facecolor": "black", "lines.linestyle": ":", "axes.unicode_minus": False, "xtick.direction": "in",
}  # fmt: skip


def test_the_users_settings_of_matplotlib_do_not_matter(short):
    """Nor is LaTeX needed, which is not there; a dollar sign in a name is one."""
    named = short.replace(name="100 % of $x_{ \\frac")
    pictures = []
    for settings in ({}, ODD):
        with rc_context(settings):
            before = dict(rcParams)
            pictures.append(BytesIO())
            views.plot_layout(named).figure.savefig(pictures[-1])
            assert dict(rcParams) == before
    assert pictures[0].getvalue() == pictures[1].getvalue()


def test_every_picture_is_drawn_in_our_own_style():
    names = [name for _, name, _ in pkgutil.walk_packages(views.__path__, "catenary_fe.views.")]
    for module in map(import_module, names):
        for name, drawn in vars(module).items():
            if name.startswith("plot_") or name in ("film", "report_page", "comparison_page"):
                assert isinstance(drawn, ModuleType) or hasattr(drawn, "__wrapped__"), (module, name)
