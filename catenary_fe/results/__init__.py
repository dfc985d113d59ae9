"""What runs return: labelled data with units, statistics, criteria, files.

Criteria: ``criteria_rows(run, "AC")`` gives one :class:`Criterion` for each limit; ``row.passed`` is True,
False, or None where no limit is known; ``missed(rows)`` are those that fail, ``labels(rows)`` their names for
a table.
"""

from catenary_fe.results.comparison import (
    Column,
    InputDifference,
    failed_checks,
    input_differences,
    key_figures,
)
from catenary_fe.results.criteria import Criterion, criteria_rows, labels, missed
from catenary_fe.results.elasticity import Elasticity
from catenary_fe.results.export import history_tables, write_tables
from catenary_fe.results.guards import Check, run_checks
from catenary_fe.results.modal_run import ModalRun
from catenary_fe.results.modes import ModeKind, Modes, WireShapes
from catenary_fe.results.run import Run, load_run
from catenary_fe.results.signal import band_pass, low_pass, spectrum
from catenary_fe.results.statistics import ForceStatistics, force_statistics
from catenary_fe.results.wires import WireHistory

__all__ = [
    "Check",
    "Column",
    "Criterion",
    "Elasticity",
    "ForceStatistics",
    "InputDifference",
    "ModalRun",
    "ModeKind",
    "Modes",
    "Run",
    "WireHistory",
    "WireShapes",
    "band_pass",
    "criteria_rows",
    "failed_checks",
    "force_statistics",
    "history_tables",
    "input_differences",
    "key_figures",
    "labels",
    "load_run",
    "low_pass",
    "missed",
    "run_checks",
    "spectrum",
    "write_tables",
]
