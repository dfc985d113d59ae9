"""A pantograph known by the frequency response of its head, measured or computed, and not by its masses."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, WithJsonSchema, field_validator, model_validator

from catenary_fe.layout.bodies import BASE, Body, ContactLaw, Joint, Strip
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.panhead import Panhead
from catenary_fe.layout.parameters import NonNegative, Number, Positive, refuse, shorten
from catenary_fe.layout.pushed import PushedPantograph
from catenary_fe.layout.substructure import Substructure
from catenary_fe.layout.tables import Column, read_table
from catenary_fe.theory import MassChain, fit_receptance
from catenary_fe.theory.receptance import LEAST_POINTS, MOST_MODES

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Row = tuple[float, float, float]

WORST_FIT = 0.05  # root mean square of the relative error that is accepted without a warning; assumed
LOWEST = 0.3  # [Hz] at which masses of some 20 kg hide base springs of less than about 70 N/m; assumed
HIGHEST = 20.0  # [Hz] of contact forces in EN 50367 (recalled)
_LEADS = 0.1  # sine of a phase that is above 0 by more than noise
_COLUMNS = {
    "frequency": Column("frequency", least=0.0),
    "receptance": Column("receptance", least=0.0),
    "apparent_mass": Column("mass", least=0.0),
    "dynamic_stiffness": Column("stiffness", least=0.0),
    "phase": Column("angle"),
}
_MAGNITUDES = "receptance", "apparent_mass", "dynamic_stiffness"
_SCHEMA = {
    "anyOf": [
        {"type": "string"},
        {"type": "array", "items": {"type": "array", "items": {"type": "number"}}},
    ]
}


class ReceptancePantograph(PushedPantograph):
    """A pantograph whose head yields under a force as a table over the frequency says.

    The table's response is met by a chain of masses, springs and dampers, which no run can make unstable; the
    constant force is on its lowest mass, so that it is what the head presses with at rest where the base's
    spring is force-free.
    """

    kind = "receptance"
    receptance: Annotated[tuple[tuple[Positive, Positive, Number], ...], WithJsonSchema(_SCHEMA)]
    """[Hz], [m/N] and [deg] rows of frequency, displacement of the head for each newton on it, and phase, the
    base at rest and without the wire; in a file, the name of a table (CSV) beside it"""
    order: Annotated[int, Field(strict=True, ge=1, le=MOST_MODES)] | None = None
    """masses of the chain; unset: the fewest whose error is below 1 %, or that more would hardly lessen"""
    static_stiffness: NonNegative | None = None
    """[N/m] by which the force falls as the head is held higher, at rest; unset: what the lowest frequencies
    lead to"""
    head_width: Positive | None = None
    """[m] of the part that may touch the wire, half to each side of the track's centre; unset: as usual"""

    @field_validator("receptance", mode="before")
    @classmethod
    def _rows(cls, value: object) -> object:
        if isinstance(value, str | Path):
            raise ValueError(
                f"{shorten(str(value))} names a table; load_pantograph reads a file with its table"
            )
        return value

    @field_validator("receptance")
    @classmethod
    def _sound(cls, rows: tuple[Row, ...]) -> tuple[Row, ...]:
        if len(rows) < LEAST_POINTS:
            raise ValueError(f"{len(rows)} frequencies: must be at least {LEAST_POINTS}")
        frequency, _, phase = np.transpose(rows)
        wrong = np.flatnonzero(np.diff(frequency) <= 0)
        if wrong.size:
            before, after = frequency[wrong[0] : wrong[0] + 2]
            raise ValueError(f"after {before:g} Hz comes {after:g} Hz; frequencies must rise")
        leads = np.sin(np.deg2rad(phase)) > _LEADS
        if 2 * leads.sum() > leads.size:
            raise ValueError(
                f"at {leads.sum()} of {leads.size} frequencies the head is ahead of the force, and so gives"
                " energy; turn the phases' sign: they lie between -180° and 0, of dynamic stiffness between 0"
                " and 180°"
            )
        return rows

    @model_validator(mode="after")
    def _fits(self) -> Self:
        try:
            assert self.chain
        except (ValueError, np.linalg.LinAlgError) as error:
            refuse([f"receptance: no chain of masses meets it: {error}"])
        return self

    @property
    def measured(self) -> tuple[Floats, Complex]:
        """Frequencies [Hz] and receptances [m/N]."""
        frequency, magnitude, phase = np.transpose(self.receptance)
        return frequency, magnitude * np.exp(1j * np.deg2rad(phase))

    @property
    def chain(self) -> MassChain:
        """What it is computed with."""
        return _fitted(self.receptance, self.order, self.static_stiffness)

    @property
    def errors(self) -> Floats:
        """Shape (frequencies,): distance of the chain's receptance from the table's, as a share of it."""
        frequency, receptance = self.measured
        return np.abs(self.chain.receptance(frequency) / receptance - 1)

    @property
    def masses(self) -> tuple[float, ...]:
        """[kg] of the chain, head first."""
        return tuple(self.chain.masses.tolist())

    @property
    def head(self) -> Panhead | None:
        """What is known of the head: its width, if it is given."""
        return Panhead(width=self.head_width) if self.head_width else None

    @property
    def panhead(self) -> Panhead:
        """A level head with one strip."""
        return self.head or Panhead()

    def assemble(
        self, *, spatial: bool, height: float | None = None, speed: float | None = None
    ) -> Substructure:
        """The chain; dampers between any two masses, and from each to the base."""
        chain, n = self.chain, len(self.chain.masses)
        D = chain.damping.tolist()
        joints = []
        for i in range(n):
            spring, lower = float(chain.springs[i]), i + 1 if i + 1 < n else BASE
            if i + 1 < n:
                joints.append(Joint(i, lower, spring, -D[i][lower]))
                joints += [Joint(i, j, 0.0, -D[i][j]) for j in range(i + 2, n) if D[i][j]]
                spring = 0.0
            joints.append(Joint(i, BASE, spring, sum(D[i])))
        return Substructure(
            bodies=tuple(map(Body, self.masses)),
            joints=tuple(joints),
            lifted=(0.0,) * (n - 1) + (1.0,),
            strips=(Strip(body=0),),
            contact=ContactLaw(self.contact_stiffness, self.contact_damping),
            follows=self.base == "contact wire",
        )

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        frequency, _ = self.measured
        names = ["mass 1 (head)", *(f"mass {n}" for n in range(2, len(self.masses) + 1))]
        return [
            ("source", self.source or "not given"),
            ("receptance", f"{len(frequency)} values, {frequency[0]:g} to {frequency[-1]:g} Hz"),
            ("met by a chain", self.fit_in_words()),
            *(
                (name, f"{m:.4g} kg on {k:.4g} N/m")
                for name, m, k in zip(names, self.masses, self.chain.springs.tolist(), strict=True)
            ),
            *self.forces_in_words(),
        ]

    def fit_in_words(self) -> str:
        """How near the chain is to the table."""
        errors, (frequency, _) = self.errors, self.measured
        worst = int(errors.argmax())
        return (
            f"{len(self.masses)} masses, off by {100 * np.sqrt((errors**2).mean()):.2g} % (root mean square),"
            f" {100 * errors[worst]:.2g} % at the most, at {frequency[worst]:.3g} Hz"
        )

    def fit_warnings(self) -> list[str]:
        """Where the chain does not meet the table, or the table does not say what a run needs."""
        (frequency, _), found = self.measured, []
        if np.sqrt((self.errors**2).mean()) > WORST_FIT:
            found.append(
                f"{self.name}: its receptance is met by {self.fit_in_words()}; look at the picture of"
                " catenary-fe pantograph for values that are off, or give another order"
            )
        if frequency[0] > LOWEST and self.static_stiffness is None:
            found.append(
                f"{self.name}: its receptance begins at {frequency[0]:g} Hz, so that its stiffness at rest is"
                f" a guess, {self.chain.static_stiffness:.3g} N/m; give static_stiffness"
            )
        if frequency[-1] < HIGHEST:
            found.append(
                f"{self.name}: its receptance ends at {frequency[-1]:g} Hz, and contact forces are judged up"
                f" to {HIGHEST:g} Hz, where the chain is a guess"
            )
        return found


