"""The catenary as an engineer describes it: spans, supports, wires, damping."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, model_validator

from catenary_fe.layout.arguments import checked, fixed_array, number, numbers, whole
from catenary_fe.layout.as_built import AsBuilt, as_built_faults, deviations
from catenary_fe.layout.equipment import Equipment
from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.images import in_the_plane, mirror_image
from catenary_fe.layout.installed import Wear, changes_of, designed_spans
from catenary_fe.layout.parameters import (
    NonEmpty,
    NonNegative,
    Number,
    Parameters,
    Positive,
    Temperature,
    Text,
    refuse,
)
from catenary_fe.layout.parts import Dropper, SectionEnd, Span, StitchWire, Support, Wire
from catenary_fe.layout.rules import catenary_faults
from catenary_fe.layout.terminations import Loss, lateral_pulls
from catenary_fe.layout.track import messenger_staggers

SAME_PLACE = 1e-3  # [m] of masts


class RayleighDamping(Parameters):
    """Damping matrix α M + β K of the wires: contact, messenger and stitch wires.

    M is the mass of the wires alone, without clamps, droppers and arms. K is their stiffness about the static
    state, of EA, EI and the tension. On a taut dropper β acts too: it damps with β k beside its own damping.
    Neither acts on the springs and links of supports and steady arms, which have dampers of their own
    (`messenger_damping`, `messenger_lateral_damping`, `steady_arm.damping`), nor on pantographs and contact.
    Programs that take β K of the whole line, springs of arms included, damp more.
    """

    alpha: NonNegative = 0.0
    """[1/s] share of the wires' mass matrix"""
    beta: NonNegative = 0.0
    """[s] share of the stiffness matrix of wires and taut droppers"""


