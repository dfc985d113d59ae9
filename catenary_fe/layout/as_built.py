"""How a line was built, beside its drawing: deviations of lengths, tensions, staggers and heights."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, PlainValidator, ValidationError, WithJsonSchema, model_validator

from catenary_fe.layout.conditions.effect import AS_IT_IS, NumberOrTable, over_x, schema_over_x, table_over_x
from catenary_fe.layout.conditions.irregularity import Wave, check_waves, drawn_waves
from catenary_fe.layout.parameters import Parameters, Positive, problem_lines

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary

Floats = NDArray[np.float64]


class Drawn(Parameters):
    """Deviations drawn by chance: each by itself, normal; or, between two wavelengths, along the line."""

    deviation: Positive
    """standard deviation, in the unit of what deviates"""
    shortest_wave: Wave | None = None
    """[m], beside `longest_wave`, of a deviation that goes up and down along the line;
    unset: each by itself"""
    longest_wave: Wave | None = None
    """[m], likewise"""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """of the random numbers: the same seed, the same deviations"""

    @model_validator(mode="after")
    def _waves_have_two_ends(self) -> Self:
        shortest, longest = self.shortest_wave, self.longest_wave
        if (shortest is None) != (longest is None):
            raise ValueError("shortest_wave and longest_wave belong together: give both or neither")
        if shortest is not None and longest is not None:
            check_waves(shortest, longest)
        return self

    def at(self, x: Floats, stream: int) -> Floats:
        """Shape of x [m]: the deviations there.

        stream : tells draws of one seed apart
        """
        if self.shortest_wave is None or self.longest_wave is None:
            found: Floats = self.deviation * np.random.default_rng((self.seed, stream)).standard_normal(
                x.shape
            )
            return found
        waves = self.shortest_wave, self.longest_wave
        return drawn_waves(x, self.deviation, *waves, np.random.default_rng((self.seed, stream)))


def _check(most: float) -> Callable[[Any], NumberOrTable | Drawn]:
    """Takes a number, a table over x, or what is drawn, each at most so large; raises ValueError."""

    def check(value: Any) -> NumberOrTable | Drawn:
        if not isinstance(value, dict | Drawn):
            return table_over_x(value, -most, most)
        try:
            drawn = Drawn.model_validate(value)
        except ValidationError as error:
            raise ValueError("; ".join(problem_lines(error, Drawn))) from None
        if drawn.deviation > most / 3:
            raise ValueError(f"deviation = {drawn.deviation:g}: must be at most {most / 3:.3g}")
        return drawn

    return check


def _schema(most: float) -> dict[str, Any]:
    """What an editor checks of it."""
    kinds = {name: {"type": "integer" if name == "seed" else "number"} for name in Drawn.model_fields}
    drawn = {"type": "object", "properties": kinds, "required": ["deviation"], "additionalProperties": False}
    return schema_over_x(-most, most, drawn)


Deviation = Annotated[
    NumberOrTable | Drawn, AS_IT_IS, PlainValidator(_check(0.5)), WithJsonSchema(_schema(0.5))
]


class AsBuilt(Parameters):
    """By how much a line as built differs from its drawing.

    Each value is a number, a table over x, [[0, 0.0], [65, 0.004]], straight between and even beyond its
    ends, or drawn by chance: { deviation = 0.004, seed = 3 }. The line as drawn gives dropper lengths, and
    preloads and pivots of steady arms; with these deviations it is then hung.
    """

    contact_wire_tension: Deviation | None = None
    """[1] share by which the tension of the contact wire is higher than drawn"""
    messenger_wire_tension: Deviation | None = None
    """[1] share by which the tension of the messenger wire is higher than drawn"""
    stagger: Deviation | None = None
    """[m] by which steady arms hold the contact wire further to the left than drawn"""
    messenger_wire_height: Deviation | None = None
    """[m] by which the messenger wire's supports are higher than drawn"""
    dropper_length: Deviation | None = None
    """[m] by which droppers are longer than they should have been cut"""
    contact_wire_height: Deviation | None = None
    """[m] by which the contact wire lies higher than drawn, at arms that hold its height and at droppers,
    whose lengths follow from it"""
    pre_sag: Deviation | None = None
    """[m] by which the contact wire sags more than drawn at mid-span; dropper lengths follow from it"""

    @model_validator(mode="after")
    def _one_tension(self) -> Self:
        for name in ("contact_wire_tension", "messenger_wire_tension"):
            value = getattr(self, name)
            if isinstance(value, Drawn) and value.shortest_wave is not None:
                raise ValueError(f"{name}: a wire has one tension; leave shortest_wave and longest_wave out")
        return self

    def at(self, name: str, x: ArrayLike, part: int = 0) -> Floats:
        """Shape of x [m]: the deviations of one kind there, 0 where none is given.

        part : of a kind that is drawn at places of several kinds, tells these apart
        """
        value, places = getattr(self, name), np.asarray(x, dtype=float)
        if value is None:
            return np.zeros_like(places)
        stream = list(type(self).model_fields).index(name)
        if not isinstance(value, Drawn):
            return over_x(value, places)
        return value.at(places, 10 * stream + part * (value.shortest_wave is None))

    @property
    def given(self) -> dict[str, Any]:
        """What is given, by its name."""
        return {name: v for name in type(self).model_fields if (v := getattr(self, name)) is not None}

    @property
    def of_heights(self) -> AsBuilt | None:
        """What of it decides about dropper lengths and settings of arms."""
        kept = {name: v for name, v in self.given.items() if name in ("contact_wire_height", "pre_sag")}
        return AsBuilt(**kept) if kept else None


