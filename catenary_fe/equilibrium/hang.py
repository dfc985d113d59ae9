"""Hang a line as its layout asks: with the dropper lengths that it gives, or with those of its design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium import form
from catenary_fe.equilibrium.shape import Shape
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.system import Catenary
from catenary_fe.system.arguments import checked
from catenary_fe.system.catenary_rules import check_lengths


@checked
def find_form(catenary: Catenary, mesh: MeshSettings | None = None) -> Shape:
    """The static shape of a line; where its droppers have no lengths, with those that its design takes.

    Without lengths, the droppers get those with which the contact wire has its design height at each of
    them. A line whose droppers all have a length is hung with these, and the contact wire lies where they let
    it (``shape.height_errors``); its design is found of ``catenary.without_dropper_lengths()``.

    mesh : element lengths; a shape belongs to its mesh

    Raises InputError where only some droppers have a length, for impossible lengths, and for a design in
    which a dropper or a steady arm would have to push or has no room; SolverError where no equilibrium is
    found or the heights of a design are off by more than 0.1 mm.
    """
    check_lengths(catenary)
    if catenary.gives_dropper_lengths:
        return form.find_heights(catenary, None, mesh)
    return form.find_form(catenary, mesh)


@checked
def find_heights(
    catenary: Catenary,
    lengths: Sequence[float] | NDArray[np.float64] | None = None,
    mesh: MeshSettings | None = None,
) -> Shape:
    """The reverse of form finding: the static shape that given dropper lengths result in.

    The shape's catenary has these lengths, so that a run on it records them.

    lengths : [m], shape (droppers,), stress-free; unset: those that the layout gives
    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for missing or impossible lengths, SolverError where no equilibrium is found.
    """
    shape = form.find_heights(catenary, lengths, mesh)
    return replace(shape, catenary=catenary.with_dropper_lengths(shape.dropper_lengths))
