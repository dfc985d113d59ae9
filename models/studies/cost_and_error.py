"""What does exactness cost? Error of σ, extremes and uplift against processor time.

Question: which element lengths, time step and engine give σ within 1 % of a converged computation at the
least cost, on a plane line, a spatial one and one with stitch wires? Are the defaults among them?

Run it with ``python models/studies/cost_and_error.py [FOLDER [LINE ...]]``; all lines take an hour on one
core. It writes ``cost_and_error.md``, ``.json`` and ``.png``. Times compare within a line only.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import catenary_fe as cf
from catenary_fe.views import style

LAYOUTS = Path(__file__).parents[1] / "layouts"
LINES = {  # file, pantograph, speed [km/h]
    "EN 50318:2002": ("en50318_2002.toml", "EN 50318:2002", 300.0),
    "AC simple": ("en50318_2018_ac_simple.toml", "EN 50318:2018 AC", 275.0),
    "AC stitched": ("en50318_2018_ac_stitched.toml", "EN 50318:2018 AC", 275.0),
}
DEFAULT = cf.MeshSettings()


def _mesh(contact: float, messenger: float, clamps: float) -> cf.MeshSettings:
    return cf.MeshSettings(contact_wire_element=contact, messenger_wire_element=messenger, at_clamps=clamps)


MESHES = {
    "converged": _mesh(0.4, 0.6, 0.12),
    "halved": DEFAULT.halved(),
    "default": DEFAULT,
    "1.3 m, 3 m, 0.65 m": _mesh(1.3, 3.0, 0.65),
    "1.65 m, 3.3 m, 0.8 m": _mesh(1.65, 3.3, 0.8),
    "2 m, 4 m, 1 m": _mesh(2.0, 4.0, 1.0),
}
STEPS = (0.5, 1.0, 1.5, 2.0, 2.5)  # ms
REFERENCE = ("linearised", "converged", 0.25)  # engine, mesh, step [ms]
CASES = [
    REFERENCE,
    *[("linearised", mesh, step) for mesh in list(MESHES)[1:] for step in STEPS],
    ("nonlinear", "default", 1.0),
    ("nonlinear", "default", 2.0),
    ("nonlinear", "halved", 0.5),
]
FIGURES = {"std_N": "σ", "max_N": "maximum", "min_N": "minimum", "max_support_uplift_mm": "uplift"}
HEADING = """# Cost against error

Written by `models/studies/cost_and_error.py`: linearised runs of all meshes and steps, and some
nonlinear ones, against a linearised run with elements of 0.12 m at clamps, at most 0.4 m (contact wire)
and 0.6 m (messenger wire), in steps of 0.25 ms. Errors of the extremes are in per cent of the converged
mean force, which no small denominator blows up. A mesh is named by its largest elements of contact and
messenger wire and those at clamps. Cost: processor time of form finding, set-up, run and statistics, in
units of the default's linearised one; compare it within the table only. What nothing beats in both is
bold.

