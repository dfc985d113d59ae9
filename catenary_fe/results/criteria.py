"""Is current collection good? A run's key figures against the limits of its system."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from math import inf
from operator import ge, gt, le
from typing import Any, Literal, get_args

from catenary_fe.layout import AnyPantograph, Catenary, InputError
from catenary_fe.layout.arguments import checked, listed, one_of
from catenary_fe.layout.current_collection import (
    DEVIATION_SHARE,
    MEAN_FORCE_TOLERANCE,
    UPLIFT_FACTOR,
    WAVE_SPEED_SHARE,
    Limit,
    PowerSystem,
    contact_loss_limit,
    force_limit,
    gradient_limit,
    mean_force_limit,
)
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.layout.terminations import slowest_contact_wire
from catenary_fe.results.quantities import DIGITS, FORCE, LATERAL, NON_UNIFORMITY
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.results.statistics import ForceStatistics

Relation = Literal["at most", "at least", "above"]
_HOLDS: dict[Relation, Callable[[float, float], bool]] = {"at most": le, "at least": ge, "above": gt}


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class Criterion:
    """One key figure of a run against one limit: a row of a table, so in display units.

    name : of the figure
    pantograph : whose it is; None: the line's
    value : in ``unit``
    relation : how the value has to stand to the limit
    limit : in ``unit``; None where none is known: then there is no verdict
    unit : N, mm, km/h or %
    source : where the limit comes from, or why there is none
    recalled : whether the limit was recalled by an expert and not read anywhere
    tolerance : in ``unit``, by which the value may miss the limit, because the run itself sets it no closer
    start : in ``unit``, the mean that a figure with a lower limit falls from; None for other figures
    """

    name: str
    pantograph: str | None = None
    value: float
    relation: Relation = "at most"
    limit: float | None
    unit: str
    source: str
    recalled: bool = False
    tolerance: float = 0.0
    start: float | None = None

    @property
    def passed(self) -> bool | None:
        """Whether the value meets the limit; None where no limit is known."""
        if self.limit is None:
            return None
        allowed = self.limit + (self.tolerance if self.relation == "at most" else -self.tolerance)
        return bool(_HOLDS[self.relation](self.value, allowed))

    @property
    def used(self) -> float | None:
        """Share of the limit: 1 at the limit, more beyond it, infinite where the margin is zero or negative.

        Value over limit, or limit over value where that is a lower one; of a figure that is a mean less its
        scatter, the scatter over what the mean has above the limit. None where no limit is known.
        """
        if self.limit is None:
            return None
        if self.start is not None and self.start > self.limit:
            return max(0.0, (self.start - self.value) / (self.start - self.limit))
        part, whole = self.value, self.limit
        if self.relation != "at most":
            part, whole = whole, part
        if whole > 0:
            return max(0.0, part / whole)
        return inf if self.passed is False else 0.0

    @property
    def limit_text(self) -> str:
        """Relation, limit and unit as tables write them; '–' where no limit is known."""
        if self.limit is None:
            return "–"
        about = f" (± {self.tolerance:g})" if self.tolerance else ""
        return f"{self.relation} {self.limit:.{self._digits}f} {self.unit}{about}"

    @property
    def value_text(self) -> str:
        """Value and unit as tables write them."""
        return f"{self.value:.{self._digits}f} {self.unit}"

    @property
    def _digits(self) -> int:
        """Decimals that a table shows: more than usual where value and limit would look the same."""
        usual = DIGITS.get(self.unit, 1)
        value, limit = self.value, self.limit
        if limit is None or limit == value:
            return usual
        return next((n for n in range(usual, 6) if f"{value:.{n}f}" != f"{limit:.{n}f}"), 6)

    @property
    def verdict(self) -> str:
        """'passed', 'missed' or 'not judged'."""
        return {True: "passed", False: "missed", None: "not judged"}[self.passed]

    def as_dict(self) -> dict[str, Any]:
        """All fields and the verdict, ready for JSON."""
        return asdict(self) | {"passed": self.passed}


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class KeyFigures:
    """What is judged of a run.

    speed : [m/s]
    catenary, pantographs : what ran
    statistics : of each pantograph's contact force over the evaluated spans
    uplift : [m] largest at each support of the evaluated spans, by its number from 1
    lateral : [m] farthest contact from the middle of each pantograph's head; None where it is not known
    non_uniformity : of the elasticity, (e_max − e_min)/(e_max + e_min); None where it was not computed
    """

    speed: float
    catenary: Catenary
    pantographs: Sequence[AnyPantograph]
    statistics: Sequence[ForceStatistics]
    uplift: Mapping[int, float]
    non_uniformity: float | None = None
    lateral: Sequence[float | None] = ()


@checked
def criteria_rows(run: Run, system: PowerSystem, *, filter: FilterKind = "causal") -> list[Criterion]:
    """Judge a run: rows of each pantograph first, then those of the line.

    system : "AC", "DC 3 kV" or "DC 1.5 kV"
    filter : "causal" (as EN 50317 measures) or "zero-phase"

    Limits: mean force of EN 50367, σ ≤ 0.3 F_m, F_m − 3σ > 0, the largest force, 0.1 or 0.2 % of the time in
    losses of contact longer than 5 ms, clearance for twice the uplift at steady arms that state theirs
    (``uplift_room``), contact within half the width of heads that state theirs, 0.7 of the wave speed. The
    elasticity's non-uniformity is reported where the run holds it (:meth:`Run.with_elasticity`); no limit of
    it is known here.

    Raises InputError for a partial run.
    """
    one_of("system", system, get_args(PowerSystem))
    if run.partial:
        raise InputError(f"criteria: {run.partial}: only whole runs are judged")
    curve = run.elasticity
    figures = KeyFigures(
        speed=run.speed,
        catenary=run.catenary,
        pantographs=run.pantographs,
        statistics=run.contact_force_statistics(filter=filter),
        uplift=run.uplift_by_support(),
        non_uniformity=curve.non_uniformity if curve else None,
        lateral=[run.largest_contact_lateral(i) for i in range(len(run.pantographs))],
    )
    return judge(figures, system)


def judge(figures: KeyFigures, system: PowerSystem) -> list[Criterion]:
    """Rows of key figures that are known without their run; see :func:`criteria_rows`."""
    rows: list[Criterion] = []
    for pantograph, statistics in zip(figures.pantographs, figures.statistics, strict=True):
        is_set = pantograph.target_mean_force(figures.speed) is not None
        rows += _mean_force(statistics, system, figures.speed, MEAN_FORCE_TOLERANCE if is_set else 0.0)
        rows += _spread(statistics, system, figures.speed)
    rows += _lateral(figures)
    rows += _uplift(figures)
    rows.append(_speed(figures))
    rows += _gradients(figures)
    if figures.non_uniformity is not None:
        rows.append(
            Criterion(
                name=NON_UNIFORMITY.name,
                value=NON_UNIFORMITY.shown(figures.non_uniformity),
                limit=None,
                unit=NON_UNIFORMITY.unit,
                source="no limit known here",
            )
        )
    return rows


def missed(rows: Iterable[Criterion]) -> list[Criterion]:
    """Criteria whose limit is not met."""
    return [row for row in rows if row.passed is False]


def criteria_in_words(rows: Sequence[Criterion]) -> str:
    """How many criteria are missed, and which."""
    count, misses = sum(row.passed is not None for row in rows), missed(rows)
    if not misses:
        return f"all {count} criteria with a known limit met"
    names = ", ".join(label for row, label in zip(rows, labels(rows), strict=True) if row in misses)
    return f"{len(misses)} of {count} criteria missed: {names}"


def excess(rows: Iterable[Criterion]) -> dict[str, float]:
    """Largest share of a limit that each pantograph which misses a criterion uses."""
    found: dict[str, float] = {}
    for row in missed(rows):
        if row.pantograph:
            found[row.pantograph] = max(found.get(row.pantograph, 0.0), row.used or 0.0)
    return found


def labels(rows: Sequence[Criterion]) -> list[str]:
    """Names of the rows, with the pantograph's where there are several."""
    several = len({row.pantograph for row in rows} - {None}) > 1
    return [f"{row.name}, {row.pantograph}" if several and row.pantograph else row.name for row in rows]


