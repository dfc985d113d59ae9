"""Pictures: drawn from data, labelled with units, without a screen."""

import pkgutil
from importlib import import_module
from io import BytesIO
from types import ModuleType

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import rc_context, rcParams
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import catenary_fe as cf
from catenary_fe import views
from catenary_fe.results import Criterion
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.views.style import (
    DROPPER,
    EVALUATED,
    PANTOGRAPHS,
    SUPPORT,
    WIRES,
    distinct,
    sequence,
    styled,
)


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
    rows = cf.criteria_rows(short_run, "AC")
    ax = views.plot_criteria(rows, title="run")
    assert ax.get_xlabel().endswith("(%)")
    assert len(ax.patches) == len(rows)
    for row, bar, text in zip(rows, ax.patches, ax.texts, strict=True):
        assert row.value_text in text.get_text()
        assert ("recalled" in text.get_text()) == row.recalled
        if row.passed is not None:
            assert row.passed == (bar.get_width() <= 100)
            assert bar.get_width() > 0 or row.value == 0
            assert bar.get_fill()
        else:
            assert not bar.get_facecolor()[3]


def test_a_missed_lower_limit_of_zero_has_a_bar_beyond_100_percent():
    """Mean 100 N, σ 35 N: 3 σ are 105 % of the mean; a share of nothing ends hatched."""
    limit = {"limit": 0.0, "source": "test", "pantograph": "P"}
    rows = [
        Criterion(name="mean force", value=100.0, unit="N", **limit | {"limit": 120.0}),
        Criterion(name="statistical minimum", value=-5.0, relation="above", unit="N", start=100.0, **limit),
        Criterion(name="contact loss", value=0.05, unit="%", **limit),
    ]
    mean, minimum, loss = views.plot_criteria(rows).patches
    assert mean.get_width() == pytest.approx(100 / 1.2)
    assert minimum.get_width() == pytest.approx(105)
    assert (loss.get_width(), bool(loss.get_hatch())) == (200, True)


def test_the_force_is_drawn_with_the_filter_of_its_figures(short_run):
    ax = short_run.plot_contact_force(filter="zero-phase")
    line = next(c for c in ax.lines if "0 to 20 Hz" in c.get_label())
    assert line.get_ydata() == pytest.approx(short_run.filtered_contact_force("zero-phase")[0])
    sigma = short_run.contact_force_statistics(filter="zero-phase")[0].std
    assert f"σ {sigma:.1f} N" in ax.get_title(loc="left")


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


@pytest.fixture(scope="module")
def whole_lines(curved_shape):
    """Pictures of six spans, with two of them closer."""
    return {
        "layout": views.plot_layout(curved_shape.catenary, curved_shape),
        "sketch": views.plot_layout(curved_shape.catenary),
        "plan": views.plot_plan(curved_shape),
        "static shape": views.plot_static_shape(curved_shape),
    }


def test_the_whole_line_is_drawn_with_a_detail(whole_lines):
    for name, whole in whole_lines.items():
        low, high = whole.get_xlim()
        assert low <= 0, name
        assert high >= 390, name
        *_, close = whole.figure.axes
        low, high = close.get_xlim()
        assert 130 < high - low < 140, name
        assert "drawn closer below" in whole.get_legend_handles_labels()[1]


def test_evaluated_spans_are_marked(whole_lines):
    """The fourth and the sixth, not what lies between them."""
    for whole in whole_lines.values():
        bands = [p for p in whole.patches if mpl.colors.to_hex(p.get_facecolor()) == EVALUATED]
        assert [(b.get_x(), b.get_x() + b.get_width()) for b in bands] == [(195, 260), (325, 390)]


def test_the_plan_contains_the_curve(whole_lines, curved_shape):
    whole = whole_lines["plan"]
    assert "curve to the left, radius 1500 m, in spans 3 to 5" in whole.get_title(loc="left")
    bar = next(line for line in whole.lines if line.get_label() == "curve")
    assert tuple(bar.get_xdata()) == (130, 325)
    wire = next(line for line in whole.lines if line.get_label() == "contact wire")
    middle = np.interp(227.5, *wire.get_data())
    assert middle == pytest.approx(curved_shape.contact_wires[0].lateral(227.5), abs=1e-4)
    assert middle > 0.3  # 65² / (8 · 1500) m
    straight = views.plot_plan(curved_shape, spans=[1, 2]).get_title(loc="left")
    assert "spans 1 and 2, straight track" in straight


def test_each_kind_of_wire_has_a_colour_of_its_own(whole_lines):
    for name in ("layout", "sketch", "plan"):
        lines = {line.get_label(): line.get_color() for line in whole_lines[name].lines}
        assert len({lines[kind] for kind in WIRES}) == 3


