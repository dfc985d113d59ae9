"""What is computed with a model: statics, elasticity, runs in time."""

from catenary_fe.analysis.simulate import simulate
from catenary_fe.analysis.statics import StaticState, elasticity, solve_statics

__all__ = ["StaticState", "elasticity", "simulate", "solve_statics"]
