"""A pantograph whose frame is described as it is built: arms, rod, drive, damper, friction, stops."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from catenary_fe.layout.bodies import BASE, FRAME, Body, ContactLaw, Joint, Law, Mechanism
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.panhead import AerodynamicForce, Panhead, Stage, lifted
from catenary_fe.layout.parameters import GRAVITY, NonEmpty, NonNegative, Number, Parameters, Positive
from catenary_fe.layout.pushed import PushedPantograph
from catenary_fe.layout.substructure import Substructure
from catenary_fe.theory.linkage import Bar, Linkage

Floats = NDArray[np.float64]
_POINTS = 201  # heights at which a frame's mass and force are tabulated; cubic between
_BELLOWS = 1e-3  # [kg] that stand for the air in a bellows, so that it is a body


class Arm(Parameters):
    """A rigid bar of the frame."""

    length: Positive
    """[m] between its joints"""
    mass: NonNegative = 0.0
    """[kg] of the bar"""
    centre: NonNegative = 0.0
    """[m] of its centre of mass from its lower joint, along the bar"""
    inertia: NonNegative = 0.0
    """[kg m²] about its centre of mass"""

    @property
    def bar(self) -> Bar:
        """For the mechanism."""
        return Bar(self.length, self.mass, self.centre, self.inertia)


class UpperArm(Arm):
    """From the knee to the apex, with a lever beyond the knee that the coupling rod holds."""

    lever: Positive
    """[m] from the knee to the coupling rod's joint"""
    lever_angle: Number
    """[rad] from the direction of the arm, seen from the knee, to that of the lever, anticlockwise with x
    along the track to the right and z up"""


class CouplingRod(Arm):
    """From its pivot on the roof to the upper arm's lever."""

    pivot: tuple[Number, Number]
    """[m] along the track and up, of its fixed joint from the base pivot"""


class FrameDrive(Parameters):
    """What raises the frame: a torque on the lower arm, and perhaps the air in a bellows."""

    torque: Positive | tuple[tuple[Number, Number], ...] | None = None
    """[N m] on the lower arm in the sense that raises it, or a table over its angle [rad], rising; unset: a
    cam sees to it that the uplift force acts on the apex at any height"""
    bellows_stiffness: NonNegative = 0.0
    """[N m/rad] by which the torque falls as the arm rises faster than the air follows"""
    lag: Positive | None = None
    """[s] in which the regulator brings the pressure back"""

    @model_validator(mode="after")
    def _air_follows(self) -> Self:
        if bool(self.bellows_stiffness) != (self.lag is not None):
            raise ValueError("bellows_stiffness and lag belong together: give both or neither")
        if isinstance(self.torque, tuple):
            angles = [angle for angle, _ in self.torque]
            if len(angles) < 2 or any(b <= a for a, b in pairwise(angles)):
                raise ValueError("torque: a table has two rows at least, their angles rising")
        return self


class FrameDamper(Parameters):
    """On the lower arm, perhaps another one up than down."""

    up: NonNegative
    """[N m s/rad] while the frame rises"""
    down: NonNegative
    """[N m s/rad] while it comes down"""


