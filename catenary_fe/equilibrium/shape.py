"""The static shape of an installed catenary."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.fe.mesh import Mesh, MeshSettings
from catenary_fe.fe.model import Installation
from catenary_fe.system import Catenary

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class DropperRow:
    """One line of the dropper schedule.

    span : number of the span, from 1
    position_m : from the span's first support
    length_m : stress-free, from clamp to clamp: what to cut
    installed_length_m : under its load
    force_N : tension
    contact_wire_height_error_mm : of the contact wire at this dropper, above its design height
    """

    span: int
    position_m: float
    length_m: float
    installed_length_m: float
    force_N: float  # noqa: N815 the unit's own letter
    contact_wire_height_error_mm: float

    def as_dict(self) -> dict[str, float]:
        """The row as plain numbers by column name."""
        return asdict(self)


@dataclass(frozen=True)
class Shape:
    """A catenary with its dropper lengths, in static equilibrium on one mesh.

    contact_wire_x, contact_wire_z, messenger_wire_x, messenger_wire_z : [m], shape (nodes,)
    contact_wire_dz_dx : shape (nodes,), inclination
    dropper_forces : [N], shape (droppers,)
    installed_lengths : [m], shape (droppers,), of the loaded droppers
    """

    catenary: Catenary
    mesh_settings: MeshSettings
    mesh: Mesh
    installation: Installation
    contact_wire_x: Floats
    contact_wire_z: Floats
    contact_wire_dz_dx: Floats
    messenger_wire_x: Floats
    messenger_wire_z: Floats
    dropper_forces: Floats
    installed_lengths: Floats

    @property
    def height_errors(self) -> Floats:
        """[m], shape (droppers,): height of the contact wire above its design height at each dropper."""
        errors: Floats = self.contact_wire_z[self.mesh.contact.droppers] - self.catenary.design_heights
        return errors

    def contact_wire_height(self, x: ArrayLike) -> Floats:
        """[m] of the contact wire at positions x [m] along the line, any shape; cubic inside the elements."""
        from scipy.interpolate import CubicHermiteSpline

        heights: Floats = CubicHermiteSpline(
            self.contact_wire_x, self.contact_wire_z, self.contact_wire_dz_dx
        )(np.asarray(x, dtype=float))
        return heights

    @property
    def dropper_lengths(self) -> Floats:
        """[m], shape (droppers,), stress-free."""
        return self.installation.dropper_lengths

    @property
    def steady_arm_forces(self) -> Floats:
        """[N], shape (spans + 1,), upward on the contact wire; 0 where there is no arm."""
        return self.installation.arm_forces

    @property
    def support_forces(self) -> Floats:
        """[N], shape (spans + 1,), upward on the messenger wire."""
        return self.installation.support_forces

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
            )
            for i, dropper in enumerate(self.catenary.droppers)
        ]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the static shape, heights exaggerated. See :func:`catenary_fe.views.plot_static_shape`."""
        from catenary_fe.views import plot_static_shape

        return plot_static_shape(self, ax=ax)
