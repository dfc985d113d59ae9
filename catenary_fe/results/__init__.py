"""What runs return: labelled data with units, statistics, criteria, files.

Criteria: ``criteria_rows(run, "AC")`` gives one :class:`Criterion` for each limit; ``row.passed`` is True,
False, or None where no limit is known; ``missed(rows)`` are those that fail, ``labels(rows)`` their names for
a table.
"""

from catenary_fe.results.check import Check, checks_in_words
from catenary_fe.results.comparison import (
    Column,
    InputDifference,
    failed_checks,
    input_differences,
    key_figures,
)
from catenary_fe.results.criteria import (
    Criterion,
    KeyFigures,
    criteria_in_words,
    criteria_rows,
    excess,
    judge,
    labels,
    missed,
)
from catenary_fe.results.export import history_tables, save_catenary, write_tables
from catenary_fe.results.modes import ModalRun, ModeKind, Modes, WireShapes
from catenary_fe.results.pantograph import PantographResponse, pantograph_response, receptance_table
from catenary_fe.results.quality import run_checks
from catenary_fe.results.run import Run, load_run
from catenary_fe.results.signal import band_pass, low_pass, spectrum
from catenary_fe.results.statistics import ForceStatistics, force_statistics, governing
from catenary_fe.results.wires import Elasticity, WireHistory

__all__ = [
    "Check", "Column", "Criterion", "Elasticity", "ForceStatistics", "InputDifference", "KeyFigures",
    "ModalRun", "ModeKind", "Modes", "PantographResponse", "Run", "WireHistory", "WireShapes",
    "band_pass", "checks_in_words", "criteria_in_words", "criteria_rows", "excess", "failed_checks",
    "force_statistics", "governing",
    "history_tables", "input_differences", "judge", "key_figures", "labels", "load_run", "low_pass",
    "missed", "pantograph_response", "receptance_table", "run_checks", "save_catenary", "spectrum",
    "write_tables",
]  # fmt: skip
