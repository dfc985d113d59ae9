"""Finite-element multibody simulation of railway catenaries and the pantographs that slide along them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn import ExudynModel, exudyn_model
    from catenary_fe.engines.settings import TimeSettings
    from catenary_fe.fe import MeshSettings
    from catenary_fe.fe.wire_problem import (
        SlidingPantograph,
        WireMotion,
        WireProblem,
        even_nodes,
        graded_nodes,
    )
    from catenary_fe.layout import (
        AerodynamicForce,
        Catenary,
        CatenaryError,
        Dropper,
        ElasticPantograph,
        Equipment,
        InputError,
        Line,
        Overlap,
        Panhead,
        Pantograph,
        RayleighDamping,
        RunInterrupted,
        SectionEnd,
        SolverError,
        Span,
        Stage,
        SteadyArm,
        StitchWire,
        Support,
        Termination,
        Wear,
        Wire,
        build_line,
        catenary_from_tables,
        join_sections,
        layout_warnings,
        library,
        load_catenary,
        load_pantograph,
        read_measured,
        target_mean_force,
    )
    from catenary_fe.results import (
        Criterion,
        Elasticity,
        ForceStatistics,
        ModalRun,
        Modes,
        Run,
        criteria_rows,
        load_run,
        save_catenary,
    )
    from catenary_fe.results.line_test import (
        LineTest,
        LineTestComparison,
        MeasuredPass,
        compare_with_line_test,
        read_line_test,
    )
    from catenary_fe.statics import Shape, against_design, find_form, find_heights, fit_measured
    from catenary_fe.statics.elasticity import StaticState, elasticity, solve_statics
    from catenary_fe.studies import modal_run, simulate, solve_modes
    from catenary_fe.studies.single_wire import run_wire

# loaded on first use: importing the package stays quick
_ROOMS = {
    "engines.modal.modes": ("solve_modes",),
    "engines.modal.run": ("modal_run",),
    "engines.settings": ("TimeSettings",),
    "engines.exudyn": ("ExudynModel", "exudyn_model"),
    "studies.single_wire": ("run_wire",),
    "statics": ("Shape", "against_design", "find_form", "find_heights", "fit_measured"),
    "statics.elasticity": ("StaticState", "elasticity", "solve_statics"),
    "fe": ("MeshSettings",),
    "fe.wire_problem": ("SlidingPantograph", "WireMotion", "WireProblem", "even_nodes", "graded_nodes"),
    "results": (
        "Criterion",
        "Elasticity",
        "ForceStatistics",
        "ModalRun",
        "Modes",
        "Run",
        "criteria_rows",
        "load_run",
        "save_catenary",
    ),
    "results.line_test": (
        "LineTest",
        "LineTestComparison",
        "MeasuredPass",
        "compare_with_line_test",
        "read_line_test",
    ),
    "studies.simulate": ("simulate",),
    "layout": (
        "AerodynamicForce",
        "Catenary",
        "CatenaryError",
        "Dropper",
        "ElasticPantograph",
        "Equipment",
        "Equipment",
        "InputError",
        "Line",
        "Overlap",
        "RunInterrupted",
        "SectionEnd",
        "Panhead",
        "Pantograph",
        "RayleighDamping",
        "SolverError",
        "Span",
        "Stage",
        "SteadyArm",
        "StitchWire",
        "Support",
        "Termination",
        "Wear",
        "Wire",
        "build_line",
        "catenary_from_tables",
        "join_sections",
        "layout_warnings",
        "MeasuredWire",
        "read_measured",
        "library",
        "load_catenary",
        "load_pantograph",
        "target_mean_force",
    ),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}

__all__ = [
    "AerodynamicForce",
    "Catenary",
    "CatenaryError",
    "Criterion",
    "Dropper",
    "ElasticPantograph",
    "Elasticity",
    "Equipment",
    "ExudynModel",
    "ForceStatistics",
    "InputError",
    "Line",
    "LineTest",
    "LineTestComparison",
    "MeasuredPass",
    "MeasuredWire",
    "MeshSettings",
    "ModalRun",
    "Modes",
    "Overlap",
    "Panhead",
    "Pantograph",
    "RayleighDamping",
    "Run",
    "RunInterrupted",
    "SectionEnd",
    "Shape",
    "SlidingPantograph",
    "SolverError",
    "Span",
    "Stage",
    "StaticState",
    "SteadyArm",
    "StitchWire",
    "Support",
    "Termination",
    "TimeSettings",
    "Wear",
    "Wire",
    "WireMotion",
    "WireProblem",
    "against_design",
    "build_line",
    "catenary_from_tables",
    "compare_with_line_test",
    "criteria_rows",
    "elasticity",
    "even_nodes",
    "exudyn_model",
    "find_form",
    "find_heights",
    "fit_measured",
    "graded_nodes",
    "join_sections",
    "layout_warnings",
    "library",
    "load_catenary",
    "load_pantograph",
    "load_run",
    "modal_run",
    "read_line_test",
    "read_measured",
    "run_wire",
    "save_catenary",
    "simulate",
    "solve_modes",
    "solve_statics",
    "target_mean_force",
]


def __getattr__(name: str) -> Any:
    room = _ROOM_OF.get(name)
    if room is None:
        raise AttributeError(f"module 'catenary_fe' has no attribute {name!r}")
    return getattr(import_module(f"catenary_fe.{room}"), name)


def __dir__() -> list[str]:
    return __all__
