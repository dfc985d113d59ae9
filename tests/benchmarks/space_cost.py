"""What space costs: one run of EN 50318:2018 AC simple in space, and of its equivalent in the plane.

    python tests/benchmarks/space_cost.py [SPANS]

Prints processor time in turns, so that a busy machine disturbs both alike, and the ratio of the minima.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import catenary_fe as cf

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2018_ac_simple.toml"
REPEATS = 3


def measured(work: Callable[[], object]) -> float:
    begin = time.process_time()
    work()
    return time.process_time() - begin


def main(spans: int) -> None:
    whole = cf.load_catenary(LAYOUT)
    space = whole.replace(
        spans=whole.spans[:spans], supports=whole.supports[: spans + 1], evaluated_spans=None
    )
    pantograph = cf.library.pantograph("EN 50318:2018 AC").replace(mean_force=None, uplift_force=150.0)
    lines = {"plane": space.planar(), "space": space}
    shapes = {name: cf.find_form(line) for name, line in lines.items()}
    form: dict[str, list[float]] = {name: [] for name in lines}
    run: dict[str, list[float]] = {name: [] for name in lines}
    for _ in range(REPEATS):
        for name, line in lines.items():
            form[name].append(measured(lambda line=line: cf.find_form(line)))
            run[name].append(
                measured(lambda name=name: cf.simulate(shapes[name], [pantograph], speed=275 / 3.6))
            )
    for what, times in (("form finding", form), ("run", run)):
        least = {name: min(values) for name, values in times.items()}
        ratio = least["space"] / least["plane"]
        print(f"{what}: plane {least['plane']:.2f} s, space {least['space']:.2f} s, ratio {ratio:.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 6)
