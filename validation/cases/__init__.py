"""The cases, by name, in the order of the report; what takes long comes last."""

from importlib import import_module

from validation.case import Case

_MODULES = (
    "closed_forms",
    "point_force",
    "sag",
    "stiff_wire_statics",
    "natural_frequencies",
    "pulse_and_echo",
    "convergence",
    "convergence_of_runs",
    "convergence_of_a_line",
    "dropper",
    "moving_force",
    "force_at_rest",
    "harmonic_force",
    "bounded_string",
    "supports_every_6_m",
    "elastic_foundation",
    "obstacle",
    "dispersion",
    "sliding_oscillator",
    "elastic_pantograph",
    "energy",
    "method_of_lines",
    "en50318_2002_statics",
    "en50318_2002_300",
    "en50318_2002_250",
    "en50318_2018_ac_simple",
)
CASES: dict[str, Case] = {
    case.name: case for name in _MODULES for case in [import_module(f"validation.cases.{name}").CASE]
}
