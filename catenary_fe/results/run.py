"""What a run returns: labelled histories, statistics, pictures; saved and loaded as netCDF."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import AnyPantograph, Catenary, InputError, recorded_catenary, recorded_pantographs
from catenary_fe.layout.arguments import checked, span_numbers, whole
from catenary_fe.layout.conditions import Conditions
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.results.check import FAILED, Check, Partial
from catenary_fe.results.files import ATTRIBUTE, atomic_write, checksum
from catenary_fe.results.quality import run_checks
from catenary_fe.results.quantities import (
    CHECKS_FAILED,
    DROPPER_FORCE,
    LATERAL,
    NON_UNIFORMITY,
    SLACK_DROPPERS,
    UPLIFT,
)
from catenary_fe.results.signal import FilterKind, low_pass
from catenary_fe.results.statistics import ForceStatistics, force_statistics, governing
from catenary_fe.results.wires import Elasticity, WireHistory, wire_histories

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
FORMAT = "catenary_fe run 2"


@changed_by_copy
@dataclass(frozen=True)
class Run:
    """Histories of a run, as an xarray Dataset with units, and the inputs they were computed from.

    data : variables position, contact_force, wire_height, mass_height, uplift_force (by pantograph),
        dropper_force, support_uplift, in space contact_lateral, of moving bases base_height, of several
        sections section_force; contact_wire_height, messenger_wire_height where stored; of nonlinear runs
        tension_change, energy, driven_work and lost_work; elasticity_uplift where it was computed; each has
        ``units`` and ``long_name``. Attributes hold the inputs, their hash, versions and settings.
    wall_s : [s] that the run took; not stored, so that a repeated run saves the same bytes
    """

    data: xr.Dataset
    wall_s: float | None = None

    @property
    def speed(self) -> float:
        """[m/s]"""
        return float(self.data.attrs["speed"])

    @property
    def method(self) -> str:
        """How it was computed: 'nonlinear', 'linearised' or 'exudyn'."""
        return str(self.data.attrs["method"])

    @cached_property
    def catenary(self) -> Catenary:
        """The catenary that was run on."""
        return recorded_catenary(self.data.attrs["catenary"])

    @property
    def conditions(self) -> Conditions | None:
        """What the surroundings did to the line; None in still air at the temperature of installation."""
        text = self.data.attrs.get("conditions")
        return Conditions.model_validate_json(text) if text else None

    @cached_property
    def pantographs(self) -> tuple[AnyPantograph, ...]:
        """The pantographs that ran, in the order of the data."""
        return recorded_pantographs(self.data.attrs["pantographs"])

    @property
    def evaluated_spans(self) -> tuple[int, ...]:
        """Numbers of the spans (from 1) that statistics are taken over."""
        return tuple(json.loads(self.data.attrs["evaluated_spans"]))

    @property
    def partial(self) -> Partial | None:
        """Why and when the run ended before its time; None for a whole one."""
        record = self.data.attrs.get("partial")
        return Partial(**json.loads(record)) if record else None

    @property
    def reached(self) -> bool:
        """Whether all pantographs passed all evaluated spans, which a partial run may not have done."""
        return all(self._passed(i, self.evaluated_spans) for i in range(self.data.sizes["pantograph"]))

    def _passed(self, pantograph: int, spans: Sequence[int]) -> bool:
        end = self.data["support_position"].values[max(spans)]
        return not self.partial or bool(self.data["position"].values[pantograph, -1] >= end)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The quality checks, each with value and bound. See :mod:`catenary_fe.results.quality`."""
        return run_checks(self)

    @property
    def failed_checks(self) -> tuple[str, ...]:
        """Names of the quality checks that the run fails."""
        return tuple(check.name for check in self.checks if not check.passed)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the program warned of before the run, and the checks that it failed."""
        partial = [str(self.partial)] if self.partial else []
        failed = (f"{FAILED}{check}" for check in self.checks if not check.passed)
        return (*partial, *json.loads(self.data.attrs["warnings"]), *failed)

    @cached_property
    def time(self) -> Floats:
        """[s], shape (times,)."""
        return np.asarray(self.data["time"].values)

    @property
    def step(self) -> float:
        """[s] between the times."""
        return float(self.time[1] - self.time[0])

    def wires(self) -> tuple[WireHistory, ...]:
        """Whole wires over time, contact wires first. Raises InputError where the run stored none."""
        return wire_histories(self.data)

    @property
    def elasticity(self) -> Elasticity | None:
        """The line's elasticity, where it was computed, see :meth:`with_elasticity`; else None."""
        if "elasticity_uplift" not in self.data:
            return None
        uplift, x = self.data["elasticity_uplift"], np.asarray(self.data["elasticity_position"].values)
        supports = np.asarray(self.data["support_position"].values)
        inside = (supports >= x[0] - 1e-9) & (supports <= x[-1] + 1e-9)
        return Elasticity(x, np.asarray(uplift.values), float(uplift.attrs["force"]), supports[inside])

    def with_elasticity(self, curve: Elasticity) -> Run:
        """The run with the line's elasticity added to its data, where report and criteria read it."""
        words = {"units": "m", "long_name": "uplift of the contact wire under a static force"}
        place = ("elasticity_position", curve.position, {"units": "m", "long_name": "place of that force"})
        variable = ("elasticity_position", curve.uplift, words | {"force": curve.force})
        data = self.without_elasticity().data.assign(elasticity_uplift=variable)
        return Run(data.assign_coords(elasticity_position=place), self.wall_s)

    def without_elasticity(self) -> Run:
        """The run with its histories alone."""
        names = ["elasticity_uplift", "elasticity_position"]
        return Run(self.data.drop_vars(names, errors="ignore"), self.wall_s)

    def window(self, pantograph: int, spans: Sequence[int] | None = None) -> NDArray[np.bool_]:
        """Shape (times,): when a pantograph (from 0) is inside the given spans.

        Raises InputError for spans that the line does not have or the pantograph does not reach, or, in a
        partial run, does not leave.
        """
        whole("pantograph", pantograph, least=0, most=self.data.sizes["pantograph"] - 1)
        supports = np.asarray(self.data["support_position"].values)
        x = np.asarray(self.data["position"].values[pantograph])
        inside = np.zeros(x.size, dtype=bool)
        for number in (numbers := self._numbers(spans)):
            inside |= (x >= supports[number - 1]) & (x <= supports[number])
        if not inside.any():
            raise InputError(f"pantograph {pantograph + 1} was never inside spans {list(numbers)}")
        if not self._passed(pantograph, numbers):
            raise InputError(
                f"spans {list(numbers)}: the run is partial and ended at {x[-1]:.1f} m,"
                f" where pantograph {pantograph + 1} had not passed them: there are no statistics"
            )
        return inside

    def _numbers(self, spans: Sequence[int] | None) -> Sequence[int]:
        return span_numbers(spans, self.data.sizes["support"] - 1, self.evaluated_spans)

    def contact_force_statistics(
        self, spans: Sequence[int] | None = None, filter: FilterKind = "causal"
    ) -> list[ForceStatistics]:
        """Statistics of each pantograph's contact force while it is in the given spans.

        spans : numbers of spans, from 1; unset: the evaluated ones
        filter : "causal" (as EN 50317 measures) or "zero-phase"

        Raises InputError for spans outside the run.
        """
        return [self._statistics(i, spans, filter) for i in range(self.data.sizes["pantograph"])]

    def statistics_by_span(self, filter: FilterKind = "causal") -> dict[int, list[ForceStatistics]]:
        """Statistics of each pantograph's contact force, by the number of each span that all of them passed.

        Single spans scatter about those of the evaluated ones: by how much tells what these are worth.
        """
        x, supports = self.data["position"].values, self.data["support_position"].values
        inside = (supports[:-1] >= x[:, 0].max()) & (supports[1:] <= x[:, -1].min())
        return {n: self.contact_force_statistics([n], filter) for n in (np.flatnonzero(inside) + 1).tolist()}

    def figures(self, filter: FilterKind = "causal") -> list[ForceStatistics | None]:
        """Statistics over the evaluated spans; None where a partial run ended before them."""
        return [
            self._statistics(i, None, filter) if self._passed(i, self.evaluated_spans) else None
            for i in range(self.data.sizes["pantograph"])
        ]

    def _statistics(self, i: int, spans: Sequence[int] | None, filter: FilterKind) -> ForceStatistics:
        return force_statistics(
            name=str(self.data["pantograph"].values[i]),
            force=np.asarray(self.data["contact_force"].values[i]),
            height=np.asarray(self.data["wire_height"].values[i]),
            inside=self.window(i, spans),
            step=self.step,
            filter=filter,
        )

    def filtered_contact_force(self, filter: FilterKind = "causal") -> Floats:
        """[N], shape (pantographs, times), low-passed at 20 Hz."""
        return low_pass(np.asarray(self.data["contact_force"].values), self.step, kind=filter)

    def largest_support_uplift(self, spans: Sequence[int] | None = None) -> float:
        """[m] largest uplift of the contact wire at the supports of the given spans.

        Raises InputError for spans that the line does not have, and where the run is partial and a pantograph
        has not passed them.
        """
        numbers = self._numbers(spans)
        for i in range(self.data.sizes["pantograph"] if self.partial else 0):
            self.window(i, numbers)
        return max(self.uplift_by_support(numbers).values())

    def largest_contact_lateral(self, pantograph: int = 0) -> float | None:
        """[m] farthest place of a contact from the middle of a head, over the evaluated spans.

        pantograph : its number, from 0

        None of a run in the plane, which knows no such place, and where nothing touched the head. Raises
        InputError for a pantograph that did not run.
        """
        whole("pantograph", pantograph, least=0, most=self.data.sizes["pantograph"] - 1)
        if "contact_lateral" not in self.data:
            return None
        places = np.abs(self.data["contact_lateral"].values[pantograph][:, self.window(pantograph)])
        return float(np.nanmax(places)) if np.isfinite(places).any() else None

    def uplift_by_support(self, spans: Sequence[int] | None = None) -> dict[int, float]:
        """[m] largest uplift in the whole run, by the number (from 1) of each support of the given spans.

        spans : numbers of spans, from 1; unset: the evaluated ones

        Raises InputError for spans that the line does not have.
        """
        supports = sorted({s for n in self._numbers(spans) for s in (n, n + 1)})
        largest = self.data["support_uplift"].values.max(axis=1)
        return {s: float(largest[s - 1]) for s in supports}

    @property
    def slackened_droppers(self) -> NDArray[np.int64]:
        """Numbers (from 0) of the droppers that went slack at any time of the run."""
        return np.flatnonzero((self.data["dropper_force"].values <= 0).any(axis=1))

    @property
    def largest_dropper_force(self) -> float:
        """[N] of any dropper at any time of the run; 0 for a line without droppers."""
        return float(self.data["dropper_force"].values.max(initial=0.0))

    @property
    def has_energy(self) -> bool:
        """Whether the run recorded its energy, as all nonlinear ones do."""
        return "energy" in self.data

    @property
    def missing_energy(self) -> Floats:
        """[J], shape (energy_times,): stored and kinetic energy, less what was done, plus what was lost.

        Raises InputError where the run recorded no energy.
        """
        if not self.has_energy:
            raise InputError("the run recorded no energy; run again with the method 'nonlinear'")
        energy, driven, lost = (self.data[n].values for n in ("energy", "driven_work", "lost_work"))
        return np.asarray(energy - energy[0] - driven + lost)

    def summary(self, filter: FilterKind = "causal") -> dict[str, Any]:
        """Key figures in display units, ready for JSON."""
        simulated = float(self.time[-1])
        names = [str(name) for name in self.data["pantograph"].values]
        figures, curve = self.figures(filter), self.elasticity
        uplift = self.uplift_by_support() if self.reached else {}
        places = [self.largest_contact_lateral(i) if self.reached else None for i in range(len(names))]
        lateral = [None if y is None else LATERAL.shown(y) for y in places]
        return ({"partial": self.partial.as_dict()} if self.partial else {}) | {
            "speed_kmh": round(3.6 * self.speed, 9),
            "method": self.method,
            "conditions": self.conditions.name if self.conditions else None,
            "evaluated_spans": list(self.evaluated_spans),
            "dropper_lengths_given": self.catenary.gives_dropper_lengths,
            "filter": filter,
            "pantographs": [
                s.as_dict() if s else ForceStatistics.none_as_dict(name)
                for s, name in zip(figures, names, strict=True)
            ],
            "governing_pantograph": governing(self.figures(filter)),
            UPLIFT.key: UPLIFT.shown(self.largest_support_uplift()) if self.reached else None,
            "support_uplift_mm": {str(n): UPLIFT.shown(z) for n, z in uplift.items()},
            LATERAL.key: max((y for y in lateral if y is not None), default=None),
            "contact_lateral_mm": lateral,
            SLACK_DROPPERS.key: self.slackened_droppers.size,
            DROPPER_FORCE.key: self.largest_dropper_force,
            NON_UNIFORMITY.key: NON_UNIFORMITY.shown(curve.non_uniformity) if curve else None,
            "simulated_s": simulated,
            "wall_s": self.wall_s,
            "real_time_factor": simulated / self.wall_s if self.wall_s else None,
            "checks": [check.as_dict() for check in self.checks],
            CHECKS_FAILED.key: list(self.failed_checks),
            "warnings": list(self.warnings),
        }

    @checked
    def save(self, path: str | Path) -> Path:
        """Write all data as netCDF (classic format: any program reads it). Raises InputError if it cannot."""
        sealed = self.data.drop_encoding().assign_attrs({ATTRIBUTE: checksum(self.data)})
        with atomic_write(path) as aside:
            sealed.to_netcdf(aside, engine="scipy", format="NETCDF3_64BIT")
        return Path(path)

    def plot_contact_force(self, ax: Axes | None = None, filter: FilterKind = "causal") -> Axes:
        """Contact force along the line. See :func:`catenary_fe.views.plot_contact_force`."""
        from catenary_fe.views import plot_contact_force

        return plot_contact_force(self, filter=filter, ax=ax)

    def plot_contact_lateral(self, ax: Axes | None = None) -> Axes:
        """Place of the contact on the heads. See :func:`catenary_fe.views.plot_contact_lateral`."""
        from catenary_fe.views import plot_contact_lateral

        return plot_contact_lateral(self, ax=ax)

    def plot_support_uplift(self, ax: Axes | None = None) -> Axes:
        """Uplift at the supports. See :func:`catenary_fe.views.plot_support_uplift`."""
        from catenary_fe.views import plot_support_uplift

        return plot_support_uplift(self, ax=ax)

    def plot_dropper_forces(self, ax: Axes | None = None) -> Axes:
        """Extremes of the dropper forces. See :func:`catenary_fe.views.plot_dropper_forces`."""
        from catenary_fe.views import plot_dropper_forces

        return plot_dropper_forces(self, ax=ax)

    def plot_energy(self, ax: Axes | None = None) -> Axes:
        """Where the energy comes from and goes to. See :func:`catenary_fe.views.plot_energy`."""
        from catenary_fe.views import plot_energy

        return plot_energy(self, ax=ax)

    def plot_waves(self, ax: Axes | None = None) -> Axes:
        """Waves on the contact wire over place and time. See :func:`catenary_fe.views.plot_run_waves`."""
        from catenary_fe.views import plot_run_waves

        return plot_run_waves(self, ax=ax)


