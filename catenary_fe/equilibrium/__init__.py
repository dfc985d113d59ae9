"""Form finding: dropper lengths and the static shape."""

from catenary_fe.equilibrium.form import find_form, find_heights
from catenary_fe.equilibrium.shape import DropperRow, Shape

__all__ = ["DropperRow", "Shape", "find_form", "find_heights"]
