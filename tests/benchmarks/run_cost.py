"""Where the time of the reference run goes, as ratios within one process.

``python tests/benchmarks/run_cost.py [--exudyn]`` runs EN 50318:2002 at 300 km/h at the default mesh and step
and prints the real-time factor (simulated over elapsed time, one core) and the shares of its parts; of a
step's parts one by one, as often as they occur. ``--exudyn`` times Exudyn's own solver beside it. Absolute
times depend on the machine and what else it does; compare ratios of one run.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.kernels import take
from catenary_fe.engines.nonlinear.cables import take_cables
from catenary_fe.engines.nonlinear.forces import local_compliance, solve
from catenary_fe.engines.nonlinear.run import NonlinearEngine
from catenary_fe.fe.contact import place
from catenary_fe.statics.newton import static_contact

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2002.toml"
SPEED, START, SECONDS, STEP = 300 / 3.6, np.array([10.0]), 6.96, 1e-3


def main() -> None:
    """Time set-up and run; print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--exudyn", action="store_true", help="time Exudyn's solver too")
    options = parser.parse_args()
    catenary, heads = cf.load_catenary(LAYOUT), [cf.library.pantograph("EN 50318:2002")]
    case, uplifts = RunCase(heads, SPEED, START, SECONDS * SPEED), np.array([120.0])
    line = NonlinearEngine(cf.find_form(catenary).system)
    line.run(RunCase(heads, SPEED, START, 0.5), uplifts)  # compiles
    rows: list[tuple[str, float]] = []
    steps = round(SECONDS / STEP)

    shape = _timed(rows, "form finding", lambda: cf.find_form(catenary))
    _timed(rows, "statics", lambda: cf.solve_statics(shape))
    line = _timed(rows, "equations of motion", lambda: NonlinearEngine(shape.system))
    placed = place(heads, uplifts, START, spatial=False)
    _timed(rows, "static contact at the start", lambda: static_contact(shape.system, placed))
    _timed(rows, "run, with that", lambda: line.run(case, uplifts))
    for name, value in rows:
        print(f"{name:44s} {value:8.3f} s")
    run = rows[-1][1]
    print(f"{'form finding and statics':44s} {rows[0][1] + rows[1][1]:8.3f} s")
    print(f"{'real-time factor of the run':44s} {SECONDS / run:8.2f}")
    stepped = _stepped(shape, heads, steps)
    print(f"{'step by step, as a script does, over that':44s} {stepped / run:8.2f}")
    print(f"{'iterations a step':44s} {line.iterations / steps:8.2f}")
    for name, value in _parts(line):
        share = 1e-6 * value * line.iterations / (run - rows[-2][1])
        print(f"{name:44s} {value:8.1f} µs {100 * share:6.1f} %")
    if options.exudyn:
        _timed(rows, "", lambda: cf.simulate(shape, heads, speed=SPEED, positions=START, method="exudyn"))
        print(f"{'real-time factor of Exudyn':44s} {SECONDS / rows[-1][1]:8.2f}")


def _timed(rows: list[tuple[str, float]], name: str, what: Callable) -> object:
    begin = time.perf_counter()
    result = what()
    rows.append((name, time.perf_counter() - begin))
    return result


def _stepped(shape: cf.Shape, heads: list[cf.Pantograph], steps: int) -> float:
    """[s] of the same run, step by step, without the start."""
    session = cf.stepping(shape, heads, speed=SPEED, positions=START, duration=SECONDS)
    begin = time.perf_counter()
    for _ in range(steps):
        session.step(uplift_force=120.0)
    return time.perf_counter() - begin


def _parts(line: NonlinearEngine) -> list[tuple[str, float]]:
    """What an iteration consists of [µs each]."""
    system, factor = line._parameters.equations, line._factor
    total, inner = system.reference.copy(), np.zeros(system.reference.size)
    x, u = np.zeros(system.force.size), np.zeros(system.force.size)
    at, weights, column = np.arange(1000, 1008, 2), np.ones(4), np.zeros(1000)

    jobs = {
        "iteration: cable forces": (take_cables, (2, system.elements, total, inner)),
        "iteration: products with mass and damping": (take, (system.mass, u, x)),
        "iteration: solution": (solve, (factor, x)),
        "iteration: window of one contact": (local_compliance, (factor, at, weights, column)),
    }
    found = []
    for name, (function, arguments) in jobs.items():
        loop = _repeated(function)
        loop(1, *arguments)
        best = np.inf
        for _ in range(5):
            begin = time.perf_counter()
            loop(200, *arguments)
            best = min(best, (time.perf_counter() - begin) / 200)
        twice = 2 if "products" in name else 1
        found.append((name, 1e6 * best * twice))
    return found


def _repeated(function: Callable) -> Callable:
    @numba.njit
    def loop(times, *arguments):
        for _ in range(times):
            function(*arguments)

    return loop


if __name__ == "__main__":
    main()
