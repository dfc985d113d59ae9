"""What the surroundings do to a wire: the answers that an effect gives, and where it is asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainSerializer, PlainValidator, WithJsonSchema

from catenary_fe.layout.parameters import LARGEST, shorten
from catenary_fe.layout.parts import Wire

Floats = NDArray[np.float64]
Signal = Callable[[Floats], Floats]
BaseSignal = Callable[[float, float, Floats], Floats]
WireKind = Literal["contact_wire", "messenger_wire", "stitch_wire"]
COPPER = 8900.0  # [kg/m³]
_OR_TABLE = ", or a list of [x, value] pairs, or in a file the name of a .csv table"
ROPE_FILL = 0.76  # of a rope's circle: 19 and 37 wires
A_FILE: dict[str, Any] = {"type": "string", "pattern": r"\.[cC][sS][vV]$"}  # in a file of conditions


def outer_diameter(wire: Wire, *, rope: bool = False) -> float:
    """[m] of a wire: its own, else that of copper of its mass."""
    fill = ROPE_FILL if rope else 1.0
    return wire.diameter or float(np.sqrt(4 * wire.mass_per_length / (np.pi * COPPER * fill)))


@dataclass(frozen=True)
class WirePart:
    """Places on one wire, of which an effect says what it does there.

    kind : "contact_wire", "messenger_wire" or "stitch_wire"
    wire : its parameters
    x : [m], shape (places,), along the line
    """

    kind: WireKind
    wire: Wire
    x: Floats

    @property
    def diameter(self) -> float:
        """[m] outside."""
        return outer_diameter(self.wire, rope=self.kind != "contact_wire")

    @property
    def nothing(self) -> Floats:
        """Shape (3, places), zeros."""
        zeros: Floats = np.zeros((3, self.x.size))
        return zeros


class Effect:
    """Something that the surroundings do to the wires. What a subclass does not answer is nothing.

    Effects add up; none may depend on another, nor on their order. Three rows are along the track, to the
    left and up.
    """

    def load(self, part: WirePart) -> Floats:
        """[N/m], shape (3, places), constant."""
        return part.nothing

    def mass(self, part: WirePart) -> Floats:
        """[kg/m], shape (places,), that the wire carries; its weight is a load, too."""
        found: Floats = part.nothing[0]
        return found

    def damping(self, part: WirePart) -> Floats:
        """[N s/m²], shape (3, places), against the wire's velocity."""
        return part.nothing

    def strain(self, part: WirePart) -> Floats:
        """[1], shape (places,): by how much the wire lengthens without force."""
        found: Floats = part.nothing[0]
        return found

    def irregularity(self, part: WirePart) -> Floats:
        """[m], shape (places,): by how much a contact wire's running surface lies above its line."""
        found: Floats = part.nothing[0]
        return found

    def in_time(self, part: WirePart) -> Sequence[tuple[Floats, Signal]]:
        """Loads [N/m], shape (3, places), each with its signal of times [s], shape (times,)."""
        return ()

    def base_motion(self) -> BaseSignal | None:
        """Heights [m] of a pantograph's base from its start [m], its speed [m/s] and even times [s], if any.

        They have the shape of the times, which count from the start on.
        """
        return None


def table_over_x(value: Any, least: float, most: float) -> float | Table:
    """A number between two bounds, or a table of [x, number] pairs in order. Raises ValueError."""
    if not isinstance(value, (list, tuple)):
        return number_between(value, least, most, "")
    if not value:
        raise ValueError("is empty; give [x, value] pairs, or a number")
    return pairs_in_order(value, least, most, "x", "m")


def pairs_in_order(value: Any, least: float, most: float, name: str, unit: str) -> Table:
    """Pairs of places or times, and numbers between two bounds. Raises ValueError."""
    if not isinstance(value, (list, tuple)) or not value:
        raise ValueError(f"{shorten(value)}: must be a list of [{name}, value] pairs")
    found: list[tuple[float, float]] = []
    for n, pair in enumerate(value, start=1):
        if not isinstance(pair, (list, tuple)) or len(pair) != 2:
            raise ValueError(f"entry {n}: {shorten(pair)}: must be a pair [{name}, value]")
        at = number_between(pair[0], -LARGEST, LARGEST, f"entry {n}: {name} ")
        if found and at <= found[-1][0]:
            last, what = found[-1][0], "places" if name == "x" else "times"
            raise ValueError(
                f"entry {n}: {name} = {at:g} {unit} does not come after {last:g} {unit}; list the {what} in"
                " order"
            )
        found.append((at, number_between(pair[1], least, most, f"entry {n}: value ")))
    return tuple(found)


def schema_over_x(least: float, most: float, *more: dict[str, Any]) -> dict[str, Any]:
    """What an editor checks of it, or of the name of a file in its place."""
    number = {"type": "number", "minimum": least, "maximum": most}
    return {"anyOf": [number, schema_of_pairs(least, most), *more, A_FILE]}


def schema_of_pairs(least: float, most: float) -> dict[str, Any]:
    """Of a list of pairs."""
    number = {"type": "number", "minimum": least, "maximum": most}
    pair = {"type": "array", "prefixItems": [{"type": "number"}, number], "minItems": 2, "maxItems": 2}
    return {"type": "array", "items": pair}


def number_between(value: Any, least: float, most: float, what: str) -> float:
    """The value as a number. Raises ValueError that begins with what it is, and the value."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value <= most:
        rule = "a number" + (f" from {least:g}" if least > -LARGEST else "")
        rule += f" to {most:g}" if most < LARGEST else ""
        raise ValueError(f"{what}{shorten(value)}: must be {rule}" + _OR_TABLE * (not what))
    return float(value)


Table = tuple[tuple[float, float], ...]
NumberOrTable = float | Table
AS_IT_IS = PlainSerializer(lambda value: value, return_type=Any)  # pydantic expects no list of lists


def _over_x(least: float, most: float) -> tuple[Any, ...]:
    check = PlainValidator(lambda value: table_over_x(value, least, most))
    return AS_IT_IS, check, WithJsonSchema(schema_over_x(least, most))


OverX = Annotated[NumberOrTable, *_over_x(0.0, LARGEST)]
SurfaceOverX = Annotated[NumberOrTable, *_over_x(-0.1, 0.1)]  # [m]
BaseOverX = Annotated[NumberOrTable, *_over_x(-0.5, 0.5)]  # [m]
TemperatureOverX = Annotated[NumberOrTable, *_over_x(-100.0, 150.0)]


def over_x(values: NumberOrTable, x: Floats) -> Floats:
    """Shape of x: a number, or a table over places [m], straight between them and even beyond its ends."""
    if isinstance(values, tuple):
        at, of = np.array(values).T
        found: Floats = np.interp(x, at, of)
        return found
    return np.full(x.shape, float(values))
