"""A line of several tension sections, and the overlaps in which a pantograph changes from one to the next."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_serializer, model_validator

from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.equipment import Equipment
from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.overlap import Overlap, run_off
from catenary_fe.layout.parameters import refuse, shorten
from catenary_fe.layout.parts import Span, Support
from catenary_fe.layout.rules import line_faults

_SAME = 0.01  # [m] by which masts of two sections may differ


class Line(Catenary):
    """Several tension sections in a row, each with its own wires, droppers and anchors.

    As a catenary it is what pantographs run along: spans and supports are those of the section in service,
    droppers those of all sections, one after the other.
    """

    sections: tuple[Catenary, ...]
    """one after the other, as built: overlaps included"""
    overlaps: tuple[Overlap, ...]
    """between each section and the next"""

    @model_validator(mode="before")
    @classmethod
    def _in_service(cls, data: Any) -> Any:
        """Fill in what follows from the sections."""
        if not isinstance(data, dict) or "sections" not in data:
            return data
        sections = [s if isinstance(s, Catenary) else Catenary.model_validate(s) for s in data["sections"]]
        overlaps = [o if isinstance(o, Overlap) else Overlap.model_validate(o) for o in data["overlaps"]]
        refuse(_faults_of_counts(sections, overlaps) or _faults(sections, overlaps))
        spans, supports = _served(sections, overlaps)
        first = min(sections, key=lambda section: section.contact_wire.wave_speed)
        common = {name: getattr(first, name) for name in Catenary.model_fields if name not in _OWN}
        common["equipment"] = _equipment(sections, overlaps)
        common |= {"wear": (), "as_built": None}  # of the sections
        own = {name: data[name] for name in _OWN if name in data}
        return (
            common
            | {"spans": spans, "supports": supports}
            | own
            | {"sections": sections, "overlaps": overlaps}
        )

    @model_validator(mode="after")
    def _counts(self) -> Self:
        refuse(line_faults(self))
        return self

    @model_serializer(mode="wrap")
    def _sections_alone(self, handler: Any) -> Any:
        return {name: value for name, value in handler(self).items() if name in _OWN}

    def replace(self, **changes: Any) -> Self:
        """A copy with other sections, overlaps, names or evaluated spans.

        Raises InputError for what belongs to a section.
        """
        if other := [name for name in changes if name not in _OWN]:
            raise InputError(f"{other[0]}: belongs to a tension section; replace it in line.sections")
        return type(self)(**({name: getattr(self, name) for name in _OWN} | changes))

    @cached_property
    def begins(self) -> tuple[float, ...]:
        """[m] along the line of each section's first support."""
        return _begins(self.sections, self.overlaps)

    @cached_property
    def common_zones(self) -> tuple[tuple[float, float], ...]:
        """[m] along the line, begin and end of each overlap: where there are wires of two sections."""
        return tuple(
            (begin, before + section.length)
            for section, before, begin in zip(self.sections, self.begins, self.begins[1:], strict=False)
        )

    def _of_droppers(self, name: str) -> NDArray[Any]:
        return np.concatenate([getattr(section, name) for section in self.sections])

    def _places_of_droppers(self, name: str) -> NDArray[np.float64]:
        parts = zip(self.sections, self.begins, strict=True)
        return np.concatenate([getattr(section, name) + begin for section, begin in parts])

    @cached_property
    def droppers(self) -> Any:
        """All droppers, section by section."""
        return tuple(dropper for section in self.sections for dropper in section.droppers)

    @cached_property
    def hanging(self) -> NDArray[np.bool_]:
        """Shape (designed droppers,): which droppers hang, section by section."""
        return self._of_droppers("hanging")

    @cached_property
    def dropper_numbers(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of each dropper in its section's span, from 1."""
        return self._of_droppers("dropper_numbers")

    @cached_property
    def lower_clamp_positions(self) -> NDArray[np.float64]:
        """[m], shape (droppers,), along the line, of their clamps on the contact wires."""
        return self._places_of_droppers("lower_clamp_positions")

    @property
    def departs_from_design(self) -> bool:
        """Whether any section departs from what its droppers were cut for."""
        return any(section.departs_from_design for section in self.sections)

    def as_designed(self) -> Self:
        """The same line as designed, section by section."""
        return self.replace(sections=tuple(section.as_designed() for section in self.sections))

    @cached_property
    def dropper_positions(self) -> NDArray[np.float64]:
        """[m], shape (droppers,), along the line."""
        return self._places_of_droppers("dropper_positions")

    @cached_property
    def dropper_spans(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of the line's span, from 1, that each dropper is in."""
        return np.searchsorted(self.support_positions, self.dropper_positions).astype(np.int64)

    @cached_property
    def dropper_contact_wires(self) -> NDArray[np.int64]:
        """Shape (droppers,): number of the contact wire, from 0, among those of all sections."""
        counts = [len(section.contact_wire_offsets) for section in self.sections]
        first = np.cumsum([0, *counts])
        return np.concatenate(
            [s.dropper_contact_wires + n for s, n in zip(self.sections, first, strict=False)]
        )

    @cached_property
    def design_heights(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): as of :class:`Catenary`."""
        return self._of_droppers("design_heights")

    @property
    def leaves_the_plane(self) -> bool:
        """Whether stagger, curves or links lie outside the vertical plane."""
        return any(section.is_spatial for section in self.sections)

    @property
    def gives_dropper_lengths(self) -> bool:
        """Whether all droppers of all sections have lengths, with which they are hung."""
        hung = [section for section in self.sections if section.hanging.size]
        return bool(hung) and all(section.gives_dropper_lengths for section in hung)

    def _with_lengths(self, lengths: Sequence[float | None]) -> Self:
        left = iter(lengths)
        sections = [s._with_lengths([next(left) for _ in range(s.hanging.size)]) for s in self.sections]
        return self.replace(sections=tuple(sections))

    def planar(self) -> Self:
        """The same line in the vertical plane, section by section."""
        return self.replace(sections=tuple(section.planar() for section in self.sections))

    def mirrored(self) -> Self:
        """The mirror image: x runs the other way, left stays left."""
        n = len(self.spans)
        evaluated = tuple(n + 1 - i for i in self.evaluated_spans) if self.evaluated_spans else None
        return self.replace(
            sections=tuple(section.mirrored() for section in reversed(self.sections)),
            overlaps=self.overlaps[::-1],
            evaluated_spans=evaluated,
        )


_OWN = ("name", "source", "sections", "overlaps", "evaluated_spans")


def join_sections(
    sections: Sequence[Catenary],
    overlaps: Sequence[Overlap],
    *,
    name: str = "",
    source: str = "",
    **others: Any,
) -> Line:
    """A line of tension sections that meet in overlaps by the rule, where these are not as written.

    sections : each with the spans that it shares with its neighbours
    overlaps : between each section and the next
    others : further fields of :class:`Line`: evaluated_spans

    Raises InputError where two sections do not fit in their overlap.
    """
    for what, items, kind in (("sections", sections, Catenary), ("overlaps", overlaps, Overlap)):
        if not isinstance(items, list | tuple) or not all(isinstance(item, kind) for item in items):
            raise InputError(f"{what} = {shorten(items)}: must be a list of {kind.__name__} objects")
    made = list(sections)
    if not made:
        raise InputError("sections is empty; a line has one at least")
    if faults := _faults_of_counts(made, overlaps):
        raise InputError(*faults)
    if any(section.is_spatial for section in made):
        made = [section.replace(spatial=True) for section in made]
    for n, overlap in enumerate(overlaps, start=1):
        if overlap.as_written:
            continue
        if any(d.length is not None for section in made[n - 1 : n + 1] for d in section.droppers):
            raise InputError(
                f"overlap {n}: droppers have lengths, which the rule makes wrong; say as_written ="
                " true where they are those of the overlap, or leave the lengths out"
            )
        try:
            side = -1.0 if made[n - 1].supports[-1 - overlap.spans].stagger > 0 else 1.0
            made[n - 1] = run_off(made[n - 1], overlap, side, side)
            made[n] = run_off(made[n].mirrored(), overlap, -side, side * (-1) ** overlap.spans).mirrored()
        except InputError as error:
            raise InputError(*(f"overlap {n}: {line}" for line in error.problems)) from None
    return Line(
        name=name or made[0].name, source=source or made[0].source,
        sections=tuple(made), overlaps=tuple(overlaps), **others,
    )  # fmt: skip


def _begins(sections: Sequence[Catenary], overlaps: Sequence[Overlap]) -> tuple[float, ...]:
    """[m] along the line of each section's first support."""
    found = [0.0]
    for section, overlap in zip(sections, overlaps, strict=False):
        found.append(found[-1] + float(section.support_positions[-1 - overlap.spans]))
    return tuple(found)


def _faults_of_counts(sections: Sequence[Catenary], overlaps: Sequence[Overlap]) -> list[str]:
    """One line for overlaps that are too many, too few, or too long for their sections."""
    if len(overlaps) != len(sections) - 1:
        return [
            f"{counted(len(sections), 'section')} and {counted(len(overlaps), 'overlap')}: there must be one"
            " between each section and the next"
        ]
    return [
        f"overlap {n} of {overlap.spans} spans: its sections have {len(a.spans)} and {len(b.spans)} spans;"
        " add spans, or take a shorter overlap"
        for n, (overlap, (a, b)) in enumerate(zip(overlaps, pairwise(sections), strict=True), start=1)
        if overlap.spans >= min(len(a.spans), len(b.spans))
    ]


def _faults(sections: Sequence[Catenary], overlaps: Sequence[Overlap]) -> list[str]:
    """One line for each way in which sections do not fit together."""
    found = []
    for name, rule in (
        ("contact_wire_height", "the nominal height, from which pantographs count"),
        ("damping", "one for the line"),
        ("cant_base", "one for the line"),
        ("is_spatial", "in space or in the vertical plane, all alike"),
    ):
        values = [getattr(section, name) for section in sections]
        if any(value != values[0] for value in values):
            found.append(f"sections: {name} differs between them; it must be {rule}")
    if len({section.messenger_wire is None for section in sections}) > 1:
        found.append("sections: some have a messenger_wire and others none; give all one, or none of them")
    for n, (overlap, (a, b)) in enumerate(zip(overlaps, pairwise(sections), strict=True), start=1):
        shared = overlap.spans
        for i, (one, other) in enumerate(zip(a.spans[-shared:], b.spans[:shared], strict=True), start=1):
            where = f"overlap {n}: shared span {i}"
            if abs(one.length - other.length) > _SAME:
                found.append(
                    f"{where} is {one.length:g} m in the section before and {other.length:g} m in the one"
                    " behind; they stand on the same masts: make them equal"
                )
            if one.curvatures != other.curvatures:
                found.append(f"{where}: curve_radius differs between the two sections; the track is the same")
        if [s.cant for s in a.supports[-1 - shared :]] != [s.cant for s in b.supports[: shared + 1]]:
            found.append(f"overlap {n}: cant differs between the two sections; the track is the same")
    return found


def _equipment(sections: Sequence[Catenary], overlaps: Sequence[Overlap]) -> tuple[Equipment, ...]:
    """That of all sections, by its place along the line."""
    return tuple(
        item.replace(x=begin + item.middle(section), span=None, position=None)
        for section, begin in zip(sections, _begins(sections, overlaps), strict=True)
        for item in section.equipment
    )


def _served(
    sections: Sequence[Catenary], overlaps: Sequence[Overlap]
) -> tuple[tuple[Span, ...], tuple[Support, ...]]:
    """Spans and supports of the section that pantographs run along."""
    spans: list[Span] = []
    supports: list[Support] = []
    begin = 0
    for section, following, overlap in zip(sections, [*sections[1:], None], [*overlaps, None], strict=True):
        end, behind = len(section.spans), 0
        if following is not None and overlap is not None:
            behind = _served_before(section, following, overlap.spans)
            end += behind - overlap.spans
        spans += section.spans[begin:end]
        supports += section.supports[begin:end]
        begin = behind
    return tuple(spans), (*supports, sections[-1].supports[-1])


def _served_before(section: Catenary, following: Catenary, shared: int) -> int:
    """How many of the shared spans the section before serves: at each mast the lower wire is in service."""
    before, behind = section.contact_wire_heights[-shared - 1 :], following.contact_wire_heights[: shared + 1]
    heights = {n: before[:n].sum() + behind[n:].sum() for n in range(1, shared + 1)}
    lowest = min(heights.values()) + _SAME
    return min((n for n in heights if heights[n] < lowest), key=lambda n: abs(2 * n - shared - 0.5))


def read_catenary(record: dict[str, Any]) -> Catenary:
    """A catenary, or a line of several sections, as :meth:`model_dump` wrote it."""
    return (Line if "sections" in record else Catenary).model_validate(record)


@lru_cache(maxsize=4)
def recorded_catenary(text: str) -> Catenary:
    """As :func:`read_catenary`, from JSON; runs are asked for it again and again."""
    return read_catenary(json.loads(text))
