"""How the cost of a run grows with the number of tension sections, as ratios in one process.

``python tests/benchmarks/sections.py [--spans 20] [--sections 1 2 3]`` takes sections of EN 50318:2002 that
overlap by three spans: processor time to find the form, and of a run from end to end, nonlinear and
linearised, over those of one section.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import catenary_fe as cf

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2002.toml"
SPEED = 250 / 3.6


def seconds(work: Callable[[], object]) -> float:
    """Processor time, the least of three."""
    found = []
    for _ in range(3):
        before = time.process_time()
        work()
        found.append(time.process_time() - before)
    return min(found)


def line_of(spans: int, sections: int) -> cf.Catenary:
    """So many equal sections."""
    reference = cf.load_catenary(LAYOUT)
    part = reference.replace(
        spans=reference.spans[:1] * spans, supports=reference.supports[:1] * (spans + 1), evaluated_spans=None
    )
    return (
        cf.join_sections([part] * sections, [cf.Overlap(spans=3)] * (sections - 1)) if sections > 1 else part
    )


def measure(spans: int, sections: int) -> dict[str, float]:
    """Seconds of each piece of work."""
    line, head = line_of(spans, sections), cf.library.pantograph("EN 50318:2002")
    shape = cf.find_form(line)
    return {"form finding": seconds(lambda: cf.find_form(line))} | {
        method: seconds(lambda method=method: cf.simulate(shape, [head], speed=SPEED, method=method))
        for method in ("nonlinear", "linearised")
    }


def main() -> None:
    """Print ratios over one section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--spans", type=int, default=20)
    parser.add_argument("--sections", type=int, nargs="+", default=[2, 3])
    given = parser.parse_args()
    measure(6, 1)  # loads the compiled code
    one = measure(given.spans, 1)
    for sections in given.sections:
        ratios = {name: value / one[name] for name, value in measure(given.spans, sections).items()}
        said = ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())
        print(f"{sections} sections of {given.spans} spans, times one: {said}", flush=True)


if __name__ == "__main__":
    main()
