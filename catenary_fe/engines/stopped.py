"""How a drive says that it came to an end before its time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from catenary_fe.layout import SolverError

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn.run import History

FEWEST = 50  # steps that are worth keeping; filters need some


class RunStopped(Exception):  # noqa: N818 the user may have wished it
    """A drive that was stopped, by a solve that failed or by the user.

    history : what was recorded until then (see :meth:`History.until`), or None where that is next to nothing
    cause : the error to end with
    """

    def __init__(self, history: History | None, cause: SolverError | KeyboardInterrupt) -> None:
        super().__init__(str(cause))
        self.history, self.cause = history, cause
