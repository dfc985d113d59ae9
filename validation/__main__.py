"""``python -m validation [CASE ...] [--quick] [--jobs N]``: exit code 1 on a miss."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation import run_cases, write_report


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m validation")
    parser.add_argument("cases", nargs="*")
    parser.add_argument("--quick", action="store_true", help="only what takes seconds")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    chosen = parser.parse_args()
    checks = run_cases(chosen.cases or None, quick=chosen.quick, jobs=chosen.jobs)
    for check in checks:
        mark = {True: "passed", False: "MISSED", None: "beside"}[check.passed]
        name = ", ".join(filter(None, (check.case, check.engine)))
        print(f"{mark} {check.error:10.3e} <= {check.tolerance:8.1e}  {name}: {check.quantity}")
    if not chosen.cases and not chosen.quick:
        write_report(checks, Path(__file__).parent)
    return 1 if any(check.passed is False for check in checks) else 0


if __name__ == "__main__":
    sys.exit(main())
