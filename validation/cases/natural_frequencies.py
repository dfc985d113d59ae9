"""First ten frequencies of a pinned tensioned beam."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from catenary_fe.studies.single_wire import vertical_matrices
from validation.case import Case
from validation.check import Check, compare
from validation.paper_wire import TENSION, Floats, wire
from validation.pictures import REFERENCE, label

LENGTH, BENDING, COUNT = 60.0, 195.0, 10
SOURCE = "textbook: ω² = (T k² + EI k⁴)/ρ, k = nπ/L; paper, eq. 1 with P = −T"
REASON = "the aim of the suite; twelve and more cubic elements a wavelength err by less than 1e-6"


def frequencies(x: Floats, bending: float, count: int) -> Floats:
    """[Hz] the lowest, from the sparse matrices of the system built for runs in time."""
    from scipy.sparse.linalg import eigsh

    K, M = vertical_matrices(WireProblem(wire=wire(bending), x=x))
    K = (K + K.T) / 2
    # a shift just below the lowest: the start vector is fixed so that runs repeat to the last digit
    values = eigsh(K.tocsc(), count, M.tocsc(), sigma=0.0, v0=np.ones(K.shape[0]), return_eigenvectors=False)
    return np.asarray(np.sqrt(np.sort(values)) / (2 * np.pi))


def exact(count: int, bending: float, perturbation: float = 1.0, length: float = LENGTH) -> Floats:
    beam = wire(bending, tension=perturbation * TENSION).beam
    return theory.natural_frequencies(beam, count, length=length) / (2 * np.pi)


def compute(quick: bool) -> Floats:
    return frequencies(even_nodes([0, LENGTH], 1.0), BENDING, COUNT)


def compare_frequencies(found: Floats, perturbation: float) -> list[Check]:
    return [
        compare(f"frequency {n + 1}", found[n], wanted, 1e-4, source=SOURCE, reason=REASON, unit="Hz")
        for n, wanted in enumerate(exact(COUNT, BENDING, perturbation))
    ]


def draw(found: Floats, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    n = np.arange(1, COUNT + 1)
    left.plot(n, found, "o", color="#c1440e", markersize=4, label="ANCF")
    left.plot(n, exact(COUNT, BENDING), **REFERENCE, label="closed form")
    label(left, "mode", "frequency in Hz")
    left.legend(fontsize=8)
    right.semilogy(n, np.abs(found / exact(COUNT, BENDING) - 1), "o", color="#c1440e", markersize=4)
    label(right, "mode", "relative error")


CASE = Case(
    name="natural_frequencies",
    kind="verification",
    title="First ten frequencies of a pinned tensioned beam",
    text=(
        "60 m of the paper's wire with EI = 195 N m² in elements of 1 m; sparse eigenvalues of the"
        " linearised wire."
    ),
    off="the tension is 1 % larger",
    compute=compute,
    compare=compare_frequencies,
    draw=draw,
)
