"""Dispersion measured from a pulse against ω(k) of the tensioned beam."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare
from validation.engines import ENGINES
from validation.paper_wire import MASS, PAPER, C, Floats, run, wire
from validation.pictures import REFERENCE, label

LENGTH, BENDING, HEIGHT, WIDTH = 60.0, 200e3, 0.002, 1.0
WAVENUMBERS = (0.2, 0.5, 1.0, 1.5)  # rad/m, wavelengths of 31 to 4 m
SOURCE = f"{PAPER}, eq. 1 with P = −T: ω² = (T k² + EI k⁴)/ρ"
REASON = "the time step lowers ω by (ωΔt)²/12, 0.05 % at the highest wavenumber"


@dataclass(frozen=True)
class Measured:
    """k : [rad/m], omega : [rad/s], those that the pulse contains"""

    k: Floats
    omega: Floats


def compute(quick: bool) -> Measured:
    """Sine transform of the shapes; every component swings as cos ωt, so three instants give cos ωτ."""
    x = even_nodes([0, LENGTH], 0.25)
    step, duration = (1e-4, 0.1) if quick else (1e-4, 0.2)
    problem = WireProblem(
        wire=wire(BENDING),
        x=x,
        initial_deflection=lambda x: HEIGHT * np.exp(-(((x - LENGTH / 3) / WIDTH) ** 2)),
    )
    motion = run(problem, duration, step=step, tolerance=1e-8, spectral_radius=1.0)
    n = np.arange(1, int(2.0 * LENGTH / np.pi))
    k = n * np.pi / LENGTH
    swing = motion.deflection @ np.sin(np.outer(x, k))
    strong = np.abs(swing[0]) > 0.05 * np.abs(swing[0]).max()
    k, swing = k[strong], swing[:, strong]
    every = 4
    middle, both = swing[every:-every], swing[2 * every :] + swing[: -2 * every]
    cosine = (middle * both).sum(axis=0) / (2 * (middle**2).sum(axis=0))
    return Measured(k, np.arccos(cosine) / (every * step))


def compare_measured(measured: Measured, perturbation: float) -> list[Check]:
    checks = []
    for wanted in WAVENUMBERS:
        i = int(np.abs(measured.k - wanted).argmin())
        k = float(measured.k[i])
        beam = wire(BENDING, mass_per_length=perturbation * MASS).beam
        exact = float(theory.angular_frequency(beam, k))
        checks.append(
            compare(
                f"ω at k = {k:.3f} rad/m",
                measured.omega[i],
                exact,
                0.002,
                source=SOURCE,
                reason=REASON,
                unit="rad/s",
            )
        )
    return checks


def draw(measured: Measured, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    k = np.linspace(0.01, measured.k.max(), 200)
    omega = theory.angular_frequency(wire(BENDING).beam, k)
    left.plot(measured.k, measured.omega, "o", markersize=3, color="#c1440e", label="measured from a pulse")
    left.plot(k, omega, **REFERENCE, label="tensioned beam")
    left.plot(k, C * k, ":", color="grey", label="string")
    label(left, "wavenumber in rad/m", "angular frequency in rad/s")
    left.legend(fontsize=8)
    exact = theory.angular_frequency(wire(BENDING).beam, measured.k)
    right.plot(measured.k, 100 * (measured.omega / exact - 1), "o", markersize=3, color="#c1440e")
    label(right, "wavenumber in rad/m", "error in %")


CASE = Case(
    name="dispersion",
    kind="verification",
    title="Dispersion measured from a pulse",
    text=(
        "A pulse 2 mm high on 60 m of the paper's wire with EI = 200 kN m² is let go from rest; its"
        " sine components"
        " give ω(k)."
    ),
    off="the wire is 1 % heavier",
    engines=ENGINES,
    compute=compute,
    compare=compare_measured,
    draw=draw,
)
