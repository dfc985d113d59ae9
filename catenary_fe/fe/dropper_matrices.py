"""What droppers do in matrices: their elongation, and their stiffness against turning."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import dropper_damping
from catenary_fe.fe.model import Model

Floats = NDArray[np.float64]


def dropper_motion(model: Model, size: int) -> tuple[Any, Floats]:
    """Motion of each dropper's upper end from its lower one, and the dropper's direction.

    Sparse, shape (axes * droppers, size), the axes of a dropper together; and shape (droppers, axes).
    """
    from scipy.sparse import coo_matrix

    mesh = model.mesh
    lower, upper = mesh.nodes(mesh.lower), mesh.nodes(mesh.upper)
    shapes = model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    points = np.concatenate([q[:, : model.axes] for q in shapes])
    span = points[upper] - points[lower]
    axes = np.arange(model.axes)
    below, above = model.node_width * lower[:, None] + axes, model.node_width * upper[:, None] + axes
    rows = np.arange(lower.size * axes.size)
    columns = np.concatenate([below.ravel(), above.ravel()])
    values = np.repeat([-1.0, 1.0], rows.size)
    moved = coo_matrix((values, (np.tile(rows, 2), columns)), shape=(rows.size, size)).tocsr()
    return moved, span


def elongation(span: Floats) -> Any:
    """Elongation of the droppers from :func:`dropper_motion`."""
    from scipy.sparse import coo_matrix

    count, axes = span.shape
    direction = span / np.linalg.norm(span, axis=1, keepdims=True)
    place = np.repeat(np.arange(count), axes), np.arange(count * axes)
    return coo_matrix((direction.ravel(), place), shape=(count, count * axes)).tocsr()


def turning_stiffness(span: Floats, tension: Floats) -> Any:
    """Stiffness of the droppers against turning, for :func:`dropper_motion`: tension over length."""
    from scipy.sparse import block_diag, csr_matrix

    if not tension.size:
        return csr_matrix((0, 0))
    length = np.linalg.norm(span, axis=1)
    direction = span / length[:, None]
    turn = np.eye(span.shape[1]) - direction[:, :, None] * direction[:, None, :]
    return block_diag(list((tension / length)[:, None, None] * turn)).tocsr()


def taut_droppers(model: Model) -> tuple[Any, Any]:
    """Stiffness and damping matrix of all droppers as if they were taut, over all coordinates.

    In closed form, because Exudyn has no Jacobian for a connector with a force law of its own.
    """
    from scipy.sparse import diags

    moved, span = dropper_motion(model, model.mbs.systemData.ODE2Size())
    rows = elongation(span) @ moved
    stiffness = diags([d.stiffness for d in model.catenary.droppers]).tocsr()
    turning = moved.T @ turning_stiffness(span, model.dropper_forces()) @ moved
    damping = diags(dropper_damping(model.catenary)).tocsr()
    return rows.T @ stiffness @ rows + turning, rows.T @ damping @ rows
