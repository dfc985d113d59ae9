"""Every case passes, and its twin, which is wrong on purpose, fails."""

import pytest

from validation import CASES, run_cases, run_twins

SLOW = {"en50318_2002_300"}
QUICK = [
    pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name
    for name, case in CASES.items()
    if case.quick
]


def check_case(name, *, quick):
    checks = run_cases([name], quick=quick)
    assert checks
    assert [f"{c.quantity}: {c.error:.3g} > {c.tolerance:.3g}" for c in checks if c.passed is False] == []
    twins = [check for check in run_twins([name], quick=quick) if check.twin]
    assert twins, "the twin must be able to fail something"
    assert [check.quantity for check in twins if check.passed] == []


@pytest.mark.parametrize("name", QUICK)
def test_quick_case_passes_and_its_twin_fails(name):
    check_case(name, quick=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_full_case_passes_and_its_twin_fails(name):
    check_case(name, quick=False)