![Error of σ against cost](cost_and_error.png)
"""


def run_case(line: str, method: str, mesh: str, step: float) -> dict[str, Any]:
    """Key figures, and the processor time [s]."""
    file, name, speed = LINES[line]
    begin = time.process_time()
    shape = cf.find_form(cf.load_catenary(LAYOUTS / file), MESHES[mesh])
    head = cf.library.pantograph(name)
    settings = cf.TimeSettings(step=step / 1e3)
    run = cf.simulate(shape, [head], speed=speed / 3.6, time=settings, method=method)  # type: ignore[arg-type]
    summary = run.summary()
    own = summary["pantographs"][0] | {"max_support_uplift_mm": summary["max_support_uplift_mm"]}
    found = {key: float(own[key]) for key in ("mean_N", *FIGURES)}
    return found | {"seconds": time.process_time() - begin, "method": method, "mesh": mesh, "step_ms": step}


def errors(row: dict[str, Any], reference: dict[str, Any]) -> dict[str, float]:
    """In per cent: of σ and uplift of themselves, of extremes of the mean force."""
    found = {}
    for key, name in FIGURES.items():
        scale = reference["mean_N"] if key in ("max_N", "min_N") else reference[key]
        found[name] = 100 * (row[key] - reference[key]) / scale
    return found


def table(line: str, rows: list[dict[str, Any]]) -> list[str]:
    """Of a line, the cheapest first; those that nothing beats in both are bold."""
    reference, unit = rows[0], next(r for r in rows if _is_default(r))["seconds"]
    found = [(r["seconds"] / unit, errors(r, reference), r) for r in rows[1:]]
    lines = [
        f"## {line}: σ = {reference['std_N']:.2f} N",
        "",
        "| engine | mesh | step (ms) | cost | " + " | ".join(f"{n} (%)" for n in FIGURES.values()) + " |",
        "|---|---|---|---|" + "---|" * len(FIGURES),
    ]
    for cost, off, row in sorted(found, key=lambda each: each[0]):
        beaten = any(c < cost and abs(o["σ"]) <= abs(off["σ"]) for c, o, _ in found)
        mark = "" if beaten else "**"
        cells = [row["method"], row["mesh"], f"{row['step_ms']:g}", f"{cost:.2f}"]
        cells += [f"{value:+.2f}" for value in off.values()]
        lines.append("| " + " | ".join(f"{mark}{cell}{mark}" for cell in cells) + " |")
    return [*lines, ""]


def _is_default(row: dict[str, Any]) -> bool:
    return (row["method"], row["mesh"], row["step_ms"]) == ("linearised", "default", 1.0)


@style.styled
def picture(results: dict[str, list[dict[str, Any]]], path: Path) -> None:
    """Error of σ against cost, a panel a line."""
    panels = style.new_panels((9.0, 11.0), [1] * len(results))
    for ax, (line, rows) in zip(panels, results.items(), strict=True):
        unit = next(r for r in rows if _is_default(r))["seconds"]
        for mesh, colour in zip(list(MESHES)[1:], style.distinct(len(MESHES) - 1), strict=True):
            for method, marker in (("linearised", "o-"), ("nonlinear", "s")):
                own = [r for r in rows if (r["method"], r["mesh"]) == (method, mesh)]
                off = [max(0.01, abs(errors(r, rows[0])["σ"])) for r in own]
                cost = [r["seconds"] / unit for r in own]
                label = f"{mesh}{', nonlinear' if method == 'nonlinear' else ''}"
                if own:
                    ax.loglog(cost, off, marker, color=colour, markersize=4, linewidth=0.8, label=label)
                for r, x, y in zip(own, cost, off, strict=True):
                    style.annotate(ax, f"{r['step_ms']:g}", (x, y), (3, 3), fontsize=6)
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter("")
        ax.axhline(1.0, color="#222222", linestyle="--", linewidth=0.9)
        style.finish(ax, "cost, of the default's", "error of σ (%)", f"{line}; numbers are steps in ms")
    panels[0].legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    panels[0].figure.savefig(path, dpi=130)


def main(folder: Path, lines: list[str]) -> None:
    """Run all cases of some lines, beside what the folder has of others; write table, numbers and picture."""
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "cost_and_error.json"
    results: dict[str, list[dict[str, Any]]] = json.loads(kept.read_text()) if kept.exists() else {}
    for line in lines:
        run_case(line, "linearised", "2 m, 4 m, 1 m", 2.0)  # compiles
        results[line] = []
        for case in CASES:
            results[line].append(run_case(line, *case))
            row = results[line][-1]
            print(
                f"{line}: {', '.join(map(str, case))}: σ {row['std_N']:.3f} N, {row['seconds']:.2f} s",
                flush=True,
            )
        kept.write_text(json.dumps(results, indent=1), encoding="utf-8")
    results = {line: results[line] for line in LINES if line in results}
    text = "\n".join([HEADING, *(text for line, rows in results.items() for text in table(line, rows))])
    (folder / "cost_and_error.md").write_text(text.rstrip() + "\n", encoding="utf-8")
    picture(results, folder / "cost_and_error.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/cost_and_error"), sys.argv[2:] or list(LINES))
