"""What an engineer writes down: wires, droppers, supports, spans, pantographs; files and the library."""

from catenary_fe.layout import library
from catenary_fe.layout.as_built import AsBuilt, Drawn
from catenary_fe.layout.builders import build_line, dropper_positions
from catenary_fe.layout.catenary import Catenary, RayleighDamping
from catenary_fe.layout.conditions import (
    BaseMotion,
    Conditions,
    ContactWireIrregularity,
    Effect,
    Gusts,
    Ice,
    VehicleSuspension,
    Wind,
    WirePart,
    conditions_schema,
    load_conditions,
)
from catenary_fe.layout.current_collection import PowerSystem, target_mean_force
from catenary_fe.layout.distributions import Distribution
from catenary_fe.layout.equipment import Equipment
from catenary_fe.layout.errors import CatenaryError, InputError, RunInterrupted, SolverError, counted
from catenary_fe.layout.files import layout_schema, load_catenary, load_pantograph, pantograph_schema
from catenary_fe.layout.from_tables import catenary_from_tables
from catenary_fe.layout.installed import Wear
from catenary_fe.layout.line import Line, join_sections, read_catenary, recorded_catenary
from catenary_fe.layout.linkage import LinkagePantograph
from catenary_fe.layout.measured import MeasuredWire, read_measured
from catenary_fe.layout.overlap import Overlap
from catenary_fe.layout.panhead import AerodynamicForce, Panhead, Stage
from catenary_fe.layout.pantograph import (
    AnyPantograph,
    AttachedPantograph,
    DescribedPantograph,
    ElasticPantograph,
    Pantograph,
    recorded_pantograph,
    recorded_pantographs,
)
from catenary_fe.layout.parameters import GRAVITY
from catenary_fe.layout.parts import (
    Dropper,
    SectionEnd,
    Span,
    SteadyArm,
    StitchWire,
    Support,
    Termination,
    Wire,
)
from catenary_fe.layout.receptance import ReceptancePantograph
from catenary_fe.layout.rules import layout_warnings
from catenary_fe.layout.study import DesignVariable, Objective, Study, load_study, study_schema
from catenary_fe.layout.terminations import ends_in_words
from catenary_fe.layout.writer import layout_text

__all__ = [
    "GRAVITY",
    "AerodynamicForce",
    "AnyPantograph",
    "AsBuilt",
    "AttachedPantograph",
    "BaseMotion",
    "Catenary",
    "CatenaryError",
    "Conditions",
    "ContactWireIrregularity",
    "DescribedPantograph",
    "DesignVariable",
    "Distribution",
    "Drawn",
    "Dropper",
    "Effect",
    "ElasticPantograph",
    "Equipment",
    "Gusts",
    "Ice",
    "InputError",
    "Line",
    "LinkagePantograph",
    "MeasuredWire",
    "Objective",
    "Overlap",
    "Panhead",
    "Pantograph",
    "PowerSystem",
    "RayleighDamping",
    "ReceptancePantograph",
    "RunInterrupted",
    "SectionEnd",
    "SolverError",
    "Span",
    "Stage",
    "SteadyArm",
    "StitchWire",
    "Study",
    "Support",
    "Termination",
    "VehicleSuspension",
    "Wear",
    "Wind",
    "Wire",
    "WirePart",
    "build_line",
    "catenary_from_tables",
    "conditions_schema",
    "counted",
    "dropper_positions",
    "ends_in_words",
    "join_sections",
    "layout_schema",
    "layout_text",
    "layout_warnings",
    "library",
    "load_catenary",
    "load_conditions",
    "load_pantograph",
    "load_study",
    "pantograph_schema",
    "read_catenary",
    "read_measured",
    "recorded_catenary",
    "recorded_pantograph",
    "recorded_pantographs",
    "study_schema",
    "target_mean_force",
]