@checked
def load_run(path: str | Path) -> Run:
    """Read a run that was saved, from its file or its folder.

    Raises InputError where the file is missing, damaged or something else.
    """
    import xarray as xr

    path = Path(path) / "run.nc" if Path(path).is_dir() else Path(path)
    try:
        with xr.open_dataset(path, engine="scipy") as opened:
            data = opened.load()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; give the run.nc of a run's folder") from None
    except Exception as error:  # netCDF readers raise what they like on damaged bytes
        raise InputError(
            f"{path}: not a readable netCDF file ({type(error).__name__}): cut off, damaged, or something"
            " else; run again, or take a copy"
        ) from None
    if data.attrs.get("format") != FORMAT:
        raise InputError(f"{path}: not a run of catenary_fe (format {data.attrs.get('format')!r})")
    if data.attrs.pop(ATTRIBUTE, None) != checksum(data):
        raise InputError(
            f"{path}: damaged: its content is not what its checksum says; run again, or take a copy (a file"
            " that is changed on purpose is to be written with Run.save)"
        )
    run = Run(data)
    try:
        _ = run.catenary, run.conditions, run.pantographs, run.evaluated_spans, run.speed, run.method
        settings, warnings = (json.loads(data.attrs[name]) for name in ("settings", "warnings"))
        _ = dict(settings["mesh"]), dict(settings["time"]), list(warnings)
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{path}: what it records of its inputs is damaged; run again") from None
    return run
