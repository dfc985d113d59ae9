"""Today's circumstances of a line: temperature, wind, ice. How it hangs without them is the layout's."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Self

from pydantic import ConfigDict, Field, ValidationError, model_validator

from catenary_fe.layout.arguments import checked
from catenary_fe.layout.conditions.base import BaseMotion, MovingBase, VehicleSuspension
from catenary_fe.layout.conditions.effect import BaseSignal, Effect, TemperatureOverX, WirePart, over_x
from catenary_fe.layout.conditions.from_files import names_files, with_tables
from catenary_fe.layout.conditions.gusts import GustLoads
from catenary_fe.layout.conditions.ice import Ice, IceMass
from catenary_fe.layout.conditions.irregularity import ContactWireIrregularity, UnevenSurface
from catenary_fe.layout.conditions.measured_wind import MeasuredWindLoads
from catenary_fe.layout.conditions.temperature import Warming
from catenary_fe.layout.conditions.wind import Drag, Gusts, Wind
from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.parameters import Parameters, Positive, Text, problem_lines
from catenary_fe.layout.toml import read_toml, toml_value


class Case(Parameters):
    """Further circumstances: the file's with these changes."""

    name: Text
    """what tables and pictures call it"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    temperature: TemperatureOverX | None = None
    """[°C] of the wires, or a table over x"""
    wind: dict[str, Any] = Field(default_factory=dict)
    """keys of `wind` that differ"""
    ice: dict[str, Any] = Field(default_factory=dict)
    """keys of `ice` that differ"""
    allowed_offset: Positive | None = None
    """[m] of the contact wire from the track's centre"""


class Conditions(Parameters):
    """What the surroundings do to a line, and perhaps further cases that change some of it."""

    model_config = ConfigDict(title="catenary_fe conditions")

    name: Text = "conditions"
    """what tables and pictures call them"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    temperature: TemperatureOverX | None = None
    """[°C] of the wires, or a table over x, for a tunnel's mouth: [[0, 5], [800, 12]]; unset: as when the
    line was hung"""
    wind: Wind | None = None
    """on the wires; unset: still air"""
    ice: Ice | None = None
    """on the wires; unset: none"""
    irregularity: ContactWireIrregularity | None = None
    """of the contact wire's running surface, in runs; unset: even"""
    base: BaseMotion | None = None
    """vertical motion of the pantographs' bases, in runs; unset: none"""
    allowed_offset: Positive | None = None
    """[m] of the contact wire from the track's centre, which `cases` judges; unset: any"""
    case: tuple[Case, ...] = ()
    """for the command `cases`: further circumstances, each with a name of its own"""

    @model_validator(mode="after")
    def _cases_are_sound(self) -> Self:
        names = [self.name]
        for number, change in enumerate(self.case, start=1):
            try:
                names.append(self._changed(change).name)
            except InputError as error:
                raise ValueError("; ".join(f"case {number}: {line}" for line in error.problems)) from None
        if twice := [name for name in names if names.count(name) > 1]:
            raise ValueError(f"case: the name {twice[0]!r} stands for two cases; give each its own")
        return self

    def _changed(self, change: Case) -> Conditions:
        own = change.model_dump(exclude_unset=True)
        return Conditions(**_merged(self.model_dump(exclude={"case"}, exclude_unset=True), own))

    @property
    def cases(self) -> list[Conditions]:
        """These, without further cases, and then each of those."""
        return [self.replace(case=()), *(self._changed(change) for change in self.case)]

    def effects(self, installation_temperature: float) -> list[Effect]:
        """What they do to the wires.

        installation_temperature : [°C] at which the line was hung
        """
        found: list[Effect] = []
        if self.temperature is not None:
            found.append(Warming(self.temperature, installation_temperature))
        if self.ice:
            found.append(IceMass(self.ice))
        if self.irregularity:
            found.append(UnevenSurface(self.irregularity))
        if self.base:
            found.append(MovingBase(self.base))
        if self.wind:
            found.append(Drag(self.wind, self.ice))
            if self.wind.gusts and self.wind.blows:
                found.append(GustLoads(self.wind, self.ice))
            if self.wind.record and self.wind.blows:
                found.append(MeasuredWindLoads(self.wind, self.ice))
        return found


def _merged(record: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """A record with what a change says; tables inside are changed key by key."""
    found = dict(record)
    for key, value in change.items():
        inner = found.get(key)
        found[key] = _merged(inner, value) if isinstance(value, dict) and isinstance(inner, dict) else value
    return found


@checked
def load_conditions(path: str | Path) -> Conditions:
    """Conditions from a TOML file, with the CSV tables that it names.

    Raises InputError, one line for each fault that the files have.
    """
    record = conditions_record(path)
    try:
        return Conditions.model_validate(record)
    except ValidationError as error:
        raise InputError(*problem_lines(error, Conditions, where=str(path))) from None


def conditions_record(path: str | Path) -> dict[str, Any]:
    """What a conditions file says, with the CSV tables that it names. Raises InputError for faulty ones."""
    return with_tables(read_toml(Path(path), "conditions"), Path(path).parent)


def conditions_text(path: str | Path) -> bytes:
    """A conditions file's content; where it names other files, with what they say in their place."""
    record = read_toml(Path(path), "conditions")
    if not names_files(record):
        return Path(path).read_bytes()
    whole = with_tables(record, Path(path).parent)
    return "".join(f"{key} = {toml_value(value)}\n" for key, value in whole.items()).encode()


def one_of_a_run(given: Conditions, path: str | Path) -> Conditions:
    """The circumstances of one run. Raises InputError for a file with several cases."""
    if given.case:
        raise InputError(
            f"{path}: has {counted(len(given.case), 'case')} beside its own circumstances, and a run takes"
            " one; leave out [[case]], or give the command cases"
        )
    return given


def conditions_schema() -> dict[str, Any]:
    """JSON Schema of a conditions file."""
    return Conditions.model_json_schema()


__all__ = [
    "BaseMotion",
    "BaseSignal",
    "Conditions",
    "ContactWireIrregularity",
    "Effect",
    "Gusts",
    "Ice",
    "VehicleSuspension",
    "Wind",
    "WirePart",
    "conditions_record",
    "conditions_schema",
    "conditions_text",
    "load_conditions",
    "one_of_a_run",
    "over_x",
]
