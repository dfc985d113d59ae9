"""The static shape of an installed catenary."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.fe.installation import Installation
from catenary_fe.fe.mesh import Mesh, MeshSettings
from catenary_fe.system import Catenary
from catenary_fe.system.arguments import on_the_wire
from catenary_fe.system.frozen import changed_by_copy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class DropperRow:
    """One line of the dropper schedule.

    span : number of the span, from 1
    position_m : from the span's first support
    length_m : stress-free, from clamp to clamp: what to cut
    installed_length_m : under its load
    force_N : tension
    contact_wire_height_error_mm : of the contact wire at this dropper, above its design height
    hangs_on : "messenger wire" or "stitch wire", on a line that has both
    contact_wire : number of the contact wire that it holds, of two: 1 is the right one
    """

    span: int
    position_m: float
    length_m: float
    installed_length_m: float
    force_N: float  # noqa: N815 the unit's own letter
    contact_wire_height_error_mm: float
    hangs_on: str | None = None
    contact_wire: int | None = None

    def as_dict(self) -> dict[str, float | str]:
        """The row by column name; what the line leaves no choice in is left out."""
        return {name: value for name, value in asdict(self).items() if value is not None}


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


@changed_by_copy
@dataclass(frozen=True)
class Shape:
    """A catenary with its dropper lengths, in static equilibrium on one mesh.

    wires : contact wires (the right one first), messenger wire, stitch wires, as in the mesh
    dropper_forces : [N], shape (droppers,)
    installed_lengths : [m], shape (droppers,), of the loaded droppers
    """

    catenary: Catenary
    mesh_settings: MeshSettings
    mesh: Mesh
    installation: Installation
    wires: tuple[HangingWire, ...]
    dropper_forces: Floats
    installed_lengths: Floats

    @property
    def contact_wires(self) -> tuple[HangingWire, ...]:
        """One contact wire, or the right and the left one."""
        return self.wires[: self.mesh.contact_wires]

    @property
    def messenger_wire(self) -> HangingWire:
        """The messenger wire."""
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
        if not self.catenary.gives_dropper_lengths:
            return "hung with the dropper lengths of its design"
        low, high = 1e3 * self.height_errors.min(), 1e3 * self.height_errors.max()
        return (
            f"hung with the {self.dropper_lengths.size} dropper lengths that the layout gives: at the"
            f" droppers the contact wire lies {low:+.1f} to {high:+.1f} mm from its design height"
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
        """The table that a crew needs, one row a dropper."""
        return [
            DropperRow(
                span=int(self.catenary.dropper_spans[i]),
                position_m=dropper.position,
                length_m=float(self.dropper_lengths[i]),
                installed_length_m=float(self.installed_lengths[i]),
                force_N=float(self.dropper_forces[i]),
                contact_wire_height_error_mm=1e3 * float(self.height_errors[i]),
                hangs_on=self._hangs_on(i),
                contact_wire=int(self.mesh.lower.wire[i]) + 1 if self.mesh.contact_wires > 1 else None,
            )
            for i, dropper in enumerate(self.catenary.droppers)
        ]

    def _hangs_on(self, dropper: int) -> str | None:
        if not self.stitch_wires:
            return None
        on_stitch = self.mesh.upper.wire[dropper] >= self.mesh.first_stitch
        return "stitch wire" if on_stitch else "messenger wire"

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the static shape, heights exaggerated. See :func:`catenary_fe.views.plot_static_shape`."""
        from catenary_fe.views import plot_static_shape

        return plot_static_shape(self, ax=ax)
