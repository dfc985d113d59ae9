"""Eigenfrequencies and shapes of a line, what kind of motion each of them is, and a run as a sum of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from numbers import Integral
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.layout import Catenary, InputError, counted
from catenary_fe.layout.arguments import checked, number, numbers, on_the_wire, one_of, whole
from catenary_fe.layout.parameters import changed_by_copy, shorten

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
Symmetry = Literal["symmetric", "antisymmetric", "neither"]

IN_WORDS = {"along": "along the track", "sideways": "sideways"}  # kinds that have no half-waves
_ALIKE = 0.7  # correlation with the mirror image from which a shape counts as symmetric
_SHAPES = 6  # half-waves in a bay that are told apart
_SAMPLES = 24  # of a bay


@changed_by_copy
@dataclass(frozen=True)
class ModeKind:
    """What a mode looks like, found by computation.

    symmetry : about the line's middle; 'neither' where bays far apart swing on their own
    kind : 'whole line': the clamps move with the wires; 'bays': the wires swing between clamps that stay;
        'along': the wires move along the track; 'sideways': across it
    half_waves : of the whole line, or of the bays (1: first shape, 2: second shape …)
    """

    symmetry: Symmetry
    kind: Literal["whole line", "bays", "along", "sideways"]
    half_waves: int

    def __str__(self) -> str:
        if self.kind in ("along", "sideways"):
            return IN_WORDS[self.kind]
        waves = "half-wave" if self.half_waves == 1 else "half-waves"
        where = f"whole line, {self.half_waves} {waves}"
        if self.kind == "bays":
            where = f"bays in shape {self.half_waves}"
        return f"{self.symmetry}, {where}" if self.symmetry != "neither" else where


@changed_by_copy
@dataclass(frozen=True)
class WireShapes:
    """Shapes of one wire, vertical unless stated otherwise, mass-normalised over the whole line.

    x : [m], shape (nodes,)
    values : [1/√kg], shape (modes, nodes)
    slopes : [1/(m √kg)], shape (modes, nodes)
    lateral : [1/√kg], shape (modes, nodes), to the left; none in the plane
    """

    x: Floats
    values: Floats
    slopes: Floats
    lateral: Floats | None = None

    def at(self, x: ArrayLike) -> Floats:
        """[1/√kg], shape (modes, points): shapes at positions [m], cubic inside the elements.

        Raises InputError beyond the wire's ends.
        """
        from scipy.interpolate import CubicHermiteSpline

        spline = CubicHermiteSpline(self.x, self.values.T, self.slopes.T, axis=0)
        shapes: Floats = spline(on_the_wire("x", x, self.x)).T
        return shapes

    def first(self, count: int) -> WireShapes:
        """Only the first modes."""
        lateral = None if self.lateral is None else self.lateral[:count]
        return WireShapes(self.x, self.values[:count], self.slopes[:count], lateral)


@changed_by_copy
@dataclass(frozen=True)
class Modes:
    """Modes of a line about its static state, droppers taut, in rising order.

    catenary : the line
    frequencies : [Hz], shape (modes,)
    contact, messenger : shapes of the wires; None without a messenger wire
    along, sideways : shape (modes,), shares of the kinetic energy that move along the track and across it
    damping_ratios : shape (modes,), of critical damping
    """

    catenary: Catenary
    frequencies: Floats
    contact: WireShapes
    messenger: WireShapes | None
    along: Floats
    sideways: Floats
    damping_ratios: Floats

    def __len__(self) -> int:
        return int(self.frequencies.size)

    def below(self, frequency: float) -> Modes:
        """Only the modes up to a frequency [Hz]. Raises InputError for what is not one."""
        frequency = number("frequency", frequency, "Hz", above=0.0)
        n = int(np.searchsorted(self.frequencies, frequency, side="right"))
        return Modes(
            self.catenary,
            self.frequencies[:n],
            self.contact.first(n),
            self.messenger and self.messenger.first(n),
            self.along[:n],
            self.sideways[:n],
            self.damping_ratios[:n],
        )

    def compliance(self, positions: ArrayLike) -> Floats:
        """[m/N], shape (points,): lift of the contact wire under a unit force there, Σ φ²/ω²."""
        shapes = self.contact.at(positions)
        omega = 2 * np.pi * self.frequencies.reshape(-1, *(1,) * (shapes.ndim - 1))
        compliance: Floats = (shapes**2 / omega**2).sum(axis=0)
        return compliance

    def kind(self, mode: int) -> ModeKind:
        """What a mode (from 0) looks like. Raises InputError for one that was not computed."""
        if not isinstance(mode, Integral) or isinstance(mode, bool) or not 0 <= int(mode) < len(self):
            raise InputError(f"mode {shorten(mode)}: computed: {counted(len(self), 'mode')}, numbered from 0")
        if self.along[mode] + self.sideways[mode] > 0.5:
            return ModeKind("neither", "along" if self.along[mode] > self.sideways[mode] else "sideways", 0)
        symmetry = self._symmetry(mode)
        moving, bays = 0.0, np.zeros(_SHAPES)
        for wire, x, shape in self._bay_samples(mode):
            of_clamps, of_bays = _bay_energies(x, shape)
            moving += wire * of_clamps
            bays += wire * of_bays
        if moving > bays.sum():
            return ModeKind(symmetry, "whole line", self._half_waves(mode))
        return ModeKind(symmetry, "bays", int(bays.argmax()) + 1)

    def kinds(self) -> list[ModeKind]:
        """What each mode looks like."""
        return [self.kind(i) for i in range(len(self))]

    def table(self) -> list[dict[str, Any]]:
        """Rows of plain numbers and words, one a mode, numbered from 1."""
        return [
            {
                "mode": i + 1,
                "frequency_Hz": float(self.frequencies[i]),
                "damping_ratio": float(self.damping_ratios[i]),
                "kind": kind.kind,
                "half_waves": kind.half_waves,
                "symmetry": kind.symmetry,
            }
            for i, kind in enumerate(self.kinds())
        ]

    def count_by_kind(self) -> Counter[str]:
        """Number of modes of each kind: 'whole line', 'bays 1' …, 'along', 'sideways'."""
        return Counter(f"bays {k.half_waves}" if k.kind == "bays" else k.kind for k in self.kinds())

    def plot(self, mode: int, ax: Axes | None = None) -> Axes:
        """Draw a mode (from 0). See :func:`catenary_fe.views.plot_mode`."""
        from catenary_fe.views import plot_mode

        return plot_mode(self, mode, ax=ax)

    def _wires(self) -> list[tuple[float, WireShapes]]:
        catenary = self.catenary
        wires = [(catenary.contact_wire.mass_per_length, self.contact)]
        if catenary.messenger_wire and self.messenger:
            wires.append((catenary.messenger_wire.mass_per_length, self.messenger))
        return wires

    def _symmetry(self, mode: int) -> Symmetry:
        """By the correlation of the shape with its mirror image, weighted with the wires' masses."""
        x = np.linspace(0, self.catenary.length, 40 * len(self.catenary.spans) + 1)
        own = both = 0.0
        for mass, wire in self._wires():
            shape = np.interp(x, wire.x, wire.values[mode])
            own += mass * float(shape @ shape)
            both += mass * float(shape @ shape[::-1])
        if both > _ALIKE * own:
            return "symmetric"
        return "antisymmetric" if both < -_ALIKE * own else "neither"

    def _bay_samples(self, mode: int) -> list[tuple[float, Floats, Floats]]:
        """For each bay, from clamp or support to the next: mass per length, positions, shape."""
        catenary = self.catenary
        supports, droppers = catenary.support_positions, catenary.dropper_positions
        registered = np.array([i in (0, supports.size - 1) or s.steady_arm is not None
                               for i, s in enumerate(catenary.supports)])  # fmt: skip
        samples = []
        for (mass, wire), held in zip(self._wires(), (supports[registered], supports), strict=False):
            for a, b in pairwise(np.unique(np.concatenate([held, droppers]))):
                x = np.linspace(a, b, _SAMPLES + 1)
                samples.append((mass, x, np.interp(x, wire.x, wire.values[mode])))
        return samples

    def _half_waves(self, mode: int) -> int:
        """Counted on the messenger and contact wire's common motion at the clamps, supports left out."""
        at = self.catenary.dropper_positions
        motion = np.zeros(at.size)
        for mass, wire in self._wires():
            motion += mass * np.interp(at, wire.x, wire.values[mode])
        strong = motion[np.abs(motion) > 0.02 * np.abs(motion).max()]
        return 1 + int((np.diff(np.sign(strong)) != 0).sum())


