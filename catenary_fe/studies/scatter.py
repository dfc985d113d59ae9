"""Monte Carlo studies: how the figures of runs scatter where a line's values do, and which values matter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import InputError, Study, counted
from catenary_fe.layout.arguments import checked, one_of, whole
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.studies.sampling import (
    MOST,
    Sampling,
    check_power_of_two,
    exchanged,
    two_cubes,
    unit_cube,
)
from catenary_fe.studies.scatter_cases import Case, Plan, broken
from catenary_fe.studies.scatter_tables import (
    Row,
    figure_bands,
    force_bands,
    missed_shares,
    sample_rows,
    sensitivity_rows,
)
from catenary_fe.studies.simulate import Method
from catenary_fe.studies.sweep import SweepSettings, run_sweep


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class Scatter:
    """What a study's samples gave. Tables are lists of rows by column; a column's unit ends its name.

    samples : that were drawn
    places : that scatter
    scalars : those of them that have one value a sample
    rows : one a sample, speed and pantograph; sample 0 is the nominal one, without scatter
    bands : one a speed, pantograph and figure: nominal value, mean, deviation, quantiles
    missed : one a speed and pantograph: share of the samples that miss a criterion, where the study judges
    force : one a speed and pantograph: nominal force and quantiles [N] along x [m], as arrays
    sensitivity : one a speed, pantograph, figure and place: Sobol' indices; empty where not asked for
    failed : values and error of each case that did not run, exchanged ones of the sensitivity among them
    cases : that were asked for
    """

    study: Study
    samples: int
    places: tuple[str, ...]
    scalars: tuple[str, ...]
    rows: list[Row]
    bands: list[Row]
    missed: list[Row]
    force: list[Row]
    sensitivity: list[Row]
    failed: list[Row]
    cases: int

    def as_dict(self) -> dict[str, Any]:
        """All but single runs and forces, ready for JSON."""
        return {
            "name": self.study.name,
            "seed": self.study.seed,
            "samples": self.samples,
            "scatter": {
                place: self.study.scatter[place].model_dump(exclude_unset=True, mode="json")
                for place in self.places
            },
            "cases": self.cases,
            "failed": self.failed,
            "criteria_system": self.study.criteria,
            "criteria": self.missed,
            "bands": self.bands,
            "sensitivity": self.sensitivity,
        }


@checked
def run_scatter(  # long by what it documents
    study: Study,
    *,
    samples: int,
    folder: str | Path,
    sensitivity: bool = False,
    sampling: Sampling | None = None,
    method: Method = "linearised",
    time: TimeSettings | None = None,
    mesh: MeshSettings | None = None,
    jobs: int = -1,
    scheduler: str | None = None,
    retry: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Scatter:
    """Run samples of a study, on all cores; what is finished is kept, and not run again.

    samples : number of them
    folder : where finished cases are kept, in ``cases``: a study that was stopped goes on from there
    sensitivity : run samples * (places + 1) more samples, which share the variance of the standard deviation,
        mean, maximum and uplift out among the places (Sobol' indices)
    sampling : "latin-hypercube" or "sobol", which needs a power of two of samples; unset: the first one, with
        sensitivity the second one
    method : of the runs, as in :func:`simulate`
    time, mesh : settings of the runs
    jobs : number of processes, -1: one a core
    scheduler : address of a Dask cluster to run on instead
    retry : run cases again that failed
    progress : called with the share done, 0 to 1

    Linearised runs end a span behind the last evaluated one: bands are those of the evaluated spans and their
    supports.

    A sample that cannot be built or run is counted, and said, and left out. Raises InputError where nothing
    scatters, a place does not exist, or no sample can be built.
    """
    whole("samples", samples, least=2, most=MOST)
    if sampling is not None:
        one_of("sampling", sampling, get_args(Sampling))
    if sensitivity and sampling == "latin-hypercube":
        raise InputError("sampling: sensitivity takes two Sobol' samples; leave latin-hypercube out")
    if not study.scatter:
        raise InputError(
            "scatter: nothing scatters; write places and distributions into the study's [scatter], such as"
            ' "contact_wire.tension" = { relative_normal = 0.02 }'
        )
    plan = Plan(study)
    nominal, cubes = plan.nominal(), _cubes(plan, samples, sensitivity, sampling or _usual(sensitivity))
    count = plan.per_sample * (1 + samples * len(cubes))
    if count > MOST:
        raise InputError(f"scatter: {count} cases are more than {MOST}; take fewer samples, speeds or places")
    cases = [*nominal, *(case for cube in cubes for case in plan.cases(cube))]
    _check_built(nominal, cases)
    settings = SweepSettings(
        method=method, time=time or TimeSettings(), mesh=mesh or MeshSettings(), keep_force=True, short=True
    )
    records = run_sweep(
        cases, settings, folder, jobs=jobs, scheduler=scheduler, retry=retry,
        progress=(lambda done, all_: progress(done / all_)) if progress else None,
    )  # fmt: skip
    end = plan.per_sample * (1 + samples)  # of the samples themselves
    rows = list(sample_rows(cases[:end], records[:end], study.criteria))
    places = tuple(each.place for each in plan.inputs)
    after = records[len(nominal) :]
    return Scatter(
        study=study,
        samples=samples,
        places=places,
        scalars=tuple(each.place for each in plan.inputs if each.is_scalar),
        rows=rows,
        bands=figure_bands(rows, study.seed),
        missed=missed_shares(rows),
        force=force_bands(records[:end]),
        sensitivity=sensitivity_rows(after, samples, plan.per_sample, places, study.seed)
        if sensitivity
        else [],
        failed=[r["values"] | {k: r[k] for k in ("error", "exit_code")} for r in records if "error" in r],
        cases=len(cases),
    )


def _usual(sensitivity: bool) -> Sampling:
    return "sobol" if sensitivity else "latin-hypercube"


def _cubes(plan: Plan, samples: int, sensitivity: bool, sampling: Sampling) -> list[Any]:
    """Samples of the cube; with sensitivity a second one, and one for each input, exchanged."""
    seed = plan.study.seed
    if sampling != "sobol":
        return [unit_cube(sampling, samples, plan.dimension, seed)]
    if sensitivity:
        check_power_of_two(samples, "Sobol' indices are estimated")
    a, b = two_cubes(samples, plan.dimension, seed)  # the first is the same with and without sensitivity
    return [a, b, *exchanged(a, b, [each.columns for each in plan.inputs])] if sensitivity else [a]


def _check_built(nominal: Sequence[Case], cases: Sequence[Case]) -> None:
    """Raises InputError where the nominal line, or no sample, can be described."""
    if faults := broken(nominal):
        raise faults[0]
    faults = broken(cases)
    if len(faults) == len(cases) - len(nominal):
        raise InputError(
            *faults[0].problems, f"scatter: none of {counted(len(faults), 'case')} can be built; look above"
        )
