"""What a mean force costs: a run that sets its uplift for one, over a plain run with that uplift.

``python tests/benchmarks/mean_force.py [LAYOUT PANTOGRAPH KMH]`` prints processor times of both in one
process and their ratio, which shall be at most 2. Without arguments: EN 50318:2018 AC simple and Re 330.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import catenary_fe as cf

LAYOUTS = Path(__file__).parents[2] / "models" / "layouts"
CASES = (("en50318_2018_ac_simple", "EN 50318:2018 AC", 250.0), ("re330", "DSA380", 250.0))


def main() -> None:
    """Time both runs of each case; print the table."""
    cases = [(Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]))] if len(sys.argv) > 3 else CASES
    for layout, name, kmh in cases:
        path = layout if isinstance(layout, Path) else LAYOUTS / f"{layout}.toml"
        shape, wanted = cf.find_form(cf.load_catenary(path)), cf.library.pantograph(name)
        target = wanted.target_mean_force(kmh / 3.6)
        plain = wanted.replace(mean_force=None, uplift_force=target)
        _seconds(shape, plain, kmh)  # compiles
        ordinary, _ = _seconds(shape, plain, kmh)
        sought, run = _seconds(shape, wanted, kmh)
        missed = run.contact_force_statistics()[0].mean - target
        print(
            f"{path.stem:24s} {name:18s} {kmh:g} km/h: plain {ordinary:5.1f} s, mean force {sought:5.1f} s,"
            f" ratio {sought / ordinary:.2f}, {missed:+.3f} N beside {target:.1f} N"
        )


def _seconds(shape: cf.Shape, pantograph: cf.Pantograph, kmh: float) -> tuple[float, cf.Run]:
    begin = time.process_time()
    run = cf.simulate(shape, [pantograph], speed=kmh / 3.6)
    return time.process_time() - begin, run


if __name__ == "__main__":
    main()
