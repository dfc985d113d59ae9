"""Ways into the compiled engines for tests."""

import numpy as np
import pytest

from catenary_fe.engines.base import RunCase


def entry(function):
    """Python's way into a function that is compiled for other compiled ones alone."""
    numba = pytest.importorskip("numba")

    @numba.njit
    def call(*arguments):
        return function(*arguments)

    return call


def drive(engine, pairs, speed, start, steps, step=1e-3):
    """History of pantographs, each with its uplift, over some steps."""
    case = RunCase([pantograph for pantograph, _ in pairs], speed, start, (steps + 0.5) * speed * step)
    return engine.run(case, np.array([uplift for _, uplift in pairs]))


def feel(wires, give, changes, first=0):
    """Let the wires of one slot feel changes of forces, by these columns of the inverse from the first on."""
    for i, change in enumerate(changes, start=first):
        begin, column = give.first[i], give.value[i]
        wires.x[begin : begin + column.size, 0] += change * column
