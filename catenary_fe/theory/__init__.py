"""Closed forms and the method of lines for strings and tensioned beams; numpy and scipy alone.

Paper: "Selected problems of wave phenomena in catenaries", its equations by number, slips of the print put
right and named where they are. SI units, deflections positive upwards, x and t scalars or arrays that
broadcast.
"""

from catenary_fe.theory.bounded_moving_force import moving_force_by_images, moving_force_series
from catenary_fe.theory.bounded_string import (
    initial_value_series,
    reflected_waves,
    standing_wave,
    static_deflection,
)
from catenary_fe.theory.dispersion import (
    angular_frequency,
    group_velocity,
    natural_frequencies,
    phase_velocity,
    wavenumber,
)
from catenary_fe.theory.elastic_foundation import critical_speed, steady_moving_force
from catenary_fe.theory.forces import HarmonicForce
from catenary_fe.theory.infinite_string import distributed_load, general_solution, running_waves, wave_speed
from catenary_fe.theory.method_of_lines import (
    ElasticPantograph,
    LinesResult,
    MovingForce,
    linear_law,
    solve_by_lines,
)
from catenary_fe.theory.point_force import (
    deflection_under_moving_force,
    force_at_rest,
    influence_interval,
    moving_force,
    moving_force_derivatives,
)
from catenary_fe.theory.pulse import pulse_at_obstacle
from catenary_fe.theory.scattering import (
    DropperScattering,
    Scattering,
    amplification_coefficient,
    characteristic_impedance,
    doppler_factor,
    lumped_impedance,
    reflection_coefficient,
    scatter_at_dropper,
    scatter_at_joint,
    scatter_at_obstacle,
)
from catenary_fe.theory.sliding_pantograph import (
    SlidingOscillator,
    elastic_pantograph_force,
    sliding_oscillator,
)
from catenary_fe.theory.supported_string import moving_force_on_supports
from catenary_fe.theory.tensioned_beam import (
    beam_free_waves,
    beam_moving_force,
    beam_point_force,
    beam_point_force_unbounded,
    beam_uniform_load,
    boundary_layer_length,
)

__all__ = [
    "DropperScattering",
    "ElasticPantograph",
    "HarmonicForce",
    "LinesResult",
    "MovingForce",
    "Scattering",
    "SlidingOscillator",
    "amplification_coefficient",
    "angular_frequency",
    "beam_free_waves",
    "beam_moving_force",
    "beam_point_force",
    "beam_point_force_unbounded",
    "beam_uniform_load",
    "boundary_layer_length",
    "characteristic_impedance",
    "critical_speed",
    "deflection_under_moving_force",
    "distributed_load",
    "doppler_factor",
    "elastic_pantograph_force",
    "force_at_rest",
    "general_solution",
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
    "scatter_at_joint",
    "scatter_at_obstacle",
    "sliding_oscillator",
    "solve_by_lines",
    "standing_wave",
    "static_deflection",
    "steady_moving_force",
    "wave_speed",
    "wavenumber",
]
