"""The self-check: passes here, and misses when the answer is another one."""

import json

import pytest

from catenary_fe.cli.main import main
from catenary_fe.studies import selfcheck

KEYS = {"name", "computed", "reference", "unit", "tolerance", "source", "error", "passed"}


def test_this_installation(capsys):
    code = main(["selfcheck", "--json", "--quiet"])
    out, err = capsys.readouterr()
    rows = json.loads(out)
    assert code == 0
    assert err == "9 passed, 0 missed\n"
    assert all(set(row) == KEYS and row["passed"] for row in rows)


def test_a_wrong_tension_is_missed(monkeypatch):
    """The closed forms see 1 % of it; the wire keeps its own."""
    monkeypatch.setattr(selfcheck, "_reference_run", lambda progress: [])
    wire = selfcheck._wire
    monkeypatch.setattr(
        selfcheck, "_wire", lambda bending=0.0: wire(bending).replace(tension=1.01 * selfcheck._TENSION)
    )
    assert not any(check.passed for check in selfcheck.selfcheck())


def test_a_miss_is_exit_code_1(capsys, monkeypatch):
    wrong = selfcheck.SelfCheck("two", 2.0, 2.1, "m", 0.01, "arithmetic")
    monkeypatch.setattr(selfcheck, "selfcheck", lambda progress: [wrong])
    assert main(["selfcheck", "--quiet"]) == 1
    assert capsys.readouterr().err == "0 passed, 1 missed\n"


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 0.0])
def test_what_is_no_answer_is_missed(value):
    assert not selfcheck.SelfCheck("x", value, 1.0, "m", 0.01, "").passed
