"""The rates would show a scheme or elements of another order."""

import numpy as np
import pytest

from catenary_fe.engines.generalized_alpha import make_scheme
from validation.cases import convergence, convergence_of_runs
from validation.engines import on
from validation.rates import compare_rate, rate


def first_order(time):
    """γ larger by 0.2 than second order needs, β so that it stays stable; all else as it is."""
    good, more = make_scheme(time), 0.2
    h, s = good.h, good.s
    gamma, beta = good.g / (h * s), good.b / (h * h * s)
    wider = (gamma + more + 0.5) ** 2 / 4 - beta
    return good._replace(
        b=good.b + wider * h * h * s,
        g=good.g + more * h * s,
        qx=good.qx + h * h * (more * s + wider * good.cx),
        qc=good.qc - wider * h * h * (1 - good.cc),
        vx=good.vx + more * h * good.cx,
        vc=good.vc - more * h * (1 - good.cc),
    )


@pytest.mark.parametrize(
    ("method", "room"), [("nonlinear", "nonlinear.run"), ("linearised", "linearised.setup")]
)
def test_scheme_of_first_order_has_rate_one_and_is_no_pass(monkeypatch, method, room):
    monkeypatch.setattr(f"catenary_fe.engines.{room}.make_scheme", first_order)
    steps = convergence_of_runs.STEPS
    with on(method):
        string = [convergence_of_runs.swing(0.5, 0.0, convergence_of_runs.STRING_END, h) for h in steps]
    nothing = np.zeros(1), np.zeros(1)
    study = convergence_of_runs.Study(string=string, beam=[], fine=nothing, off=nothing)
    errors = convergence_of_runs.string_errors(study)
    assert rate(steps, errors) == pytest.approx(1, abs=0.2)
    assert not compare_rate("step", steps, errors, 2, source="s").passed


def test_lumped_masses_have_rate_two_and_are_no_pass(monkeypatch):
    from scipy.sparse import diags

    from catenary_fe.studies.single_wire import vertical_matrices

    def lumped(problem):
        K, M = vertical_matrices(problem)
        return K, diags(M.diagonal() * M.sum() / M.diagonal().sum())

    monkeypatch.setattr("validation.cases.natural_frequencies.vertical_matrices", lumped)
    study = convergence.Study(
        tie=np.ones(1),
        string=np.array([convergence.frequency(h, 0.0) for h in convergence.ELEMENTS]),
        beam=np.ones(1),
    )
    errors = convergence.errors(study)[1]
    assert rate(convergence.ELEMENTS, errors) < 3
    assert not compare_rate("mesh", convergence.ELEMENTS, errors, 6, source="s").passed


def test_rate_is_that_of_a_power_law():
    size = np.array([4.0, 2.0, 1.0])
    assert rate(size, 5 * size**3) == pytest.approx(3)
    assert compare_rate("q", size, size**3.1, 3, source="s").passed
    assert not compare_rate("q", size, size**3.3, 3, source="s").passed
