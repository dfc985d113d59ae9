"""Form finding: dropper lengths and the static shape."""

from catenary_fe.statics.cases import CaseRows, case_rows
from catenary_fe.statics.forms import find_form, find_heights
from catenary_fe.statics.installed import InstalledRow, against_design, design_of, fit_measured
from catenary_fe.statics.line import LineShape
from catenary_fe.statics.schedules import ArmRow, DropperRow, SupportRow
from catenary_fe.statics.settled import settle
from catenary_fe.statics.shape import HangingWire, Shape

__all__ = [
    "ArmRow",
    "CaseRows",
    "DropperRow",
    "HangingWire",
    "InstalledRow",
    "LineShape",
    "Shape",
    "SupportRow",
    "against_design",
    "case_rows",
    "design_of",
    "find_form",
    "find_heights",
    "fit_measured",
    "settle",
]
