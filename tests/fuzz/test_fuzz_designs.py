"""Designs and options, impossible ones among them: each ends in a shape that holds or in clear errors."""

import copy
import faulthandler
import json
import math
import sys

import pytest
from hostile import INPUTS, call, document, layouts, places, try_all
from hypothesis import strategies as st

import catenary_fe as cf

PATIENCE = 120  # [s] a line of two spans takes a second; what takes longer has hung
LONGEST = 1000.0  # [m] a long line is slow, not hostile

numbers = st.one_of(st.sampled_from([0.0, 1e-15, 0.011, 1e3, 1e6, 1e15, -1.0, 51.0]), st.floats(-2, 2))
factors = st.one_of(
    st.floats(-1.5, 1.5).map(lambda power: 10**power),
    st.floats(0.5, 2.0),
    st.sampled_from([-1.0, 1e3, 1e-3, 1e-9]),
)
changes = st.tuples(st.integers(0, 10**6), st.one_of(factors, factors, numbers.map(str)))
designs = st.tuples(st.integers(0, 4), st.lists(changes, min_size=1, max_size=3))


def changed(record, change):
    """A copy with one of its numbers scaled by a factor, or replaced where the change is a text."""
    where, factor = change
    paths = [p for p in places(record) if is_number(at(record, p)) and p[-1] != "count"]
    record = copy.deepcopy(record)
    *parents, last = paths[where % len(paths)]
    owner = at(record, parents)
    owner[last] = float(factor) if isinstance(factor, str) else owner[last] * factor
    return record


def is_number(value):
    return isinstance(value, int | float) and not isinstance(value, bool)


def at(record, path):
    for part in path:
        record = record[part]
    return record


def test_designs(reference_layout, tmp_path, capsys):
    path = tmp_path / "design.toml"
    bases = layouts(reference_layout.parent)
    for base in bases:
        base["span"][0]["count"] = 2
        base["span"][0]["droppers"] = base["span"][0]["droppers"][::2]

    def outcome(case):
        record = bases[case[0]]
        for change in case[1]:
            record = changed(record, change)
        path.write_text(document(record))
        try:
            if cf.load_catenary(path).length > LONGEST:
                return "too long to try"
        except cf.InputError:
            pass
        faulthandler.dump_traceback_later(PATIENCE, exit=True, file=sys.__stderr__)
        try:
            code, out, err = call("form", path, "--json")
        finally:
            faulthandler.cancel_dump_traceback_later()
        said = [line for line in err.splitlines() if not line.startswith("warning: ")]
        if code:
            assert code in (3, 4)
            assert out == ""
            assert said
            assert all(line.startswith("error: ") for line in said)
            return "refused" if code == 3 else "no equilibrium"
        assert not said
        for dropper in json.loads(out)["droppers"]:
            assert dropper["length_m"] > 0
            assert dropper["force_N"] >= 0
            assert abs(dropper["contact_wire_height_error_mm"]) <= 0.1
            assert all(math.isfinite(v) for v in dropper.values() if isinstance(v, float))
        return "a shape"

    seen = try_all(designs, outcome, max(20, INPUTS // 10))
    with capsys.disabled():
        print(f"\ndesigns tried: {seen.total() - seen['too long to try']}, {dict(seen)}")
    assert seen["refused"]
    assert seen["a shape"]


OPTIONS = {
    "--speed-kmh": ["nan", "inf", "-inf", "0", "-0.0", "1e308", "1e-300", "4.99", "600.1", "", "300 km/h"],
    "--time-step-ms": ["nan", "inf", "0", "-1", "1e-300", "1e-4", "20.1", "1e308", "eins"],
    "--element-m": ["nan", "inf", "0", "-0.0", "-1", "1e-300", "1e-6", "5e-324"],
    "--store-wire-ms": ["nan", "inf", "-1", "1e-300", "0.5"],
    "--pantograph-at": ["nan", "inf", "-1", "0", "1e308", "9.9", "119", "10 10", "10 10.5", "100 10 20"],
    "--spans": ["", ",", "0", "-1", "1", "99", "2,,3", "2;3", "1e3", "٣", "9" * 5000, "nan"],
    "--pantograph": ["", " ", "x" * 5000, "\0", "..", "/dev/zero", "/dev/null", "a\nb", "missing.toml"],
    "--filter": ["", "none"],
    "--criteria": ["", "ac ", "EN"],
}  # fmt: skip
sound = {"--speed-kmh": "200", "--pantograph": "EN 50318:2002"}
faulty = st.sampled_from([(option, value) for option, values in OPTIONS.items() for value in values])


def test_options_of_a_run(reference_layout, tmp_path, capsys):
    """One or two hostile options beside sound ones; each is refused, with nothing on standard output."""
    path = tmp_path / "line.toml"
    record = layouts(reference_layout.parent)[0]
    record["span"][0]["count"] = 3
    path.write_text(document(record))

    def outcome(case):
        words = ["run", path, "--quiet", "--json"]
        for option, value in (sound | dict(case)).items():
            parts = value.split(" ") if option == "--pantograph-at" else [value]
            words += [option, *parts]
            if option == "--pantograph-at":
                words += ["--pantograph", "EN 50318:2002"] * (len(parts) - 1)
        code, out, err = call(*words)
        assert code in (2, 3), words
        assert out == ""
        assert "rror: " in err
        return "usage" if code == 2 else "refused"

    seen = try_all(st.lists(faulty, min_size=1, max_size=2), outcome, max(30, INPUTS // 5))
    with capsys.disabled():
        print(f"\noptions tried: {seen.total()}, {dict(seen)}")
    assert min(seen["usage"], seen["refused"]) > 0


@pytest.mark.parametrize("force", ["nan", "inf", "-1", "0"])
def test_forces(reference_layout, force):
    code, out, err = call("static", reference_layout, "--force", force)
    assert (code, out) == (3, "")
    assert err.startswith("error: elasticity: force = ")
