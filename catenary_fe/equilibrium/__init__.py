"""Form finding: dropper lengths and the static shape."""

from catenary_fe.equilibrium.hang import find_form, find_heights
from catenary_fe.equilibrium.schedules import ArmRow, DropperRow, SupportRow
from catenary_fe.equilibrium.shape import HangingWire, Shape, check_shape

__all__ = [
    "ArmRow",
    "DropperRow",
    "HangingWire",
    "Shape",
    "SupportRow",
    "check_shape",
    "find_form",
    "find_heights",
]
