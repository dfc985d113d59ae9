"""The one family of errors that this package raises on purpose."""

from __future__ import annotations

from signal import SIGINT
from typing import Any


def counted(number: int, what: str) -> str:
    """``1 span``, ``2 spans``: how messages count."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


class CatenaryError(Exception):
    """Root of all errors of catenary_fe. Its text is made for an engineer, not for a programmer."""

    exit_code = 1


class InputError(CatenaryError, ValueError):
    """Something that the user wrote breaks a rule.

    ``problems`` holds one line for each fault (what, where, value, rule, remedy): several faults of one
    input are reported together.
    """

    exit_code = 3

    def __init__(self, *problems: str) -> None:
        self.problems = tuple(" ".join(line.splitlines()) for line in problems)  # names may have line breaks
        super().__init__("\n".join(self.problems))


class SolverError(CatenaryError, RuntimeError):
    """A static or dynamic solve failed; the text says where, when and what to try.

    partial : the run until then (:class:`catenary_fe.Run`), where one had begun
    """

    exit_code = 4
    partial: Any = None


class RunInterrupted(KeyboardInterrupt):
    """The user or the machine asked the program to stop.

    signal : number of the signal that did
    partial : the run until then (:class:`catenary_fe.Run`), where one had begun
    """

    def __init__(self, signal: int = SIGINT, partial: Any = None) -> None:
        super().__init__(signal)
        self.signal, self.partial = int(signal), partial

    @property
    def exit_code(self) -> int:
        """130 after Ctrl-C, 143 after SIGTERM, as shells have it."""
        return 128 + self.signal
