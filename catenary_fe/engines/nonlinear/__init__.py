"""Nonlinear runs in compiled code: the Exudyn model's equations and integrator, ten times as fast."""