@lru_cache(maxsize=64)
def _fitted(rows: tuple[Row, ...], order: int | None, static_stiffness: float | None) -> MassChain:
    frequency, magnitude, phase = np.transpose(rows)
    receptance = magnitude * np.exp(1j * np.deg2rad(phase))
    return fit_receptance(frequency, receptance, order, static_stiffness)


def receptance_table_of(path: Path, record: dict[str, Any]) -> Path | None:
    """The table that a pantograph's file names, which lies beside it. Raises InputError."""
    name = record.get("receptance")
    if not isinstance(name, str):
        return None
    if not name or Path(name).name != name:
        raise InputError(
            f"{path}: receptance = {shorten(name)}: must be the name of a table beside this file"
        )
    return path.parent / name


def read_receptance(path: Path) -> tuple[Row, ...]:
    """Rows of frequency [Hz], receptance [m/N] and phase [deg] of a table, whatever of it is given there.

    Raises InputError, one line for each fault with its row and column.
    """
    table = read_table(path, _COLUMNS, ["frequency", "phase"])
    given = [name for name in _MAGNITUDES if table.has(name)]
    if len(given) != 1:
        known = "receptance_m_per_N, apparent_mass_kg, dynamic_stiffness_N_per_m"
        raise InputError(f"{path}: row 1: {len(given)} columns of a magnitude; give one of {known}")
    faults = [
        f"{table.where(i, name)}: {'is empty' if row[name] is None else 'is 0'}; leave the row out"
        + (", and give static_stiffness" if name == "frequency" else "")
        for i, row in enumerate(table.rows)
        for name in ("frequency", *given, "phase")
        if row[name] is None or (row[name] == 0 and name != "phase")
    ]
    if faults:
        raise InputError(*faults)
    return tuple(_row(given[0], row["frequency"], row[given[0]], row["phase"]) for row in table.rows)


def _row(kind: str, frequency: float, magnitude: float, phase: float) -> Row:
    if kind == "apparent_mass":  # force by acceleration, which is -ω² times the displacement
        magnitude, phase = 1 / (magnitude * (2 * np.pi * frequency) ** 2), -phase - 180
    elif kind == "dynamic_stiffness":
        magnitude, phase = 1 / magnitude, -phase
    return frequency, magnitude, (phase + 270) % 360 - 270
