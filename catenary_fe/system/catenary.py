"""The catenary as an engineer describes it: spans, supports, wires, damping."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationInfo, field_validator, model_validator

from catenary_fe.system.parameters import NonEmpty, NonNegative, Number, Parameters, Positive, Text, refuse
from catenary_fe.system.wire import Dropper, Wire

CLOSEST = 0.01  # [m] between clamps: closer ones are a slip of the pen, and no mesh


class SteadyArm(Parameters):
    """Registration of the contact wire at a support: in the plane a vertical spring and a mass."""

    stiffness: NonNegative
    """[N/m] vertical, at the contact wire"""
    mass: NonNegative = 0.0
    """[kg] of arm and clamp that moves with the wire"""
    damping: NonNegative = 0.0
    """[N s/m] vertical"""
    holds_design_height: bool = True
    """true: preloaded so that the wire has its design height here; false: it carries `preload`"""
    preload: Number = 0.0
    """[N] upward force on the wire at its design height, where `holds_design_height` is false"""


class Support(Parameters):
    """What holds the wires at a mast. The first and the last support of a line anchor both wires."""

    messenger_stiffness: Positive | None = None
    """[N/m] vertical, under the messenger wire; unset: rigid"""
    messenger_damping: NonNegative = 0.0
    """[N s/m] vertical, beside the stiffness"""
    steady_arm: SteadyArm | None = None
    """registration of the contact wire; unset: the contact wire is free here"""
    system_height: Positive | None = None
    """[m] between the wires at this support; unset: the catenary's"""

    @model_validator(mode="after")
    def _damping_needs_a_spring(self) -> Self:
        if self.messenger_damping and self.messenger_stiffness is None:
            raise ValueError(
                f"messenger_damping = {self.messenger_damping:g} N s/m has no effect on a rigid support;"
                " give messenger_stiffness too"
            )
        return self


