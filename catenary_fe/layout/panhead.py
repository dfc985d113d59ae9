"""A pantograph's head: its masses on springs, and what its strips do beside moving up and down."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Self

from pydantic import model_validator

from catenary_fe.layout.arguments import number
from catenary_fe.layout.bodies import BASE, Body, Joint, Mode, Strip
from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive
from catenary_fe.theory.beam import free_beam_shapes

Knuckle = Literal["leading", "trailing"]


class AerodynamicForce(Parameters):
    """Upward force of the air, a V² + b V."""

    quadratic: Number = 0.0
    """[N s²/m²] a, times the square of the speed in m/s"""
    linear: Number = 0.0
    """[N s/m] b, times the speed in m/s"""
    trailing: tuple[Number, Number] | None = None
    """[N s²/m²], [N s/m] a and b with the knuckle trailing; unset: the same as with it leading"""

    def at(self, speed: float, knuckle: Knuckle = "leading") -> float:
        """[N] at a speed in m/s. Raises InputError for a negative or non-finite speed."""
        speed = number("speed", speed, "m/s", least=0.0)
        quadratic, linear = self._of(knuckle)
        return quadratic * speed**2 + linear * speed

    def in_words(self, knuckle: Knuckle) -> str:
        """One line."""
        quadratic, linear = self._of(knuckle)
        running = f", knuckle {knuckle}" if self.trailing else ""
        return f"{quadratic:g} V² + {linear:g} V (N, m/s){running}"

    def _of(self, knuckle: Knuckle) -> tuple[float, float]:
        if self.trailing and knuckle == "trailing":
            return self.trailing
        return self.quadratic, self.linear


class Panhead(Parameters):
    """The head beyond its mass: its width, a roll of its own, a second collector strip, pitch, bending."""

    width: Positive = 1.2
    """[m] of the part that may touch the wire, half to each side of the track's centre; the default is that
    of the 1600 mm head (recalled)"""
    spring_distance: Positive | None = None
    """[m] sideways between the two springs that share the stiffness below the head, which then rolls on
    them; unset: a head that stays level"""
    roll_inertia: Positive | None = None
    """[kg m²] about the track's direction; unset: that of a uniform bar of the head's width"""
    strips: Literal[1, 2] = 1
    """collector strips, one behind the other; two share the head's mass, spring and damper"""
    strip_distance: Positive | None = None
    """[m] along the track between two strips"""
    pitch_inertia: Positive | None = None
    """[kg m²] about the axis across the track, of two strips on one rigid head; unset: each by itself"""
    pitch_spring_distance: Positive | None = None
    """[m] along the track between the springs of a head that pitches"""
    bending_frequencies: tuple[Positive] | tuple[Positive, Positive] | None = None
    """[Hz] of the first bending modes, one or two, of a uniform strip of the head's width and mass that hangs
    free; unset: a stiff one"""
    bending_damping: NonNegative = 0.01
    """[1] ratio of damping of the bending modes (assumed)"""

    @model_validator(mode="after")
    def _options_belong_together(self) -> Self:
        if (self.strips == 2) != (self.strip_distance is not None):
            raise ValueError("strips = 2 and strip_distance belong together: give both or neither")
        if self.roll_inertia and self.spring_distance is None:
            raise ValueError("roll_inertia has no effect without spring_distance; give both or neither")
        if (self.pitch_inertia is None) != (self.pitch_spring_distance is None):
            raise ValueError("pitch_inertia and pitch_spring_distance belong together: give both or neither")
        if self.pitch_inertia and self.strips == 1:
            raise ValueError("pitch_inertia has no effect with one strip; give strips = 2, or leave it out")
        if self.pitch_inertia and self.bending_frequencies:
            raise ValueError(
                "pitch_inertia and bending_frequencies: a head that pitches is rigid; give one of them"
            )
        usual = type(self).model_fields["bending_damping"].default
        if self.bending_frequencies is None and self.bending_damping != usual:
            raise ValueError(
                "bending_damping has no effect without bending_frequencies; give both or neither"
            )
        return self

    def rolling_inertia(self, mass: float) -> float:
        """[kg m²] of a head of this mass [kg]."""
        return self.roll_inertia or mass * self.width**2 / 12

    @property
    def modes(self) -> tuple[Mode, ...]:
        """Of bending, of each strip."""
        frequencies = self.bending_frequencies or ()
        if not frequencies:
            return ()
        shapes = free_beam_shapes(len(frequencies), self.width).tolist()
        return tuple(
            Mode(f, self.bending_damping, tuple(shape)) for f, shape in zip(frequencies, shapes, strict=True)
        )

    def on_springs(
        self, stages: Sequence[Stage], *, on_base: bool, spatial: bool
    ) -> tuple[list[Body], list[Joint], list[Strip]]:
        """The bodies of stages, head first, their joints, and the strips.

        on_base : whether the last stage stands on the base, or on a body that follows
        spatial : whether the line has coordinates across the track, in which a head on two springs rolls
        """
        first, half = stages[0], (self.spring_distance or 0.0) / 2
        rolls, pitch = bool(half) and spatial, self.pitch_inertia
        lever = half if rolls or self.modes else 0.0
        count = 1 if pitch else self.strips
        share = 1 / count
        inertia = self.rolling_inertia(first.mass) * share if rolls else None
        bodies = [Body(first.mass * share, inertia, pitch, self.modes)] * count
        bodies += [Body(stage.mass) for stage in stages[1:]]
        below = [*range(count, len(bodies)), BASE if on_base else len(bodies)]
        reach = (self.pitch_spring_distance or 0.0) / 2
        joints = [first.joint(i, below[0], share, lever, reach) for i in range(count)]
        joints += [
            stage.joint(i, lower) for i, lower, stage in zip(below, below[1:], stages[1:], strict=False)
        ]
        apart = self.strip_distance or 0.0
        strips = [Strip(apart * (0.5 - i), 0 if pitch else i) for i in range(2)]
        return bodies, joints, strips if self.strips == 2 else [Strip(0.0, 0)]


