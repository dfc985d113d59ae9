"""Writes REPORT.md and its pictures."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from catenary_fe.results.files import atomic_write, write_text
from validation.case import Case
from validation.cases import CASES
from validation.check import NO_REFERENCE, Check

_INTRODUCTION = """# Validation report

Written by `catenary-fe validate` with Exudyn {exudyn}; do not edit.

**{passed} of {count} checks pass.**{missed}

*Verification* compares with closed forms and independent numerical solutions of the same equations;
*validation* with published results. An error is relative to the reference unless its line says otherwise; of
a curve, it is the root mean square of the difference over that of the reference. Where engines compute a
case, each has a column of errors, the default one first, whose values are shown. Each case has a negative
control, wrong on purpose by what its last line names, which the tests run and which must fail. *Inside* and
*outside* stand where a reference was recalled and not read: shown, not counted.
"""
_HEADINGS = {"verification": "Verification", "validation": "Validation"}


def write_report(checks: Sequence[Check], path: Path | str) -> Path:
    """Write ``REPORT.md`` and ``pictures/`` into the folder ``path``; returns the report's path."""
    folder = Path(path)
    pictures: dict[str, bytes] = getattr(checks, "pictures", {})
    (folder / "pictures").mkdir(parents=True, exist_ok=True)
    for name, picture in pictures.items():
        with atomic_write(folder / "pictures" / f"{name}.png") as aside:
            aside.write_bytes(picture)
    report = folder / "REPORT.md"
    write_text(report, report_text(checks, set(pictures)))
    return report


def report_text(checks: Sequence[Check], pictures: set[str]) -> str:
    """The report as Markdown. pictures : names of the cases that have one"""
    misses = [check for check in checks if check.passed is False]
    judged = [check for check in checks if check.passed is not None]
    names = [", ".join(filter(None, (c.case, c.engine, c.quantity))) for c in misses]
    missed = f" Missed: {'; '.join(names)}." if names else ""
    parts = [
        _INTRODUCTION.format(
            exudyn=version("exudyn"), passed=len(judged) - len(misses), count=len(judged), missed=missed
        )
    ]
    by_case: dict[str, list[Check]] = {}
    for check in checks:
        by_case.setdefault(check.case, []).append(check)
    for kind, heading in _HEADINGS.items():
        cases = [name for name in by_case if CASES[name].kind == kind]
        if cases:
            parts.append(f"## {heading}\n")
        parts += [_section(CASES[name], by_case[name], name in pictures) for name in cases]
    return "\n".join(parts)


def _section(case: Case, checks: Sequence[Check], picture: bool) -> str:
    lines = [f"### {case.title}\n", f"`{case.name}`: {case.text}\n"]
    errors = [f"error, {engine}" for engine in case.engines] or ["error"]
    heads = ["quantity", "computed", "reference", *errors, "tolerance", ""]
    lines += [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    by_quantity: dict[str, list[Check]] = {}
    for check in checks:
        by_quantity.setdefault(check.quantity, []).append(check)
    lines += [_row(rows) for rows in by_quantity.values()]
    sources = list(dict.fromkeys(check.source for check in checks))
    reasons = list(dict.fromkeys(check.reason for check in checks))
    lines += ["", *(f"- Tolerance: {reason}" for reason in reasons)]
    lines += [f"- Reference: {source}" for source in sources]
    lines += [f"- Negative control: {case.off}", ""]
    if picture:
        lines += [f"![{case.title}](pictures/{case.name}.png)\n"]
    return "\n".join(lines)


def _row(checks: Sequence[Check]) -> str:
    """One quantity, as all engines have it; it passes if all of them do."""
    first, verdicts = checks[0], [check.passed for check in checks]
    beside = "" if first.reference == NO_REFERENCE else "**outside**" if first.error else "inside"
    mark = beside if None in verdicts else "passed" if all(verdicts) else "**MISSED**"
    errors = [f"{check.error:.2g}" for check in checks]
    values = [_text(value, first.unit) for value in (first.computed, first.reference)]
    return f"| {' | '.join([first.quantity, *values, *errors, f'{first.tolerance:.2g}', mark])} |"


def _text(value: float | str, unit: str) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.6g} {unit}".rstrip()
