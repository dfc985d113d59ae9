"""A way into the compiled kernels for tests."""

import pytest


def entry(function):
    """Python's way into a function that is compiled for other compiled ones alone."""
    numba = pytest.importorskip("numba")

    @numba.njit
    def call(*arguments):
        return function(*arguments)

    return call
