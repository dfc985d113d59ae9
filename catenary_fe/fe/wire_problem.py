"""One wire to be set in motion, and how it moved."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import MOST_ELEMENTS
from catenary_fe.layout import InputError, Pantograph, Wire
from catenary_fe.layout.arguments import instance, number, numbers
from catenary_fe.layout.parameters import changed_by_copy, shorten
from catenary_fe.theory import ElasticPantograph, MovingForce

Floats = NDArray[np.float64]
Function = Callable[[Floats], Floats]


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class SlidingPantograph:
    """A pantograph of lumped masses in moving contact with the wire, its heads at z = 0 when it starts.

    uplift : [N] constant force on the lowest mass
    speed : [m/s]
    start : [m] where it is at t = 0
    """

    pantograph: Pantograph
    uplift: float
    speed: float
    start: float = 0.0

    def __post_init__(self) -> None:
        instance("pantograph", self.pantograph, Pantograph, "such as library.pantograph('DSA250')")
        number("uplift", self.uplift, "N")
        number("speed", self.speed, "m/s", least=0.0)
        number("start", self.start, "m")


Load = MovingForce | ElasticPantograph | SlidingPantograph


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class WireProblem:
    """A wire along the track, held in height at both ends.

    wire : its mass per length, tension and stiffnesses
    x : [m] shape (nodes,), rising, of the nodes; supports, masses and springs lie on nodes
    tensioned : the last node is free along the track and pulled by the wire's tension; otherwise both ends
        are fixed, and the tension rises as the wire is deflected
    supports : [m] rigid supports, which let the wire slide along the track
    foundation_stiffness : [N/m²] vertical, per length of the wire
    masses : [kg] by position [m]
    springs : [N/m] vertical, to the ground, by position [m]
    dampers : [N s/m] vertical, to the ground, by position [m]
    weight : the wire and its masses weigh, and the motion starts as they are let go
    initial_deflection : [m] of positions [m], smooth, 0 at ends and supports; unset: straight
    initial_velocity : [m/s] of positions [m], smooth, likewise; unset: at rest
    loads : forces and pantographs that move along the wire; they act while they are on it

    Raises InputError where something lies off the nodes.
    """

    wire: Wire
    x: Floats
    tensioned: bool = True
    supports: Sequence[float] = ()
    foundation_stiffness: float = 0.0
    masses: Mapping[float, float] = field(default_factory=dict)
    springs: Mapping[float, float] = field(default_factory=dict)
    dampers: Mapping[float, float] = field(default_factory=dict)
    weight: bool = False
    initial_deflection: Function | None = None
    initial_velocity: Function | None = None
    loads: Sequence[Load] = ()

    def __post_init__(self) -> None:
        instance("wire", self.wire, Wire, "library.wire(name, tension=...) gives one")
        x = numbers("x", self.x)
        if x.ndim != 1 or x.size < 2 or not (np.diff(x) > 0).all():
            raise InputError("x: the nodes' positions must rise; give at least two")
        number("foundation_stiffness", self.foundation_stiffness, "N/m²", least=0.0)
        for name in ("masses", "springs", "dampers"):
            given = getattr(self, name)
            if not isinstance(given, Mapping):
                raise InputError(f"{name} = {shorten(given)}: must be a table {{position: value}}")
            for position, value in given.items():
                number(f"{name}: value at {shorten(position)} m", value, least=0.0)
        for position in (
            *np.atleast_1d(numbers("supports", self.supports)),
            *self.masses,
            *self.springs,
            *self.dampers,
        ):
            self.node(position)
        for name in ("initial_deflection", "initial_velocity"):
            if getattr(self, name) is not None and not callable(getattr(self, name)):
                raise InputError(f"{name} = {shorten(getattr(self, name))}: must be a function of positions")
        if isinstance(self.loads, str) or not isinstance(self.loads, Sequence):
            raise InputError(f"loads = {shorten(self.loads)}: must be a list of loads")
        for load in self.loads:
            if not isinstance(load, MovingForce | ElasticPantograph | SlidingPantograph):
                raise InputError(
                    f"loads: {shorten(load)}: must be a theory.MovingForce, a theory.ElasticPantograph or a"
                    " SlidingPantograph"
                )

    def node(self, position: float) -> int:
        """Number of the node at a position [m]. Raises InputError if there is none."""
        position = number("position", position, "m")
        nearest = int(np.abs(np.asarray(self.x) - position).argmin())
        if abs(self.x[nearest] - position) > 1e-6:
            raise InputError(
                f"{position:g} m is not on a node, the nearest is at {self.x[nearest]:g} m; add it to x"
            )
        return nearest


@changed_by_copy
@dataclass(frozen=True)
class WireMotion:
    """Motion of a wire, complete.

    t : [s] shape (times,)
    x : [m] shape (nodes,)
    deflection : [m] shape (times, nodes), upwards
    velocity : [m/s] shape (times, nodes)
    forces : [N] shape (times, loads), of each load on the wire, upwards; 0 while it is off the wire
    under_loads : [m] shape (times, loads), deflection of the wire at each load; NaN while it is off
    heads : [m] shape (times, loads), height of each pantograph's head; NaN for plain forces
    energy : [J] shape (times,), kinetic and stored, of the wire and what it carries; empty unless asked for
    """

    t: Floats
    x: Floats
    deflection: Floats
    velocity: Floats
    forces: Floats
    under_loads: Floats
    heads: Floats
    energy: Floats

    def at(self, time: float) -> Floats:
        """[m] shape (nodes,), the deflection at the stored time [s] nearest to the given one.

        Raises InputError for a time outside the motion.
        """
        number("time", time, "s", least=float(self.t[0]), most=float(self.t[-1]))
        shape: Floats = self.deflection[np.abs(self.t - time).argmin()]
        return shape


@dataclass(frozen=True, kw_only=True)
class WirePair:
    """Wires without moving loads, and the dropper between them.

    lower, upper : the wires; both have a node at the dropper
    height : [m] of the upper wire above the lower one
    position : [m] of the dropper along the track
    stiffness : [N/m] of the dropper in tension
    preload : [N] tension at rest, balanced by constant forces on the wires as by a weight and its support
    damping : [N s/m] of the dropper while it is taut
    """

    lower: WireProblem
    upper: WireProblem
    height: float
    position: float
    stiffness: float
    preload: float
    damping: float = 0.0


@dataclass(frozen=True)
class PairMotion:
    """Motion of both wires, complete.

    lower, upper : the wires' motions
    dropper_force : [N] shape (times,), tension
    """

    lower: WireMotion
    upper: WireMotion
    dropper_force: Floats


def even_nodes(fixed: Sequence[float] | Floats, element: float) -> Floats:
    """Positions [m] of nodes on all the fixed points and evenly between them.

    fixed : [m] ends, supports and whatever needs a node
    element : [m] largest length of an element

    Raises InputError for fewer than two positions, or a wire of more than 200,000 elements.
    """
    points = np.unique(numbers("fixed", fixed))
    if points.size < 2:
        raise InputError(f"fixed = {shorten(fixed)}: give at least the wire's two ends")
    number("element", element, "m", above=0.0)
    if np.ptp(points) / element > MOST_ELEMENTS:
        raise InputError(
            f"element = {element:g} m: {np.ptp(points):g} m take more than {MOST_ELEMENTS:,} of them; use"
            " longer ones"
        )
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / element - 1e-9))), endpoint=False)
        for a, b in pairwise(points)
    ]
    return np.append(np.concatenate(parts), points[-1])


def graded_nodes(
    fixed: Sequence[float] | Floats,
    element: float,
    *,
    kinks: Sequence[float] | Floats,
    finest: float,
    growth: float = 2.0,
) -> Floats:
    """Positions [m] of nodes that crowd around kinks: supports, masses, springs and forces at rest.

    fixed : [m] ends and whatever else needs a node
    element : [m] largest length of an element
    kinks : [m] where elements start with the length ``finest``
    growth : ratio of neighbouring lengths

    Raises InputError as :func:`even_nodes`, and for values out of their order.
    """
    number("element", element, "m", above=0.0)
    number(
        "finest", finest, "m", least=element / MOST_ELEMENTS, most=element, remedy="no longer than an element"
    )
    number("growth", growth, above=1.0)
    kinks = numbers("kinks", kinks).ravel()
    fixed = numbers("fixed", fixed).ravel()
    if not kinks.size:
        return even_nodes(fixed, element)
    sizes = finest * growth ** np.arange(max(0, int(np.log(element / finest) / np.log(growth))) + 1)
    around = np.concatenate([[0.0], np.cumsum(sizes)])
    points = np.unique(np.concatenate([fixed, kinks]))
    left, right = np.subtract.outer(kinks, around), np.add.outer(kinks, around)
    # where two kinks are close, neither crowds beyond the middle between them
    gaps = np.diff(np.asarray(kinks, dtype=float), prepend=-np.inf, append=np.inf) / 2
    left = left[np.broadcast_to(around, left.shape) <= gaps[:-1, None]]
    right = right[np.broadcast_to(around, right.shape) <= gaps[1:, None]]
    inside = np.concatenate([left, right])
    inside = inside[(inside > points[0]) & (inside < points[-1])]
    return even_nodes(np.unique(np.round(np.concatenate([points, inside]), 9)), element)
