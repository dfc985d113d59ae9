"""Form finding: dropper lengths and the static shape."""

from catenary_fe.equilibrium.form import find_form, find_heights
from catenary_fe.equilibrium.schedules import ArmRow, DropperRow, SupportRow
from catenary_fe.equilibrium.shape import HangingWire, Shape

__all__ = ["ArmRow", "DropperRow", "HangingWire", "Shape", "SupportRow", "find_form", "find_heights"]
