"""Every case passes, and its negative control, which is wrong on purpose, fails."""

import pytest

from validation import CASES, run_cases, run_negative_controls

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
    controls = [check for check in run_negative_controls([name], quick=quick) if check.negative_control]
    assert controls, "the negative control must be able to fail something"
    assert [check.quantity for check in controls if check.passed] == []


@pytest.mark.parametrize("name", QUICK)
def test_quick_case_passes_and_its_negative_control_fails(name):
    check_case(name, quick=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_full_case_passes_and_its_negative_control_fails(name):
    check_case(name, quick=False)
