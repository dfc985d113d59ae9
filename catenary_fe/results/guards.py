"""Physics guards: what a finished run must satisfy before its numbers are trusted.

Each guard is a named check with value and bound, computed from the run's own histories and inputs, so that it
is there for every run, loaded ones too. A guard that cannot be judged on a run is left out.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results.signal import CUT_OFF
from catenary_fe.system import Pantograph

if TYPE_CHECKING:
    from catenary_fe.results.run import Run

Floats = NDArray[np.float64]

DEEPEST = 0.010  # [m] of the head in the wire
STEPS_A_PERIOD = 20  # the trapezoidal rule then lengthens a period by (2π/20)²/12, 0.8 %
STEPS_AN_ELEMENT = 2  # below it, whole elements are jumped over
IMBALANCE = 0.005  # of the uplift
SPREAD = 0.2  # of the standard deviation
SLACK = 0.1  # of the droppers' time


@dataclass(frozen=True)
class Check:
    """One guard: what was found, what it must be, and what to do if it is not.

    name : short, for tables and JSON
    rule : whether the bound is the largest ("at most") or the smallest ("at least") good value
    text : what value and bound are, and the remedy
    """

    name: str
    value: float
    unit: str
    rule: Literal["at most", "at least"]
    bound: float
    text: str

    @property
    def passed(self) -> bool:
        """False also where the value is not a number."""
        return self.value <= self.bound if self.rule == "at most" else self.value >= self.bound

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {
            "name": self.name,
            "value": self.value if np.isfinite(self.value) else None,
            "unit": self.unit,
            "rule": self.rule,
            "bound": self.bound,
            "passed": bool(self.passed),
        }

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"{self.name} = {self.value:.4g}{unit}, must be {self.rule} {self.bound:.4g}{unit}: {self.text}"
        )


def run_checks(run: Run) -> tuple[Check, ...]:
    """All guards that can be judged on a run."""
    guards: tuple[Callable[[Run], Iterator[Check]], ...] = (
        _penetration,
        _force_balance,
        _element_passing,
        _steps_per_element,
        _steps_per_period,
        # those of the evaluated spans come last
        _end_reflection,
        _start_transient,
        _slack_droppers,
    )
    if not run.reached:  # of a partial run: what its evaluated spans say is not known
        guards = guards[:5]
    return tuple(check for guard in guards for check in guard(run))


def _lumped(run: Run) -> list[tuple[int, Pantograph]]:
    return [(i, p) for i, p in enumerate(run.pantographs) if isinstance(p, Pantograph)]


def _penetration(run: Run) -> Iterator[Check]:
    """The contact spring stands for a hard contact: 50 kN/m gives by 4 mm under 200 N, by 10 mm under 500 N.

    What goes deeper is a spring so soft that it changes the result, or an impact that no head survives.
    """
    depths = [
        float((run.data["mass_height"].values[i, 0] - run.data["wire_height"].values[i]).max())
        for i, _ in _lumped(run)
    ]
    if depths:
        text = "the head goes into the wire; take a stiffer contact, and look at the peaks of the force"
        yield Check("penetration", 1e3 * float(np.max(depths)), "mm", "at most", 1e3 * DEEPEST, text)


def _force_balance(run: Run) -> Iterator[Check]:
    """Newton's law over the whole run: uplift, base spring and damper, less the contact force, is momentum.

    The histories are those of the steps' ends; what is left of a sound run is the rounding of the last
    velocity, far below half a per cent of the uplift (0.02 % at most in the EN 50318:2002 runs).
    """
    if run.time.size < 3:
        return
    shares = []
    for i, pantograph in _lumped(run):
        force, uplift = run.data["contact_force"].values[i], float(run.data["uplift_force"].values[i])
        heights = run.data["mass_height"].values[i, : len(pantograph.stages)]
        base = heights[-1] - run.catenary.contact_wire_height
        lowest, duration = pantograph.stages[-1], float(run.time[-1])
        pushed = np.trapezoid(uplift - force - lowest.stiffness * base, dx=run.step)
        pushed -= lowest.damping * (base[-1] - base[0])
        velocity = (1.5 * heights[:, -1] - 2 * heights[:, -2] + 0.5 * heights[:, -3]) / run.step
        gained = sum(s.mass * v for s, v in zip(pantograph.stages, velocity, strict=True))
        shares.append(abs(float(pushed - gained)) / duration / uplift)
    if shares:
        text = "forces on a pantograph and its momentum do not agree; take a smaller time step or tolerance"
        yield Check("force balance", 100 * float(np.max(shares)), "%", "at most", 100 * IMBALANCE, text)


def _mesh(run: Run) -> dict[str, float]:
    return dict(json.loads(run.data.attrs["settings"]).get("mesh", {}))


def _element_passing(run: Run) -> Iterator[Check]:
    """A wire gives a little more in an element than at its nodes: passing elements sound a tone.

    It must lie above the evaluated band. The study of meshes has what it does: 2 m at 300 km/h, 42 Hz.
    """
    if longest := _mesh(run).get("contact_wire_element"):
        text = "elements are passed in the band of the filter; take shorter ones (--element-m)"
        yield Check("element-passing frequency", run.speed / longest, "Hz", "at least", CUT_OFF, text)


def _steps_per_element(run: Run) -> Iterator[Check]:
    """Each element must see the pantograph."""
    mesh = _mesh(run)
    if mesh:
        shortest = min(mesh["at_clamps"], mesh["contact_wire_element"])
        text = "the pantograph jumps over the shortest elements; take a smaller time step"
        steps = shortest / (run.speed * run.step)
        yield Check("steps in an element", steps, "", "at least", STEPS_AN_ELEMENT, text)


def _steps_per_period(run: Run) -> Iterator[Check]:
    """Of the highest frequency excited that matters: the filter's, or the head's on its contact spring."""
    resonances = [sqrt(p.contact_stiffness / p.stages[0].mass) / (2 * pi) for _, p in _lumped(run)]
    highest = max([CUT_OFF, *resonances])
    text = f"in a period of {highest:.1f} Hz, the filter's or the head's on the contact; take a smaller step"
    yield Check("time steps in a period", 1 / (highest * run.step), "", "at least", STEPS_A_PERIOD, text)


def _end_reflection(run: Run) -> Iterator[Check]:
    """The wave that the leading pantograph sends ahead at the start comes back from the line's end.

    On its way, at the speed of the faster of the two wires, supports and droppers take from it; yet from
    where it meets a pantograph on, the force is that of a line that ends.
    """
    catenary, start = run.catenary, run.data["position"].values[:, 0]
    fastest = max(catenary.contact_wire.wave_speed, catenary.messenger_wire.wave_speed)
    meeting = (2 * catenary.length - start.max() - start) / (fastest + run.speed)
    met = float((start + run.speed * meeting).min())
    end = float(catenary.support_positions[max(run.evaluated_spans)])
    text = (
        "there the wave of the start, back from the line's end, meets a pantograph, before the evaluated"
        f" spans end at {end:g} m; add spans behind them or evaluate earlier ones"
    )
    yield Check("end reflection", met, "m", "at least", end, text)


def _start_transient(run: Run) -> Iterator[Check]:
    """Equal spans far from the start have equal forces: what is left of the start differs from span to span.

    Compared are the standard deviations in neighbouring equal spans, the one before the evaluated ones
    included where the run passes all of it; their difference is a share of the mean one.
    """
    catenary, first = run.catenary, min(run.evaluated_spans)
    started = float(run.data["position"].values[:, 0].max())
    numbers = sorted(run.evaluated_spans)
    if first > 1 and catenary.support_positions[first - 2] >= started and len(numbers) == 1:
        numbers = [first - 1, *numbers]
    equal = [
        (a, b) for a, b in pairwise(numbers) if b == a + 1 and catenary.spans[a - 1] == catenary.spans[b - 1]
    ]
    if not equal:
        return
    shares = []
    for a, b in equal:
        for before, after in zip(
            run.contact_force_statistics([a]), run.contact_force_statistics([b]), strict=True
        ):
            shares.append(2 * abs(before.std - after.std) / (before.std + after.std or 1.0))
    text = (
        "standard deviations of neighbouring equal spans differ: the start's transient or reflections are"
        " still there; evaluate spans further from the start and the ends"
    )
    yield Check("start transient", 100 * float(np.max(shares)), "%", "at most", 100 * SPREAD, text)


def _slack_droppers(run: Run) -> Iterator[Check]:
    """A passing pantograph slackens the droppers near it for a moment; more is a wire that is not carried."""
    inside = np.isin(run.data["dropper_span"].values, run.evaluated_spans)
    forces = run.data["dropper_force"].values[inside]
    if forces.size:
        text = "share of the time that droppers of the evaluated spans are slack; look at uplift and lengths"
        yield Check("slack droppers", 100 * float((forces <= 0).mean()), "%", "at most", 100 * SLACK, text)
