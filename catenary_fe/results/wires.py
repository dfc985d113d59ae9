"""Curves along a line: the whole wires of a run over time, and the elasticity of the contact wire."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.parameters import changed_by_copy

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
_SUFFIX = "_height"
_SECTION = re.compile(r"section (\d+) ")


@changed_by_copy
@dataclass(frozen=True)
class WireHistory:
    """One wire's shapes.

    name : in words, such as "contact wire"
    x : [m], shape (points,), along the line
    static : [m], shape (points,), height before the run
    height : [m], shape (times, points), above the rail
    time : [s], shape (times,)
    """

    name: str
    x: Floats
    static: Floats
    height: Floats
    time: Floats

    @property
    def touched(self) -> bool:
        """Whether pantographs run along it: a contact wire."""
        return self.name.endswith("contact wire")

    @property
    def section(self) -> int:
        """Number of its tension section, from 1."""
        found = _SECTION.match(self.name)
        return int(found[1]) if found else 1

    @property
    def uplift(self) -> Floats:
        """[m], shape (times, points), above the static height."""
        return self.height - self.static

    @property
    def velocity(self) -> Floats:
        """[m/s], shape (times, points), upwards, by central differences."""
        velocity: Floats = np.gradient(self.height, self.time, axis=0)
        return velocity


def wire_histories(data: xr.Dataset) -> tuple[WireHistory, ...]:
    """All wires that a run stored: contact wires first, in the order of the sections, the right one first.

    The order of a file's variables does not matter.

    Raises InputError where the run stored none.
    """
    names = [str(n) for n in data.data_vars if str(n).endswith(_SUFFIX) and data[n].dims[0] == "wire_time"]
    if not names or data.sizes["wire_time"] < 2:
        raise InputError(
            "the run holds no wire shapes; run again with --store-wire-ms 10 (store_wire=0.01 in Python)"
        )
    wires = [_history(data, name) for name in names]
    return tuple(sorted(wires, key=lambda wire: (not wire.touched, wire.section, "left" in wire.name)))


def _history(data: xr.Dataset, variable: str) -> WireHistory:
    place = str(data[variable].dims[1])
    return WireHistory(
        name=variable.removesuffix(_SUFFIX).replace("_", " "),
        x=np.asarray(data[place].values),
        static=np.asarray(data[f"static_{variable}"].values, dtype=float),
        height=np.asarray(data[variable].values, dtype=float),
        time=np.asarray(data["wire_time"].values),
    )


def contact_wires(wires: Sequence[WireHistory]) -> list[WireHistory]:
    """Those that pantographs run along."""
    return [wire for wire in wires if wire.touched]


@changed_by_copy
@dataclass(frozen=True)
class Elasticity:
    """Uplift under a static force, point by point along the line.

    position : [m], shape (points,), along the line
    uplift : [m], shape (points,), under the force
    force : [N] upward
    support_position : [m] of the supports in the range, for the picture
    """

    position: Floats
    uplift: Floats
    force: float
    support_position: Floats

    @property
    def values(self) -> Floats:
        """[m/N], shape (points,): uplift over force."""
        return self.uplift / self.force

    @property
    def non_uniformity(self) -> float:
        """(e_max − e_min)/(e_max + e_min) over the range."""
        e = self.values
        return float((e.max() - e.min()) / (e.max() + e.min()))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curve. See :func:`catenary_fe.views.plot_elasticity`."""
        from catenary_fe.views import plot_elasticity

        return plot_elasticity(self, ax=ax)
