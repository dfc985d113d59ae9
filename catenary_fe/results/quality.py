"""Quality checks: what a finished run must satisfy before its numbers are trusted.

Each is computed from the run's own histories and inputs, so that every run has it, loaded ones too. A check
that cannot be judged on a run is left out.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from itertools import pairwise
from math import floor, log10, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import AnyPantograph, Catenary, Line
from catenary_fe.layout.terminations import WireField
from catenary_fe.results.balances import (
    energy_balance,
    force_balance,
    lumped,
    met_stops,
    name_of,
    pantograph_energy,
    worst,
)
from catenary_fe.results.check import Check
from catenary_fe.results.signal import CUT_OFF, spectrum

if TYPE_CHECKING:
    from catenary_fe.results.run import Run

Floats = NDArray[np.float64]

DEEPEST = 0.010  # [m] of the head in the wire
STEPS_A_PERIOD = 20  # the trapezoidal rule then lengthens a period by (2π/20)²/12, 0.8 %
STEPS_AN_ELEMENT = 2  # below it, whole elements are jumped over
DRIFT = 0.03  # of the tension, which moves the wave speed by 1.5 %; pantographs alone change it by 1 %
TONE = 0.03  # of the mean force
TONE_BAND = 0.9, 1.15  # of the frequency: elements are of somewhat different lengths
FINE = 4  # elements from dropper to dropper
HANN_WIDTH = 1.5  # by which a Hann window widens a line of the spectrum
REFLECTED = 0.1  # of the uplift at the supports
SPREAD = 0.2  # of the standard deviation
SLACK = 0.1  # of the droppers' time


def run_checks(run: Run) -> tuple[Check, ...]:
    """All quality checks that can be judged on a run."""
    checks: tuple[Callable[[Run], Iterator[Check]], ...] = (
        _penetration,
        force_balance,
        pantograph_energy,
        energy_balance,
        _tension_drift,
        _steps_per_element,
        _steps_per_period,
        # those of the evaluated spans come last
        _element_passing,
        _end_reflection,
        _start_transient,
        _slack_droppers,
    )
    if not run.reached:  # of a partial run: what its evaluated spans say is not known
        checks = checks[:7]
    return tuple(check for each in checks for check in each(run))


def _contact_stiffness(pantograph: AnyPantograph) -> float:
    return pantograph.assemble(spatial=False).contact.stiffness


def _down(value: float) -> str:
    """Two digits of a positive number, rounded down, so that the value suggested meets the bound."""
    unit = 10.0 ** (floor(log10(value)) - 1)
    return f"{floor(value / unit + 1e-9) * unit:.2g}"


def _penetration(run: Run) -> Iterator[Check]:
    """The contact spring stands for a hard contact: at 50 kN/m, 4 mm deep under 200 N, 10 mm under 500 N.

    What goes deeper is a spring so soft that it changes the result, or an impact that no head survives.
    """
    found = []
    for i, pantograph in lumped(run):
        depth = run.data["mass_height"].values[i, 0] - run.data["wire_height"].values[i]
        x, force = (float(run.data[n].values[i, depth.argmax()]) for n in ("position", "contact_force"))
        span = int(np.searchsorted(run.data["support_position"].values, x))
        text = (
            f"so deep the head of {name_of(run, i)} goes into the wire at {x:.1f} m (span {span}), under"
            f" {force:.0f} N; raise contact_stiffness from {_contact_stiffness(pantograph):g} N/m, or find"
            " what the head hits there"
        )
        found.append((1e3 * float(depth.max()), text))
    if found:
        value, text = worst(found)
        yield Check("penetration", value, "mm", "at most", 1e3 * DEEPEST, text)


def _tension_drift(run: Run) -> Iterator[Check]:
    """Weights keep the tension of contact and messenger wires, whatever happens between the supports.

    A passing pantograph changes the mean tension of a span by less than 1 %. Stitch wires, which no weight
    keeps, change by 6 % and are not judged; nor are wires with two fixed ends, whose tension is an outcome.
    """
    if "tension_change" not in run.data:
        return
    names = [str(name) for name in run.data["wire"].values]
    judged = [n for n, name in enumerate(names) if _keeps_tension(name, run.catenary)]
    if judged:
        changes = run.data["tension_change"].values[judged]
        row, reading = np.unravel_index(changes.argmax(), changes.shape)
        wire = judged[int(row)]
        span = int(run.data["tension_span"].values[wire, reading])
        text = (
            f"change of the {names[wire].replace('_', ' ')}'s tension in span {span} since the start, at"
            f" {float(run.data['tension_time'].values[reading]):.2f} s; look for what holds the wire along"
            " the track there"
        )
        share = 100 * float(changes[row, reading])
        yield Check("tension drift", share, "%", "at most", 100 * DRIFT, text)


def _keeps_tension(name: str, catenary: Catenary) -> bool:
    """Whether weights or a spring keep the tension of a wire, by its name in the results."""
    if "stitch_wire" in name:
        return False
    number = int(name.split("_")[1]) if name.startswith("section_") else 1
    section = catenary.sections[number - 1] if isinstance(catenary, Line) else catenary
    wire: WireField = "messenger_wire" if name.endswith("messenger_wire") else "contact_wire"
    return any(end.of(wire).kind != "fixed" for end in (section.begin, section.end))


def _mesh(run: Run) -> dict[str, float]:
    return dict(json.loads(run.data.attrs["settings"]).get("mesh", {}))


def _element_passing(run: Run) -> Iterator[Check]:
    """A wire is a little softer within an element than at its nodes: passing elements sound a tone.

    Above the evaluated band it is filtered away. In slow runs it lies inside; of a mesh with several elements
    from dropper to dropper the tone itself is then judged, as part of the filtered force: at 3 % of the mean
    it adds that much to σ at the very most, and 0.15 % to one at its limit of 30 %. Four published lines at
    30 to 90 km/h with elements of 1.3 m have up to 2.3 %; σ is then 0.25 N off where it is 5 N. The study of
    meshes has what longer elements do: 2 m at 300 km/h, 42 Hz.
    """
    longest = _mesh(run).get("contact_wire_element")
    if not longest:
        return
    frequency, catenary = run.speed / longest, run.catenary
    clamps = np.unique(np.concatenate([catenary.lower_clamp_positions, catenary.support_positions]))
    if frequency >= CUT_OFF or FINE * longest > np.median(np.diff(clamps)):
        text = (
            f"at this rate elements of {longest:g} m are passed, inside the filter's band: the force has a"
            f" tone of the mesh; take elements of at most {_down(run.speed / CUT_OFF)} m (--element-m)"
        )
        yield Check("element-passing frequency", frequency, "Hz", "at least", CUT_OFF, text)
        return
    found = []
    for i, force in enumerate(run.filtered_contact_force()):
        inside = force[run.window(i)]
        of_line, amplitude = spectrum(inside, run.step)
        band = (of_line > TONE_BAND[0] * frequency) & (of_line < TONE_BAND[1] * frequency)
        rms = sqrt(float((amplitude[band] ** 2).sum()) / 2 / HANN_WIDTH)
        found.append((100 * rms / max(abs(float(inside.mean())), 1e-9), name_of(run, i)))
    value, name = worst(found)
    text = (
        f"share of the mean force of {name}, as elements of {longest:g} m are passed at {frequency:.1f} Hz;"
        " take shorter ones (--element-m)"
    )
    yield Check("element-passing tone", value, "%", "at most", 100 * TONE, text)


def _steps_per_element(run: Run) -> Iterator[Check]:
    """The pantograph must not step over whole elements."""
    mesh = _mesh(run)
    if mesh:
        shortest = min(mesh["at_clamps"], mesh["contact_wire_element"])
        steps = shortest / (run.speed * run.step)
        text = (
            f"a pantograph moves {run.speed * run.step:.2g} m a step, over elements of {shortest:g} m; take a"
            f" time step of at most {_down(1e3 * shortest / run.speed / STEPS_AN_ELEMENT)} ms"
        )
        yield Check("steps in an element", steps, "", "at least", STEPS_AN_ELEMENT, text)


def _steps_per_period(run: Run) -> Iterator[Check]:
    """Of the highest frequency excited that matters: of the filter, head on contact spring, or stop met."""
    found = [(CUT_OFF, "the filter's cut-off")]
    for i, p in lumped(run):
        resonance = sqrt(_contact_stiffness(p) / p.masses[0]) / (2 * pi)
        found.append((resonance, f"the resonance of the head of {name_of(run, i)} on its contact spring"))
        found.append((met_stops(run, i, p), f"the resonance of {name_of(run, i)} on a stop that it met"))
    highest, what = max(found)
    text = (
        f"in a period of {highest:.1f} Hz, {what}; take a time step of at most"
        f" {_down(1e3 / highest / STEPS_A_PERIOD)} ms"
    )
    yield Check("time steps in a period", 1 / (highest * run.step), "", "at least", STEPS_A_PERIOD, text)


def _end_reflection(run: Run) -> Iterator[Check]:
    """Waves that run ahead are reflected at the end of the model, where no real line ends.

    Judged is the motion at the support before the end, early enough to be back at a pantograph, at the speed
    of the faster wire, before that leaves the evaluated spans. Supports and droppers hold most waves back: a
    slow train meets the front several times and hardly feels it, so that the time of its return alone says
    nothing. (EN 50318:2002 at 40 to 120 km/h, span 3 evaluated: with one span behind it 37 % or more, and σ
    up to 6 % off; with two or more, 9 % at most, and σ as close as that of long lines to each other.)
    """
    catenary, start = run.catenary, run.data["position"].values[:, 0]
    fastest = max(w.wave_speed for w in (catenary.contact_wire, catenary.messenger_wire) if w)
    end = float(catenary.support_positions[max(run.evaluated_spans)])
    leaving = (end - start.min()) / run.speed
    behind = catenary.length - end + catenary.spans[-1].length  # from the last but one support and back
    moved = np.abs(run.data["support_uplift"].values[-2, run.time <= leaving - behind / fastest])
    share = float(moved.max(initial=0.0)) / max(run.largest_support_uplift(), 1e-6)
    text = (
        "share of the largest uplift that reaches the line's last support but one early enough to be back"
        f" before the evaluated spans end at {end:g} m; add spans behind span {max(run.evaluated_spans)}, or"
        " evaluate earlier ones"
    )
    yield Check("end reflection", 100 * share, "%", "at most", 100 * REFLECTED, text)


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
    at = catenary.support_positions
    carried = {int(np.searchsorted(at, item.middle(catenary))) for item in catenary.equipment}
    apart = beside_overlaps(catenary) | carried
    equal = [
        (a, b)
        for a, b in pairwise(numbers)
        if b == a + 1 and catenary.spans[a - 1] == catenary.spans[b - 1] and not {a, b} & apart
    ]
    if not equal:
        return
    found = []
    for i, force in enumerate(run.filtered_contact_force()):
        for spans in equal:
            s, t = (float(force[run.window(i, [span])].std()) for span in spans)
            text = (
                f"so far σ of {name_of(run, i)} in the equal spans {spans[0]} and {spans[1]} differs, {s:.1f}"
                f" and {t:.1f} N: what is left of the start or comes back from the end is still there;"
                " evaluate spans further from both"
            )
            found.append((200 * abs(s - t) / (s + t or 1.0), text))
    value, text = worst(found)
    yield Check("start transient", value, "%", "at most", 100 * SPREAD, text)


def beside_overlaps(catenary: Catenary) -> set[int]:
    """Numbers of the spans in and next to overlaps, where equal spans need not have equal forces."""
    zones = catenary.common_zones if isinstance(catenary, Line) else ()
    ends = catenary.support_positions
    return {
        n
        for begin, end in zones
        for n in range(1, ends.size)
        if ends[n] > begin - catenary.spans[n - 1].length and ends[n - 1] < end + catenary.spans[n - 1].length
    }


def _slack_droppers(run: Run) -> Iterator[Check]:
    """A passing pantograph slackens the droppers near it for a moment; more is a wire that is not carried."""
    spans = run.data["dropper_span"].values
    inside = np.flatnonzero(np.isin(spans, run.evaluated_spans))
    if not inside.size:
        return
    slack = (run.data["dropper_force"].values[inside] <= 0).mean(axis=1)
    longest = int(inside[slack.argmax()])
    number = int(run.catenary.dropper_numbers[longest])
    text = (
        "share of the time that droppers of the evaluated spans are slack, longest dropper"
        f" {number} of span {spans[longest]} with {100 * slack.max():.0f} %; look at the uplift and at the"
        " droppers' lengths"
    )
    yield Check("slack droppers", 100 * float(slack.mean()), "%", "at most", 100 * SLACK, text)
