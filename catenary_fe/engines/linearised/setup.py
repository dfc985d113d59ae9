"""What linearised runs of one catenary with one time step share: factorised once, used by all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.factor import csr_rows, factorise, packed_rows
from catenary_fe.engines.generalized_alpha import Scheme, make_scheme
from catenary_fe.engines.linearised.arrays import (
    ComplianceColumns,
    Line,
    Operator,
    SteadyArmBars,
    StretchCoupling,
)
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.contact import BaseLine
from catenary_fe.fe.reduction import LinearModel
from catenary_fe.fe.spring import FIXED
from catenary_fe.fe.system import System

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
    base_line : what the bases of pantographs follow
    """

    model: LinearModel
    scheme: Scheme
    line: Line
    factor: Any
    static: Any
    nominal: float
    base_line: BaseLine
    beta: float
    stiffness: Any
    rest: Any

    def load_at(self, signals: Floats) -> Floats:
        """[N], shape (size,): with the loads that vary in time at signals of shape (loads,)."""
        load: Floats = self.line.load + signals @ self.line.patterns
        return load

    @property
    def size(self) -> int:
        """Number of coordinates, filled up to a multiple of four."""
        return int(self.stiffness.shape[0])

    @cached_property
    def for_one_slot(self) -> Operator:
        """The factors in the form that suits one run."""
        return _operator(self, packed_rows)

    @cached_property
    def for_eight_slots(self) -> Operator:
        """The factors in the form that suits a batch."""
        return _operator(self, csr_rows)


def set_up(model: LinearModel, time: TimeSettings, system: System) -> Setup:
    """Factorise for a time step; most of the damping matrix follows the system's Rayleigh damping."""
    beta, nominal = system.beta, system.contact_wire_height
    scheme = make_scheme(time)
    model = _filled_up(model)
    factor = factorise(model.mass + scheme.g * model.damping + scheme.b * model.stiffness)
    static = factorise(model.stiffness)
    K = model.stiffness.tocsr()
    rest = (model.damping - beta * K).tocsr()
    rest.data[np.abs(rest.data) < 1e-12 * np.abs(model.damping.data).max(initial=0.0)] = 0.0
    rest.eliminate_zeros()
    return Setup(
        model, scheme, _line(model, factor), factor, static, nominal, system.base_line, beta, K, rest
    )


def _operator(setup: Setup, form: Callable[..., Any]) -> Operator:
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
        imbalance=np.append(model.imbalance, np.zeros(more)),
        patterns=np.hstack([model.patterns, np.zeros((len(model.patterns), more))]),
        dropper_rows=hstack([model.dropper_rows, csr_matrix((model.dropper_rows.shape[0], more))]).tocsr(),
    )


def _line(model: LinearModel, factor: Any) -> Line:
    from scipy.sparse import csc_matrix

    contacts = model.contacts
    at = np.concatenate([wire.dof for wire in contacts])
    free = np.unique(at[at != FIXED])
    column = np.full(at.shape, FIXED, dtype=np.int64)
    column[at != FIXED] = np.searchsorted(free, at[at != FIXED])
    units = csc_matrix((np.ones(free.size), (free, np.arange(free.size))), shape=(model.size, free.size))
    return Line(
        first=np.cumsum([0, *(wire.x.size for wire in contacts)]),
        x=np.concatenate([wire.x for wire in contacts]),
        lengths=np.concatenate([[*wire.lengths, 1.0] for wire in contacts]),
        profile=np.concatenate([wire.profile for wire in contacts]),
        lateral=np.concatenate([wire.lateral for wire in contacts]),
        at=at,
        across=np.concatenate([wire.across_dof for wire in contacts]),
        column=column,
        contact_compliance=_columns(factor, units),
        rows=csr_rows(model.dropper_rows),
        k=model.dropper_stiffness,
        d=model.dropper_damping,
        tension=model.dropper_tension,
        dropper_compliance=_columns(factor, model.dropper_rows.T.tocsc()),
        links=_links(model, factor),
        stretch=StretchCoupling(model.stretch.index, model.stretch.length, model.stretch.gap),
        load=model.load,
        patterns=model.patterns,
        supports=np.concatenate([wire.dof[wire.supports, 0] for wire in contacts]),
        heights=model.heights,
        tensions=model.tensions,
    )


def _links(model: LinearModel, factor: Any) -> SteadyArmBars:
    from scipy.sparse import csc_matrix

    links = model.links
    at = links.index.ravel()
    units = csc_matrix((np.ones(at.size), (at, np.arange(at.size))), shape=(model.size, at.size))
    return SteadyArmBars(links.index, links.span, links.length, links.stiffness, _columns(factor, units))


def _columns(factor: Any, right: Any) -> ComplianceColumns:
    """Columns of the inverse times ``right``, many at once: in one step a force is felt nearby only."""
    size, count = right.shape
    if not count:
        return ComplianceColumns(np.zeros(0, dtype=np.int64), np.zeros((0, 1)))
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
    return ComplianceColumns(first, np.where((inside >= 0) & (inside < spacing), value, 0.0))


def _combed(factor: Any, right: Any, middle: Integers, spacing: int) -> tuple[Integers, Floats]:
    """First rows of the columns' windows, and what is in them, shape (columns, spacing).

    ComplianceColumns at least this far apart are solved for in one go.
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
