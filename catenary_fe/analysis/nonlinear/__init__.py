"""Nonlinear runs in compiled code: the equations of the Exudyn model, the same integrator, ten times as fast."""
