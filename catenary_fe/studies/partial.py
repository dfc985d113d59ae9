"""Runs that were stopped: what was computed until then, marked so that nobody takes it for a whole run."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from catenary_fe.engines.history import RunStopped
from catenary_fe.layout import RunInterrupted, SolverError
from catenary_fe.results import Run

if TYPE_CHECKING:
    from catenary_fe.engines.history import History


@contextmanager
def kept_when_stopped(label: Callable[[History], Run], planned: float) -> Iterator[None]:
    """Let the error of a drive that was stopped carry the run until then.

    label : makes a run of a history
    planned : [s] that the run should have taken

    Raises SolverError or RunInterrupted with ``partial``.
    """
    try:
        yield
    except RunStopped as stopped:
        cause = stopped.cause
        error = cause if isinstance(cause, SolverError | RunInterrupted) else RunInterrupted()
        if stopped.history is not None:
            reason = str(cause) if isinstance(cause, SolverError) else "interrupted"
            error.partial = marked(label(stopped.history), reason, planned)
        raise error from None


def marked(run: Run, reason: str, planned: float) -> Run:
    """The run as a partial one: its title, which heads every picture, says so, too.

    reason : why it ended
    planned : [s] that it should have taken
    """
    reached = float(run.time[-1])
    title = f"PARTIAL, {reached:.2f} of {planned:.2f} s: {run.data.attrs['title']}"
    record = {"reason": reason, "reached_s": reached, "planned_s": planned}
    return Run(run.data.assign_attrs(title=title, partial=json.dumps(record)), run.wall_s)
