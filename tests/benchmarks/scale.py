"""How cost and memory of linearised runs grow with the line, as a table and a picture.

``python tests/benchmarks/scale.py [FOLDER] [--most 100]`` takes lines of 10 to 100 spans of EN 50318:2002
with one and with four pantographs, each in a process of its own: set-up, processor time of a step, peak
memory, over 3000 steps. The histories that a run keeps grow with its steps besides.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.studies.linearised import LinearisedLine
from catenary_fe.views.style import PANTOGRAPHS, finish

LAYOUT = Path(__file__).parents[2] / "models" / "layouts" / "en50318_2002.toml"
SPEED, APART, STEPS = 300 / 3.6, 60.0, 3000
_LOADED_MB = 1 / 1024  # ru_maxrss counts in KiB on Linux


def measure(spans: int, count: int) -> dict[str, float]:
    """Set-up [s], processor time of a step [ms], peak memory [MB], of one line."""
    reference = cf.load_catenary(LAYOUT)
    line = reference.replace(
        spans=reference.spans[:1] * spans, supports=reference.supports[:1] * (spans + 1), evaluated_spans=None
    )
    cf.find_form(reference)  # loads Exudyn
    begin = time.process_time()
    shape = cf.find_form(line)
    formed = time.process_time()
    linearised = LinearisedLine(shape)
    ready = time.process_time()
    head = cf.library.pantograph("EN 50318:2002")
    start = 10.0 + APART * np.arange(count)[::-1]
    case = RunCase([head] * count, SPEED, start, STEPS * SPEED * 1e-3)
    linearised.run([case])  # loads the compiled code
    used = []
    for _ in range(3):
        before = time.process_time()
        linearised.run([case])
        used.append(time.process_time() - before)
    return {
        "spans": spans,
        "pantographs": count,
        "form_s": formed - begin,
        "linearise_s": ready - formed,
        "step_ms": 1e3 * min(used) / STEPS,
        "memory_MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _LOADED_MB,
    }


def main() -> None:
    """Measure in processes of their own; write table and picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("out/scale"))
    parser.add_argument("--most", type=int, default=100, help="spans")
    parser.add_argument("--one", nargs=2, type=int, help="spans and pantographs of one measurement")
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measure(*options.one)))
        return
    rows = []
    for spans in [n for n in (10, 20, 40, 70, 100) if n <= options.most]:
        for count in (1, 4):
            command = [sys.executable, __file__, "--one", str(spans), str(count)]
            rows.append(json.loads(subprocess.run(command, check=True, capture_output=True).stdout))
            print("  ".join(f"{key} {value:.4g}" for key, value in rows[-1].items()), flush=True)
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / "scale.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    draw(rows, options.folder / "scale.png")


def draw(rows: list[dict[str, float]], path: Path) -> None:
    """Three panels against the number of spans, with straight lines for linear growth."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    panels = figure.subplots(1, 3)
    quantities = {
        "set-up (s)": lambda r: r["form_s"] + r["linearise_s"],
        "a step of 1 ms (ms)": lambda r: r["step_ms"],
        "peak memory (MB)": lambda r: r["memory_MB"],
    }
    for ax, (title, value) in zip(panels, quantities.items(), strict=True):
        for colour, count in zip(PANTOGRAPHS, (1, 4), strict=False):
            part = [r for r in rows if r["pantographs"] == count]
            x, y = np.array([r["spans"] for r in part]), np.array([value(r) for r in part])
            name = f"{count} pantograph" + "s" * (count > 1)
            ax.plot(x, y, "o", color=colour, label=f"{name}, measured")
            slope, offset = np.polyfit(x, y, 1)
            ax.plot(x, slope * x + offset, color=colour, linewidth=1, label=f"{name}, straight line")
        ax.set_ylim(bottom=0.0)
        ax.set_xlim(left=0.0)
        ax.legend(fontsize=7, loc="upper left")
        finish(ax, "spans of 60 m", title, f"Linearised run: {title.rsplit(' (', 1)[0]}")
    figure.savefig(path, dpi=130, metadata={"Software": None})


if __name__ == "__main__":
    main()