def criteria_table(rows: Sequence[Criterion]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Names of the columns, and a row of texts for each criterion, with what its limit rests on."""
    columns = ("criterion", "value", "limit", "verdict", "source of the limit")
    return columns, [
        (label, row.value_text, row.limit_text, row.verdict, row.source)
        for label, row in zip(labels(rows), rows, strict=True)
    ]


def _row(s: ForceStatistics, figure: str, **limit: Any) -> Criterion:
    """The criterion of a contact-force figure, named by its attribute."""
    quantity = FORCE[figure]
    value = quantity.shown(getattr(s, figure))
    return Criterion(name=quantity.name, pantograph=s.pantograph, value=value, unit=quantity.unit, **limit)


def _against(limit: Limit) -> dict[str, Any]:
    return {"limit": limit.value, "source": limit.source, "recalled": limit.recalled}


def _mean_force(s: ForceStatistics, system: PowerSystem, speed: float, tolerance: float) -> list[Criterion]:
    low, high = mean_force_limit(system, "minimum", speed), mean_force_limit(system, "maximum", speed)
    return [
        _row(s, "mean", tolerance=tolerance, relation="at least", **_against(low)),
        _row(s, "mean", tolerance=tolerance, relation="at most", **_against(high)),
    ]


def _lateral(figures: KeyFigures) -> Iterator[Criterion]:
    """The contact stays on the part of the head that may touch, where the pantograph says how wide it is."""
    each = zip(figures.pantographs, figures.statistics, figures.lateral, strict=False)
    for pantograph, statistics, y in each:
        if y is not None and pantograph.head:
            yield Criterion(
                name=LATERAL.name,
                pantograph=statistics.pantograph,
                value=LATERAL.shown(y),
                limit=LATERAL.shown(pantograph.head.width / 2),
                unit=LATERAL.unit,
                source="half of the pantograph's head.width",
            )


def _spread(s: ForceStatistics, system: PowerSystem, speed: float) -> list[Criterion]:
    largest, loss = _against(force_limit(system, speed)), contact_loss_limit(speed)
    share = f"{DEVIATION_SHARE:g} of the mean force (secondary source)"
    above_0 = "mean force − 3 σ above 0 (secondary source)"
    long_losses = {
        "limit": None if loss.value is None else 100 * loss.value,
        "source": f"share of the time in {loss.source}",
        "recalled": loss.recalled,
    }
    return [
        _row(s, "std", limit=DEVIATION_SHARE * s.mean, source=share),
        _row(s, "statistical_min", relation="above", limit=0.0, source=above_0, start=s.mean),
        _row(s, "statistical_max", **largest),
        _row(s, "max", **largest),
        _row(s, "long_contact_loss", **long_losses),
    ]


def _uplift(figures: KeyFigures) -> list[Criterion]:
    """The tightest support of the evaluated spans; those of unknown clearance make a row of their own."""
    uplift, supports = figures.uplift, figures.catenary.supports
    arms = {n: supports[n - 1].steady_arm for n in uplift}
    clearances = {n: arm.uplift_room for n, arm in arms.items() if arm and arm.uplift_room is not None}
    unknown = [n for n in uplift if n not in clearances]
    rows = []
    if clearances:
        tightest = max(clearances, key=lambda n: UPLIFT_FACTOR * uplift[n] - clearances[n])
        source = f"room for {UPLIFT_FACTOR:g} times the uplift (recalled), support {tightest}"
        rows.append(_uplift_row(uplift[tightest], 1e3 * clearances[tightest], source))
    if unknown:
        source = f"no uplift_room given, support {listed(unknown)}"
        rows.append(_uplift_row(max(uplift[i] for i in unknown), None, source))
    return rows


def _uplift_row(uplift: float, clearance: float | None, source: str) -> Criterion:
    return Criterion(
        name="twice the uplift at steady arms",
        value=1e3 * UPLIFT_FACTOR * uplift,
        limit=clearance,
        unit="mm",
        source=source,
        recalled=clearance is not None,
    )


def _gradients(figures: KeyFigures) -> list[Criterion]:
    """Of the design line between supports, where it changes its height."""
    if not figures.catenary.changes_height:
        return []
    limit, gradients = gradient_limit(figures.speed), figures.catenary.gradients.tolist()
    steps = zip([0.0, *gradients], [*gradients, 0.0], strict=True)
    steepest, bend = max(map(abs, gradients)), max(abs(after - before) for before, after in steps)
    assert limit.value is not None
    return [
        Criterion(
            name=name, value=round(1e3 * value, 9), limit=1e3 * share * limit.value, unit="‰",
            source=limit.source, recalled=limit.recalled,
        )
        for name, value, share in (
            ("gradient of the contact wire", steepest, 1.0),
            ("change of the gradient", bend, 0.5),
        )
    ]  # fmt: skip


def _speed(figures: KeyFigures) -> Criterion:
    return Criterion(
        name="speed",
        value=round(3.6 * figures.speed, 9),
        limit=3.6 * WAVE_SPEED_SHARE * slowest_contact_wire(figures.catenary).wave_speed,
        unit="km/h",
        source=f"{WAVE_SPEED_SHARE:g} of the wave speed (secondary source)",
    )
