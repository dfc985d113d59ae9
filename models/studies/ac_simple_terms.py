"""EN 50318:2018 AC simple at 275 km/h: what each term of the model moves.

Question: the model lies inside the accepted ranges (recalled, not read) but for the standard deviation, which
is 0.4 N above. Which datum or choice would have to differ? Nothing here is a proposal to tune: each row
changes one thing. The uplift is set for the mean force of 0.00097 v² + 70 N in the first row and kept.

Run it with ``python models/studies/ac_simple_terms.py [FOLDER]``; it takes some minutes on two cores and
writes ``ac_simple_terms.md`` and ``ac_simple_terms.png``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import catenary_fe as cf
from catenary_fe.views.style import PANTOGRAPHS, finish, new_axes

LAYOUT = Path(__file__).parents[1] / "layouts" / "en50318_2018_ac_simple.toml"
SPEED = 275 / 3.6  # m/s
RANGES = {  # accepted, recalled
    "mean_N": (141.5, 146.5),
    "std_N": (31.9, 34.8),
    "std_0_5_Hz_N": (26.4, 28.9),
    "std_5_20_Hz_N": (16.2, 22.4),
    "max_N": (219, 244),
    "min_N": (71, 86),
    "contact_point_range_mm": (38, 49),
    "uplift_mm": (39, 48),
}
PUBLISHED_LENGTHS = (1.017, 0.896, 0.810, 0.758, 0.741)  # m, of the droppers, secondary source


@dataclass(frozen=True)
class Variant:
    """One change: of the line, the pantograph, the mesh, the time step or the filter."""

    line: Callable[[cf.Catenary], cf.Catenary] = lambda line: line
    pantograph: Callable[[cf.Pantograph], cf.Pantograph] = lambda p: p
    mesh: cf.MeshSettings | None = None
    time: cf.TimeSettings | None = None
    filter: str = "causal"


def supports(change: Callable[[cf.Support], cf.Support]) -> Variant:
    return Variant(lambda line: line.replace(supports=tuple(change(s) for s in line.supports)))


def arms(**changes: float) -> Variant:
    return supports(lambda s: s.replace(steady_arm=s.steady_arm.replace(**changes)))


def droppers(**changes: float) -> Variant:
    def change(line: cf.Catenary) -> cf.Catenary:
        spans = [s.replace(droppers=tuple(d.replace(**changes) for d in s.droppers)) for s in line.spans]
        return line.replace(spans=tuple(spans))

    return Variant(change)


def damping(**changes: float) -> Variant:
    return Variant(lambda line: line.replace(damping=line.damping.replace(**changes)))


def follow(support: cf.Support) -> cf.Support:
    return support.replace(messenger_stagger=support.stagger)


def level(support: cf.Support) -> cf.Support:
    return support.replace(steady_arm=support.steady_arm.replace(inclination=0.0))


def no_bending(line: cf.Catenary) -> cf.Catenary:
    return line.replace(messenger_wire=line.messenger_wire.replace(bending_stiffness=0.0))


VARIANTS = {
    "base": Variant(),
    "the line in the vertical plane": Variant(lambda line: line.planar()),
    "messenger wire follows the stagger": supports(follow),
    "arms level: no upward force": supports(level),
    "both, as the published dropper lengths ask": supports(lambda s: follow(level(s))),
    "arms without mass": arms(mass_per_length=0.0, clamp_mass=0.0),
    "arms of 0.9 m": arms(length=0.9),
    "stagger 0.3 m": supports(lambda s: s.replace(stagger=1.5 * s.stagger)),
    "dropper stiffness 100 kN/m": droppers(stiffness=1e5),
    "dropper stiffness 50 kN/m": droppers(stiffness=5e4),
    "dropper stiffness 20 kN/m": droppers(stiffness=2e4),
    "droppers and clamps without mass": droppers(
        mass_per_length=0.0, messenger_clamp_mass=0.0, contact_wire_clamp_mass=0.0
    ),
    "dropper damping 20 N s/m": droppers(damping=20.0),
    "no pre-sag": droppers(height_offset=0.0),
    "damping α = 0": damping(alpha=0.0),
    "damping β = 0": damping(beta=0.0),
    "damping β = 5e-4 s": damping(beta=5e-4),
    "contact stiffness 200 kN/m": Variant(pantograph=lambda p: p.replace(contact_stiffness=2e5)),
    "contact damping 50 N s/m": Variant(pantograph=lambda p: p.replace(contact_damping=50.0)),
    "messenger support 50 kN/m": supports(lambda s: s.replace(messenger_stiffness=5e4)),
    "messenger support undamped": supports(lambda s: s.replace(messenger_damping=0.0)),
    "messenger wire without EI": Variant(no_bending),
    "elements half as long": Variant(mesh=cf.MeshSettings().halved()),
    "time step 0.5 ms": Variant(time=cf.TimeSettings(step=5e-4)),
    "evaluated spans 8 to 13": Variant(lambda line: line.replace(evaluated_spans=tuple(range(8, 14)))),
    "zero-phase filter": Variant(filter="zero-phase"),
}
COLUMNS = tuple(RANGES)

HEADING = """# EN 50318:2018 AC simple: what each term moves

