"""EN 50318:2002 at rest: dropper forces and elasticity of an independent finite-element model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import catenary_fe as cf
from validation.case import Case
from validation.check import Check, compare
from validation.en50318 import Floats, shape
from validation.pictures import COMPUTED, label

SPAN_START = 240.0  # m, of the fifth of ten spans of 60 m
DROPPERS = np.array([69.4, 79.5, 86.2, 86.1, 86.1])  # N, outer to middle
PLACES = np.array([0.0, 2.5, 5.0, 10.5, 17.0, 23.5, 30.0])  # m, in the span
ELASTICITY = np.array([0.234, 0.226, 0.191, 0.293, 0.383, 0.436, 0.454])  # mm/N at 100 N
SOURCE = "an independent planar finite-element model of the same data, three digits"
FORCES = "forces at rest follow from the weights and the design height alone; three digits are printed"
LIFT = "two models with their own meshes, stiffnesses and preloads of supports and arms: 2 %"


@dataclass(frozen=True)
class Statics:
    """Dropper forces [N] from the span's start to its middle, elasticity [mm/N] at PLACES and in between."""

    droppers: Floats
    elasticity: Floats
    x: Floats
    curve: Floats


def compute(quick: bool) -> Statics:
    form = shape()
    positions = form.catenary.dropper_positions
    first = int(np.searchsorted(positions, SPAN_START))
    droppers = cf.solve_statics(form).dropper_forces[first : first + DROPPERS.size]
    at_places = cf.elasticity(form, force=100.0, positions=SPAN_START + PLACES)
    x = PLACES if quick else np.linspace(0, 60, 61)
    curve = cf.elasticity(form, force=100.0, positions=SPAN_START + x)
    return Statics(droppers, 1e3 * at_places.values, x, 1e3 * curve.values)


def compare_statics(statics: Statics, perturbation: float) -> list[Check]:
    droppers = [
        compare(
            f"force of dropper {i + 1}",
            force,
            wanted * perturbation,
            0.005,
            source=SOURCE,
            reason=FORCES,
            unit="N",
        )
        for i, (force, wanted) in enumerate(zip(statics.droppers, DROPPERS, strict=True))
    ]
    elasticity = [
        compare(
            f"elasticity at {x:g} m",
            found,
            wanted * perturbation,
            0.02,
            source=SOURCE,
            reason=LIFT,
            unit="mm/N",
            negative_control=False,
        )
        for x, found, wanted in zip(PLACES, statics.elasticity, ELASTICITY, strict=True)
    ]
    return droppers + elasticity


def draw(statics: Statics, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    number = np.arange(1, DROPPERS.size + 1)
    left.plot(number, statics.droppers, "o", color="#c1440e", label="computed")
    left.plot(number, DROPPERS, "kx", label="independent model")
    left.set_xticks(number)
    left.set_ylim(0, 100)
    label(left, "dropper, from the support to the middle", "force in N")
    left.legend(fontsize=8)
    right.plot(statics.x, statics.curve, **COMPUTED)
    right.plot(PLACES, ELASTICITY, "kx")
    label(right, "x in the span in m", "elasticity at 100 N in mm/N")


CASE = Case(
    name="en50318_2002_statics",
    kind="validation",
    title="EN 50318:2002 at rest",
    text="Dropper forces and elasticity at 100 N in the fifth span of the standard's reference model.",
    off="the reference values are 1 % larger",
    compute=compute,
    compare=compare_statics,
    draw=draw,
)