def deviations(catenary: Catenary, name: str, x: ArrayLike, part: int = 0) -> Floats:
    """Shape of x [m]: how much a line as built differs from its drawing there; see :meth:`AsBuilt.at`."""
    built = catenary.as_built
    return built.at(name, x, part) if built else np.zeros(np.shape(x))


def tension_ratio(catenary: Catenary, wire: str) -> float:
    """[1] of the tension of a contact or messenger wire as built over that as drawn."""
    return 1.0 + float(deviations(catenary, f"{wire}_tension", 0.0)) if catenary.as_built else 1.0


def set_heights(catenary: Catenary) -> Floats:
    """[m], shape (droppers,): height of the contact wire for which each dropper was cut."""
    if catenary.as_built is None:
        return catenary.design_heights
    starts, found = catenary.support_positions, []
    middles = (starts[:-1] + starts[1:]) / 2
    sags = deviations(catenary, "pre_sag", middles).tolist()
    for span, sag in zip(catenary.spans, sags, strict=True):
        bare = [d.replace(height_offset=None) for d in span.droppers]
        found.append(
            span.replace(pre_sag=sag, droppers=tuple(bare)).height_offsets() if sag else np.zeros(len(bare))
        )
    higher = deviations(catenary, "contact_wire_height", catenary.designed_positions, part=1)
    heights: Floats = catenary.design_heights + (np.concatenate(found) + higher)[catenary.hanging]
    return heights


def as_built_faults(catenary: Catenary) -> Iterator[str]:
    """One line for each deviation that a line cannot have."""
    given = catenary.as_built.given if catenary.as_built else {}
    if catenary.messenger_wire is None:
        for name in ("messenger_wire_tension", "messenger_wire_height"):
            if name in given:
                yield f"as_built.{name} has no effect on a line without a messenger wire; leave it out"
    if "stagger" in given and not catenary.is_spatial:
        yield "as_built.stagger leaves the vertical plane; set spatial = true"
    if "dropper_length" in given and not any(span.droppers for span in catenary.spans):
        yield "as_built.dropper_length has no effect on a line without droppers; leave it out"
    lengths = [d.length for span in catenary.spans for d in span.droppers]
    for name in ("contact_wire_height", "pre_sag"):
        if name in given and lengths and None not in lengths:
            yield (
                f"as_built.{name} has no effect beside lengths of all droppers, which decide where the wire"
                " lies; leave one of them out, or give dropper_length"
            )


def mirrored(catenary: Catenary) -> AsBuilt | None:
    """The deviations of a line's mirror image, at its supports, droppers and spans."""
    if catenary.as_built is None:
        return None
    supports, droppers = catenary.support_positions, catenary.designed_positions
    spans = (supports[:-1] + supports[1:]) / 2
    found: dict[str, Any] = {}
    for name in catenary.as_built.given:
        if name.endswith("tension"):
            found[name] = float(deviations(catenary, name, 0.0))
            continue
        places = {
            "dropper_length": [droppers],
            "pre_sag": [spans],
            "contact_wire_height": [supports, droppers],
        }
        table = {
            catenary.length - x: value
            for part, at in enumerate(places.get(name, [supports]))
            for x, value in zip(at.tolist(), deviations(catenary, name, at, part).tolist(), strict=True)
        }
        found[name] = tuple(sorted(table.items()))
    return AsBuilt(**found)
