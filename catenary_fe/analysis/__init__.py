"""What is computed with a model: statics, elasticity, modes, runs in time."""

from catenary_fe.analysis.modal_run import modal_run
from catenary_fe.analysis.modes import solve_modes
from catenary_fe.analysis.repeat import Repetition, repeat
from catenary_fe.analysis.simulate import simulate
from catenary_fe.equilibrium.statics import StaticState, elasticity, solve_statics

__all__ = [
    "Repetition",
    "StaticState",
    "elasticity",
    "modal_run",
    "repeat",
    "simulate",
    "solve_modes",
    "solve_statics",
]
