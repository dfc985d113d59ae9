"""The one family of errors that this package raises on purpose."""

from __future__ import annotations


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
    """A static or dynamic solve did not end well; the text says where, when and what to try."""

    exit_code = 4
