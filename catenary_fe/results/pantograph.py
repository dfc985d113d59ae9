"""What a pantograph is by itself: own frequencies, how its head yields at each frequency, static force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import AnyPantograph, InputError
from catenary_fe.layout.arguments import checked, number, numbers
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.layout.substructure import Substructure
from catenary_fe.results.files import write_text

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

LOWEST, HIGHEST, VALUES = 0.1, 50.0, 400  # [Hz] and number of the frequencies that are usual
REACH = 0.5  # [m] above and below the base spring's force-free height, of static forces
_STEPS = 20  # of that range
_PASSES, _SETTLED = 50, 1e-9  # of what is not linear, and [m] by which it may still move
_STILL = 1e-6  # share of the highest own frequency below which one is that of a body that nothing holds


@changed_by_copy
@dataclass(frozen=True)
class PantographResponse:
    """A pantograph whose base is at rest, without the wire.

    pantograph : the pantograph
    uplift : [N] force on the lowest mass; of an elastic pantograph, its force at the nominal height
    own_frequencies : [Hz], shape (modes,), rising; of two poles without oscillation, their geometric mean
    damping_ratios : shape (modes,), of critical damping; no number for a body that nothing holds
    frequency : [Hz], shape (frequencies,)
    receptance : [m/N], shape (frequencies,), complex: displacement of the head for each newton on it; empty
        for an elastic pantograph whose force does not depend on the height
    height : [m], shape (heights,), of the head above where its base's spring is force-free
    force : [N], shape (heights,), of the head on a wire at rest there
    """

    pantograph: AnyPantograph
    uplift: float
    own_frequencies: Floats
    damping_ratios: Floats
    frequency: Floats
    receptance: Complex
    height: Floats
    force: Floats

    @property
    def dynamic_stiffness(self) -> Complex:
        """[N/m], shape (frequencies,): force on the head for each metre of its displacement."""
        return 1 / self.receptance

    @property
    def apparent_mass(self) -> Complex:
        """[kg], shape (frequencies,): force on the head for each m/s² of its acceleration."""
        omega = 2 * np.pi * self.frequency
        return np.asarray(-self.dynamic_stiffness / omega**2)

    @property
    def force_varies(self) -> bool:
        """Whether the static force depends on the height by more than a hundredth."""
        return bool(np.ptp(self.force) > 0.01 * max(self.uplift, 1e-9))

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON; display units in the names."""
        ratios = [None if np.isnan(ratio) else ratio for ratio in self.damping_ratios.tolist()]
        table = {
            "frequency_Hz": self.frequency.tolist(),
            "magnitude_m_per_N": np.abs(self.receptance).tolist(),
            "phase_deg": np.rad2deg(np.angle(self.receptance)).tolist(),
        }
        return {
            "name": self.pantograph.name,
            "kind": self.pantograph.kind,
            "static_uplift_N": self.uplift,
            "masses_kg": list(self.pantograph.masses),
            "frequencies_Hz": self.own_frequencies.tolist(),
            "damping_ratios": ratios,
            "receptance": table if self.receptance.size else None,
            "static_force": {"height_m": self.height.tolist(), "force_N": self.force.tolist()},
        }

    def plot(self) -> Any:
        """As :func:`catenary_fe.views.plot_pantograph`."""
        from catenary_fe.views import plot_pantograph

        return plot_pantograph(self)


@checked
def pantograph_response(
    pantograph: AnyPantograph, frequencies: Sequence[float] | None = None, *, speed: float = 0.0
) -> PantographResponse:
    """Own frequencies, receptance and static force of a pantograph on a base at rest, without the wire.

    They are closed forms of its masses, springs and dampers. Two strips are pressed down together. Of what is
    not linear, stops are in the static force; own frequencies and receptance are without it, with the smaller
    of two dampers.

    frequencies : [Hz], of the receptance, above 0; unset: 400 from 0.1 to 50 Hz
    speed : [m/s], at which the uplift force is

    Raises InputError.
    """
    found = np.geomspace(LOWEST, HIGHEST, VALUES)
    if frequencies is not None:
        found = numbers("frequencies", frequencies)
        if found.ndim != 1 or not found.size or (found <= 0).any():
            raise InputError("frequencies: must be a list of frequencies above 0 Hz; give one at least")
    uplift = pantograph.static_uplift(number("speed", speed, "m/s", least=0.0))
    body = pantograph.assemble(spatial=False, speed=speed)
    heights = np.linspace(-REACH, REACH, _STEPS + 1)
    own, ratios = _modes(body)
    forces = np.maximum(0.0, _static_forces(body, uplift, heights))
    return PantographResponse(
        pantograph, uplift, own, ratios, found, _receptance(body, found), heights, forces
    )


