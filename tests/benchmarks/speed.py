"""Real-time factors of all ways to run, in one process after another: compare them with each other only.

``python tests/benchmarks/speed.py [--repeat 3] [--seconds 3] [--json]`` runs EN 50318:2002 at 300 km/h with
steps of 1 ms on the default mesh. Wall time depends on what else the machine does; the last column counts
processor time, as if each core had nothing else to do. The best of the repetitions is printed. A design is a
line with another tension, its form, a linearised run and its statistics.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import catenary_fe as cf
from catenary_fe.engines.arrays import SLOTS
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.nonlinear.run import NonlinearEngine
from catenary_fe.fe.reduction import linear_model
from catenary_fe.studies.checks import plan_run
from catenary_fe.studies.linearised import LinearisedLine
from catenary_fe.studies.reference_models import reference_line

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2002.toml"
SPEED, START, STEP = 300 / 3.6, 10.0, 1e-3
CASES_A_CORE = 2 * SLOTS
DESIGNS = {  # steps of 2 ms leave σ within 1 % of a converged run: see models/studies/cost_and_error.md
    "designs_per_minute": ("designs a minute, ten spans, 2 ms", 2e-3, False),
    "designs_per_minute_1_ms": ("designs a minute, ten spans, 1 ms", 1e-3, False),
    "designs_per_minute_short": ("designs a minute, as optimise runs, 2 ms", 2e-3, True),
}


def nonlinear(line: NonlinearEngine, seconds: float) -> float:
    head = cf.library.pantograph("EN 50318:2002")
    line.run(RunCase([head], SPEED, np.array([START]), seconds * SPEED), np.array([120.0]))
    return seconds


def exudyn(shape: cf.Shape, seconds: float) -> float:
    from catenary_fe.engines.exudyn.run import ExudynEngine

    head = cf.library.pantograph("EN 50318:2002")
    case = RunCase([head], SPEED, np.array([START]), seconds * SPEED)
    ExudynEngine(shape).run(case, np.array([120.0]))
    return seconds


def stepping(shape: cf.Shape, seconds: float) -> float:
    """A step a call, each with another force: what a controller costs."""
    head = cf.library.pantograph("EN 50318:2002")
    session = cf.stepping(shape, [head], speed=SPEED, positions=[START])
    for n in range(round(seconds / STEP)):
        session.step(uplift_force=120.0 + n % 2)
    return seconds


def linearised(line: LinearisedLine, cases: int = 1) -> float:
    head = cf.library.pantograph("EN 50318:2002")
    runs = line.run([RunCase([head], SPEED, np.array([START]), 580.0)] * cases)
    return sum(float(run.time[-1]) for run in runs)


_line: LinearisedLine | None = None


def sweep_worker(cases: int) -> tuple[float, float]:
    """Simulated seconds and processor time; the line is set up and the code compiled by the first call."""
    global _line
    if _line is None:
        _line = LinearisedLine(cf.find_form(cf.load_catenary(LAYOUT)))
        linearised(_line, 2)
    begin = time.process_time()
    return (linearised(_line, cases), time.process_time() - begin) if cases else (0.0, 0.0)


def design_worker(designs: int, first: int, step: float, short: bool) -> float:
    """Processor time of so many designs, none of which has the tension of another one.

    short : as ``optimise`` runs them, to a span behind the last evaluated one
    """
    begin, catenary, settings = time.process_time(), cf.load_catenary(LAYOUT), cf.TimeSettings(step=step)
    head = cf.library.pantograph("EN 50318:2002")
    for n in range(first, first + designs):
        wire = catenary.contact_wire.replace(tension=20e3 + 7.0 * n)
        line = LinearisedLine(cf.find_form(catenary.replace(contact_wire=wire)), settings)
        (run,) = line.run([plan_run(line.shape, [head], SPEED, None, settings, short=short)])
        assert isinstance(run, cf.Run)
        run.summary()
    return time.process_time() - begin


def elasticity(shape: cf.Shape) -> float:
    """[s] of processor time for the elasticity of all spans, at the points of the command."""
    begin = time.process_time()
    cf.elasticity(shape, spans=range(1, len(shape.catenary.spans) + 1))
    return time.process_time() - begin


def plain_scipy(shape: cf.Shape, seconds: float) -> float:
    """The trapezoidal rule on the linear model with scipy alone; droppers taut, contact sticks."""
    from scipy.interpolate import CubicHermiteSpline
    from scipy.sparse.linalg import splu

    model = linear_model(shape.system)
    head = cf.library.pantograph("EN 50318:2002")
    M, D, K = (A.tocsc() for A in (model.mass, model.damping, model.stiffness))
    solve = splu(M + STEP / 2 * D + STEP**2 / 4 * K, permc_spec="NATURAL", diag_pivot_thresh=0.0).solve
    line, k = model.contacts[0], head.contact_stiffness
    rest = CubicHermiteSpline(
        line.x, line.profile[:, 0] - shape.catenary.contact_wire_height, line.profile[:, 1]
    )
    joints = np.eye(2) - np.eye(2, k=1)
    m, d, c = (np.array([getattr(s, name) for s in head.stages]) for name in ("mass", "damping", "stiffness"))
    Mp, Dp, Kp = np.diag(m), joints.T @ np.diag(d) @ joints, joints.T @ np.diag(c) @ joints
    inverse = np.linalg.inv(Mp + STEP / 2 * Dp + STEP**2 / 4 * Kp)
    q, v, a = (np.zeros(model.size) for _ in range(3))
    y, u, b = (np.zeros(2) for _ in range(3))
    for n in range(1, round(seconds / STEP) + 1):
        x = START + SPEED * STEP * n
        e = int(np.searchsorted(line.x, x, side="right")) - 1
        row = np.zeros(model.size)
        xi, length = (x - line.x[e]) / (line.x[e + 1] - line.x[e]), line.lengths[e]
        weights = 1 - 3 * xi**2 + 2 * xi**3, xi - 2 * xi**2 + xi**3, 3 * xi**2 - 2 * xi**3, xi**3 - xi**2
        row[line.dof[e : e + 2].ravel()] = np.array(weights) * [1, length, 1, length]
        q, v = q + STEP * v + STEP**2 / 4 * a, v + STEP / 2 * a
        y, u = y + STEP * u + STEP**2 / 4 * b, u + STEP / 2 * b
        a, give = solve(-(D @ v + K @ q)), solve(row)
        b = inverse @ (np.array([0.0, 120.0]) - Dp @ u - Kp @ y)
        gap = y[0] + STEP**2 / 4 * b[0] - rest(x) - row @ (q + STEP**2 / 4 * a)
        force = k * gap / (1 + k * STEP**2 / 4 * (row @ give + inverse[0, 0]))
        a, b = a + force * give, b - force * inverse[:, 0]
        q, v, y, u = q + STEP**2 / 4 * a, v + STEP / 2 * a, y + STEP**2 / 4 * b, u + STEP / 2 * b
    return seconds


def main() -> None:
    """Measure and print."""
    from joblib import Parallel, delayed

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2.0, help="simulated by the slow ones")
    parser.add_argument("--json", action="store_true", help="print a table for programs")
    options = parser.parse_args()
    cores = os.cpu_count() or 1
    catenary = cf.load_catenary(LAYOUT)
    shape = cf.find_form(catenary)  # loads Exudyn
    line = LinearisedLine(shape)
    linearised(line)  # compiles
    whole = NonlinearEngine(shape.system)
    nonlinear(whole, 0.01)
    setups = [_setup(catenary) for _ in range(options.repeat)]
    found = {"setup_s": min(s[1] for s in setups)}
    if not options.json:
        print(f"{'set-up: form, statics, linearisation':44s} {min(s[0] for s in setups):6.2f} s wall", end="")
        print(f" {min(s[1] for s in setups):6.2f} s processor")
        print(f"{'real-time factor of':44s} {'wall':>8s} {'processor':>10s}")
    rows: dict[str, Callable[[], float]] = {
        "nonlinear run": lambda: nonlinear(whole, 6.96),
        "steps of a session, one a call": lambda: stepping(shape, options.seconds),
        "nonlinear run by Exudyn's solver": lambda: exudyn(shape, options.seconds),
        "plain scipy, linear, droppers taut": lambda: plain_scipy(shape, options.seconds),
        "linearised run": lambda: linearised(line),
        f"linearised, {SLOTS} slots on one core": lambda: linearised(line, CASES_A_CORE),
    }
    best = dict.fromkeys(rows, (0.0, 0.0))
    for _ in range(options.repeat):
        for name, run in rows.items():
            begin, used = time.perf_counter(), time.process_time()
            simulated = run()
            factors = simulated / (time.perf_counter() - begin), simulated / (time.process_time() - used)
            best[name] = tuple(map(max, best[name], factors))
    keys = "nonlinear", "stepping", "exudyn", "plain_scipy", "linearised", "linearised_slots"
    for key, (name, (wall, processor)) in zip(keys, best.items(), strict=True):
        found[f"{key}_real_time_factor"] = processor
        if not options.json:
            print(f"{name:44s} {wall:8.2f} {processor:10.2f}")
    with Parallel(n_jobs=cores, batch_size=1, pre_dispatch="all") as parallel:
        parallel(delayed(sweep_worker)(0) for _ in range(4 * cores))
        wall = processor = 0.0
        for _ in range(options.repeat):
            begin = time.perf_counter()
            parts = parallel(delayed(sweep_worker)(CASES_A_CORE) for _ in range(cores))
            wall = max(wall, sum(p[0] for p in parts) / (time.perf_counter() - begin))
            processor = max(processor, sum(simulated / used for simulated, used in parts))
        minutes = {}
        for number, (name, given) in enumerate(DESIGNS.items()):
            parallel(delayed(design_worker)(1, 0, *given[1:]) for _ in range(4 * cores))
            begin, each = time.perf_counter(), 10
            parallel(
                delayed(design_worker)(each, each * (number * cores + n), *given[1:]) for n in range(cores)
            )
            minutes[name] = 60 * cores * each / (time.perf_counter() - begin)
    long = cf.find_form(reference_line(20))
    found |= {"sweep_real_time_factor": wall, "elasticity_20_spans_s": elasticity(long)} | minutes
    if options.json:
        print(json.dumps(found, indent=1))
        return
    print(f"{f'batched sweep on {cores} cores':44s} {wall:8.2f} {processor:10.2f}")
    print(f"{'elasticity of 20 spans, seconds':44s} {'':8s} {found['elasticity_20_spans_s']:10.2f}")
    for name, given in DESIGNS.items():
        print(f"{given[0]:44s} {minutes[name]:8.1f}")


def _setup(catenary: cf.Catenary) -> tuple[float, float]:
    begin, used = time.perf_counter(), time.process_time()
    LinearisedLine(cf.find_form(catenary))
    return time.perf_counter() - begin, time.process_time() - used


if __name__ == "__main__":
    main()
