"""A force over a wire with bending stiffness, free and supported: method of lines (fig. 7 and 8)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from validation.case import PERTURBED, Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import FORCE, PAPER, TENSION, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

BENDING, TIME = 200e3, 0.5
ENDS = (-36.0, 96.0)
SUPPORTS = np.arange(-30.0, 91.0, 6.0)
MISTUNED = np.array(
    [-30.0, -23.6, -18.0, -12.4, -5.2, 0.0, 7.2, 12.0, 18.8, 23.6, 30.8, 36.0, 43.2, 60.0, 72.4, 90.0]
)
RUNS: dict[str, tuple[float, Floats]] = {
    "free, V = 0.725 c": (0.725, np.array([])),
    "supports every 6 m, V = 0.725 c": (0.725, SUPPORTS),
    "supports every 6 m, V = c": (1.0, SUPPORTS),
    "irregular supports, V = 0.725 c": (0.725, MISTUNED),
}
QUICK = 2  # so many of them
INTERVALS = (0.2, 0.1)  # m
SOURCE = f"{PAPER}, eq. 1 and 8 (P = −T, h² put right): second differences on 0.2 and 0.1 m, extrapolated"
REASON = "the aim of the suite; steps of 0.125 ms leave 0.1 to 0.2 % at supports, the extrapolation as much"
TEXT = """200 N over the paper's wire with S = 200 kN m²; both models end at pinned ends, so that echoes
agree too. The method of lines is of second order: over supports, 0.2 m leaves 2.8 % at 0.725 c and 5.8 % at
c, 0.1 m 0.7 % and 1.4 %, so the reference is extrapolated from both. Of ANCF it is the time step that
counts, not the element: 0.5 ms leaves 1.4 % and 2.5 %, 0.25 ms 0.4 % and 0.6 %; 0.5 m instead of 0.25 m or
2 N instead of 200 N change nothing."""


@dataclass(frozen=True)
class Runs:
    """Deflections at the nodes x: by ANCF, by ANCF with 1 % more tension, by the method of lines."""

    x: Floats
    ancf: Floats
    off: Floats
    lines: Floats


def compute(quick: bool) -> dict[str, Runs]:
    chosen = list(RUNS)[: QUICK if quick else None]
    return {name: _both(name, 2.5e-4 if quick else 1.25e-4) for name in chosen}


def _both(name: str, step: float) -> Runs:
    x, supports, load = _posed(name)
    ancf = []
    for perturbation in (1.0, PERTURBED):
        tensioned = wire(BENDING, tension=perturbation * TENSION)
        problem = WireProblem(wire=tensioned, x=x, supports=supports.tolist(), loads=[load])
        ancf.append(run(problem, TIME, step=step, interval=TIME).deflection[-1])
    return Runs(x, ancf[0], ancf[1], _reference(name))


def _posed(name: str) -> tuple[Floats, Floats, theory.MovingForce]:
    """Nodes [m], supports [m] and the force of one of the runs."""
    ratio, supports = RUNS[name]
    return even_nodes([*ENDS, *supports], 0.25), supports, theory.MovingForce(force=FORCE, speed=ratio * C)


@lru_cache(maxsize=len(RUNS))
def _reference(name: str) -> Floats:
    """[m] at the nodes, the same for every engine: what costs most of this case is solved once."""
    coarse, fine = (_by_lines(name, interval) for interval in INTERVALS)
    return fine + (fine - coarse) / 3


def _by_lines(name: str, interval: float) -> Floats:
    from scipy.interpolate import CubicSpline

    x, supports, load = _posed(name)
    lines = theory.solve_by_lines(
        wire(BENDING).beam,
        [TIME],
        ends=ENDS,
        intervals=round((ENDS[1] - ENDS[0]) / interval),
        supports=supports,
        loads=[load],
    )
    return np.asarray(CubicSpline(lines.x, lines.deflection[-1])(x))


def compare_runs(runs: dict[str, Runs], perturbation: float) -> list[Check]:
    return [
        compare_curves(
            f"{name}: deflection at {TIME:g} s",
            pair.x,
            pair.off if perturbation == PERTURBED else pair.ancf,
            pair.lines,
            0.002 if name.startswith("free") else 0.01,
            source=SOURCE,
            reason="a smooth deflection: both methods are exact to 0.1 %"
            if name.startswith("free")
            else REASON,
            unit="m",
        )
        for name, pair in runs.items()
    ]


def draw(runs: dict[str, Runs], figure: Figure) -> None:
    figure.set_size_inches(8, 2.3 * len(runs))
    for ax, (name, pair) in zip(figure.subplots(len(runs), 1, sharex=True), runs.items(), strict=True):
        ax.plot(pair.x, 1e3 * pair.ancf, **COMPUTED, label="ANCF")
        ax.plot(pair.x, 1e3 * pair.lines, **REFERENCE, label="method of lines")
        supports = RUNS[name][1]
        ax.plot(supports, 0 * supports, "k^", markersize=3)
        label(ax, "", "deflection in mm", f"{name}, t = {TIME:g} s")
    figure.axes[-1].set_xlabel("x in m")
    figure.axes[0].legend(fontsize=8)


CASE = Case(
    name="method_of_lines",
    kind="verification",
    title="Bending stiffness of 200 kN m², free and supported",
    text=TEXT,
    off="ANCF with a tension 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_runs,
    draw=draw,
)
