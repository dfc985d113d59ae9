"""What linearised runs of one catenary with one time step share: factorised once, used by all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.linearised.arrays import Bowed, Columns, Line, Links, Operator, Quads, Rows, Scheme
from catenary_fe.fe.linear_model import LinearModel
from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.fe.spring import FIXED

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

NEGLIGIBLE = 1e-6  # of a column's largest entry
_SPACING = 640  # rows between columns that are found together, at first


@dataclass(frozen=True)
class Setup:
    """A linearised catenary, ready for steps.

    factor : of the step's matrix, as scipy has it
    static : factor of the stiffness
    nominal : [m], contact wire height
    """

    model: LinearModel
    scheme: Scheme
    line: Line
    factor: Any
    static: Any
    nominal: float
    beta: float
    stiffness: Any
    rest: Any

    @property
    def size(self) -> int:
        """Number of coordinates, filled up to a multiple of four."""
        return int(self.stiffness.shape[0])


def make_scheme(time: TimeSettings) -> Scheme:
    """Coefficients of the generalised-α method that Exudyn uses.

    With a the method's own accelerations, (1 - αm) a' + αm a = (1 - αf) x' + αf x; c is the part of a' that
    does not come from x'.
    """
    h, rho = time.step, time.spectral_radius
    am, af = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 - am + af
    beta = (gamma + 0.5) ** 2 / 4
    s = (1 - af) / (1 - am)
    b, g = h * h * beta * s, h * gamma * s
    cx, cc = (af - am * s) / (1 - am), -am / (1 - am)
    return Scheme(
        h=h,
        b=b,
        g=g,
        qx=b + h * g + h * h * ((0.5 - beta) * s + beta * cx),
        qc=h * h * (0.5 - beta + beta * cc),
        vx=g + h * ((1 - gamma) * s + gamma * cx),
        vc=h * (1 - gamma + gamma * cc),
        cx=cx,
        cc=cc,
    )


def set_up(model: LinearModel, time: TimeSettings, beta: float, nominal: float) -> Setup:
    """Factorise for a time step.

    beta : [s] of the Rayleigh damping, which most of the damping matrix follows
    nominal : [m] contact wire height
    """
    scheme = make_scheme(time)
    model = _filled_up(model)
    factor = factorise(model.mass + scheme.g * model.damping + scheme.b * model.stiffness)
    static = factorise(model.stiffness)
    K = model.stiffness.tocsr()
    rest = (model.damping - beta * K).tocsr()
    rest.data[np.abs(rest.data) < 1e-12 * np.abs(model.damping.data).max(initial=0.0)] = 0.0
    rest.eliminate_zeros()
    return Setup(model, scheme, _line(model, factor), factor, static, nominal, beta, K, rest)


def make_operator(setup: Setup, lanes: int) -> Operator:
    """The factors in the form that suits one lane or eight."""
    form = quads if lanes == 1 else _rows
    return Operator(
        lower=form(setup.factor.L, "lower"),
        upper=form(setup.factor.L.T, "upper"),
        inverse=1 / setup.factor.U.diagonal(),
        stiffness=form(setup.stiffness),
        rest=form(setup.rest),
        beta=setup.beta,
    )


def _filled_up(model: LinearModel) -> LinearModel:
    """With idle coordinates at the end, up to a multiple of four."""
    from scipy.sparse import block_diag, csr_matrix, hstack, identity

    more = -model.size % 4
    if not more:
        return model
    mass, stiffness = (block_diag([A, identity(more)]).tocsr() for A in (model.mass, model.stiffness))
    return replace(
        model,
        mass=mass,
        stiffness=stiffness,
        damping=block_diag([model.damping, csr_matrix((more, more))]).tocsr(),
        dropper_rows=hstack([model.dropper_rows, csr_matrix((model.dropper_rows.shape[0], more))]).tocsr(),
    )


def factorise(matrix: Any) -> Any:
    """Without pivoting: symmetric and quasi-definite, and in the order of the stations L is narrow."""
    from scipy.sparse.linalg import splu

    factor = splu(
        matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    assert np.array_equal(factor.perm_r, np.arange(matrix.shape[0]))
    return factor


def _entries(matrix: Any, triangle: str) -> tuple[Integers, Integers, Floats]:
    """Rows, columns, values by rows, the columns in the order in which a solve comes to them."""
    coo = matrix.tocoo()
    row, column, value = coo.row.astype(np.int64), coo.col.astype(np.int64), coo.data
    if triangle:
        keep = row != column
        row, column, value = row[keep], column[keep], value[keep]
    order = np.lexsort((-column if triangle == "upper" else column, row))
    return row[order], column[order], value[order]


def _rows(matrix: Any, triangle: str = "") -> Rows:
    row, column, value = _entries(matrix, triangle)
    start = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=matrix.shape[0]))])
    return Rows(start.astype(np.uint32), column.astype(np.uint32), np.ascontiguousarray(value))


def quads(matrix: Any, triangle: str = "") -> Quads:
    size = matrix.shape[0]
    assert size % 4 == 0
    row, column, value = _entries(matrix, triangle)
    inner = np.zeros((size // 4, 6))
    if triangle:
        place = {(1, 0): 0, (2, 0): 1, (2, 1): 2, (3, 0): 3, (3, 1): 4, (3, 2): 5}
        if triangle == "upper":
            place = {(0, 1): 0, (0, 2): 1, (0, 3): 2, (1, 2): 3, (1, 3): 4, (2, 3): 5}
        table = np.full((4, 4), -1)
        for (r, c), k in place.items():
            table[r, c] = k
        same = row // 4 == column // 4
        inner[row[same] // 4, table[row[same] % 4, column[same] % 4]] = value[same]
        row, column, value = row[~same], column[~same], value[~same]
    sign = -1 if triangle == "upper" else 1
    key, entry = np.unique(row // 4 * size + sign * column % size, return_inverse=True)
    values = np.zeros((key.size, 4))
    values[entry, row % 4] = value
    start = np.concatenate([[0], np.cumsum(np.bincount(key // size, minlength=size // 4))])
    index = sign * (key % size) % size
    return Quads(start.astype(np.uint32), index.astype(np.uint32), values, inner)


def _line(model: LinearModel, factor: Any) -> Line:
    from scipy.sparse import csc_matrix

    contacts = model.contacts
    at = np.concatenate([wire.index for wire in contacts])
    free = np.unique(at[at != FIXED])
    column = np.full(at.shape, FIXED, dtype=np.int64)
    column[at != FIXED] = np.searchsorted(free, at[at != FIXED])
    units = csc_matrix((np.ones(free.size), (free, np.arange(free.size))), shape=(model.size, free.size))
    return Line(
        first=np.cumsum([0, *(wire.x.size for wire in contacts)]),
        x=np.concatenate([wire.x for wire in contacts]),
        lengths=np.concatenate([[*wire.lengths, 1.0] for wire in contacts]),
        static=np.concatenate([wire.static for wire in contacts]),
        lateral=np.concatenate([wire.lateral for wire in contacts]),
        at=at,
        column=column,
        give=_columns(factor, units),
        rows=_rows(model.dropper_rows),
        k=model.dropper_stiffness,
        d=model.dropper_damping,
        tension=model.dropper_tension,
        yielding=_columns(factor, model.dropper_rows.T.tocsc()),
        links=_links(model, factor),
        bows=Bowed(model.bows.index, model.bows.length, model.bows.gap),
        load=model.load,
        supports=np.concatenate([wire.supports for wire in contacts]),
        heights=model.heights,
        tensions=model.tensions,
    )


def _links(model: LinearModel, factor: Any) -> Links:
    from scipy.sparse import csc_matrix

    links = model.links
    at = links.index.ravel()
    units = csc_matrix((np.ones(at.size), (at, np.arange(at.size))), shape=(model.size, at.size))
    return Links(links.index, links.span, links.length, links.stiffness, _columns(factor, units))


def _columns(factor: Any, right: Any) -> Columns:
    """Columns of the inverse times ``right``, many at once: in one step a force is felt nearby only."""
    size, count = right.shape
    if not count:
        return Columns(np.zeros(0, dtype=np.int64), np.zeros((0, 1)))
    owner = np.repeat(np.arange(count), np.diff(right.indptr))
    middle = (np.bincount(owner, right.indices) / np.bincount(owner)).astype(np.int64)
    spacing = _SPACING
    while True:
        low, values = _combed(factor, right, middle, spacing)
        large = np.abs(values) > NEGLIGIBLE * np.abs(values).max(axis=1, keepdims=True)
        if spacing > 2 * size or not (large[:, 0] | large[:, -1]).any():
            break
        spacing *= 2  # neighbours overlap
    begin, end = large.argmax(axis=1), spacing - large[:, ::-1].argmax(axis=1)
    width = int((end - begin).max())
    # all are as wide as the widest: the room to spare, to both sides
    first = np.clip(low + (begin + end - width) // 2, 0, size - width)
    inside = first[:, None] + np.arange(width) - low[:, None]
    value = np.take_along_axis(values, np.clip(inside, 0, spacing - 1), axis=1)
    return Columns(first, np.where((inside >= 0) & (inside < spacing), value, 0.0))


def _combed(factor: Any, right: Any, middle: Integers, spacing: int) -> tuple[Integers, Floats]:
    """First rows of the columns' windows, and what is in them, shape (columns, spacing).

    Columns at least this far apart are solved for in one go.
    """
    size, count = right.shape
    order = np.argsort(middle, kind="stable")
    values = np.empty((count, spacing))
    low = middle - spacing // 2
    around = np.zeros(size + 2 * spacing)
    left = np.ones(count, dtype=bool)
    while left.any():
        chosen, last = [], -spacing
        for i in order[left[order]].tolist():
            if middle[i] >= last + spacing:
                chosen.append(i)
                last = middle[i]
        left[chosen] = False
        which = np.zeros(count)
        which[chosen] = 1.0
        around[spacing : spacing + size] = factor.solve(right @ which)
        values[chosen] = around[spacing + low[chosen, None] + np.arange(spacing)]
    return low, values
