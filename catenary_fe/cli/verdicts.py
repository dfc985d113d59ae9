"""How a run, or the cases of a sweep, did: checks, criteria and warnings, by case and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import click

from catenary_fe.cli.folder import folder_of, read_record
from catenary_fe.cli.terminal import progress_bar, say
from catenary_fe.layout import PowerSystem
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.results import Criterion, Run
    from catenary_fe.statics import Shape
    from catenary_fe.studies.sweep import BrokenCase, SweepCase
    from catenary_fe.studies.sweep_store import Record

_MOST = 5  # warnings by themselves
_NO_MARGIN = 100.0  # share of a limit


def evaluated(
    run: Run, filter: FilterKind, system: PowerSystem | None
) -> tuple[dict[str, Any], list[Criterion]]:
    """Summary of a run and, where a system is given, its criteria, which the summary holds too."""
    from catenary_fe.results import criteria_rows, excess, governing

    summary = run.summary(filter=filter)
    if system is None:
        return summary, []
    rows = criteria_rows(run, system, filter=filter)
    summary["governing_pantograph"] = governing(run.figures(filter), excess(rows))
    summary["criteria_system"] = system
    summary["criteria"] = [row.as_dict() for row in rows]
    return summary, rows


def with_elasticity(run: Run, shape: Shape, quiet: bool) -> Run:
    """The run with the elasticity of its evaluated spans."""
    from catenary_fe.statics.elasticity import elasticity

    with progress_bar("elasticity", not quiet) as progress:
        return run.with_elasticity(elasticity(shape, progress=progress))


def kept_evaluation(folder: str | Path) -> tuple[FilterKind, PowerSystem | None]:
    """How the run in a folder was evaluated, by its summary: the filter, and the system if it was judged.

    Raises InputError where the summary is damaged.
    """
    said = read_record(folder_of(folder) / "summary.json")
    kinds: tuple[FilterKind, ...] = get_args(FilterKind)
    systems: tuple[PowerSystem, ...] = get_args(PowerSystem)
    return (
        next((kind for kind in kinds if kind == said.get("filter")), "causal"),
        next((system for system in systems if system == said.get("criteria_system")), None),
    )


def exit_code(rows: Sequence[Criterion]) -> int:
    """1 where a criterion is missed, which is said on standard error; else 0."""
    from catenary_fe.results import labels, missed

    misses = missed(rows)
    for row, label in zip(rows, labels(rows), strict=True):
        if row in misses:
            click.echo(f"missed: {label}: {row.value_text}, must be {row.limit_text}", err=True)
    return 1 if misses else 0


@dataclass(frozen=True)
class Verdict:
    """Checks, criteria and warnings of one case.

    values : what tells it from the others
    criteria : of its system; empty where it was not judged, or failed
    failed_checks : by name, in words
    warnings : besides failed checks
    governing : name of the pantograph that decides
    error : why it did not run; empty where it did
    """

    values: dict[str, Any]
    criteria: Sequence[Criterion] = ()
    failed_checks: dict[str, str] = field(default_factory=dict)
    warnings: Sequence[str] = ()
    governing: str | None = None
    error: str = ""

    @property
    def missed(self) -> list[Criterion]:
        """Criteria that it misses."""
        return [row for row in self.criteria if row.passed is False]

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON, criteria with the share of their limits used."""
        from catenary_fe.results import labels

        return {
            "values": self.values,
            "governing": self.governing,
            "criteria": [
                row.as_dict() | {"label": label, "used": _finite(row.used)}
                for row, label in zip(self.criteria, labels(self.criteria), strict=True)
            ],
            "checks_failed": self.failed_checks,
            "warnings": list(self.warnings),
            "error": self.error,
        }

    def missed_by(self, pantograph: str) -> str:
        """Names of the criteria that a pantograph misses, and the line's."""
        return "; ".join(row.name for row in self.missed if row.pantograph in (pantograph, None))


def _finite(used: float | None) -> float | None:
    """A share of a limit as JSON can hold it; where there is no margin at all, a large one."""
    return None if used is None else min(used, _NO_MARGIN)


