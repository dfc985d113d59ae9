"""Form finding: dropper lengths and the static shape."""

from catenary_fe.equilibrium.hang import find_form, find_heights
from catenary_fe.equilibrium.shape import DropperRow, HangingWire, Shape, check_shape

__all__ = ["DropperRow", "HangingWire", "Shape", "check_shape", "find_form", "find_heights"]
