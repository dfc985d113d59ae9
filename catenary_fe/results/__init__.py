"""What runs return: labelled data with units, statistics, files."""

from catenary_fe.results.elasticity import Elasticity
from catenary_fe.results.modal_run import ModalRun
from catenary_fe.results.modes import ModeKind, Modes, WireShapes
from catenary_fe.results.run import Run, load_run
from catenary_fe.results.signal import band_pass, low_pass, spectrum
from catenary_fe.results.statistics import ForceStatistics, force_statistics

__all__ = [
    "Elasticity",
    "ForceStatistics",
    "ModalRun",
    "ModeKind",
    "Modes",
    "Run",
    "WireShapes",
    "band_pass",
    "force_statistics",
    "load_run",
    "low_pass",
    "spectrum",
]