@checked
def receptance_table(
    pantograph: AnyPantograph, path: str | Path, frequencies: Sequence[float] | None = None
) -> Path:
    """Write the receptance of a pantograph as a table, which a pantograph's file may name; returns its path.

    frequencies : [Hz], as of :func:`pantograph_response`

    Raises InputError for a path that cannot be written, and for a pantograph without a receptance.
    """
    response = pantograph_response(pantograph, frequencies)
    if not response.receptance.size:
        raise InputError(f"{pantograph.name}: its force is the same at any height: it has no receptance")
    write_text(path, receptance_text(response))
    return Path(path)


def receptance_text(response: PantographResponse) -> str:
    """The receptance as a table, with all digits."""
    table = response.as_dict()["receptance"]
    rows = zip(*table.values(), strict=True)
    lines = ["frequency_Hz,receptance_m_per_N,phase_deg"]
    lines += [",".join(f"{value:.12g}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


def _head(body: Substructure) -> Floats:
    """Shape (coordinates,): the head's height as made of the coordinates; the mean of several strips."""
    return np.asarray(np.mean([body.row(strip) for strip in body.strips], axis=0))


def _receptance(body: Substructure, frequency: Floats) -> Complex:
    """[m/N], shape (frequencies,)."""
    if not body.size:
        slope = body.contact.slope(0.0)
        return np.full(frequency.size if slope else 0, 1 / slope if slope else 0.0, dtype=np.complex128)
    omega, head = 2 * np.pi * frequency[:, None, None], _head(body)
    Z = body.stiffness + 1j * omega * body.damping - omega**2 * body.mass
    return np.asarray(np.linalg.solve(Z, head[:, None])[..., 0] @ head, dtype=np.complex128)


def _static_forces(body: Substructure, uplift: float, heights: Floats) -> Floats:
    """[N] on a wire that holds the head at heights [m]: K y + laws = uplift · load - force · head."""
    if not body.size:
        return np.array([body.contact.force(-z) for z in heights])
    n, head, found = body.size, _head(body), np.zeros(heights.size)
    for i, z in enumerate(heights.tolist()):
        y = np.full(n, z)
        for _ in range(_PASSES):
            pull, tangent, _ = body.static_laws(y)
            matrix = np.block([[body.stiffness + tangent, head[:, None]], [head[None, :], np.zeros((1, 1))]])
            right = np.concatenate([uplift * body.load - pull + tangent @ y, [z]])
            before, solved = y, np.linalg.solve(matrix, right)
            y, found[i] = solved[:n], solved[n]
            if np.abs(y - before).max() < _SETTLED:
                break
    return found


def _modes(body: Substructure) -> tuple[Floats, Floats]:
    """Own frequencies [Hz] and damping ratios of pairs of poles."""
    n = body.size
    if not n:
        return np.zeros(0), np.zeros(0)
    inverse = np.linalg.inv(body.mass)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ body.stiffness, -inverse @ body.damping]])
    poles = np.linalg.eigvals(state).astype(np.complex128)
    real = poles[poles.imag == 0].real
    real = real[np.argsort(np.abs(real))]
    upper = poles[poles.imag > 0]
    squares = np.concatenate([np.abs(upper) ** 2, real[::2] * real[1::2]])
    own = np.sqrt(np.maximum(squares, 0.0))
    decay = np.concatenate([-upper.real, -(real[::2] + real[1::2]) / 2])
    held = own > _STILL * own.max()
    ratios = np.full(n, np.nan)
    ratios[held] = decay[held] / own[held]
    order = np.argsort(own)
    return (np.where(held, own, 0.0) / (2 * np.pi))[order], ratios[order]
