"""What was measured beside the bands of a scatter study: might a line within that scatter have given it?"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.results.line_test.comparison import PlacedPass

Floats = NDArray[np.float64]
Row = Mapping[str, str]

FIGURES = tuple(FORCE[n] for n in ("mean", "std", "statistical_max", "statistical_min", "max", "min"))
FILTER: FilterKind = "causal"
"""Of the forces of scatter studies."""
WITHIN = 90
"""[%] of its places and figures that a line within the scatter has inside the bands on average."""
_QUANTILES = "low_5", "median", "high_95"
_SAME_SPEED = 1e-3  # [km/h]
_SAME_PLACE = 1.0  # [m]


@dataclass(frozen=True)
class ScatterBand:
    """Bands of a scatter study at one speed, of one pantograph: quantiles of 5, 50 and 95 %.

    pantograph : as the study names it
    samples : that ran
    x : [m], shape (places,), along the line
    force : [N], shape (3, places), low-passed
    figures : by key, in the unit that it ends with
    """

    pantograph: str
    samples: int
    x: Floats
    force: Floats
    figures: Mapping[str, tuple[float, ...]]


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class InBand:
    """Whether the passes of a line test lie in the bands of a scatter study.

    band : of the study
    figures : one a figure: key, quantiles, the values of what was measured, and which of them are inside
    inside : % of the places of each pass, by its name, at which its force is inside
    notes : on what the bands are of
    """

    band: ScatterBand
    figures: Sequence[Mapping[str, Any]]
    inside: Mapping[str, float]
    notes: Sequence[str]

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        rows = [dict(row) for row in self.figures]
        return {"samples": self.band.samples, "figures": rows, "force_inside_percent": dict(self.inside)}


def read_band(folder: str | Path, *, speed: float, pantograph: str, number: int) -> ScatterBand:
    """Bands that a scatter study wrote into a folder.

    speed : [m/s]
    pantograph, number : name, and which one of the train, from 1

    Raises InputError where the folder has none of that speed and pantograph.
    """
    path = Path(folder)
    try:
        figures, places = _rows(path / "bands.csv"), _rows(path / "force_band.csv")
        groups = dict.fromkeys(map(_group, figures))
    except FileNotFoundError as error:
        raise InputError(
            f"{path}: {Path(str(error.filename)).name} is missing; give the folder that a scatter study wrote"
        ) from None
    except (KeyError, ValueError, OSError, csv.Error) as error:
        raise InputError(f"{path}: the study's tables cannot be read ({error}); run it again") from None
    fits = [g for g in groups if abs(g[0] - 3.6 * speed) < _SAME_SPEED and g[2] == number]
    if len(fits) > 1:
        fits = [g for g in fits if g[1] == pantograph]
    if not fits:
        listed = "; ".join(f"{v:g} km/h, {name}, no. {n}" for v, name, n in groups)
        raise InputError(
            f"{path}: no band of {pantograph}, no. {number}, at {3.6 * speed:g} km/h; there are: {listed}"
        )
    try:
        return _band(
            [r for r in figures if _group(r) == fits[0]], [r for r in places if _group(r) == fits[0]]
        )
    except (KeyError, ValueError, IndexError) as error:
        raise InputError(f"{path}: the study's tables cannot be read ({error}); run it again") from None


def _rows(path: Path) -> list[Row]:
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def _group(row: Row) -> tuple[float, str, int]:
    return float(row["speed_kmh"]), row["pantograph"], int(row["number"])


def _band(figures: Sequence[Row], places: Sequence[Row]) -> ScatterBand:
    names = "5_percent_force_N", "median_force_N", "95_percent_force_N"
    return ScatterBand(
        pantograph=figures[0]["pantograph"],
        samples=int(figures[0]["samples"]),
        x=np.array([float(r["position_m"]) for r in places]),
        force=np.array([[float(r[name]) for r in places] for name in names]),
        figures={r["figure"]: tuple(float(r[name]) for name in _QUANTILES) for r in figures},
    )


def in_band(
    band: ScatterBand,
    passes: Sequence[PlacedPass],
    uplift: float | None,
    begin: float,
    end: float,
    filter: FilterKind,
) -> InBand:
    """Passes, placed on the line, in the bands.

    uplift : [m] largest that was measured at a support, or None
    begin, end : [m] of what is compared

    Raises InputError where the forces are filtered in another way than the study's.
    """
    measured = {p.name: p for p in passes if p.force is not None}
    if measured and filter != FILTER:
        raise InputError(f"filter = {filter}: the study's forces are filtered {FILTER}ly; compare them so")
    rows = []
    for q in FIGURES if measured else ():
        values = {n: float(q.shown(getattr(p.statistics, q.attribute))) for n, p in measured.items()}
        rows.append(_figure(q.key, band, values))
    if uplift is not None:
        rows.append(_figure(UPLIFT.key, band, {"measured": float(UPLIFT.shown(uplift))}))
    return InBand(
        band=band,
        figures=rows,
        inside={name: _share_inside(band, p) for name, p in measured.items()},
        notes=_notes(band, bool(measured), begin, end),
    )


def _figure(key: str, band: ScatterBand, values: Mapping[str, float]) -> dict[str, Any]:
    low, median, high = band.figures[key]
    return {
        "figure": key,
        "low_5": low,
        "median": median,
        "high_95": high,
        "measured": dict(values),
        "inside": {name: low <= value <= high for name, value in values.items()},
    }


def _share_inside(band: ScatterBand, one: PlacedPass) -> float:
    assert one.force is not None
    x, force = one.x[one.inside], one.force[one.inside]
    there = (x >= band.x[0] - _SAME_PLACE) & (x <= band.x[-1] + _SAME_PLACE)
    low, high = (np.interp(x[there], band.x, band.force[i]) for i in (0, 2))
    return float(100 * np.mean((force[there] >= low) & (force[there] <= high))) if there.any() else 0.0


def _notes(band: ScatterBand, measured: bool, begin: float, end: float) -> list[str]:
    said = [
        f"scatter: bands of {band.samples} samples of {band.pantograph}, from 5 to 95 %: a line within that"
        f" scatter has {WITHIN} % of its places inside on average"
    ]
    first, last = float(band.x[0]), float(band.x[-1])
    if measured and (abs(first - begin) > _SAME_PLACE or abs(last - end) > _SAME_PLACE):
        said.append(
            f"scatter: its figures are those of {first:.1f} to {last:.1f} m, compared are {begin:.1f} to"
            f" {end:.1f} m"
        )
    return said
