"""The comparison of a run with a line test."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, number, one_of, whole
from catenary_fe.results.line_test.band import in_band, read_band
from catenary_fe.results.line_test.comparison import LineTestComparison
from catenary_fe.results.line_test.record import LineTest
from catenary_fe.results.line_test.run_side import RunSide
from catenary_fe.results.line_test.signals import check_shift, even_pass
from catenary_fe.results.line_test.verdict import warnings_of
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind


@checked
def compare_with_line_test(
    run: Run,
    test: LineTest,
    *,
    shift: float | None = None,
    speed: float | None = None,
    pantograph: int = 0,
    filter: FilterKind = "causal",
    is_filtered: bool = False,
    scatter: str | Path | None = None,
) -> LineTestComparison:
    """Put a run beside what was measured on the line.

    run : whole, or partial with its evaluated spans passed
    shift : [m] to add to measured positions, so that they are those of the run's line; unset: found for each
        pass, where the filtered forces (or heights) correlate best
    speed : [m/s] of the train, where the measurement does not say it (above 0); unset: then the run's
    pantograph : number of the run's pantograph that was measured, from 0
    filter : "causal" (as EN 50317 measures) or "zero-phase", of both
    is_filtered : whether the force was low-passed at 20 Hz when it was measured, and is not to be again

    scatter : folder of a scatter study of this line, speed and pantograph, in whose bands the measurement is
        looked for

    Compared is what lies in the run's evaluated spans and was measured in all passes.

    Raises InputError where that is nothing, where no clear place is found, for fewer than 50 samples a
    second, for rows too far apart, and for a study without such bands.
    """
    whole("pantograph", pantograph, least=0, most=run.data.sizes["pantograph"] - 1)
    one_of("filter", filter, get_args(FilterKind))
    histories = [p for p in test.passes if p.has_history]
    _check(shift, speed, is_filtered, bool(histories))
    band = None
    if scatter is not None:
        name = run.pantographs[pantograph].name
        band = read_band(scatter, speed=run.speed, pantograph=name, number=pantograph + 1)
    own = RunSide(run, pantograph, filter)
    notes = list(test.notes)
    even = [
        even_pass(p, speed=speed, run_speed=run.speed, filter=filter, is_filtered=is_filtered)
        for p in histories
    ]
    places = [own.place_of(one, shift) for one in even]
    begin, end = own.common_range(even, places)
    passes = [
        own.placed(one, place, begin, end, is_filtered) for one, place in zip(even, places, strict=True)
    ]
    uplift = own.uplifts(test, notes)
    if not passes and not uplift:
        raise InputError("no uplift was measured at a support of the run's evaluated spans")
    notes += [note for one in even for note in one.notes]
    has_force = any(p.force is not None for p in passes)
    measured_uplift = max((most for _, most in uplift.values()), default=None)
    placed = in_band(band, passes, measured_uplift, begin, end, filter) if band else None
    has_height = any(p.height_range is not None for p in passes)
    return LineTestComparison(
        run=run,
        pantograph=pantograph,
        filter=filter,
        passes=passes,
        begin=begin,
        end=end,
        statistics=own.statistics(begin, end) if has_force else None,
        by_span=own.by_span(begin, end) if has_force else {},
        height_range=own.height_range(begin, end) if has_height else None,
        spectrum=own.spectrum(begin, end) if has_force else None,
        uplift=uplift,
        band=placed,
        notes=[*notes, *own.notes_on(passes, begin, end), *(placed.notes if placed else ())],
        warnings=warnings_of(passes, run.speed, own.spans_in(begin, end), end - begin, shift is None),
    )


def _check(shift: float | None, speed: float | None, is_filtered: bool, has_history: bool) -> None:
    """Raises InputError for what is no shift and no speed, and where there is nothing that they are of."""
    check_shift(shift)
    if speed is not None:
        number("speed", speed, "m/s", above=0.0, most=200.0, remedy="it is in m/s")
    if not has_history and (shift is not None or speed is not None or is_filtered):
        raise InputError(
            "shift, speed and filter of a measurement are those of a force or a height, which it has not"
        )
