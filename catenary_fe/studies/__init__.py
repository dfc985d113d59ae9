"""What is computed with a line: runs in time, sweeps of runs, runs again."""

from catenary_fe.engines.modal.modes import solve_modes
from catenary_fe.engines.modal.run import modal_run
from catenary_fe.statics.elasticity import StaticState, elasticity, solve_statics
from catenary_fe.studies.rerun import Rerun, rerun
from catenary_fe.studies.simulate import simulate
from catenary_fe.studies.stepping import Session, stepping

__all__ = [
    "Rerun",
    "Session",
    "StaticState",
    "elasticity",
    "modal_run",
    "rerun",
    "simulate",
    "solve_modes",
    "solve_statics",
    "stepping",
]
