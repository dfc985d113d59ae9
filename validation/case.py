"""A case of the suite, and what a run of the suite returns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from matplotlib.figure import Figure

from validation.check import Check
from validation.engines import Engine

PERTURBED = 1.01  # of a parameter in a case's negative control: 1 % off


@dataclass(frozen=True, kw_only=True)
class Case:
    """One case, in three steps: compute, compare, draw.

    name : unique; what the command line takes
    kind : 'verification' against closed forms, 'validation' against published results
    title : one line for the report
    text : what was found, for the report
    off : what is wrong in the case's negative control
    compute : makes the data, which the negative control shares; its argument asks for the quick variant
    compare : makes the checks from the data; ``perturbation`` is 1, or 1.01 for the negative control: a
        factor on one parameter of the reference, or, where ``off`` says so, a sign to take something else
    draw : draws the data
    quick : part of a quick run
    engines : that its motions are computed with, the default one first; none: statics, modes, several at once
    """

    name: str
    kind: Literal["verification", "validation"]
    title: str
    text: str
    off: str
    compute: Callable[[bool], Any]
    compare: Callable[[Any, float], list[Check]]
    draw: Callable[[Any, Figure], None]
    quick: bool = True
    engines: tuple[Engine, ...] = ()

    def checks(self, data: Any, engine: str = "", *, negative_control: bool = False) -> list[Check]:
        """Compare the data with the reference, or with the negative control's wrong one."""
        found = self.compare(data, PERTURBED if negative_control else 1.0)
        return [replace(check, case=self.name, engine=engine) for check in found]


@dataclass
class Outcome:
    """What one case gave. picture : a PNG file's bytes, or none."""

    checks: list[Check]
    picture: bytes | None = None


class Checks(list[Check]):
    """A list of checks with the pictures that belong to it, by case."""

    def __init__(self, checks: Sequence[Check] = (), pictures: dict[str, bytes] | None = None) -> None:
        super().__init__(checks)
        self.pictures: dict[str, bytes] = pictures or {}
