"""The static shape of an installed catenary."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.fe.assembly import assemble
from catenary_fe.fe.installation import Installation
from catenary_fe.fe.mesh import Mesh, MeshSettings
from catenary_fe.fe.system import System
from catenary_fe.layout import Catenary
from catenary_fe.layout.arguments import on_the_wire
from catenary_fe.layout.conditions import Conditions
from catenary_fe.layout.installed import changes_in_words
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.statics.schedules import DropperRow, SupportRow, dropper_rows, support_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class HangingWire:
    """Where one wire hangs.

    x, y, z : [m], shape (nodes,), along the track, to the left of its centre (0 in the plane), above the rail
    dy_dx, dz_dx : shape (nodes,), inclinations
    """

    x: Floats
    y: Floats
    z: Floats
    dy_dx: Floats
    dz_dx: Floats

    @classmethod
    def from_coordinates(cls, q: Floats) -> HangingWire:
        """From total coordinates of shape (nodes, 2 * axes): points, slopes."""
        axes = q.shape[1] // 2
        inclinations = q[:, axes:] / q[:, axes : axes + 1]
        none = np.zeros(len(q))
        y, dy_dx = (q[:, 1], inclinations[:, 1]) if axes == 3 else (none, none)
        return cls(q[:, 0], y, q[:, axes - 1], dy_dx, inclinations[:, -1])

    def height(self, x: ArrayLike) -> Floats:
        """[m] at positions x [m] along the line, any shape; cubic inside the elements.

        Raises InputError beyond the wire's ends.
        """
        return self._between(x, self.z, self.dz_dx)

    def lateral(self, x: ArrayLike) -> Floats:
        """[m] to the left of the track's centre at positions x [m] along the line, any shape.

        Raises InputError beyond the wire's ends.
        """
        return self._between(x, self.y, self.dy_dx)

    def _between(self, x: ArrayLike, values: Floats, slopes: Floats) -> Floats:
        from scipy.interpolate import CubicHermiteSpline

        at = on_the_wire("x", x, self.x)
        found: Floats = CubicHermiteSpline(self.x, values, slopes)(at)
        return found


@dataclass(frozen=True)
class Settlement:
    """How a line came to where it hangs under conditions.

    before : as it was hung
    conditions : or None of a script's own effects
    moved : [m and 1], shape (all coordinates,), since then
    springs : [N], shape (all coordinates,), what springs to the ground pull more since then
    """

    before: Shape
    conditions: Conditions | None
    moved: Floats
    springs: Floats


@changed_by_copy
@dataclass(frozen=True)
class Shape:
    """A catenary with its dropper lengths, in static equilibrium on one mesh.

    wires : contact wires (the right one first), messenger wire, stitch wires, as in the mesh
    dropper_forces : [N], shape (droppers,)
    installed_lengths : [m], shape (droppers,), of the loaded droppers
    has_effect : whether something was added to the system, see :meth:`with_effect`
    settlement : of a line under conditions, what brought it there
    """

    catenary: Catenary
    mesh_settings: MeshSettings
    mesh: Mesh
    installation: Installation
    wires: tuple[HangingWire, ...]
    dropper_forces: Floats
    installed_lengths: Floats
    has_effect: bool = field(default=False, kw_only=True)
    settlement: Settlement | None = field(default=None, kw_only=True)

    @cached_property
    def system(self) -> System:
        """The assembled line, from which every engine starts."""
        return assemble(self.catenary, self.mesh, self.installation)

    def with_effect(self, effect: Callable[[System], System]) -> Shape:
        """The same line with something more in its system: a spring, a load, other properties of an element.

        Statics, modes and runs of every engine see it. The shape itself stays as it was installed: what the
        effect does to the line at rest, they find by themselves.
        """
        changed = replace(self, has_effect=True)
        changed.__dict__["system"] = effect(self.system)
        return changed

    @property
    def contact_wires(self) -> tuple[HangingWire, ...]:
        """One contact wire, or the right and the left one."""
        return self.wires[: self.mesh.contact_wires]

    @property
    def messenger_wire(self) -> HangingWire:
        """The messenger wire; one of no nodes without it."""
        if self.mesh.messenger is None:
            return HangingWire(*np.zeros((5, 0)))
        return self.wires[self.mesh.contact_wires]

    @property
    def stitch_wires(self) -> tuple[HangingWire, ...]:
        """The stitch wires, none without them."""
        return self.wires[self.mesh.first_stitch :]

    @property
    def contact_wire_x(self) -> Floats:
        """[m], shape (nodes,), of the (right) contact wire."""
        return self.wires[0].x

    @property
    def contact_wire_z(self) -> Floats:
        """[m], shape (nodes,), of the (right) contact wire."""
        return self.wires[0].z

    @property
    def messenger_wire_x(self) -> Floats:
        """[m], shape (nodes,)."""
        return self.messenger_wire.x

    @property
    def messenger_wire_z(self) -> Floats:
        """[m], shape (nodes,)."""
        return self.messenger_wire.z

    @property
    def height_errors(self) -> Floats:
        """[m], shape (droppers,): height of the contact wire above its design height at each dropper."""
        heights = np.concatenate([wire.z for wire in self.wires])
        errors: Floats = heights[self.mesh.nodes(self.mesh.lower)] - self.catenary.design_heights
        return errors

    @property
    def lengths_note(self) -> str:
        """Which dropper lengths the line hangs with, and what they make of its design heights."""
        given, changes = self.catenary.gives_dropper_lengths, changes_in_words(self.catenary)
        if not given and not changes:
            return "hung with the dropper lengths of its design"
        errors = 1e3 * self.height_errors if self.height_errors.size else np.zeros(1)
        lengths = (
            f"{self.dropper_lengths.size} dropper lengths that the layout gives"
            if given
            else ("dropper lengths of its design")
        )
        return (
            f"hung with the {lengths}{f', {changes}' if changes else ''}: at the droppers the contact wire"
            f" lies {errors.min():+.1f} to {errors.max():+.1f} mm from its design height"
        )

    def contact_wire_height(self, x: ArrayLike) -> Floats:
        """[m] of the (right) contact wire at positions x [m] along the line, any shape.

        Raises InputError beyond the line's ends.
        """
        return self.wires[0].height(x)

    @property
    def dropper_lengths(self) -> Floats:
        """[m], shape (droppers,), stress-free."""
        return self.installation.dropper_lengths

    @property
    def steady_arm_forces(self) -> Floats:
        """[N], shape (spans + 1,), upward on all contact wires; 0 where there is no arm."""
        forces: Floats = self.installation.arm_forces[:, :, -1].sum(axis=0)
        return forces

    @property
    def steady_arm_lateral_forces(self) -> Floats:
        """[N], shape (spans + 1,), to the left on all contact wires; 0 in the plane."""
        forces = self.installation.arm_forces
        lateral: Floats = forces[:, :, 0].sum(axis=0) if forces.shape[2] > 1 else 0 * forces[0, :, 0]
        return lateral

    @property
    def support_forces(self) -> Floats:
        """[N], shape (spans + 1,), upward on the messenger wire."""
        return self.installation.support_forces[:, -1]

    def dropper_schedule(self) -> list[DropperRow]:
        """The table that a crew cuts and hangs the droppers by, one row a dropper."""
        return dropper_rows(self)

    def support_schedule(self) -> list[SupportRow]:
        """The table that a crew sets the supports by, one row a support: places, arms, forces, tensions."""
        return support_rows(self)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the static shape, heights exaggerated. See :func:`catenary_fe.views.plot_static_shape`."""
        from catenary_fe.views import plot_static_shape

        return plot_static_shape(self, ax=ax)