def lifted(shares: Sequence[float], bodies: int, masses: int) -> tuple[float, ...]:
    """Share of each body in the uplift force.

    shares : of the masses, head first, and once more of the lowest one
    bodies : number of them, of which the first ones may share the head's mass
    masses : number of them
    """
    heads = bodies - masses + 1
    each = [*shares[:-2], sum(shares[-2:])] if len(shares) > masses else list(shares)
    return (*(each[0] / heads,) * heads, *each[1:])


class Stage(Parameters):
    """A mass with the spring and damper below it, which join it to the next stage or to the base."""

    mass: Positive
    """[kg] of the stage"""
    stiffness: NonNegative
    """[N/m] of the spring below the mass"""
    damping: NonNegative = 0.0
    """[N s/m] of the damper below the mass"""
    damping_up: NonNegative | None = None
    """[N s/m] of a damper that differs: while the mass rises against what is below it"""
    damping_down: NonNegative | None = None
    """[N s/m] likewise, while it comes down; both instead of `damping`"""
    friction: NonNegative = 0.0
    """[N] dry, between the mass and what is below it"""
    travel: tuple[Positive, Positive] | None = None
    """[m] down and up by which the mass can move from where the spring below it is force-free, before it
    meets its stops; unset: no stops"""
    stop_stiffness: Positive = 1e6
    """[N/m] of the stops (a value of an SNCF thesis)"""
    aerodynamic_force: AerodynamicForce = AerodynamicForce()
    """of the air, on this mass; on the lowest one added to that of the pantograph"""

    @model_validator(mode="after")
    def _one_damper(self) -> Self:
        up, down = self.damping_up, self.damping_down
        if (up is None) != (down is None):
            raise ValueError("damping_up and damping_down belong together: give both or neither")
        if up is not None and self.damping:
            raise ValueError("damping has no effect beside damping_up and damping_down; leave it out")
        if self.travel is None and self.stop_stiffness != type(self).model_fields["stop_stiffness"].default:
            raise ValueError("stop_stiffness has no effect without travel; give both or neither")
        return self

    def joint(
        self, upper: int, lower: int, share: float = 1.0, lever: float = 0.0, reach: float = 0.0
    ) -> Joint:
        """The spring and damper below the mass, or a share of them, with what is not linear there."""
        up, down = (self.damping if each is None else each for each in (self.damping_up, self.damping_down))
        common = min(up, down)
        return Joint(
            upper,
            lower,
            share * self.stiffness,
            share * common,
            lever,
            rising=share * (up - common),
            falling=share * (down - common),
            friction=share * self.friction,
            travel=self.travel,
            stop_stiffness=share * self.stop_stiffness,
            reach=reach,
        )

    @property
    def in_words(self) -> str:
        """One line."""
        damper = f"{self.damping:g} N s/m"
        if self.damping_up is not None:
            damper = f"{self.damping_up:g} N s/m up and {self.damping_down:g} down"
        friction = f", {self.friction:g} N of friction" if self.friction else ""
        stops = f", stops at −{self.travel[0]:g} and {self.travel[1]:g} m" if self.travel else ""
        known = self.aerodynamic_force != AerodynamicForce()
        air = f", air {self.aerodynamic_force.in_words('leading')}" if known else ""
        return f"{self.mass:g} kg on {self.stiffness:g} N/m, {damper}{friction}{stops}{air}"
