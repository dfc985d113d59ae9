"""Pictures. The only room that imports matplotlib; nothing is shown on a screen, axes are returned."""

from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
from catenary_fe.views.criteria import plot_criteria
from catenary_fe.views.layout import plot_layout
from catenary_fe.views.modes import plot_mode, plot_spectrum
from catenary_fe.views.plan import plot_plan
from catenary_fe.views.run import plot_contact_force, plot_dropper_forces, plot_energy, plot_support_uplift
from catenary_fe.views.run_waves import plot_run_waves
from catenary_fe.views.space_time import plot_family, plot_space_time, plot_surface
from catenary_fe.views.spectrum import plot_force_spectrum
from catenary_fe.views.static import plot_elasticity, plot_static_shape
from catenary_fe.views.sweep import plot_sweep_deviation, plot_sweep_forces, plot_sweep_uplift

__all__ = [
    "plot_contact_force",
    "plot_criteria",
    "plot_dropper_forces",
    "plot_elasticity",
    "plot_energy",
    "plot_family",
    "plot_force_comparison",
    "plot_force_spectrum",
    "plot_layout",
    "plot_mode",
    "plot_plan",
    "plot_run_waves",
    "plot_space_time",
    "plot_spectrum",
    "plot_static_shape",
    "plot_support_uplift",
    "plot_surface",
    "plot_sweep_deviation",
    "plot_sweep_forces",
    "plot_sweep_uplift",
    "plot_uplift_comparison",
]