275 km/h, spans 6 to 15 of 20, causal 20 Hz filter; the uplift is set for F_m = 0.00097 v² + 70 N in the first
row, and kept. Linearised runs, which the validation report puts beside a nonlinear one; written by
`models/studies/ac_simple_terms.py`. Bold: outside the accepted ranges, which were recalled. The last column
is how much longer a span's droppers come out than the published lengths, from the outer to the middle one."""

CONCLUSION = """![σ of each variant](ac_simple_terms.png)

- The model as published and recalled is 0.4 N (σ) and 0.1 N (σ from 5 to 20 Hz) above the accepted ranges,
  and inside the other six.
- Mesh, step, filter and evaluated spans move σ by less than the model's data do: numerics are not it.
- What would bring σ inside, each by itself: arms or clamps without mass, softer droppers, a messenger support
  of 50 kN/m, β = 5e-4 s, a contact of 200 kN/m or a little contact damping. None is what the sources say.
- The published dropper lengths are met within 5 mm, instead of 12 to 23 mm, if the arms carry no weight of
  the wire and the droppers hang upright (the messenger wire above the contact wire); 2.7 mm of the rest is
  the support's spring under 1360 N. So the statics of the standard speak for level arms. The dynamics do
  not: σ and the maximum then move away from the ranges. Data and ranges here were both partly recalled.
- The pre-sag decides most: without it the low frequencies halve."""


def run_variant(name: str, uplift: float | None = None) -> dict[str, float | str]:
    """Key figures of one variant, and its dropper lengths beside the published ones.

    uplift : [N]; unset: for the mean force of EN 50367
    """
    variant = VARIANTS[name]
    line = variant.line(cf.load_catenary(LAYOUT))
    pantograph = variant.pantograph(cf.library.pantograph("EN 50318:2018 AC"))
    if uplift is not None:
        pantograph = pantograph.replace(mean_force=None, uplift_force=uplift)
    shape = cf.find_form(line, variant.mesh)
    run = cf.simulate(shape, [pantograph], speed=SPEED, time=variant.time, method="linearised")
    summary = run.summary(filter=variant.filter)
    lengths = shape.dropper_lengths[9 * len(line.spans[0].droppers) :][: len(PUBLISHED_LENGTHS)]
    longer = 1e3 * (lengths - np.array(PUBLISHED_LENGTHS))
    return summary["pantographs"][0] | {
        "uplift_mm": summary["max_support_uplift_mm"],
        "uplift_N": float(run.data["uplift_force"].values[0]),
        "longer_mm": ", ".join(f"{value:.0f}" for value in longer),
    }


def row(name: str, result: dict[str, float | str]) -> str:
    """A line of the table; what lies outside its range is bold."""
    cells = []
    for column in COLUMNS:
        low, high = RANGES[column]
        text = f"{result[column]:.1f}"
        cells.append(text if low <= float(text) <= high else f"**{text}**")
    return f"| {name} | {' | '.join(cells)} | {result['longer_mm']} |"


def main(folder: Path) -> None:
    """Run all variants, two at a time; write table and picture."""
    folder.mkdir(parents=True, exist_ok=True)
    first, *others = VARIANTS
    results = {first: run_variant(first)}
    uplift = results[first]["uplift_N"]
    print(row(first, results[first]), flush=True)
    with ProcessPoolExecutor(2) as pool:
        for name, result in zip(others, pool.map(run_variant, others, [uplift] * len(others)), strict=True):
            results[name] = result
            print(row(name, result), flush=True)
    lines = [
        "| variant | mean | σ | σ 0–5 Hz | σ 5–20 Hz | max | min (N) | range | uplift (mm) | longer (mm) |",
        "|" + "---|" * 10,
        "| accepted | " + " | ".join(f"{low:g}–{high:g}" for low, high in RANGES.values()) + " | |",
        *(row(name, result) for name, result in results.items()),
    ]
    text = "\n".join([HEADING, "", *lines, "", CONCLUSION])
    (folder / "ac_simple_terms.md").write_text(text + "\n", encoding="utf-8")
    ax = new_axes(None, (9.5, 7.5))
    for column, colour, label in (
        ("std_N", PANTOGRAPHS[0], "σ"),
        ("std_5_20_Hz_N", PANTOGRAPHS[1], "σ 5–20 Hz"),
    ):
        ax.plot([r[column] for r in results.values()], list(results), "o", color=colour, label=label)
        ax.axvspan(*RANGES[column], color=colour, alpha=0.15)
    ax.invert_yaxis()
    ax.legend(loc="lower center", fontsize=9)
    finish(
        ax,
        "standard deviation (N); bands: accepted",
        "",
        "EN 50318:2018 AC simple, 275 km/h: what each term moves",
    )
    ax.figure.savefig(folder / "ac_simple_terms.png", dpi=130)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/ac_simple_terms"))
