"""The closed forms against each other and against their equations; no finite elements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from validation.case import PERTURBED, Case
from validation.check import Check, compare, compare_curves
from validation.paper_wire import FORCE, MASS, PAPER, STRING, TENSION, C, Floats, wire
from validation.pictures import COMPUTED, REFERENCE, label

LENGTH, SPEED, TIME = 50.0, 0.725 * C, 0.55
BOUNDED: dict[str, Any] = {"length": LENGTH, "speed": SPEED}
EQUATION = "differences of second order with a spacing of 0.05 m leave (0.05 m/2 m)² of the terms"
SERIES = "2000 terms, summed as they stand, fall as 1/n²"
ROUNDING = "two ways to write the same number: rounding"


@dataclass(frozen=True)
class Data:
    """Deflections at TIME on a bounded string by images, and by the series."""

    x: Floats
    images: Floats
    series: Floats


def compute(quick: bool) -> Data:
    x = np.linspace(0, LENGTH, 501)
    images = theory.moving_force_by_images(STRING, x, TIME, **BOUNDED, force=FORCE)
    series = theory.moving_force_series(STRING, x, TIME, **BOUNDED, force=FORCE, modes=2000, accelerate=False)
    return Data(x, images, series)


def residual(factor: float) -> tuple[float, float]:
    """[N/m] largest |ρ ü − T u'' − f| of eq. 4 with its source term times a factor, and largest f."""
    width = 2.0

    def load(x: Floats, t: Floats) -> Floats:
        return factor * FORCE * np.exp(-(((x - SPEED * t) / width) ** 2))

    h, t = 0.05, 0.2
    tick = h / C / 2
    x = np.linspace(-30, 30, 241)
    u = {
        (i, j): theory.distributed_load(
            STRING, x + i * h, np.full_like(x, t + j * tick), load=load, points=64
        )
        for i, j in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
    }
    inertia = MASS * (u[0, 1] - 2 * u[0, 0] + u[0, -1]) / tick**2
    tension = TENSION * (u[1, 0] - 2 * u[0, 0] + u[-1, 0]) / h**2
    pressure = FORCE * np.exp(-(((x - SPEED * t) / width) ** 2))
    return float(np.abs(inertia - tension - pressure).max()), float(np.abs(pressure).max())


def compare_data(data: Data, perturbation: float) -> list[Check]:
    printed = perturbation == PERTURBED
    left, pressure = residual(perturbation)
    ends = float(np.abs(data.images[[0, -1]]).max() / data.images.max())
    # the print has ρc = 1 in eq. 6
    under = FORCE * TIME / (2.0 if printed else 2 * MASS * C)
    moving = float(theory.moving_force(STRING, SPEED * TIME, TIME, speed=SPEED, force=FORCE))
    x = np.linspace(-50, 50, 401)
    slow = theory.moving_force(STRING, x, 0.3, speed=1e-6 * C, force=perturbation * FORCE)
    rest = theory.force_at_rest(STRING, x, 0.3, force=FORCE)
    near = theory.moving_force(STRING, x, 0.3, speed=(1 - 1e-9) * C, force=perturbation * FORCE)
    critical = theory.moving_force(STRING, x, 0.3, speed=C, force=FORCE)
    flexible, more = wire(1e-3).beam, perturbation * FORCE
    beam = theory.moving_force_series(flexible, data.x, TIME, **BOUNDED, force=more, modes=2000)
    eq4, eq7, eq6 = f"{PAPER}, eq. 4 and 5", f"{PAPER}, eq. 7", f"{PAPER}, eq. 6, with its ρc"
    return [
        compare(
            "eq. 4: ρ ü − T u'' − f over f",
            left / pressure,
            0.0,
            1e-3,
            source=eq4,
            reason=EQUATION,
            absolute=True,
        ),
        compare_curves(
            "bounded string: series, images",
            data.x,
            data.series,
            perturbation * data.images,
            1e-3,
            source=eq7,
            reason=SERIES,
            unit="m",
        ),
        compare(
            "bounded string: deflection at the ends over the largest",
            ends,
            0.0,
            1e-12,
            source=eq7,
            reason=ROUNDING,
            absolute=True,
            negative_control=False,
        ),
        compare(
            "eq. 6: deflection under the force", moving, under, 1e-9, source=eq6, reason=ROUNDING, unit="m"
        ),
        compare_curves(
            "V → 0: force at rest", x, slow, rest, 1e-5, source=eq4, reason="V is 1e-6 c, not 0", unit="m"
        ),
        compare_curves("V → c", x, near, critical, 1e-6, source=eq4, reason="V is 1e-9 c from c", unit="m"),
        compare_curves(
            "beam, EI → 0: string",
            data.x,
            beam,
            data.images,
            1e-3,
            source=eq7,
            reason="EI is not 0, and 2000 terms of the sum",
            unit="m",
        ),
    ]


def draw(data: Data, figure: Figure) -> None:
    ax = figure.subplots()
    ax.plot(data.x, 1e3 * data.series, **COMPUTED, label="sine series")
    ax.plot(data.x, 1e3 * data.images, **REFERENCE, label="images")
    label(ax, "x in m", "deflection in mm", f"bounded string, V = 0.725 c, t = {TIME:g} s")
    ax.legend(fontsize=8)


CASE = Case(
    name="closed_forms",
    kind="verification",
    title="Closed forms against each other and their equations",
    text=(
        "Residual of eq. 4 by differences under a moving bell-shaped pressure; limits; series against images."
    ),
    off="1 % more force in eq. 4, and eq. 6 as it is printed, with ρc = 1",
    compute=compute,
    compare=compare_data,
    draw=draw,
)
