"""What an engineer writes down: wires, droppers, supports, spans, pantographs; files and the library."""

from catenary_fe.system import library
from catenary_fe.system.catenary import Catenary, RayleighDamping
from catenary_fe.system.current_collection import PowerSystem, target_mean_force
from catenary_fe.system.errors import CatenaryError, InputError, Interrupted, SolverError, counted
from catenary_fe.system.files import layout_schema, load_catenary, load_pantograph, pantograph_schema
from catenary_fe.system.pantograph import (
    AerodynamicForce,
    AnyPantograph,
    ElasticPantograph,
    Panhead,
    Pantograph,
    Stage,
)
from catenary_fe.system.parameters import GRAVITY
from catenary_fe.system.plausibility import layout_warnings
from catenary_fe.system.span import Span
from catenary_fe.system.support import SteadyArm, Support
from catenary_fe.system.wire import Dropper, StitchWire, Wire

__all__ = [
    "GRAVITY",
    "AerodynamicForce",
    "AnyPantograph",
    "Catenary",
    "CatenaryError",
    "Dropper",
    "ElasticPantograph",
    "InputError",
    "Interrupted",
    "Panhead",
    "Pantograph",
    "PowerSystem",
    "RayleighDamping",
    "SolverError",
    "Span",
    "Stage",
    "SteadyArm",
    "StitchWire",
    "Support",
    "Wire",
    "counted",
    "layout_schema",
    "layout_warnings",
    "library",
    "load_catenary",
    "load_pantograph",
    "pantograph_schema",
    "target_mean_force",
]
