"""The parts of a layout as its file writes them; the library and common tables fill in what is not given."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import ConfigDict, Field, model_validator

from catenary_fe.layout import library
from catenary_fe.layout.parameters import Number, Text, shorten
from catenary_fe.layout.parts import Dropper, Span, SteadyArm, StitchWire, Support, Wire


class WireEntry(Wire):
    """A wire of its own, or one of the library with some values changed."""

    library: Text | None = None
    """name of a wire in the library, which fills in the values that are not given"""

    model_config = ConfigDict(json_schema_extra=lambda schema: schema.update(required=["tension"]))

    @model_validator(mode="before")
    @classmethod
    def _fill_in(cls, data: Any) -> Any:
        if isinstance(data, dict) and isinstance(data.get("library"), str):
            return library.wire_record(data["library"]) | data
        return data

    def wire(self) -> Wire:
        return Wire(**self.model_dump(exclude={"library"}))


class StitchWireEntry(StitchWire, WireEntry):
    """Stitch wires, of the library or of their own."""

    model_config = ConfigDict(json_schema_extra=lambda schema: schema.update(required=["tension", "length"]))

    def wire(self) -> StitchWire:
        return StitchWire(**self.model_dump(exclude={"library"}))


class DropperEntry(Dropper):
    """A dropper with values of its own; a bare number is its position."""

    model_config = ConfigDict(
        json_schema_extra=lambda schema: schema.update(
            {"anyOf": [{"type": "object"}, {"type": "number"}], "type": ["object", "number"]}
        )
    )

    @model_validator(mode="before")
    @classmethod
    def _bare_position(cls, data: Any) -> Any:
        if isinstance(data, int | float):
            return {"position": data}
        if not isinstance(data, dict):
            raise ValueError(f"{shorten(data)} is neither a position in metres nor a table")
        return data


class DropperDefaults(Dropper):
    """What all droppers of the line have in common."""

    position: Number = Field(default=0.0, exclude=True, json_schema_extra={"deprecated": True})
    """not used here: each span lists the positions"""

    @model_validator(mode="after")
    def _no_position(self) -> DropperDefaults:
        if "position" in self.model_fields_set:
            raise ValueError("a position belongs to a span's list of droppers, not to the common values")
        return self


class SpanEntry(Span):
    """One span, or several equal ones."""

    droppers: tuple[DropperEntry, ...]
    """positions in metres from the span's first support, or tables for droppers with values of their own"""
    count: Annotated[int, Field(strict=True, ge=1, le=10_000)] = 1
    """how many spans like this follow one another"""


class SteadyArmEntry(SteadyArm):
    """How one support's steady arm differs: keys that are not given stay as all supports have them.

    A `length` where the others have a `stiffness`, or the reverse, makes an arm of the other kind: of theirs
    it then keeps the `uplift_room` alone.
    """

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        return self  # judged when it is whole

    @model_validator(mode="after")
    def _link_has_a_height(self) -> Self:
        return self

    def beside(self, common: SteadyArm | None) -> SteadyArm:
        """The whole arm. Raises InputError where the two do not make one."""
        own = {name: getattr(self, name) for name in self.model_fields_set}
        kept: dict[str, Any] = common.model_dump() if common else {}
        for kind, other in (("length", "stiffness"), ("stiffness", "length")):
            if kind in own and other not in own and kept.get(other) is not None:
                kept = {"uplift_room": kept["uplift_room"]}
        if own.get("holds_design_height"):
            kept.pop("preload", None)  # of arms that do not hold it
        return SteadyArm(**(kept | own))


class SupportEntry(Support):
    """A support that differs from the others; keys that are not given stay as all supports have them."""

    steady_arm: SteadyArmEntry | None = None
    """registration of the contact wire, as far as it differs"""
    at: Annotated[int, Field(strict=True, ge=1)]
    """number of the support, from 1; support n stands before span n"""

    @model_validator(mode="after")
    def _damping_needs_a_spring(self) -> Self:
        return self  # judged beside what all supports have

    def beside(self, common: Support) -> Support:
        """The whole support. Raises InputError where the two do not make one."""
        changes = {name: getattr(self, name) for name in self.model_fields_set - {"at"}}
        if self.steady_arm:
            changes["steady_arm"] = self.steady_arm.beside(common.steady_arm)
        return common.replace(**changes)
