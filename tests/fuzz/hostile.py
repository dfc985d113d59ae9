"""Files that no engineer would write: sound records with hostile edits, and bytes that are no text."""

from __future__ import annotations

import contextlib
import copy
import io
import json
import os
import tomllib
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from catenary_fe.cli.main import main

# of each test of files, and a share of it of those that solve; FUZZ_INPUTS=10000 is the longer mode
INPUTS = int(os.environ.get("FUZZ_INPUTS", "300"))

EDGES = (
    0, -0.0, 1, -1, 1e-300, 5e-324, 1e-15, 1e-12, 1e-6, 1e-3, 0.01, 0.5, 49.9, 50.0, -50.0, 1e3, 1e6, 1e9,
    1e12, 1e15, 1.7976931348623157e308, -1e308, 10**25, 10**400, 2**63, -(2**63), float("inf"),
    float("-inf"), float("nan"),
)  # fmt: skip
NOT_NUMBERS = (
    True, False, "", "20 kN", "name\nsecond line", "é\u2028\x7f", "x" * 5000, [], {}, [[]], [1, "a"],
    {"a": {"b": 1}},
)  # fmt: skip
FACTORS = (1e3, 1e-3, 3.6, 1 / 3.6, 9.81, -1.0, 1e6, 1e-6)  # a unit for another

values = st.one_of(
    st.sampled_from(EDGES),
    st.sampled_from(NOT_NUMBERS),
    st.floats(),
    st.floats(1e-3, 1e3),
    st.integers(-5, 20),
    st.integers(),
    st.text(max_size=20),
    st.recursive(st.integers(-3, 3), lambda s: st.lists(s, max_size=3), max_leaves=8),
)
edits = st.tuples(
    st.integers(0, 10**6),
    st.sampled_from(["put", "put", "put", "scale", "drop", "twice", "add"]),
    values,
    st.sampled_from(FACTORS),
    st.text(min_size=1, max_size=6),
)


def places(record: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of everything inside a record."""
    found = [path] if path else []
    items = (
        record.items() if isinstance(record, dict) else enumerate(record) if isinstance(record, list) else ()
    )
    for key, value in items:
        found += places(value, (*path, key))
    return found


def edited(record: dict[str, Any], edit: tuple[Any, ...]) -> dict[str, Any]:
    """A copy of a record with one thing put, scaled, dropped, given twice or added."""
    where, how, value, factor, name = edit
    record = copy.deepcopy(record)
    paths = places(record)
    if not paths:
        return {name: value}
    *parents, last = paths[where % len(paths)]
    owner: Any = record
    for part in parents:
        owner = owner[part]
    old = owner[last]
    if how == "drop":
        del owner[last]
    elif how == "scale" and isinstance(old, int | float) and not isinstance(old, bool):
        owner[last] = old * factor if abs(old) < 1e300 else -old  # beyond floats: a whole number
    elif how == "twice" and isinstance(owner, list):
        owner.insert(last, copy.deepcopy(old))
    elif how == "add" and isinstance(owner, dict):
        owner[name] = value
    else:
        owner[last] = value
    return record


def toml(value: Any) -> str:
    """A value as TOML, tables in one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml(str(k))} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return repr(value)


def document(record: dict[str, Any]) -> str:
    """A record as a TOML file."""
    return "\n".join(f"{toml(str(key))} = {toml(value)}" for key, value in record.items()) + "\n"


def damaged(text: str, damage: tuple[str, int, bytes, str]) -> bytes:
    """A file with bytes cut, put in or given twice, or in another encoding."""
    how, where, extra, encoding = damage
    if how == "encode":
        return text.encode(encoding, errors="replace")
    raw = text.encode(errors="surrogatepass")
    at = where % (len(raw) + 1)
    if how == "cut":
        return raw[:at]
    if how == "twice":
        line = raw[at:].split(b"\n")[0]
        return raw + line + b"\n"
    return raw[:at] + extra + raw[at:]


damages = st.tuples(
    st.sampled_from(["encode", "cut", "twice", "insert"]),
    st.integers(0, 10**6),
    st.one_of(
        st.binary(max_size=8),
        st.sampled_from([b"\0", b"[[", b'"""', b"\xef\xbb\xbf", b"= = ", b"1e999", b"0x" + b"f" * 50]),
    ),
    st.sampled_from(["utf-8-sig", "utf-16", "utf-32", "latin-1", "cp037", "utf-7"]),
)  # fmt: skip


def hostile_records(bases: list[dict[str, Any]], most: int = 4) -> st.SearchStrategy[dict[str, Any]]:
    """Records with one to some hostile edits."""

    def build(case: tuple[int, list[tuple[Any, ...]]]) -> dict[str, Any]:
        record = bases[case[0]]
        for edit in case[1]:
            record = edited(record, edit)
        return record

    return st.tuples(st.integers(0, len(bases) - 1), st.lists(edits, min_size=1, max_size=most)).map(build)


def hostile_files(bases: list[dict[str, Any]]) -> st.SearchStrategy[bytes]:
    """Files of hostile records, of damaged sound ones, and of anything at all."""
    written = hostile_records(bases).map(lambda r: document(r).encode(errors="surrogatepass"))
    broken = st.tuples(st.sampled_from(bases).map(document), damages).map(lambda case: damaged(*case))
    return st.one_of(
        written, written, written, broken, st.binary(max_size=200), st.text(max_size=200).map(str.encode)
    )


def try_all(strategy: st.SearchStrategy[Any], outcome: Callable[[Any], str], inputs: int) -> Counter[str]:
    """Try many inputs; counts of what they ended in. The same ones each time, unless in the longer mode."""
    seen: Counter[str] = Counter()

    @settings(
        max_examples=inputs,
        deadline=None,
        database=None,
        phases=[Phase.generate],  # a found case is short enough; making it shorter takes minutes
        derandomize="FUZZ_INPUTS" not in os.environ,
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def one(case: Any) -> None:
        seen[outcome(case)] += 1

    one()
    return seen


def layouts(folder: Path) -> list[dict[str, Any]]:
    """The library's layouts, with few spans, and keys of the space that none of them has."""
    records = []
    for name in ("en50318_2002", "en50318_2018_ac_simple", "en50318_2018_ac_stitched", "dc_3kv_twin"):
        record = tomllib.loads((folder / f"{name}.toml").read_text())
        del record["evaluated_spans"]
        record["span"] = [record["span"][0] | {"count": 3, "pre_sag": 0.02}]
        records.append(record)
    arm = {"length": 1.0, "mass_per_length": 0.7, "clamp_mass": 0.2, "inclination": 0.2, "side": "left"}
    arm |= {"holds_design_height": False, "uplift_room": 0.2}
    support = {"at": 2, "stagger": -0.2, "messenger_stagger": 0.1, "system_height": 1.3, "steady_arm": arm}
    support |= {"messenger_lateral_stiffness": 1e5, "messenger_lateral_damping": 10.0, "stitch_wire": False}
    records.append(records[1] | {"curve_radius": 800.0, "supports": [support], "spatial": True})
    return records


def call(*arguments: object) -> tuple[int, str, str]:
    """Exit code, output and errors of a command, with numerical warnings as faults."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
        warnings.simplefilter("error")
        code = main([str(a) for a in arguments])
    return code, out.getvalue(), err.getvalue()
