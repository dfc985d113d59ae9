"""Cases that prove the program: computed beside reference, with tolerance and source.

Each file of ``validation/cases`` holds one case. ``run_cases`` runs them, ``run_negative_controls`` their
negative controls, which are wrong on purpose and must fail, ``write_report`` writes ``REPORT.md`` and its
pictures.
"""

from validation.case import Case, Checks
from validation.cases import CASES
from validation.check import Check
from validation.report import write_report
from validation.run import run_cases, run_negative_controls

__all__ = ["CASES", "Case", "Check", "Checks", "run_cases", "run_negative_controls", "write_report"]
