"""Pictures. The only room that imports matplotlib; nothing is shown on a screen, axes are returned."""

from catenary_fe.views.layout import plot_elasticity, plot_layout, plot_static_shape
from catenary_fe.views.run import plot_contact_force, plot_dropper_forces, plot_support_uplift

__all__ = [
    "plot_contact_force",
    "plot_dropper_forces",
    "plot_elasticity",
    "plot_layout",
    "plot_static_shape",
    "plot_support_uplift",
]