class Span(Parameters):
    """From one support to the next, with its droppers in order."""

    length: Positive
    """[m] between the supports"""
    droppers: tuple[Dropper, ...]
    """in order of their positions"""
    pre_sag: Number = 0.0
    """[m] design sag of the contact wire at mid-span, a parabola between the outermost droppers"""

    @field_validator("droppers")
    @classmethod
    def _droppers_in_order(cls, droppers: tuple[Dropper, ...], info: ValidationInfo) -> tuple[Dropper, ...]:
        length = info.data.get("length", np.inf)  # a faulty one is reported by itself
        faults, previous = [], 0.0
        for number, dropper in enumerate(droppers, start=1):
            x = dropper.position
            if not 0 < x < length:
                faults.append(
                    f"dropper {number} at {x:g} m lies outside the {length:g} m span;"
                    f" positions count from the span's first support, between 0 and {length:g} m"
                )
            elif x <= previous:
                faults.append(
                    f"dropper {number} at {x:g} m does not come after the one before it at {previous:g} m;"
                    " list the droppers in order, each position once"
                )
            elif min(x - previous, length - x) < CLOSEST:
                faults.append(
                    f"dropper {number} at {x:.6g} m is less than {CLOSEST:g} m from the next clamp or support"
                    "; move it, or make one dropper of two"
                )
            else:
                previous = x
        refuse(faults)
        return droppers

    def height_offsets(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): design height of the contact wire at each dropper above the nominal one."""
        x = np.array([d.position for d in self.droppers])
        if x.size == 0:
            return x
        first, last = x[0], x[-1]
        xi = (x - first) / (last - first) if last > first else np.full_like(x, 0.5)
        sag = -4 * self.pre_sag * xi * (1 - xi)
        own = [np.nan if d.height_offset is None else d.height_offset for d in self.droppers]
        return np.where(np.isnan(own), sag, own)


class RayleighDamping(Parameters):
    """Damping matrix α M + β K of the wires, K with the stiffness that the tension gives."""

    alpha: NonNegative = 0.0
    """[1/s] share of the mass matrix"""
    beta: NonNegative = 0.0
    """[s] share of the stiffness matrix"""


class Catenary(Parameters):
    """One tension section of a two-wire catenary in the vertical plane.

    x runs along the track from the first support, z upwards from the rail. Both wires end on the first and
    the last support: fixed at the first, tensioned by weights (free to move along the track) at the last.
    """

    name: Text = "catenary"
    """what is drawn and printed as title"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    contact_wire: Wire
    """the wire that the pantograph touches"""
    messenger_wire: Wire
    """the wire that carries the droppers"""
    spans: Annotated[tuple[Span, ...], NonEmpty]
    """one after the other; they may all differ"""
    supports: tuple[Support, ...]
    """one more than spans"""
    contact_wire_height: Positive = 5.3
    """[m] nominal, above the rail"""
    system_height: Positive = 1.2
    """[m] between messenger wire and contact wire at the supports"""
    damping: RayleighDamping = RayleighDamping()
    """of the wires"""
    evaluated_spans: tuple[int, ...] | None = None
    """numbers of the spans (from 1) over which statistics are taken; unset: the middle third"""

    @model_validator(mode="after")
    def _counts(self) -> Self:
        if len(self.supports) != len(self.spans) + 1:
            raise ValueError(
                f"{len(self.supports)} supports for {len(self.spans)} spans: there must be one more support"
                " than spans"
            )
        refuse([*self._absent_spans(), *self._long_droppers()])
        return self

    def _absent_spans(self) -> list[str]:
        if self.evaluated_spans == ():
            return ["evaluated_spans is empty; name spans, or leave it out for the middle third"]
        count = len(self.spans)
        return [
            f"evaluated_spans names span {number}: the line has spans 1 to {count}"
            for number in self.evaluated_spans or ()
            if not 1 <= number <= count
        ]

    def _long_droppers(self) -> list[str]:
        """A messenger wire sags: no dropper can be longer than the room at the higher of its two supports."""
        faults = []
        top = self.messenger_support_heights
        design = iter(self.design_heights)
        for i, span in enumerate(self.spans):
            for number, dropper in enumerate(span.droppers, start=1):
                room = max(top[i], top[i + 1]) - next(design)
                if dropper.length is not None and dropper.length >= room:
                    faults.append(
                        f"span {i + 1}: dropper {number} with a length of {dropper.length:g} m is longer than"
                        f" the system height allows, {room:g} m here; shorten it or raise system_height"
                    )
        return faults

    @classmethod
    def regular(
        cls,
        *,
        spans: int,
        span_length: float,
        droppers: Sequence[Dropper],
        contact_wire: Wire,
        messenger_wire: Wire,
        support: Support,
        pre_sag: float = 0.0,
        **others: object,
    ) -> Self:
        """A line of equal spans with equal supports.

        spans : number of spans
        span_length : [m]
        droppers : of one span, in order
        pre_sag : [m] of the contact wire at mid-span
        others : further fields of :class:`Catenary`

        Raises InputError where a value breaks a rule.
        """
        span = Span(length=span_length, droppers=tuple(droppers), pre_sag=pre_sag)
        return cls(
            contact_wire=contact_wire,
            messenger_wire=messenger_wire,
            spans=(span,) * spans,
            supports=(support,) * (spans + 1),
            **others,
        )

    @cached_property
    def support_positions(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,)."""
        return np.concatenate([[0.0], np.cumsum([span.length for span in self.spans])])

    @property
    def length(self) -> float:
        """[m] from the first to the last support."""
        return float(self.support_positions[-1])

    @cached_property
    def droppers(self) -> tuple[Dropper, ...]:
        """All droppers of the line in order."""
        return tuple(dropper for span in self.spans for dropper in span.droppers)

    @cached_property
    def dropper_positions(self) -> NDArray[np.float64]:
        """[m], shape (droppers,), along the line."""
        starts = self.support_positions
        return np.array([starts[i] + d.position for i, s in enumerate(self.spans) for d in s.droppers])

    @cached_property
    def dropper_spans(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of the span, from 1, that each dropper is in."""
        return np.array([i for i, s in enumerate(self.spans, start=1) for _ in s.droppers], dtype=np.int64)

    @cached_property
    def design_heights(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): height of the contact wire that form finding gives each dropper."""
        return self.contact_wire_height + np.concatenate([s.height_offsets() for s in self.spans])

    @cached_property
    def messenger_support_heights(self) -> NDArray[np.float64]:
        """[m], shape (spans + 1,): height of the installed messenger wire at the supports."""
        heights = [s.system_height or self.system_height for s in self.supports]
        return self.contact_wire_height + np.array(heights)

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
        """The same line seen from its other end."""
        spans = tuple(
            span.replace(
                droppers=tuple(d.replace(position=span.length - d.position) for d in reversed(span.droppers))
            )
            for span in reversed(self.spans)
        )
        n = len(self.spans)
        evaluated = tuple(n + 1 - i for i in self.evaluated_spans) if self.evaluated_spans else None
        return self.replace(spans=spans, supports=self.supports[::-1], evaluated_spans=evaluated)
