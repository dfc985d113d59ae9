"""EN 50318:2018 AC simple in space at 275 km/h beside the accepted values (recalled, not read)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import catenary_fe as cf
from validation.case import Case
from validation.check import NO_REFERENCE, Check, compare
from validation.pictures import label

Floats = NDArray[np.float64]
LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2018_ac_simple.toml"
SPEED, FASTER = 275, 320  # km/h
APART = 200.0  # m
RECALLED = "EN 50318:2018 (recalled, not read): compared, not judged"
RANGES = (
    ("mean force", "N", 141.5, 146.5),
    ("standard deviation", "N", 31.9, 34.8),
    ("standard deviation, 0 to 5 Hz", "N", 26.4, 28.9),
    ("standard deviation, 5 to 20 Hz", "N", 16.2, 22.4),
    ("actual maximum", "N", 219.0, 244.0),
    ("actual minimum", "N", 71.0, 86.0),
    ("range of the contact point's height", "mm", 38.0, 49.0),
    ("largest uplift at a support", "mm", 39.0, 48.0),
)
HALVES = "half a per cent: four more digits than the standard's ranges; the uplift was set by linearised runs"
LINEAR = (
    "1 %: what the linearised run leaves out, large motions, is small here (the actual minimum is 1.4 % off)"
)


@dataclass(frozen=True)
class RunData:
    """Key figures of each run, one tuple a pantograph in the order of RANGES.

    x, force : [m] and [N], the nonlinear run's filtered force over the evaluated spans
    """

    nonlinear: tuple[float, ...]
    linearised: tuple[float, ...]
    faster: tuple[float, ...]
    pair: list[tuple[float, ...]]
    x: Floats
    force: Floats


def figures(run: cf.Run) -> list[tuple[float, ...]]:
    """A tuple a pantograph."""
    uplift = 1e3 * run.largest_support_uplift()
    return [
        (s.mean, s.std, s.std_0_5, s.std_5_20, s.max, s.min, 1e3 * s.contact_point_range, uplift)
        for s in run.contact_force_statistics()
    ]


def compute(quick: bool) -> RunData:
    shape = cf.find_form(cf.load_catenary(LAYOUT))
    pantograph = cf.library.pantograph("EN 50318:2018 AC")
    linear = cf.simulate(shape, [pantograph], speed=SPEED / 3.6, method="linearised")
    uplift = float(linear.data["uplift_force"].values[0])
    fixed = pantograph.replace(mean_force=None, uplift_force=uplift)
    run = cf.simulate(shape, [fixed], speed=SPEED / 3.6)
    faster = cf.simulate(shape, [pantograph], speed=FASTER / 3.6, method="linearised")
    pair = cf.simulate(
        shape,
        [pantograph, pantograph],
        speed=SPEED / 3.6,
        positions=[APART + 10.0, 10.0],
        method="linearised",
    )
    inside = run.window(0)
    return RunData(
        figures(run)[0],
        figures(linear)[0],
        figures(faster)[0],
        figures(pair),
        np.asarray(run.data["position"].values[0])[inside],
        run.filtered_contact_force()[0][inside],
    )


def compare_runs(data: RunData, perturbation: float) -> list[Check]:
    checks = [
        compare(
            "mean force against 0.00097 v² + 70 N",
            data.nonlinear[0],
            perturbation * cf.target_mean_force("EN 50367 AC", SPEED / 3.6),
            5e-3,
            source="EN 50367 (secondary source)",
            reason=HALVES,
            unit="N",
        ),
        *(_beside(row, value) for row, value in zip(RANGES, data.nonlinear, strict=False)),
    ]
    sigma = 1
    linear = compare(
        "standard deviation, linearised against nonlinear run",
        data.linearised[sigma],
        data.nonlinear[sigma] * (1 + 10 * (perturbation - 1)),
        1e-2,
        source="the nonlinear run",
        reason=LINEAR,
        unit="N",
    )
    return [*checks, linear, *_without_reference(data)]


def _beside(row: tuple[str, str, float, float], value: float) -> Check:
    name, unit, low, high = row
    return Check(
        quantity=f"{name} in {unit}",
        computed=round(value, 2),
        reference=f"{low:g} to {high:g}",
        error=max(low - value, value - high, 0.0) / ((high - low) / 2),
        tolerance=0.0,
        source=RECALLED,
        passed=None,
        reason="the accepted range; the error is the distance outside it in units of its half width",
        negative_control=False,
    )


def _without_reference(data: RunData) -> list[Check]:
    rows = [
        (f"{FASTER} km/h", data.faster),
        (f"{SPEED} km/h, leading of two {APART:g} m apart", data.pair[0]),
        (f"{SPEED} km/h, trailing of two {APART:g} m apart", data.pair[1]),
    ]
    return [
        Check(
            quantity=f"{what}: mean, σ, maximum, minimum in N, uplift in mm",
            computed=", ".join(f"{values[i]:.1f}" for i in (0, 1, 4, 5, 7)),
            reference=NO_REFERENCE,
            error=0.0,
            tolerance=0.0,
            source="none; linearised runs",
            passed=None,
            reason="there is nothing to compare with",
            negative_control=False,
        )
        for what, values in rows
    ]


def draw(data: RunData, figure: Figure) -> None:
    figure.set_size_inches(11, 4.5)
    left, right = figure.subplots(1, 2)
    left.plot(data.x, data.force, color="#c1440e", linewidth=1.0)
    label(left, "x in m", "contact force in N, 20 Hz low-pass", f"spans 6 to 15, {SPEED} km/h")
    for i, ((_, _, low, high), value, linear) in enumerate(
        zip(RANGES, data.nonlinear, data.linearised, strict=False)
    ):
        middle, half = (low + high) / 2, (high - low) / 2
        right.plot([-1, 1], [i, i], color="#bbbbbb", linewidth=9, solid_capstyle="butt", zorder=1)
        right.plot((value - middle) / half, i, "o", color="#c1440e", label=None if i else "nonlinear run")
        right.plot((linear - middle) / half, i, "k|", markersize=11, label=None if i else "linearised run")
    names = [f"{name}\n{low:g} to {high:g} {unit}" for name, unit, low, high in RANGES]
    right.set_yticks(range(len(RANGES)), names, fontsize=7)
    label(right, "place in the recalled range: −1 lower, 1 upper end", "")
    right.set_xlim(-1.8, 1.8)
    right.set_ylim(len(RANGES) - 0.4, -1.3)
    right.legend(fontsize=7, loc="upper right", ncols=2)


CASE = Case(
    name="en50318_2018_ac_simple",
    kind="validation",
    title="EN 50318:2018 AC simple at 275 km/h",
    text=(
        "The spatial reference model, 20 spans with stagger and steady arms as links, one pantograph, the"
        " uplift set for the mean force of EN 50367, spans 6 to 15, causal 20 Hz filter. The accepted"
        " ranges were recalled and not read, so they are shown and do not count. What each datum and choice"
        " moves stands in `models/studies/ac_simple_terms.md`."
    ),
    off="1 % on the mean force; 10 % on the nonlinear run's standard deviation",
    compute=compute,
    compare=compare_runs,
    draw=draw,
    quick=False,
)