class LinkagePantograph(PushedPantograph):
    """A single-arm pantograph: a four-bar mechanism, and on its apex the head's masses.

    Its motion is that of the head's masses and the frame's apex, whose mass, weight and drive change with the
    height, exactly as the mechanism says (virtual work; kinetic energy). The apex's small drift along the
    track is part of the kinetic energy, and of nothing else. Damper, friction and bellows act as they do
    where it stands under its static force.
    """

    kind = "linkage"
    lower_arm: Arm
    """from the base pivot to the knee"""
    upper_arm: UpperArm
    """from the knee to the apex"""
    coupling_rod: CouplingRod
    """from the roof to the upper arm's lever"""
    apex_mass: NonNegative = 0.0
    """[kg] that moves with the apex without turning: head guide, and what of the head has no spring"""
    head_stages: Annotated[tuple[Stage, ...], NonEmpty]
    """what stands on the apex, head first: masses with the spring and damper below each"""
    pivot_height: Positive
    """[m] of the base pivot above the rail"""
    head_height: NonNegative = 0.0
    """[m] of the strips above the apex, the head's springs bearing the head alone"""
    working_height: Positive = 5.3
    """[m] of the contact wire above the rail, at which the pantograph by itself is shown"""
    reach: tuple[Number, Number] | None = None
    """[m] lowest and highest place of the apex above the base pivot, at stops; unset: no stops"""
    stop_stiffness: Positive = 1e6
    """[N/m] of the stops, at the apex (a value of an SNCF thesis)"""
    drive: FrameDrive = FrameDrive()
    """what raises the frame"""
    damper: FrameDamper = FrameDamper(up=0.0, down=0.0)
    """of the frame"""
    joint_friction: NonNegative | tuple[NonNegative, NonNegative, NonNegative, NonNegative] = 0.0
    """[N m] dry, in base pivot, knee, the lever's joint and the rod's pivot; one number for each of them"""
    head: Panhead | None = None
    """what the head is beyond its mass; unset: a level head of the usual width with one strip"""
    base: Literal["rail"] = "rail"
    """the frame is a mechanism: it stands on the roof"""

    @model_validator(mode="after")
    def _one_force(self) -> Self:
        given = [self.uplift_force, self.mean_force, self.drive.torque]
        if sum(value is not None for value in given) != 1:
            raise ValueError(
                "uplift_force, mean_force and drive.torque: give exactly one, the force on the apex, the mean"
                " contact force that it shall result in, or the torque from which it follows"
            )
        return self

    @model_validator(mode="after")
    def _stands(self) -> Self:
        try:
            low, high = self.linkage.heights
            self.linkage.angle_at(self._apex(self.working_height))
        except ValueError as error:
            raise ValueError(
                f"the frame does not stand at working_height = {self.working_height:g} m: {error}; look at"
                " lengths, pivot_height and head_height"
            ) from None
        if self.reach is None:
            if self.stop_stiffness != type(self).model_fields["stop_stiffness"].default:
                raise ValueError("stop_stiffness has no effect without reach; give both or neither")
        elif not low <= self.reach[0] < self.reach[1] <= high:
            raise ValueError(
                f"reach = {self.reach[0]:g} to {self.reach[1]:g} m: must rise, and lie within what the"
                f" mechanism reaches, {low:.3f} to {high:.3f} m"
            )
        return self

    @cached_property
    def linkage(self) -> Linkage:
        """The mechanism."""
        upper = self.upper_arm
        return Linkage(
            lower=self.lower_arm.bar,
            upper=upper.bar,
            rod=self.coupling_rod.bar,
            lever=upper.lever,
            lever_angle=upper.lever_angle,
            rod_pivot=self.coupling_rod.pivot,
            apex_mass=self.apex_mass,
        )

    def _apex(self, height: float) -> float:
        """[m] of the apex above the base pivot, the contact wire at a height [m], its force away."""
        return height - self.pivot_height - self.head_height

    @property
    def stages(self) -> tuple[Stage, ...]:
        """Those of the head."""
        return self.head_stages

    @property
    def panhead(self) -> Panhead:
        """What the head is, be it given or the usual one."""
        return self.head or Panhead()

    @property
    def masses(self) -> tuple[float, ...]:
        """[kg] of the head's stages, and of the frame at its apex at the working height."""
        angle = self.linkage.angle_at(self._apex(self.working_height))
        return (*(stage.mass for stage in self.head_stages), float(self.linkage.mass(angle)))

    def lift(self, angle: Any) -> Floats:
        """[N] up on the head at rest, at angles [rad] of the lower arm, any shape: drive less weight.

        Of a drive with a torque: with a cam it is the uplift force.
        """
        torque, angles = self.drive.torque, np.asarray(angle, dtype=float)
        assert torque is not None
        rise = self.linkage.rise(angles)
        if isinstance(torque, tuple):
            at, of = np.transpose(torque)
            pull = np.interp(angles, at, of)
        else:
            pull = np.full(angles.shape, torque)
        found: Floats = pull / np.abs(rise) - self.linkage.weight(angles) - self._head_weight
        return found

    def static_uplift(self, speed: float) -> float:
        """[N] on the apex at a speed in m/s, at the working height; for a mean force, the first guess.

        Raises InputError where drive and air leave nothing to press with.
        """
        if self.drive.torque is None:
            return super().static_uplift(speed)
        uplift = float(self.lift(self.linkage.angle_at(self._apex(self.working_height))))
        uplift += sum(self.air(speed))
        if uplift <= 0:
            raise InputError(
                f"{self.name}: drive, weight and air leave {uplift:.6g} N for the head at {3.6 * speed:g}"
                " km/h: must be above 0, or it stays down; raise drive.torque, or look at the masses"
            )
        return uplift

    @property
    def airs(self) -> list[AerodynamicForce]:
        """Forces of the air on the head's masses, head first, and on the apex."""
        return [*(stage.aerodynamic_force for stage in self.head_stages), self.aerodynamic_force]

    def assemble(
        self, *, spatial: bool, height: float | None = None, speed: float | None = None
    ) -> Substructure:
        """The head's masses on the frame's apex, which counts from where it is with the wire at its height.

        height : [m] of the contact wire above the rail; unset: the working height
        speed : [m/s], by which the air shares the uplift force out; None: at a standstill

        Raises InputError for a wire that the frame does not reach.
        """
        apex = self._apex(self.working_height if height is None else height)
        try:
            angle = self.linkage.angle_at(apex)
        except ValueError as error:
            raise InputError(
                f"{self.name}: with the contact wire at {height or self.working_height:g} m the apex would be"
                f" {apex:.3f} m above the base pivot; {error}; look at pivot_height and head_height"
            ) from None
        bodies, joints, strips = self.panhead.on_springs(self.head_stages, on_base=False, spatial=spatial)
        frame = len(bodies)
        table, force_slope = self._frame_law(apex, angle)
        standing = self._standing(apex, speed)
        joints.append(self._frame_joint(frame, apex, standing, force_slope))
        bodies.append(Body(float(self.linkage.mass(angle))))
        up = list(lifted(self.shares(speed), frame + 1, len(self.head_stages) + 1))
        if self.drive.bellows_stiffness and self.drive.lag:
            stiffness = self.drive.bellows_stiffness / float(self.linkage.rise(standing)) ** 2
            bodies.append(Body(_BELLOWS))
            up.append(0.0)
            joints.append(Joint(frame, frame + 1, stiffness, 0.0))
            joints.append(Joint(frame + 1, BASE, 0.0, stiffness * self.drive.lag))
        row = [0.0] * len(bodies)
        row[frame] = 1.0
        return Substructure(
            bodies=tuple(bodies),
            joints=tuple(joints),
            lifted=tuple(up),
            strips=tuple(strips),
            contact=ContactLaw(self.contact_stiffness, self.contact_damping),
            follows=False,
            frame=Law(FRAME, tuple(row), *table),
            mechanism=self._mechanism(apex),
        )

    def _standing(self, apex: float, speed: float | None) -> float:
        """[rad] of the lower arm with the head's springs pressed by the static force, from an apex [m]."""
        soft = sum(1 / stage.stiffness for stage in self.head_stages if stage.stiffness)
        highest = self._heights()[-1]
        return self.linkage.angle_at(float(min(apex + soft * self.static_uplift(speed or 0.0), highest)))

    def _mechanism(self, apex: float) -> Mechanism:
        torque = self.drive.torque
        if torque is None:
            return Mechanism(self.linkage, apex)
        own = float(self.lift(self.linkage.angle_at(self._apex(self.working_height))))
        return Mechanism(self.linkage, apex, torque, own, self._head_weight)

    @property
    def _head_weight(self) -> float:
        """[N] of what stands on the apex."""
        return GRAVITY * sum(stage.mass for stage in self.head_stages)

    def _heights(self) -> Floats:
        """[m] of the apex above the base pivot, even, at which mass and force are tabulated."""
        low, high = self.linkage.heights
        spare = 1e-3 * (high - low)
        return np.linspace(low + spare, high - spare, _POINTS)

    def _frame_law(self, apex: float, angle: float) -> tuple[Any, float]:
        """Values, base part and table of the frame's law, and the slope [N/m] of the force that is linear."""
        from scipy.interpolate import CubicSpline

        heights = self._heights()
        angles = self.linkage.angles_at(heights)
        mass = CubicSpline(heights, self.linkage.mass(angles))
        missing = np.zeros(heights.size)
        if self.drive.torque is not None:
            missing = self.lift(self.linkage.angle_at(self._apex(self.working_height))) - self.lift(angles)
        force = CubicSpline(heights, missing)
        slope, own = float(force(apex, 1)), float(self.linkage.mass(angle))
        rows = np.column_stack(
            [
                mass(heights) - own,
                mass(heights, 1),
                force(heights) - slope * (heights - apex),
                force(heights, 1) - slope,
            ]
        )
        values = (float(heights[0] - apex), float(heights[1] - heights[0]))
        return (values, -1.0, tuple(map(tuple, rows.tolist()))), slope

    def _frame_joint(self, frame: int, apex: float, angle: float, force_slope: float) -> Joint:
        """Damper, friction and stops between roof and apex, as they are at this height."""
        rise = abs(float(self.linkage.rise(angle)))
        up, down = self.damper.up / rise**2, self.damper.down / rise**2
        torques = self.joint_friction
        each = torques if isinstance(torques, tuple) else (torques,) * 4
        friction = float(np.abs(self.linkage.joint_rates(angle)) @ np.array(each))
        travel = (apex - self.reach[0], self.reach[1] - apex) if self.reach else None
        common = min(up, down)
        return Joint(
            frame,
            BASE,
            force_slope,
            common,
            rising=up - common,
            falling=down - common,
            friction=friction,
            travel=travel,
            stop_stiffness=self.stop_stiffness,
        )

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        low, high = self.linkage.heights
        names = ["mass 1 (head)", *(f"mass {n}" for n in range(2, len(self.head_stages) + 1))]
        return [
            ("source", self.source or "not given"),
            *((name, stage.in_words) for name, stage in zip(names, self.head_stages, strict=True)),
            ("frame", f"{self.masses[-1]:.4g} kg at the apex with the wire at {self.working_height:g} m"),
            ("apex above the base pivot", f"{low:.3f} to {high:.3f} m"),
            ("damper of the frame", f"{self.damper.up:g} N m s/rad up and {self.damper.down:g} down"),
            *self.forces_in_words(),
        ]
