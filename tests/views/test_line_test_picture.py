"""The picture of a run beside a line test: an axis for all that was measured, and nothing else."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe import views


def measured(run, *what):
    x, force = run.data["position"].values[0], run.data["contact_force"].values[0]
    place = {"position": x + 50} if {"force", "height"} & set(what) else {}
    found = {
        "force": force + 4.0,
        "height": run.data["wire_height"].values[0] - 5,
        "uplift": {3: [0.02], 4: [0.01]},
    }
    return cf.LineTest([cf.MeasuredPass(**place, **{name: found[name] for name in what})])


@pytest.mark.parametrize(
    ("what", "labels"),
    [
        (["force"], ["contact force (N)", "mean (N)", "σ (N)", "amplitude (N)"]),
        (["height"], ["height (mm)"]),
        (["uplift"], ["largest uplift (mm)"]),
        (
            ["force", "height", "uplift"],
            ["contact force (N)", "mean (N)", "σ (N)", "amplitude (N)", "height (mm)", "largest uplift (mm)"],
        ),
    ],
)
def test_axes_are_of_what_was_measured(short_run, what, labels):
    shift = -50.0 if what != ["uplift"] else None
    compared = cf.compare_with_line_test(short_run, measured(short_run, *what), shift=shift)
    first = views.plot_line_test(compared)
    axes = first.get_figure().axes
    assert [ax.get_ylabel() for ax in axes] == labels
    assert axes[0] is first and short_run.data.attrs["title"] in first.get_title(loc="left")
    assert all(ax.get_xlabel() for ax in axes)


def test_curves_are_those_of_run_and_measurement(short_run):
    compared = cf.compare_with_line_test(short_run, measured(short_run, "force", "height"), shift=-50.0)
    axes = {ax.get_ylabel(): ax for ax in views.plot_line_test(compared).get_figure().axes}
    lines = {line.get_label().split(":")[0]: line for line in axes["contact force (N)"].lines}
    x, y = lines["run"].get_data()
    assert y == pytest.approx(
        np.interp(x, short_run.data["position"].values[0], short_run.filtered_contact_force()[0])
    )
    assert lines["measured"].get_ydata() - y == pytest.approx(
        4.0, abs=1e-6
    )  # where both are at the same times
    assert lines["measured"].get_xdata() == pytest.approx(x, abs=1e-6)
    own, other = (axes["height (mm)"].lines[i].get_ydata() for i in (-1, -2))
    assert own - own.mean() == pytest.approx(other - other.mean(), abs=1e-6)
    assert abs(own.mean() - other.mean()) < 0.01  # from levels that are 5 m apart