def _bay_energies(x: Floats, shape: Floats) -> tuple[float, Floats]:
    """Mean squares times length: of the straight line between a bay's ends, and of the sines on it."""
    length, fraction = x[-1] - x[0], np.linspace(0.0, 1.0, x.size)
    chord = shape[0] + (shape[-1] - shape[0]) * fraction
    a, b = shape[0], shape[-1]
    n = np.arange(1, _SHAPES + 1)
    sines = np.sin(np.pi * np.outer(n, fraction))
    amplitudes = 2 * (sines @ (shape - chord)) / (x.size - 1)
    return length * (a * a + a * b + b * b) / 3, length * amplitudes**2 / 2


@changed_by_copy
@dataclass(frozen=True)
class ModalRun:
    """One pantograph on a line whose response is a sum of a limited number of eigenforms.

    modes : those that were summed
    time : [s], shape (times,)
    position : [m], shape (times,), of the pantograph along the track
    contact_force : [N], shape (times,)
    wire_height : [m], shape (times,), of the contact wire over the head, above the rail
    mass_height : [m], shape (masses, times), above the rail; no masses for an elastic pantograph
    coordinates : [m √kg], shape (times, modes)
    """

    modes: Modes
    time: Floats
    position: Floats
    contact_force: Floats
    wire_height: Floats
    mass_height: Floats
    coordinates: Floats

    @checked
    def uplift(self, x: ArrayLike, every: int = 1) -> Floats:
        """[m], shape (times, points): uplift of the contact wire at positions [m], at every n-th time."""
        whole("every", every, least=1)
        uplift: Floats = np.tensordot(self.coordinates[::every], self.modes.contact.at(x), axes=1)
        return uplift

    @checked
    def error_against(self, signal: ArrayLike, of: str = "contact_force") -> float:
        """Root mean square of the difference to a signal of the same times, over the signal's deviation.

        of : "contact_force" or "wire_height"

        Raises InputError for a signal of other times, or one that is constant.
        """
        one_of("of", of, ("contact_force", "wire_height"))
        full = numbers("signal", signal, shape=self.time.shape, each="one value a time")
        if np.ptp(full) == 0:
            raise InputError("signal is constant: it has no deviation to compare with")
        return float(np.sqrt(np.mean((getattr(self, of) - full) ** 2)) / full.std())
