"""Samples of a study as cases to run: which numbers go where, and what they make of line and pantographs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary, Conditions, DescribedPantograph, Distribution, InputError, Study
from catenary_fe.layout.members import Members, members_of_line, members_of_pantograph
from catenary_fe.layout.variation import PANTOGRAPH, Variable, kind_of, varied_pantograph
from catenary_fe.studies.sweep import BrokenCase, SweepCase

Floats = NDArray[np.float64]
Case = SweepCase | BrokenCase
NOMINAL = 0  # number of the sample without scatter
_LINE = ""  # stands for the line where a pantograph's name would


@dataclass(frozen=True)
class Input:
    """A place whose values scatter.

    members : by the pantograph's name; of layout and conditions one, by an empty name
    columns : its numbers in a sample of the cube
    """

    place: str
    distribution: Distribution
    members: dict[str, Members]
    columns: slice

    @property
    def is_scalar(self) -> bool:
        """Whether one value is drawn."""
        return bool(self.columns.stop - self.columns.start == 1)

    def changes(self, cube: Floats, owner: str) -> list[dict[str, Any]]:
        """Values by place, for each sample; of one owner of members. Raises InputError."""
        members = self.members[owner]
        width = 1 if self.distribution.together else len(members.nominal)
        numbers = cube[:, self.columns][:, :width]
        drawn = self.distribution.draw(numbers, members.nominal, self.place)
        return [members.changes(values) for values in drawn]


class Plan:
    """What scatters in a study. Raises InputError for files and places that do not exist.

    variable : line and conditions; unset: those of the study's files
    heads : values of the pantographs that are others than those of their files, by place
    """

    def __init__(
        self, study: Study, variable: Variable | None = None, heads: Mapping[str, Any] | None = None
    ) -> None:
        self.study, self._heads = study, dict(heads or {})
        self._variable = variable or Variable(study.layout, study.conditions)
        self._lines: dict[str, tuple[Catenary, Conditions | None]] = {}
        self._line({})  # its faults come before those of places
        self.inputs: list[Input] = []
        for place, distribution in study.scatter.items():
            members = self._members(place, distribution)
            most = max(len(each.nominal) for each in members.values())
            begin = self.dimension
            columns = slice(begin, begin + (1 if distribution.together else most))
            self.inputs.append(Input(place, distribution, members, columns))

    @property
    def dimension(self) -> int:
        """Numbers of a sample."""
        return int(self.inputs[-1].columns.stop) if self.inputs else 0

    @property
    def per_sample(self) -> int:
        """Cases of a sample: one a pantograph and speed."""
        return len(self.study.pantographs) * len(self.study.speed_kmh)

    def _members(self, place: str, distribution: Distribution) -> dict[str, Members]:
        if kind_of(place) == PANTOGRAPH:
            own = place.removeprefix(PANTOGRAPH)
            return {name: _prefixed(members_of_pantograph(name, own)) for name in self.study.pantographs}
        return {_LINE: members_of_line(self._variable, place, together=distribution.together)}

    def _line(self, values: dict[str, Any]) -> tuple[Catenary, Conditions | None]:
        """Line and conditions; the same object for the same values."""
        known = repr(values)
        if known not in self._lines:
            line, spans = self._variable.catenary(values), self.study.evaluated_spans
            made = line if spans is None else line.replace(evaluated_spans=spans)
            self._lines[known] = made, self._variable.conditions(values)
        return self._lines[known]

    def nominal(self) -> list[Case]:
        """Without scatter."""
        return self._sample(NOMINAL, {}, {name: {} for name in self.study.pantographs})

    def cases(self, cube: Floats, first: int = 1) -> list[Case]:
        """All cases of all samples, sample by sample, pantograph by pantograph, speed by speed.

        cube : shape (samples, dimension)
        first : number of the first sample
        """
        drawn = {(n, owner): each.changes(cube, owner) for n, each in enumerate(self.inputs)
                 for owner in each.members}  # fmt: skip
        found: list[Case] = []
        for i in range(cube.shape[0]):
            values: dict[str, dict[str, Any]] = {name: {} for name in (_LINE, *self.study.pantographs)}
            for (_, owner), samples in drawn.items():
                values[owner] |= samples[i]
            found += self._sample(first + i, values.pop(_LINE), values)
        return found

    def _sample(
        self, number: int, of_line: dict[str, Any], of_heads: dict[str, dict[str, Any]]
    ) -> list[Case]:
        found: list[Case] = []
        for name, of_head in of_heads.items():
            shown = self._shown(of_line, of_head, name)
            error: InputError | None = None
            try:
                (line, day), head = self._line(of_line), varied_pantograph(name, self._heads | of_head)
            except InputError as fault:
                error = fault
            for speed in self.study.speed_kmh:
                values = {"sample": number, "speed_kmh": speed, "pantograph": name} | shown
                if error:
                    found.append(BrokenCase(values=values, error=error))
                    continue
                found.append(self._case(values, line, day, head, speed))
        return found

    def _case(
        self,
        values: dict[str, Any],
        line: Catenary,
        day: Conditions | None,
        head: DescribedPantograph,
        speed: float,
    ) -> SweepCase:
        positions = self.study.positions
        return SweepCase(
            values=values,
            catenary=line,
            pantographs=(head,) * max(1, len(positions)),
            speed=speed / 3.6,
            positions=positions,
            conditions=day,
        )

    def _shown(self, of_line: dict[str, Any], of_head: dict[str, Any], name: str) -> dict[str, Any]:
        """Values of the places that have one."""
        given, shown = of_line | of_head, {}
        for each in self.inputs if given else ():
            members = each.members.get(name) or each.members[_LINE]
            if each.is_scalar:
                value = given[members.places[0]]
                shown[each.place] = value[0][1] if isinstance(value, list) else value
            else:
                shown[each.place] = None
        return {place: value for place, value in shown.items() if value is not None}


def _prefixed(members: Members) -> Members:
    """With places as a study writes them."""
    places = tuple(f"{PANTOGRAPH}{place}" for place in members.places)
    return Members(f"{PANTOGRAPH}{members.place}", places, members.nominal)


def broken(cases: Sequence[Case]) -> list[InputError]:
    """Errors of the cases that cannot be described."""
    return [
        case.error for case in cases if isinstance(case, BrokenCase) and isinstance(case.error, InputError)
    ]