def test_wires_are_drawn_as_the_curves_that_they_are(twin_wires_shape):
    """Cubic between nodes, and not straight: both wires, where they were drawn."""
    ax, line = views.plot_static_shape(twin_wires_shape), twin_wires_shape.catenary
    for wire, name in zip(twin_wires_shape.contact_wires, ("right", "left"), strict=True):
        x, z = next(c for c in ax.lines if c.get_label() == f"{name} contact wire").get_data()
        assert z == pytest.approx(1e3 * (wire.height(x) - 5.2))
        bends = np.abs(np.diff(np.diff(z) / np.diff(x)))
        clamps = np.union1d(line.support_positions, line.dropper_positions)
        free = np.abs(x[1:-1, None] - clamps).min(axis=1) > 0.6
        assert bends[free].max() < 0.2  # mm/m; straight between nodes it is 0.8 and more


def boxes(ax, texts):
    """Bounding boxes of texts, once the figure is laid out."""
    FigureCanvasAgg(ax.figure)
    ax.figure.draw_without_rendering()
    return [text.get_window_extent() for text in texts]


@pytest.mark.parametrize("name", ["curved_shape", "twin_wires_shape", "reference_shape"])
def test_labels_do_not_overlap(request, name):
    """Tensions of 45 droppers, distances, numbers, forces: none is written over another."""
    shape = request.getfixturevalue(name)
    figures = [views.plot_layout(shape.catenary, shape).figure, views.plot_static_shape(shape).figure]
    if shape.catenary.is_spatial:
        figures.append(views.plot_plan(shape).figure)
    for figure in figures:
        for ax in figure.axes:
            texts = [text for text in ax.texts if text.get_text()]
            found = boxes(ax, texts)
            for i, a in enumerate(found):
                over = [texts[j].get_text() for j in range(i) if a.overlaps(found[j])]
                assert not over, (ax.get_title(loc="left"), texts[i].get_text(), over)


def overlapping(ax):
    """Pairs of texts of a picture that are written over each other."""
    texts = [text for text in ax.texts if text.get_text()]
    found = boxes(ax, texts)
    return [(texts[i], texts[j]) for i, a in enumerate(found) for j in range(i) if a.overlaps(found[j])]


@pytest.fixture(scope="module")
def overlap_shape(curved_shape):
    """Two sections of six spans, four of them shared."""
    line = curved_shape.catenary
    straight = line.replace(spans=tuple(span.replace(curve_radius=None) for span in line.spans))
    return cf.find_form(cf.join_sections([straight, straight], [cf.Overlap(spans=4)]))


def test_numbers_of_many_supports_are_thinned(reference):
    """Eighty spans: numbers stay level and clear of each other, equal spans are counted."""
    count = 80
    line = reference.replace(
        spans=reference.spans[:1] * count, supports=reference.supports[:1] * (count + 1), evaluated_spans=(3,)
    )
    whole = views.plot_layout(line)
    assert overlapping(whole) == []
    texts = [text.get_text() for text in whole.texts]
    numbers = [int(text) for text in texts if text.isdigit()]
    assert numbers == list(range(2, count + 2, 2))
    assert f"{count} × 60 m" in texts


def test_labels_of_an_overlap_stay_clear(overlap_shape):
    """Two arms at a support have a force each, beside each other."""
    pictures = [views.plot_plan(overlap_shape), views.plot_layout(overlap_shape.catenary, overlap_shape)]
    for ax in (ax for picture in pictures for ax in picture.figure.axes):
        assert overlapping(ax) == [], ax.get_title(loc="left")
    close = pictures[0].figure.axes[1]
    places = [text.xy[0] for text in close.texts if text.get_text().endswith("N")]
    assert len(places) > len(set(places)) > 1


def test_a_legend_names_neighbouring_sections(overlap_shape):
    lines = {line.get_label(): line.get_color() for line in views.plot_static_shape(overlap_shape).lines}
    first, second = (lines[f"contact wire, section {n}"] for n in (1, 2))
    assert first != second
    assert not {first, second} & {WIRES["messenger wire"], WIRES["stitch wire"], SUPPORT, DROPPER}


def test_wires_droppers_supports_and_pantographs_have_colours_of_their_own():
    """Far apart as red, green and blue go: none is mistaken for another in one picture."""
    colours = [*WIRES.values(), DROPPER, SUPPORT, *PANTOGRAPHS[:2]]
    channels = [np.array(mpl.colors.to_rgb(colour)) for colour in colours]
    for i, a in enumerate(channels):
        for b in channels[:i]:
            assert np.linalg.norm(a - b) > 0.3, (colours[i], b)


