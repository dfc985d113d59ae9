"""Closed forms and the method of lines for strings and beams, gusts, receptances; numpy and scipy alone.

Paper: "Selected problems of wave phenomena in catenaries", its equations by number, misprints corrected and
named where they are. SI units, deflections positive upwards, x and t scalars or arrays that broadcast; an
answer has their shape unless its line says otherwise.

What follows from a wire alone is a property of its `String` or `Beam`; every other answer about wires is a
function whose first argument is that wire. A closed form of the string takes a `Beam` without stiffnesses
too, and one for beams a `String`. All raise ValueError for a value out of its range, a number that is not
finite, a position off the wire, and a wire with a stiffness that the closed form does not cover.
"""

from catenary_fe.theory.beam import (
    free_beam_shapes,
    static_deflection,
    static_deflection_unbounded,
    static_uniform_load,
    steady_moving_force,
)
from catenary_fe.theory.forces import ElasticPantograph, HarmonicForce, MovingForce, linear_law
from catenary_fe.theory.gust_response import spectrum_of_string_response, variance_of_string_response
from catenary_fe.theory.gusts import GustField, Gusts, generate_gusts
from catenary_fe.theory.infinite_string import (
    SlidingOscillator,
    deflection_under_moving_force,
    distributed_load,
    elastic_pantograph_force,
    force_at_rest,
    influence_interval,
    moving_force,
    moving_force_derivatives,
    running_waves,
    sliding_oscillator,
)
from catenary_fe.theory.method_of_lines import LinesResult, solve_by_lines
from catenary_fe.theory.pinned_wire import (
    initial_value_series,
    moving_force_by_images,
    moving_force_on_supports,
    moving_force_series,
    reflected_waves,
)
from catenary_fe.theory.receptance import MassChain, fit_receptance
from catenary_fe.theory.scattering import (
    Scattering,
    amplification_coefficient,
    doppler_factor,
    lumped_impedance,
    pulse_at_obstacle,
    reflection_coefficient,
    scatter_at_dropper,
    scatter_at_obstacle,
)
from catenary_fe.theory.wires import (
    Beam,
    String,
    angular_frequency,
    group_velocity,
    natural_frequencies,
    phase_velocity,
    wavenumber,
)

__all__ = [
    "Beam",
    "ElasticPantograph",
    "GustField",
    "Gusts",
    "HarmonicForce",
    "LinesResult",
    "MassChain",
    "MovingForce",
    "Scattering",
    "SlidingOscillator",
    "String",
    "amplification_coefficient",
    "angular_frequency",
    "deflection_under_moving_force",
    "distributed_load",
    "doppler_factor",
    "elastic_pantograph_force",
    "fit_receptance",
    "force_at_rest",
    "free_beam_shapes",
    "generate_gusts",
    "group_velocity",
    "influence_interval",
    "initial_value_series",
    "linear_law",
    "lumped_impedance",
    "moving_force",
    "moving_force_by_images",
    "moving_force_derivatives",
    "moving_force_on_supports",
    "moving_force_series",
    "natural_frequencies",
    "phase_velocity",
    "pulse_at_obstacle",
    "reflected_waves",
    "reflection_coefficient",
    "running_waves",
    "scatter_at_dropper",
    "scatter_at_obstacle",
    "sliding_oscillator",
    "solve_by_lines",
    "spectrum_of_string_response",
    "static_deflection",
    "static_deflection_unbounded",
    "static_uniform_load",
    "steady_moving_force",
    "variance_of_string_response",
    "wavenumber",
]
