"""Where the time of the reference run goes, as ratios within one process.

``python tests/benchmarks/run_cost.py [--seconds 3]`` runs EN 50318:2002 at 300 km/h at the default mesh and
step and prints the real-time factor (simulated over elapsed time, one core) and the shares of its parts.
Absolute times depend on the machine and what else it does; compare ratios of one run.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

import catenary_fe as cf
from catenary_fe.fe import drive as driver
from catenary_fe.fe.drive import Trip, drive

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2002.toml"


def main() -> None:
    """Time set-up and run; print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=6.96, help="simulated")
    seconds = parser.parse_args().seconds
    catenary = cf.load_catenary(LAYOUT)
    cf.find_form(catenary)  # loads Exudyn
    rows: list[tuple[str, float]] = []

    begin = time.perf_counter()
    shape = cf.find_form(catenary)
    rows.append(("form finding", time.perf_counter() - begin))
    begin = time.perf_counter()
    cf.solve_statics(shape)
    rows.append(("statics", time.perf_counter() - begin))

    recording = _Stopwatch(driver._Recorder, "record")
    moving = _Stopwatch(driver.MovingContact, "move_to")
    pantograph = cf.library.pantograph("EN 50318:2002")
    trip = Trip(300 / 3.6, np.array([10.0]), round(seconds / 1e-3), cf.TimeSettings())
    begin = time.perf_counter()
    drive(shape.catenary, shape.mesh, shape.installation, [(pantograph, 120.0)], trip)
    total = time.perf_counter() - begin
    rows += [
        ("run: Exudyn's steps", total - recording.elapsed - moving.elapsed),
        ("run: moving the contact", moving.elapsed),
        ("run: recording", recording.elapsed),
    ]
    whole = sum(value for _, value in rows)
    for name, value in rows:
        print(f"{name:28s} {value:8.2f} s {100 * value / whole:6.1f} %")
    print(f"{'set-up (form and statics)':28s} {rows[0][1] + rows[1][1]:8.2f} s")
    print(f"{'real-time factor of the run':28s} {seconds / total:8.2f}")


class _Stopwatch:
    """Adds up the time spent in a method."""

    def __init__(self, owner: type, name: str) -> None:
        self.elapsed = 0.0
        method = getattr(owner, name)

        def timed(*args, **kwargs):
            begin = time.perf_counter()
            try:
                return method(*args, **kwargs)
            finally:
                self.elapsed += time.perf_counter() - begin

        setattr(owner, name, timed)


if __name__ == "__main__":
    main()