class Catenary(Parameters):
    """One tension section of a catenary: contact wire (or two), messenger wire, perhaps stitch wires.

    x runs along the track from the first support, y to the left of the track's centre, z upwards from the
    rail. Contact and messenger wires end on the first and the last support. Unless `begin`, `end` and
    `midpoint` say otherwise they are fixed at the first, and tensioned by weights, free to move along the
    track, at the last.
    """

    name: Text = "catenary"
    """what is drawn and printed as title"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    contact_wire: Wire
    """the wire that the pantograph touches"""
    messenger_wire: Wire | None = None
    """the wire that carries the droppers; unset, on a line without droppers: none, the contact wire hangs at
    the supports alone"""
    contact_wire_spacing: Positive | None = None
    """[m] sideways between two equal contact wires; unset: one contact wire"""
    stitch_wire: StitchWire | None = None
    """at each support between the line's ends; unset: none"""
    spans: Annotated[tuple[Span, ...], NonEmpty]
    """one after the other; they may all differ"""
    supports: tuple[Support, ...]
    """one more than spans"""
    contact_wire_height: Positive = 5.3
    """[m] nominal, above the rail"""
    system_height: Positive = 1.2
    """[m] between messenger wire and contact wire at the supports"""
    begin: SectionEnd = SectionEnd(kind="fixed")
    """what holds the wires along the track at the first support"""
    end: SectionEnd = SectionEnd(kind="weights")
    """what holds the wires along the track at the last support"""
    midpoint: Annotated[int, Field(strict=True)] | None = None
    """number of the support, from 1, that holds the wires along the track between two tensioned ends"""
    midpoint_position: Number | None = None
    """[m] from the first support to a midpoint anchor within a span, instead"""
    tension_loss: Loss = 0.0
    """[1] share of a wire's tension that friction takes at each support on the way from weights or spring"""
    equipment: tuple[Equipment, ...] = ()
    """within the spans: section insulators, neutral sections, clamps"""
    wear: tuple[Wear, ...] = ()
    """of the contact wire, since its droppers were cut"""
    as_built: AsBuilt | None = None
    """by how much the line differs from its drawing; unset: not at all"""
    installation_temperature: Temperature = 15.0
    """[°C] at which the line hangs as designed; what is warmer or colder, conditions say"""
    cant_base: Positive = 1.5
    """[m] between the rails' middles, over which `cant` is measured"""
    damping: RayleighDamping = RayleighDamping()
    """of wires and taut droppers"""
    evaluated_spans: tuple[int, ...] | None = None
    """numbers of the spans (from 1) over which statistics are taken; unset: the middle third"""
    spatial: bool | None = None
    """true: modelled in space; unset: where stagger, curves or links leave the vertical plane"""

    @model_validator(mode="after")
    def _counts(self) -> Self:
        if len(self.supports) != len(self.spans) + 1:
            raise ValueError(
                f"{counted(len(self.supports), 'support')} for {counted(len(self.spans), 'span')}: there must"
                " be one more support than spans"
            )
        refuse([*catenary_faults(self), *as_built_faults(self)])
        return self

    @classmethod
    @checked
    def regular(
        cls,
        *,
        spans: int,
        span_length: float,
        droppers: Sequence[Dropper],
        contact_wire: Wire,
        messenger_wire: Wire | None = None,
        support: Support,
        pre_sag: float = 0.0,
        stagger: float = 0.0,
        curve_radius: float | None = None,
        **others: object,
    ) -> Self:
        """A line of equal spans with equal supports.

        spans : number of spans
        span_length : [m]
        droppers : of one span, in order
        pre_sag : [m] of the contact wire at mid-span
        stagger : [m] of the contact wire, to the left at the first support and then to alternating sides
        curve_radius : [m] of the track, positive to the left; unset: straight
        others : further fields of :class:`Catenary`

        Raises InputError where a value breaks a rule.
        """
        whole("spans", spans, least=1, most=10_000)
        number("stagger", stagger, "m")
        span = Span(length=span_length, droppers=droppers, pre_sag=pre_sag, curve_radius=curve_radius)
        supports = (support,) * (spans + 1)
        if stagger and support.stagger:
            raise InputError(
                f"stagger = {stagger:g} m, to alternating sides, and support.stagger = {support.stagger:g} m:"
                " give one of them"
            )
        if stagger:
            supports = tuple(s.replace(stagger=stagger * (-1) ** i) for i, s in enumerate(supports))
        return cls(
            contact_wire=contact_wire,
            messenger_wire=messenger_wire,
            spans=(span,) * spans,
            supports=supports,
            **others,
        )

    @fixed_array
    def support_positions(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,)."""
        return np.concatenate([[0.0], np.cumsum([span.length for span in self.spans])])

    def supports_at(self, x: ArrayLike) -> NDArray[np.int64]:
        """Numbers, from 0, of the supports at places x [m] along the line, any shape."""
        return np.searchsorted(self.support_positions, np.asarray(x, dtype=float) - SAME_PLACE)

    @property
    def length(self) -> float:
        """[m] from the first to the last support."""
        return float(self.support_positions[-1])

    @fixed_array
    def hanging(self) -> NDArray[np.bool_]:
        """Shape (designed droppers,): which droppers hang; others are missing or broken."""
        return np.array([d.state is None for span in self.spans for d in span.droppers], dtype=bool)

    @cached_property
    def droppers(self) -> tuple[Dropper, ...]:
        """All droppers of the line that hang, in order."""
        return tuple(dropper for span in self.spans for dropper in span.droppers if dropper.state is None)

    @fixed_array
    def dropper_positions(self) -> NDArray[np.float64]:
        """[m], shape (droppers,), along the line; where a clamp has slid, of the upper end."""
        found: NDArray[np.float64] = self.designed_positions[self.hanging]
        return found

    @fixed_array
    def designed_positions(self) -> NDArray[np.float64]:
        """[m], shape (designed droppers,), along the line, of those too that are gone."""
        starts = np.repeat(self.support_positions[:-1], [len(span.droppers) for span in self.spans])
        found: NDArray[np.float64] = starts + [d.position for span in self.spans for d in span.droppers]
        return found

    @fixed_array
    def lower_clamp_positions(self) -> NDArray[np.float64]:
        """[m], shape (droppers,), along the line, of their clamps on the contact wire."""
        low: NDArray[np.float64] = self.dropper_positions + [d.clamp_shift for d in self.droppers]
        return low

    @fixed_array
    def dropper_spans(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of the span, from 1, that each dropper is in."""
        spans = [i for i, s in enumerate(self.spans, start=1) for _ in s.droppers]
        found: NDArray[np.int64] = np.array(spans, dtype=np.int64)[self.hanging]
        return found

    @fixed_array
    def dropper_numbers(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of each dropper in its span, from 1, as designed: missing ones count."""
        numbers = [n for span in self.spans for n in range(1, len(span.droppers) + 1)]
        found: NDArray[np.int64] = np.array(numbers, dtype=np.int64)[self.hanging]
        return found

    @cached_property
    def departs_from_design(self) -> bool:
        """Whether droppers are gone, clamps have slid, the contact wire has worn, or was hung otherwise."""
        return bool(changes_of(self))

    def as_designed(self) -> Self:
        """The same line as drawn: all droppers and clamps in place, a new contact wire, no deviations."""
        drawn: dict[str, Any] = {"spans": designed_spans(self), "wear": (), "as_built": None}
        return self.replace(**drawn) if self.departs_from_design else self

    @property
    def gives_dropper_lengths(self) -> bool:
        """Whether all its droppers have lengths, with which it is hung instead of those of its design."""
        return bool(self.hanging.size) and all(d.length is not None for s in self.spans for d in s.droppers)

    def with_dropper_lengths(self, lengths: Sequence[float] | NDArray[np.float64]) -> Self:
        """The same line with these dropper lengths, which it is then hung with.

        lengths : [m], shape (designed droppers,), stress-free; missing and broken droppers count

        Raises InputError where their number is another one than the droppers', or one is not a length.
        """
        return self._with_lengths(numbers("lengths", lengths, shape=(self.hanging.size,)).tolist())

    def without_dropper_lengths(self) -> Self:
        """The same line without dropper lengths of its own: form finding gives it those of the design."""
        return self._with_lengths([None] * self.hanging.size)

    def _with_lengths(self, lengths: Sequence[float | None]) -> Self:
        left = iter(lengths)
        spans = tuple(
            span.replace(droppers=tuple(d.replace(length=next(left)) for d in span.droppers))
            for span in self.spans
        )
        return self.replace(spans=spans)

    @fixed_array
    def contact_wire_heights(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): height of the contact wire at the supports, as built."""
        off = deviations(self, "contact_wire_height", self.support_positions)
        return self.drawn_heights + off

    @fixed_array
    def drawn_heights(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): design height of the contact wire at the supports."""
        return np.array([s.contact_wire_height or self.contact_wire_height for s in self.supports])

    @property
    def changes_height(self) -> bool:
        """Whether the contact wire's design height is another one at some supports."""
        return bool(np.ptp(self.drawn_heights) or self.drawn_heights[0] != self.contact_wire_height)

    def design_line(self, x: ArrayLike) -> NDArray[np.float64]:
        """[m] above the rail, at places x [m] along the line: straight between the supports' heights."""
        at = np.asarray(x, dtype=float)
        line: NDArray[np.float64] = np.interp(at, self.support_positions, self.drawn_heights)
        return line

    @fixed_array
    def gradients(self) -> NDArray[np.float64]:
        """Shape (spans,): design gradient of the contact wire in each span."""
        gradients: NDArray[np.float64] = np.diff(self.drawn_heights) / np.diff(self.support_positions)
        return gradients

    @fixed_array
    def design_heights(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): design height of the contact wire at each dropper."""
        offsets = np.concatenate([s.height_offsets() for s in self.spans])
        heights: NDArray[np.float64] = self.design_line(self.dropper_positions) + offsets[self.hanging]
        return heights

    @fixed_array
    def messenger_support_heights(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): height of the installed messenger wire at the supports.

        Without one, of the contact wire.
        """
        if self.messenger_wire is None:
            return self.contact_wire_heights
        heights = self.drawn_heights + [s.system_height or self.system_height for s in self.supports]
        above: NDArray[np.float64] = heights + deviations(
            self, "messenger_wire_height", self.support_positions
        )
        return above

    @property
    def leaves_the_plane(self) -> bool:
        """Whether stagger, curves or links lie outside the vertical plane."""
        return any(any(span.curvatures) for span in self.spans) or any(
            s.stagger or y or s.cant or (s.steady_arm and s.steady_arm.length is not None)
            for s, y in zip(self.supports, self.messenger_staggers.tolist(), strict=True)
        )

    @property
    def is_spatial(self) -> bool:
        """Whether the model is one in space; else it lies in the vertical plane."""
        return self.leaves_the_plane if self.spatial is None else self.spatial

    @property
    def contact_wire_offsets(self) -> tuple[float, ...]:
        """[m], of each contact wire to the left of the stagger; the right wire comes first."""
        half = (self.contact_wire_spacing or 0.0) / 2
        return (-half, half) if half else (0.0,)

    @fixed_array
    def dropper_contact_wires(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of the contact wire, from 0, that each dropper holds."""
        found: NDArray[np.int64] = np.array(self.wires_held(), dtype=np.int64)[self.hanging]
        return found

    def wires_held(self) -> list[int]:
        """Number of the contact wire, from 0, of every dropper of the design."""
        wires, designed = len(self.contact_wire_offsets), [d for span in self.spans for d in span.droppers]
        return [(d.contact_wire - 1) if d.contact_wire else i % wires for i, d in enumerate(designed)]

    def has_stitch_wire(self, support: int) -> bool:
        """Whether one hangs at the support of this number, from 0. Raises InputError for an absent one."""
        whole("support", support, least=0, most=len(self.supports) - 1)
        inside = 0 < support < len(self.supports) - 1
        return bool(self.stitch_wire and inside and self.supports[support].stitch_wire)

    @cached_property
    def stitched_supports(self) -> tuple[int, ...]:
        """Numbers of the supports, from 0, that have a stitch wire."""
        return tuple(i for i in range(len(self.supports)) if self.has_stitch_wire(i))

    @fixed_array
    def stitch_wire_lengths(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): of the stitch wires at the supports; 0 where none hangs."""
        usual = self.stitch_wire.length if self.stitch_wire else 0.0
        own = [s.stitch_wire_length or usual for s in self.supports]
        return np.array([each if self.has_stitch_wire(i) else 0.0 for i, each in enumerate(own)])

    @fixed_array
    def staggers(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): stagger of the contact wire at the supports, as built."""
        drawn = np.array([support.stagger for support in self.supports])
        return drawn + deviations(self, "stagger", self.support_positions)

    @fixed_array
    def messenger_staggers(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): likewise of the messenger wire; of one that follows, where that is."""
        return messenger_staggers(self)

    @fixed_array
    def lateral_pulls(self) -> NDArray[np.float64]:
        """[N], shape (spans + 1,): force to the left with which stagger, curves, cant pull on the supports.

        Tension times the change of direction of all contact wires, a polygon; 0 at the line's ends.
        """
        return lateral_pulls(self)

    def planar(self) -> Self:
        """The same line in the vertical plane: no stagger, curves and cant, links as springs.

        A link under the lateral force H acts in the plane like a vertical spring of H over its length.

        Raises InputError for a link so short, or pulled so hard, that no spring can stand for it.
        """
        return in_the_plane(self) if self.is_spatial else self

    @property
    def spans_to_evaluate(self) -> tuple[int, ...]:
        """Numbers of the spans (from 1) that statistics are taken over."""
        if self.evaluated_spans:
            return tuple(sorted(set(self.evaluated_spans)))
        n = len(self.spans)
        count = min(max(2, n // 3), max(1, n - 2))  # a run starts in the first span and ends in the last
        first = (n - count) // 2 + 1
        return tuple(range(first, first + count))

    def mirrored(self) -> Self:
        """The mirror image: x runs the other way, left stays left."""
        return mirror_image(self)