def test_heights_along_the_line(reference):
    """A ramp of 50 mm in a span of 60 m: 0.83 ‰, where 2 ‰ are allowed at 200 km/h."""
    heights = (5.3, 5.3, 5.25, 5.25, 5.25)
    supports = [
        support.replace(contact_wire_height=height)
        for support, height in zip(reference.supports[:5], heights, strict=True)
    ]
    line = reference.replace(spans=reference.spans[:4], supports=tuple(supports), evaluated_spans=(3,))
    ax = views.plot_heights(cf.find_form(line), speed=200 / 3.6)
    wire = next(c for c in ax.lines if c.get_label() == "contact wire at rest")
    assert np.interp(line.support_positions[1:4], *wire.get_data()) == pytest.approx(heights[1:4], abs=2e-3)
    shown = [text.get_text() for text in ax.texts if "." in text.get_text()]
    assert shown == ["5.30", "5.30", "5.25", "5.25"]  # the ends, and where the wire begins to rise or fall
    assert overlapping(ax) == []
    below = ax.figure.axes[0] if ax.figure.axes[1] is ax else ax.figure.axes[1]
    steps = next(patch for patch in below.patches if patch.get_label() == "gradient of a span")
    assert steps.get_data().values == pytest.approx([0, -0.05 / 60 * 1e3, 0, 0])
    limits = sorted(c.get_ydata()[0] for c in below.lines if c.get_linestyle() == "--")
    assert limits == pytest.approx([-2, 2])


def test_the_tension_of_every_dropper_is_drawn(twin_wires_shape):
    heights, tensions = views.plot_static_shape(twin_wires_shape).figure.axes
    texts = [t.get_text() for t in heights.texts]
    assert texts == [f"{force:.0f} N" for force in twin_wires_shape.dropper_forces]
    ends = np.concatenate([[s[1] for s in c.get_segments()] for c in tensions.collections])
    assert sorted(ends[:, 1]) == pytest.approx(sorted(twin_wires_shape.dropper_forces))


def test_elasticity_breaks_where_spans_were_not_computed():
    x = np.array([0.0, 25, 50, 75, 100, 200, 225, 250])
    curve = cf.Elasticity(
        position=x, uplift=0.05 + 1e-4 * x, force=100.0, support_position=np.arange(0.0, 251, 50)
    )
    pieces = [line.get_xdata().tolist() for line in curve.plot().lines if line.get_marker() == "."]
    assert pieces == [[0, 25, 50, 75, 100], [200, 225, 250]]


def test_as_many_colours_as_supports(short_run):
    run = cf.Run(short_run.data.assign_attrs(evaluated_spans="[1, 2, 3, 4]"))
    ax = run.plot_support_uplift()
    curves = [line.get_color() for line in ax.lines if "support" in str(line.get_label())]
    assert len(curves) == len(set(curves)) == 3
    bars = ax.figure.axes[1].patches
    assert [mpl.colors.to_hex(bar.get_facecolor()) for bar in bars] == curves
    assert [bar.get_height() for bar in bars] == pytest.approx(
        1e3 * run.data["support_uplift"].values[1:-1].max(axis=1)
    )
    for count in (5, 14, 60):
        assert len(set(sequence(count))) == len(set(distinct(count))) == count


def test_spans_that_the_line_does_not_have(short_shape):
    for draw in (views.plot_static_shape, views.plot_plan):
        with pytest.raises(cf.InputError, match="span 5: the line has spans 1 to 4"):
            draw(short_shape, spans=[4, 5])
    with pytest.raises(cf.InputError, match="the line has spans 1 to 4"):
        views.plot_layout(short_shape.catenary, spans=[0])


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


def wrappers(function):
    """The code of all functions that a decorated one is made of."""
    while function:
        yield function.__code__
        function = getattr(function, "__wrapped__", None)


def test_every_picture_is_drawn_in_our_own_style():
    ours = styled(lambda: None).__code__
    names = [name for _, name, _ in pkgutil.walk_packages(views.__path__, "catenary_fe.views.")]
    for module in map(import_module, names):
        for name, drawn in vars(module).items():
            if name.startswith("plot_") or name in ("film", "report_page", "comparison_page"):
                assert isinstance(drawn, ModuleType) or ours in wrappers(drawn), (module, name)


@pytest.mark.parametrize("plot", ["forces", "deviation", "uplift"])
@pytest.mark.parametrize("by", [[], ["contact_wire.tension"]])
def test_the_legend_of_a_sweep_stays_inside(plot, by):
    """Also where names are long: two tensions, two pantographs each."""
    keys = [*(q.key for q in FORCE.values()), UPLIFT.key]
    rows = [
        {"speed_kmh": v, "contact_wire.tension": tension, "number": n} | dict.fromkeys(keys, 100.0 + v + n)
        for v in (150.0, 200.0)
        for tension in ((20e3, 22e3) if by else (20e3,))
        for n in ((1, 2) if by else (1,))
    ]
    ax = getattr(views, f"plot_sweep_{plot}")(rows, "speed_kmh", by)
    FigureCanvasAgg(ax.figure).draw()
    legend, inside = ax.get_legend().get_window_extent(), ax.get_window_extent()
    assert legend.x0 >= inside.x0 and legend.x1 <= inside.x1
    assert legend.y0 >= ax.transData.transform((150.0, ax.dataLim.y1))[1]