def verdict_of(record: Record, case: SweepCase | BrokenCase, system: PowerSystem | None) -> Verdict:
    """The verdict on a case, by what is kept of its run."""
    from catenary_fe.results import excess, governing, judge
    from catenary_fe.results.check import FAILED
    from catenary_fe.studies.sweep import BrokenCase
    from catenary_fe.studies.sweep_figures import key_figures_of

    if isinstance(case, BrokenCase) or "error" in record:
        return Verdict(record["values"], error=record["error"])
    summary = record["summary"]
    figures = key_figures_of(record, case)
    criteria = judge(figures, system) if system else []
    failed = [text.removeprefix(FAILED) for text in summary["warnings"] if text.startswith(FAILED)]
    return Verdict(
        record["values"],
        criteria,
        dict(zip(summary["checks_failed"], failed, strict=True)),
        [text for text in summary["warnings"] if not text.startswith(FAILED)],
        governing(figures.statistics, excess(criteria)),
    )


def in_words(verdicts: Sequence[Verdict], system: PowerSystem | None) -> list[str]:
    """One sentence each on cases that did not run, checks, criteria and warnings."""
    ran = [v for v in verdicts if not v.error]
    count = f"of {len(ran)} cases"
    said = (
        [f"{len(verdicts) - len(ran)} of {len(verdicts)} cases did not run"]
        if len(ran) < len(verdicts)
        else []
    )
    if not ran:
        return said
    checks = [list(v.failed_checks) for v in ran if v.failed_checks]
    said.append(f"checks failed in {len(checks)} {count}{_named(checks)}" if checks else "all checks passed")
    misses = [[row.name for row in v.missed] for v in ran if v.missed]
    if system:
        missed = f"criteria of {system} missed in {len(misses)} {count}{_named(misses)}"
        said.append(missed if misses else f"all criteria of {system} with a known limit met")
    warned = sum(bool(v.warnings) for v in ran)
    said.append(f"warnings in {warned} {count}" if warned else "no warning")
    return said


def _named(by_case: Iterable[Sequence[str]]) -> str:
    """Each name with the number of cases that it is in."""
    counted = Counter(name for names in by_case for name in dict.fromkeys(names))
    return ": " + ", ".join(f"{name} in {n}" for name, n in counted.most_common())


def warn_once(verdicts: Sequence[Verdict]) -> None:
    """Each warning once on standard error, with the number of its cases; of many, the most frequent ones."""
    counted = Counter(text for v in verdicts for text in dict.fromkeys(v.warnings))
    for text, n in counted.most_common(_MOST):
        say("warning", f"{n} of {len(verdicts)} cases: {text}", "yellow")
    if len(counted) > _MOST:
        say("warning", f"and {len(counted) - _MOST} others: all are in remarks.csv", "yellow")


def sweep_exit_code(verdicts: Sequence[Verdict], system: PowerSystem | None) -> int:
    """1 where a case misses a criterion, which is said on standard error; else 0."""
    misses = [[row.name for row in v.missed] for v in verdicts if v.missed]
    if misses:
        click.echo(
            f"missed: criteria of {system} in {len(misses)} of {len(verdicts)} cases{_named(misses)}",
            err=True,
        )
    return 1 if misses else 0


def remarks(verdicts: Sequence[Verdict]) -> Iterator[dict[str, Any]]:
    """Rows of a table: all remarks on the cases, in words."""
    from catenary_fe.results import labels

    for verdict in verdicts:
        found = [("did not run", verdict.error)] if verdict.error else []
        found += [("check failed", text) for text in verdict.failed_checks.values()]
        found += [
            ("criterion missed", f"{label}: {row.value_text}, must be {row.limit_text}")
            for row, label in zip(verdict.criteria, labels(verdict.criteria), strict=True)
            if row.passed is False
        ]
        found += [("warning", text) for text in verdict.warnings]
        for kind, text in found:
            yield verdict.values | {"kind": kind, "text": text}
