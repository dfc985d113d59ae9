"""A catenary's small motions about its static state, as sparse matrices of few coordinates.

What a wire does along the track matters through its tension only, which is even between two clamps up to
hundreds of hertz. So the coordinates along the track are kept at clamps and supports alone; between them the
wire is a spring whose tension is a coordinate of its own, and the matrices stay narrow:

    K_b q + G t = f      G_e the change of a gap's length with the coordinates q
    Gᵀ q − t / k = 0     t its tension, k its stiffness

Two terms of second order are kept beside the matrices, since a tension that changes by a per cent changes how
the wire moves by as much: inclinations lengthen a gap, and its change of tension works on inclined elements.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import scattered, tangent_blocks
from catenary_fe.fe.contact import ContactPath
from catenary_fe.fe.spring import FIXED
from catenary_fe.fe.system import System

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

ALONG = 0


@dataclass(frozen=True)
class SteadyArmBars:
    """Steady arms that are links: the wire on one swings on a circle, of which the matrices know the tangent.

    index : shape (links, 2), numbers of the coordinates to the left and up
    span : [m], shape (links, 2), likewise from the wire to the pivot, at rest
    length : [m], shape (links,), without force
    stiffness : [N/m], shape (links,)
    """

    index: Integers
    span: Floats
    length: Floats
    stiffness: Floats


@dataclass(frozen=True)
class StretchCoupling:
    """Elements seen along one axis across the track, of which each has one or two.

    index : shape (elements, 4), numbers of place and slope at the first node, then at the second, or FIXED
    length : [m], shape (elements,)
    gap : shape (elements,), number of the element's gap in ``tensions``
    """

    index: Integers
    length: Floats
    gap: Integers


@dataclass(frozen=True)
class Gaps:
    """Lengths of wire between two clamps, over which the tension is even.

    wire : shape (gaps,), number of the wire in the mesh
    ends : [m], shape (gaps, 2), along the line
    tension : [N], shape (gaps,), nominal
    """

    wire: Integers
    ends: Floats
    tension: Floats


@dataclass(frozen=True)
class LinearModel:
    """M q̈ + D q̇ + K q = f with all droppers taut; coordinates by section, in the order of their stations.

    mass, stiffness, damping : sparse, symmetric, shape (size, size)
    dropper_rows : sparse, shape (droppers, size), elongation of each dropper
    dropper_stiffness, dropper_damping : [N/m], [N s/m], shape (droppers,)
    dropper_tension : [N], shape (droppers,), at rest; below 0 for those that are slack there: what they would
        push with if they could
    contacts : the contact wires
    heights : shape (nodes of all wires,), numbers of the coordinates up, or FIXED
    tensions : shape (gaps,), numbers of the coordinates that are tensions [N]
    links : steady arms that swing
    stretch : elements whose inclination lengthens a gap
    gaps : where these tensions are
    imbalance : [N], shape (size,), what the line is out of balance where it was installed
    patterns : [N], sparse, shape (size, loads), of loads that vary in time
    section_starts : shape (sections + 1,), where the coordinates of each tension section begin
    vertical : numbers of all heights and vertical slopes: among all coordinates of the line, and among these
    spatial : whether it has coordinates across the track
    """

    mass: Any
    stiffness: Any
    damping: Any
    dropper_rows: Any
    dropper_stiffness: Floats
    dropper_damping: Floats
    dropper_tension: Floats
    contacts: tuple[ContactPath, ...]
    heights: Integers
    tensions: Integers
    gaps: Gaps
    links: SteadyArmBars
    stretch: StretchCoupling
    imbalance: Floats
    patterns: Any
    section_starts: Integers
    vertical: tuple[Integers, Integers]
    spatial: bool

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.mass.shape[0])

    @property
    def load(self) -> Floats:
        """[N], shape (size,), constant: what is out of balance, and that slack droppers do not push."""
        load: Floats = self.imbalance - self.dropper_rows.T @ np.minimum(self.dropper_tension, 0.0)
        return load


def linear_model(system: System) -> LinearModel:
    """The line linearised where it was installed."""
    wires = _reduced_wires(system)
    whole = system.dof.size
    T, place, starts = _kept(system, wires)
    own, size = T[:whole], T.shape[1]
    M, K = _wire_matrices(wires, place, whole, size)
    droppers, rows = system.droppers, (system.elongations() @ own).tocsr()
    span = droppers.span(system.reference)
    pull, push = droppers.tension(span), droppers.stiffness * (np.linalg.norm(span, axis=1) - droppers.length)
    D = system.alpha * M + system.beta * K + rows.T @ _diagonal(droppers.damping) @ rows
    D = D + _moved(_diagonal(system.ground_damping) + system.linear_damping, place, size)
    K = K + _moved(system.spring_stiffness(), place, size)
    M = M + _moved(system.mass - system.wire_mass, place, size)
    M, K, D = (matrix.tocsr() for matrix in (M, K, D))
    for matrix in (M, K, D):
        matrix.eliminate_zeros()
    vertical = np.concatenate([system.heights, system.heights + system.axes])
    return LinearModel(
        mass=M,
        stiffness=K,
        damping=D,
        dropper_rows=rows,
        dropper_stiffness=droppers.stiffness,
        dropper_damping=droppers.damping,
        dropper_tension=np.where(pull > 0, pull, np.minimum(push, 0.0)),
        contacts=tuple(
            replace(path, dof=place[path.index], across_dof=place[path.across])
            for path in system.contact_paths
        ),
        heights=place[system.heights],
        tensions=place[whole:],
        gaps=_gaps(wires),
        links=_swinging_links(system, place),
        stretch=_stretch_coupling(system, wires, place),
        imbalance=own.T @ system.out_of_balance(np.zeros(whole)),
        patterns=(own.T @ system.time_patterns).tocsr(),
        section_starts=starts,
        vertical=(vertical, place[vertical]),
        spatial=system.spatial,
    )


def _gaps(wires: list[_ReducedWire]) -> Gaps:
    return Gaps(
        wire=np.repeat([wire.number for wire in wires], [wire.tension.size for wire in wires]),
        ends=np.concatenate([np.column_stack([wire.gap_x[:-1], wire.gap_x[1:]]) for wire in wires]),
        tension=np.concatenate([wire.tension for wire in wires]),
    )


def _stretch_coupling(system: System, wires: list[_ReducedWire], place: Integers) -> StretchCoupling:
    across = system.axes - 1
    index, length, gap, first = [], [], [], 0
    for wire in wires:
        for axis in range(across):
            index.append(place[wire.across[:, axis::across]])
            length.append(wire.lengths)
            gap.append(first + wire.gap_of)
        first += wire.gap_stiffness.size
    return StretchCoupling(np.concatenate(index), np.concatenate(length), np.concatenate(gap))


def _swinging_links(system: System, place: Integers) -> SteadyArmBars:
    """An arm that has swung along the track is seen from along it: shorter, and with what it pulls across."""
    arms, axes = system.arms, system.axes
    span = arms.span(system.reference)
    whole, seen = np.linalg.norm(span, axis=1), np.linalg.norm(span[:, -2:], axis=1)
    return SteadyArmBars(
        index=place[arms.first[:, None] + [axes - 2, axes - 1]],
        span=span[:, -2:],
        length=seen * (1 - arms.tension(span) / (arms.stiffness * whole)),
        stiffness=arms.stiffness,
    )


@dataclass(frozen=True)
class _ReducedWire:
    """Elements of a wire without the coordinates along the track.

    number : of the wire among those of the line
    across : shape (elements, m), numbers of their other coordinates
    lengths : [m], shape (elements,)
    stiffness, mass : shape (elements, m, m)
    lengthening : shape (elements, m), of an element with its other coordinates, its ends held along the track
    gap_of : shape (elements,)
    gap_ends : shape (gaps, 2), numbers of the coordinates along the track at the ends
    gap_stiffness, gap_mass : shape (gaps,)
    gap_x : [m], shape (gaps + 1,), stations of the gaps' ends
    tension : [N], shape (gaps,), nominal
    """

    number: int
    across: Integers
    lengths: Floats
    stiffness: Floats
    mass: Floats
    lengthening: Floats
    gap_of: Integers
    gap_ends: Integers
    gap_stiffness: Floats
    gap_mass: Floats
    gap_x: Floats
    tension: Floats


def _reduced_wires(system: System) -> list[_ReducedWire]:
    """Section by section."""
    rest = system.of_elements(system.reference)
    stiffness, mass = tangent_blocks(system.cables, rest), system.element_mass
    ends = np.cumsum([wire.tension.size for wire in system.wires])
    found = []
    for number in np.argsort([wire.section for wire in system.wires], kind="stable").tolist():
        wire = system.wires[number]
        part = slice(ends[number] - wire.tension.size, ends[number])
        reduced = _reduced(
            stiffness[part], mass[part], system.elements()[part], wire.clamps, wire.x, wire.tension
        )
        found.append(replace(reduced, number=number, lengths=system.cables.length[part]))
    return found


def _reduced(
    K: Floats, M: Floats, index: Integers, clamps: Integers, x: Floats, pull: Floats
) -> _ReducedWire:
    """Condense slopes along the track in each element, and positions along the track between clamps.

    K, M, index : of a wire's elements and their coordinates
    clamps, x, pull : nodes, [m] stations, [N] nominal along the track
    """
    width = index.shape[1] // 2
    ends = np.array([ALONG, width + ALONG])
    slopes = ends + width // 2
    across = np.setdiff1d(np.arange(2 * width), [*ends, *slopes])
    kept = np.concatenate([ends, across])
    inner = np.linalg.solve(K[:, slopes[:, None], slopes], K[:, slopes[:, None], kept])
    K = K[:, kept[:, None], kept] - K[:, kept[:, None], slopes] @ inner
    k = (K[:, 0, 0] - K[:, 0, 1]) / 2
    lengthening = (K[:, 1, 2:] - K[:, 0, 2:]) / (2 * k[:, None])
    stiffness = K[:, 2:, 2:] - k[:, None, None] * lengthening[:, :, None] * lengthening[:, None, :]
    gap_of = np.searchsorted(clamps, np.arange(len(M)), side="right") - 1
    element_mass = M[:, ends[:, None], ends].sum(axis=(1, 2))  # of a wire moved along the track
    first = index[0, 0] + width * clamps
    return _ReducedWire(
        number=0,
        across=index[:, across],
        lengths=np.zeros(len(M)),
        stiffness=stiffness,
        mass=M[:, across[:, None], across],
        lengthening=lengthening,
        gap_of=gap_of,
        gap_ends=np.column_stack([first[:-1], first[1:]]),
        gap_stiffness=1 / np.bincount(gap_of, 1 / k),
        gap_mass=np.bincount(gap_of, element_mass).astype(float),
        gap_x=x[clamps],
        tension=pull[clamps[:-1]],
    )


def _wire_matrices(wires: list[_ReducedWire], place: Integers, whole: int, size: int) -> tuple[Any, Any]:
    """Mass and stiffness of the wires over the coordinates that are kept, sparse."""
    mass, stiffness, first = [], [], whole
    for wire in wires:
        count = wire.gap_stiffness.size
        gaps = first + np.arange(count)
        first += count
        mass.append((wire.across, wire.mass))
        mass.append((wire.gap_ends, wire.gap_mass[:, None, None] * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6))
        of_tension = np.zeros((len(wire.across), 1 + wire.across.shape[1], 1 + wire.across.shape[1]))
        of_tension[:, 1:, 1:] = wire.stiffness
        of_tension[:, 0, 1:] = of_tension[:, 1:, 0] = wire.lengthening
        stiffness.append((np.column_stack([gaps[wire.gap_of], wire.across]), of_tension))
        of_gap = np.tile([[0.0, -1.0, 1.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], (count, 1, 1))
        of_gap[:, 0, 0] = -1 / wire.gap_stiffness
        stiffness.append((np.column_stack([gaps, wire.gap_ends]), of_gap))
    return scattered(mass, size, place), scattered(stiffness, size, place)


def _kept(system: System, wires: list[_ReducedWire]) -> tuple[Any, Integers, Integers]:
    """T with q = T x, x the coordinates that are kept, by section and station.

    Also the place of each q in x, or FIXED, and where the sections begin in x. A gap's tension comes just
    before the gap's end that is farther from where the wire is held along the track: so each pivot is one
    without exchanging rows.
    """
    from scipy.sparse import csr_matrix

    counts = [wire.tension.size for wire in wires]
    whole, gaps, width = system.dof.size, sum(counts), 2 * system.axes
    dof = np.append(system.dof, system.size + np.arange(gaps))
    station = np.full(dof.size, np.nan)
    section = np.append(
        system.section, np.repeat([system.wires[wire.number].section for wire in wires], counts)
    )
    for wire in wires:
        line = system.wires[wire.number]
        nodes = width * (line.first + np.arange(line.x.size))
        across = np.setdiff1d(np.arange(width), [ALONG, ALONG + system.axes])
        station[(nodes[:, None] + across).ravel()] = np.repeat(line.x, across.size)
        station[wire.gap_ends[:, 1]] = wire.gap_x[1:]
        station[wire.gap_ends[0, 0]] = wire.gap_x[0]
    held = (system.dof == FIXED) | (system.ground_stiffness > 0)
    station[whole:] = np.concatenate([_tension_stations(wire, held) for wire in wires])
    moves = np.flatnonzero(dof >= 0)
    of_free, part = np.full(system.size + gaps, np.nan), np.zeros(system.size + gaps, dtype=np.int64)
    of_free[dof[moves]], part[dof[moves]] = station[moves], section[moves]
    order = np.lexsort((np.arange(of_free.size) < system.size, of_free, part))
    order = order[np.isfinite(of_free[order])]
    new = np.full(of_free.size, FIXED, dtype=np.int64)
    new[order] = np.arange(order.size)
    place = np.where(dof >= 0, new[dof], FIXED)
    starts = np.searchsorted(part[order], np.arange(system.section_starts.size))
    kept = np.flatnonzero(place >= 0)
    T = csr_matrix((np.ones(kept.size), (kept, place[kept])), shape=(dof.size, order.size))
    return T, place, starts


def _tension_stations(wire: _ReducedWire, held: NDArray[np.bool_]) -> Floats:
    """[m], shape (gaps,): the end of each gap that is farther from where the wire is held.

    held : shape (all,), coordinates that are fixed or on a spring
    """
    at = np.flatnonzero(held[[wire.gap_ends[0, 0], *wire.gap_ends[:, 1]]])
    first = int(at[0]) if at.size else 0  # of stitch wires, the messenger wire holds both ends
    return np.where(np.arange(wire.tension.size) < first, wire.gap_x[:-1], wire.gap_x[1:])


def _moved(matrix: Any, place: Integers, size: int) -> Any:
    """A matrix over all coordinates as one over those that are kept, sparse."""
    from scipy.sparse import csr_matrix

    entries = matrix.tocoo()
    rows, columns = place[entries.row], place[entries.col]
    kept = (rows >= 0) & (columns >= 0) & (entries.data != 0)
    return csr_matrix((entries.data[kept], (rows[kept], columns[kept])), shape=(size, size))


def _diagonal(values: Floats) -> Any:
    from scipy.sparse import diags

    return diags(values).tocsr()
