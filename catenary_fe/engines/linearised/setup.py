"""What linearised runs of one catenary with one time step share: factorised once, used by all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.factor import csr_rows, factorise, packed_factor, packed_rows
from catenary_fe.engines.generalized_alpha import Scheme, make_scheme
from catenary_fe.engines.linearised.arrays import (
    Line,
    Operator,
    SteadyArmBars,
    StretchCoupling,
)
from catenary_fe.engines.linearised.columns import compliance_columns
from catenary_fe.engines.linearised.stretch import by_elements
from catenary_fe.engines.recorder import surfaces_of
from catenary_fe.engines.sections import Rows, parts_of
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.contact import BaseLine
from catenary_fe.fe.reduction import LinearModel
from catenary_fe.fe.spring import FIXED
from catenary_fe.fe.system import System

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_Each = TypeVar("_Each")


class Slices(NamedTuple, Generic[_Each]):
    """Of each section: its rows, droppers, links and gaps among those of the line."""

    rows: _Each
    droppers: _Each
    links: _Each
    gaps: _Each


@dataclass(frozen=True)
class Setup:
    """A linearised catenary, ready for steps.

    factor : of the step's matrix, as scipy has it
    static : factor of the stiffness
    nominal : [m], contact wire height
    base_line : what the bases of pantographs follow
    parts : where those of each section begin, shape (sections + 1,) each
    relays : whether a run can compute some of the sections alone
    """

    model: LinearModel
    scheme: Scheme
    line: Line
    factor: Any
    static: Any
    nominal: float
    base_line: BaseLine
    operator: Operator
    parts: Slices[Integers]
    relays: bool

    def load_at(self, signals: Floats) -> Floats:
        """[N], shape (size,): with the loads that vary in time at signals of shape (loads,)."""
        load: Floats = self.line.load + self.model.patterns @ signals
        return load

    @property
    def size(self) -> int:
        """Number of coordinates, filled up to a multiple of eight."""
        return self.model.size


def set_up(model: LinearModel, time: TimeSettings, system: System) -> Setup:
    """Factorise for a time step; most of the damping matrix follows the system's Rayleigh damping."""
    beta, nominal = system.beta, system.contact_wire_height
    scheme = make_scheme(time)
    model = _filled_up(model)
    starts = model.section_starts
    factor = factorise(model.mass + scheme.g * model.damping + scheme.b * model.stiffness)
    static = factorise(model.stiffness)
    rest = (model.damping - beta * model.stiffness).tocsr()
    rest.data[np.abs(rest.data) < 1e-12 * np.abs(model.damping.data).max(initial=0.0)] = 0.0
    rest.eliminate_zeros()
    of_elements, others = by_elements(model.stiffness, model.stretch.index, model.tensions[model.stretch.gap])
    line = _line(model, factor, of_elements)
    of_gaps = np.array([wire.section for wire in system.wires])[model.gaps.wire]
    return Setup(
        model=model,
        scheme=scheme,
        line=line,
        factor=factor,
        static=static,
        nominal=nominal,
        base_line=system.base_line,
        operator=Operator(
            factor=packed_factor(factor),
            stiffness=packed_rows(others),
            rest=packed_rows(rest),
            beta=beta,
        ),
        parts=Slices(
            rows=starts,
            droppers=parts_of(system.section[system.droppers.first], starts.size - 1),
            links=parts_of(system.section[system.arms.first], starts.size - 1),
            gaps=parts_of(of_gaps, starts.size - 1),
        ),
        relays=starts.size > 2 and not model.patterns.shape[1] and _widest(line) <= np.diff(starts).min(),
    )


def _widest(line: Line) -> int:
    each = line.contact_compliance, line.dropper_compliance, line.links.compliance
    return max(int(columns.value.shape[1]) for columns in each)


def _filled_up(model: LinearModel) -> LinearModel:
    """With idle coordinates at the end of each section, up to a multiple of eight."""
    from scipy.sparse import csr_matrix

    rows = Rows.of(model.section_starts)
    if rows.size == model.size:
        return model
    own = model.dropper_rows.tocsr()
    return replace(
        model,
        mass=rows.matrix(model.mass, 1.0),
        stiffness=rows.matrix(model.stiffness, 1.0),
        damping=rows.matrix(model.damping),
        imbalance=rows.spread(model.imbalance),
        patterns=rows.rows_of(model.patterns),
        dropper_rows=csr_matrix((own.data, rows.place[own.indices], own.indptr), (own.shape[0], rows.size)),
        contacts=tuple(
            replace(path, dof=rows.number(path.dof), across_dof=rows.number(path.across_dof))
            for path in model.contacts
        ),
        heights=rows.number(model.heights),
        tensions=rows.number(model.tensions),
        links=replace(model.links, index=rows.number(model.links.index)),
        stretch=replace(model.stretch, index=rows.number(model.stretch.index)),
        section_starts=rows.starts,
        vertical=(model.vertical[0], rows.number(model.vertical[1])),
    )


def _line(model: LinearModel, factor: Any, of_elements: Floats) -> Line:
    from scipy.sparse import csc_matrix

    contacts, starts = model.contacts, model.section_starts
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
        contact_compliance=compliance_columns(factor, units, starts),
        rows=csr_rows(model.dropper_rows),
        k=model.dropper_stiffness,
        d=model.dropper_damping,
        tension=model.dropper_tension,
        dropper_compliance=compliance_columns(factor, model.dropper_rows.T.tocsc(), starts),
        links=_links(model, factor),
        stretch=StretchCoupling(model.stretch.index, model.stretch.length, model.stretch.gap, of_elements),
        load=model.load,
        patterns=csr_rows(model.patterns),
        surfaces=surfaces_of(contacts),
        supports=np.concatenate([wire.dof[wire.supports, 0] for wire in contacts]),
        heights=model.heights,
        tensions=model.tensions,
    )


def _links(model: LinearModel, factor: Any) -> SteadyArmBars:
    from scipy.sparse import csc_matrix

    links = model.links
    at = links.index.ravel()
    units = csc_matrix((np.ones(at.size), (at, np.arange(at.size))), shape=(model.size, at.size))
    compliance = compliance_columns(factor, units, model.section_starts)
    return SteadyArmBars(links.index, links.span, links.length, links.stiffness, compliance)
