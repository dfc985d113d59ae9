"""Pictures. The only room that imports matplotlib; nothing is shown on a screen, axes are returned."""

from catenary_fe.views.cases import plot_cases
from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
from catenary_fe.views.design import plot_design
from catenary_fe.views.dxf import write_dxf
from catenary_fe.views.film import film
from catenary_fe.views.heights import plot_heights
from catenary_fe.views.layout import plot_layout, plot_plan
from catenary_fe.views.line_test import plot_line_test
from catenary_fe.views.pantograph import plot_pantograph
from catenary_fe.views.run import (
    plot_contact_force,
    plot_contact_lateral,
    plot_criteria,
    plot_dropper_forces,
    plot_energy,
    plot_force_spectrum,
    plot_handover,
    plot_support_uplift,
)
from catenary_fe.views.scatter import (
    plot_force_bands,
    plot_scatter,
    plot_scatter_inputs,
    plot_sensitivity,
)
from catenary_fe.views.static import plot_elasticity, plot_mode, plot_spectrum, plot_static_shape
from catenary_fe.views.sweep import (
    plot_force_envelopes,
    plot_sweep_deviation,
    plot_sweep_forces,
    plot_sweep_uplift,
    plot_verdicts,
)
from catenary_fe.views.waves import plot_family, plot_run_waves, plot_space_time, plot_surface

__all__ = [
    "film", "plot_cases", "plot_contact_force", "plot_contact_lateral", "plot_criteria",
    "plot_design", "plot_dropper_forces", "plot_elasticity", "plot_energy",
    "plot_family", "plot_force_bands", "plot_force_comparison", "plot_force_envelopes",
    "plot_force_spectrum", "plot_handover", "plot_heights", "plot_layout", "plot_line_test",
    "plot_mode", "plot_pantograph", "plot_plan", "plot_run_waves", "plot_scatter", "plot_scatter_inputs",
    "plot_sensitivity", "plot_space_time", "plot_spectrum",
    "plot_static_shape", "plot_support_uplift", "plot_surface", "plot_sweep_deviation", "plot_sweep_forces",
    "plot_sweep_uplift", "plot_uplift_comparison", "plot_verdicts", "write_dxf",
]  # fmt: skip
