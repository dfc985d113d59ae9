"""Files of studies: a line, pantographs and speeds, what of it scatters, and what is to be designed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from catenary_fe.layout.arguments import checked
from catenary_fe.layout.current_collection import PowerSystem
from catenary_fe.layout.distributions import Distribution
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import (
    NonEmpty,
    Number,
    Parameters,
    Positive,
    Text,
    problem_lines,
    refuse,
    shorten,
)
from catenary_fe.layout.toml import read_toml


class DesignVariable(Parameters):
    """A value that is looked for, between two bounds."""

    between: tuple[Number, Number]
    """[of the value] lowest and highest one"""
    whole: Annotated[bool, Field(strict=True)] = False
    """true: whole numbers alone, which only the global search finds"""
    apart: Annotated[bool, Field(strict=True)] = False
    """true: each member of the place by itself; false: one value for all of them"""
    evenly: Positive | None = None
    """[m] of a place `span.*.droppers`: the value is a number of droppers, the first and the last this far
    from the supports, the others evenly between"""

    @model_validator(mode="after")
    def _bounds_rise(self) -> Self:
        low, high = self.between
        if low >= high:
            raise ValueError(f"between = [{low:g}, {high:g}]: the first bound must be below the second one")
        if self.evenly is not None and low < 1:
            raise ValueError(f"between = [{low:g}, {high:g}]: at least one dropper hangs in a span")
        return self

    @property
    def is_whole(self) -> bool:
        """Whether only whole numbers count."""
        return self.whole or self.evenly is not None


class Objective(Parameters):
    """What a design is judged by: the smallest value of a figure is the best, of minima the largest."""

    figure: Literal[
        "std_N", "max_N", "min_N", "statistical_max_N", "statistical_min_N", "max_support_uplift_mm",
        "contact_loss_percent",
    ] = "std_N"  # fmt: skip
    """of the contact force, or the largest uplift at a support"""
    over: Literal["worst", "mean"] = "worst"
    """over speeds, pantographs and samples"""
    samples: Annotated[int, Field(strict=True, ge=0)] = 0
    """of what scatters, beside the line as it is drawn; the same for each design"""


def _by_place(model: type[Parameters], example: str) -> Callable[[Any], Any]:
    """Tables by place; each fault with its place, which is no key that the schema knows."""

    def read(given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        found, faults = {}, []
        for place, value in given.items():
            if isinstance(value, dict) and any(isinstance(inner, dict) for inner in value.values()):
                faults.append(
                    f'{place}: write the whole place in quotes, such as "{place}.{next(iter(value))}"'
                )
                continue
            if not isinstance(value, dict | model):
                faults.append(f"{place} = {shorten(value)}: must be a table, such as {{ {example} }}")
                continue
            try:
                found[place] = model.model_validate(value)
            except ValidationError as error:
                faults += problem_lines(error, model, where=str(place))
        refuse(faults)
        return found

    return read


class Study(Parameters):
    """A line, pantographs and speeds, what of it scatters, and what is to be designed."""

    model_config = ConfigDict(title="catenary_fe study")

    name: Text = "study"
    """what is drawn and printed as title"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    layout: Text
    """its file, from where the study's file is"""
    pantographs: Annotated[tuple[Text, ...], NonEmpty]
    """names in the library, or files from where the study's file is; each runs by itself"""
    speed_kmh: Annotated[tuple[Positive, ...], NonEmpty]
    """[km/h] at which each of them runs"""
    positions: tuple[Number, ...] = ()
    """[m] along the line at the start: each case runs one pantograph at each; unset: one, near the first
    support"""
    conditions: Text | None = None
    """file of the conditions that the line is under, from where the study's file is"""
    evaluated_spans: tuple[Annotated[int, Field(strict=True)], ...] | None = None
    """numbers of the spans (from 1) for the statistics; unset: the layout's"""
    criteria: PowerSystem | None = None
    """system by whose limits each case is judged; unset: none"""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """of the random numbers: the same seed, the same samples"""
    scatter: Annotated[
        dict[Text, Distribution], BeforeValidator(_by_place(Distribution, "normal = 0.004"))
    ] = Field(default_factory=dict)
    """how values scatter, by their place as with `sweep --vary`; `*` stands for all members of a list"""
    design: Annotated[
        dict[Text, DesignVariable], BeforeValidator(_by_place(DesignVariable, "between = [15e3, 27e3]"))
    ] = Field(default_factory=dict)
    """which values are looked for, by their place"""
    objective: Objective = Objective()
    """what a design is judged by; its limits are the criteria"""


@checked
def load_study(path: str | Path) -> Study:
    """A study from a TOML file, its files found from where it is.

    Raises InputError, one line for each fault that the file has.
    """
    path = Path(path)
    record = read_toml(path, "study")
    try:
        study = Study.model_validate(record)
    except ValidationError as error:
        raise InputError(*problem_lines(error, Study, where=str(path))) from None
    return study.replace(
        layout=str(path.parent / study.layout),
        conditions=None if study.conditions is None else str(path.parent / study.conditions),
        pantographs=tuple(_pantograph(path.parent, name) for name in study.pantographs),
    )


def _pantograph(folder: Path, name: str) -> str:
    """A name of the library, or the path of a file."""
    path = folder / name
    return str(path) if path.suffix == ".toml" or os.path.isfile(path) else name


def study_schema() -> dict[str, Any]:
    """JSON Schema of a study file."""
    return Study.model_json_schema()
