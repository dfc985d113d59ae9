"""What an engineer writes down: wires, droppers, supports, spans, pantographs; files and the library."""

from catenary_fe.system import library
from catenary_fe.system.catenary import Catenary, RayleighDamping, Span, SteadyArm, Support
from catenary_fe.system.errors import CatenaryError, InputError, SolverError
from catenary_fe.system.files import layout_schema, load_catenary, load_pantograph, pantograph_schema
from catenary_fe.system.pantograph import (
    AerodynamicForce,
    AnyPantograph,
    ElasticPantograph,
    Pantograph,
    Stage,
    target_mean_force,
)
from catenary_fe.system.plausibility import layout_warnings
from catenary_fe.system.wire import Dropper, Wire

__all__ = [
    "AerodynamicForce",
    "AnyPantograph",
    "Catenary",
    "CatenaryError",
    "Dropper",
    "ElasticPantograph",
    "InputError",
    "Pantograph",
    "RayleighDamping",
    "SolverError",
    "Span",
    "Stage",
    "SteadyArm",
    "Support",
    "Wire",
    "layout_schema",
    "layout_warnings",
    "library",
    "load_catenary",
    "load_pantograph",
    "pantograph_schema",
    "target_mean_force",
]
