"""The golden set: what moved since it was written, and by how much."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from results import FILE, compute

RELATIVE = 2e-4  # rounding of another machine or library, through iterations that end at 1e-4 of a step
ABSOLUTE = {"form": 2e-4, "statics": 1e-5, "run": 0.02, "system": 0.0}  # [N, m, mm] of small numbers


def moved(case, before, now):
    """Lines on the numbers of a case that are not what they were."""
    kind = next(kind for kind in ABSOLUTE if kind in case.split(": ")[1])
    found = [f"{case}: {name}: gone" for name in before if name not in now]
    for name, value in now.items():
        if name not in before:
            found.append(f"{case}: {name}: new")
        elif not abs(value - before[name]) <= max(RELATIVE * abs(before[name]), ABSOLUTE[kind]):
            found.append(f"{case}: {name}: {before[name]:.6g} -> {value:.6g} ({value - before[name]:+.2g})")
    return found


@pytest.fixture(scope="module")
def golden():
    return json.loads(FILE.read_text(encoding="utf-8"))


def test_no_number_moved(golden):
    now = compute()
    assert now.keys() == golden.keys()
    lines = [text for case in now for text in moved(case, golden[case], now[case])]
    assert not lines, "\n".join(
        ["numbers moved; if that is meant: python tests/golden/renew.py, and say so in CHANGELOG.md", *lines]
    )


def test_a_moved_number_is_named(golden):
    case = "en50318_2002: nonlinear run, 250 km/h"
    now = golden[case] | {"std_N": golden[case]["std_N"] + 0.05}
    (line,) = moved(case, golden[case], now)
    assert line.startswith(f"{case}: std_N: ") and line.endswith("(+0.05)")
    assert moved(case, golden[case], golden[case]) == []
    assert moved(case, golden[case], {}) and moved(case, {}, golden[case])
    assert moved(case, golden[case], dict.fromkeys(golden[case], float("nan")))
