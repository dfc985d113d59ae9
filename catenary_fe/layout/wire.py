"""Wires under tension and the droppers that join them."""

from __future__ import annotations

from typing import Literal

from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive, Text
from catenary_fe.theory import Beam


class Wire(Parameters):
    """A wire under a constant tension: contact wire or messenger wire."""

    mass_per_length: Positive
    """[kg/m] of the wire as installed"""
    tension: Positive
    """[N] along the wire, held by tensioning weights"""
    axial_stiffness: Positive
    """[N] EA, cross-section times Young's modulus"""
    bending_stiffness: NonNegative = 0.0
    """[N m²] EI"""
    name: Text = ""
    """what the wire is, e.g. 'AC-150'"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""

    @property
    def beam(self) -> Beam:
        """The wire as the closed forms of `catenary_fe.theory` take it."""
        return Beam(
            tension=self.tension,
            mass_per_length=self.mass_per_length,
            bending_stiffness=self.bending_stiffness,
        )

    @property
    def wave_speed(self) -> float:
        """[m/s] of transverse waves, √(T/ρ)."""
        return self.beam.wave_speed

    @property
    def impedance(self) -> float:
        """[N s/m] √(T ρ), force over velocity of a wave running one way."""
        return self.beam.impedance


class Dropper(Parameters):
    """A dropper: a spring in tension that goes slack instead of pushing, with its mass and clamps."""

    position: Number
    """[m] from the span's first support"""
    length: Positive | None = None
    """[m] stress-free, from clamp to clamp, where it is given; unset: form finding decides"""
    stiffness: Positive = 1e5
    """[N/m] of the whole dropper in tension"""
    damping: NonNegative = 0.0
    """[N s/m] of the whole dropper while it is taut"""
    mass_per_length: NonNegative = 0.0
    """[kg/m], lumped half to each end"""
    messenger_clamp_mass: NonNegative = 0.0
    """[kg] of the clamp at its upper end, on the messenger wire or the stitch wire"""
    contact_wire_clamp_mass: NonNegative = 0.0
    """[kg] of the clamp at its lower end"""
    height_offset: Number | None = None
    """[m] design height of the contact wire here above the nominal one; unset: the span's pre-sag decides"""
    contact_wire: Literal[1, 2] | None = None
    """which of two contact wires hangs here, the right (1) or the left (2) one; unset: in turns"""


class StitchWire(Wire):
    """A wire clamped on the messenger wire to both sides of a support, from which the next droppers hang.

    `tension` is what it has when installed; no weights hold it.
    """

    length: Positive
    """[m] along the track, half of it to each side of the support"""
    clamp_mass: NonNegative = 0.0
    """[kg] of each of the two clamps on the messenger wire"""
