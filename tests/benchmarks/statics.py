"""What statics cost beside a run, in processor time on one thread.

``python tests/benchmarks/statics.py [LAYOUT]`` times form finding, elasticity of the evaluated spans and one
linearised run of the same line in one process, and the command ``static`` as a process of its own.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before NumPy: idle threads that spin count as processor time

import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import catenary_fe as cf

RE330 = Path(__file__).parents[2] / "models" / "layouts" / "re330.toml"


def spent(work: Callable[[], Any]) -> tuple[Any, float]:
    """What comes of some work, and its processor time [s]."""
    begin = time.process_time()
    found = work()
    return found, time.process_time() - begin


def main(layout: Path) -> None:
    catenary = cf.load_catenary(layout)
    pantograph = cf.library.pantograph("DSA380").replace(mean_force=None, uplift_force=120.0)
    warm = cf.find_form(catenary.replace(spans=catenary.spans[:3], supports=catenary.supports[:4],
                                         evaluated_spans=(2,)))  # fmt: skip
    cf.elasticity(warm)
    cf.simulate(warm, [pantograph], speed=60.0, method="linearised")  # compiles
    shape, form = spent(lambda: cf.find_form(catenary))
    curve, elasticity = spent(lambda: cf.elasticity(shape))
    _, run = spent(lambda: cf.simulate(shape, [pantograph], speed=70.0, method="linearised"))
    print(f"{catenary.name}: {len(catenary.spans)} spans, elasticity at {curve.position.size} places")
    for name, seconds in (("form finding", form), ("elasticity", elasticity), ("linearised run", run)):
        print(f"{name:15} {seconds:7.2f} s   {seconds / run:7.3f} of the linearised run")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "catenary_fe", "static", str(layout), "--quiet"]
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{'command static':15} {seconds:7.2f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else RE330)
