"""What is computed with a model: statics, elasticity, runs in time."""

from catenary_fe.analysis.checks import layout_warnings
from catenary_fe.analysis.simulate import simulate
from catenary_fe.analysis.statics import StaticState, elasticity, solve_statics

__all__ = ["StaticState", "elasticity", "layout_warnings", "simulate", "solve_statics"]
