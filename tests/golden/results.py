"""What the golden set holds: key numbers of statics, form finding and short runs, computed anew."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import catenary_fe as cf
from catenary_fe.fe.assembly import assemble

LAYOUTS = Path(__file__).parents[2] / "models" / "layouts"
FILE = Path(__file__).with_name("golden.json")

Numbers = dict[str, float]


def line(name: str, spans: int, evaluated: int) -> cf.Catenary:
    """The first spans of a layout."""
    whole = cf.load_catenary(LAYOUTS / f"{name}.toml")
    return whole.replace(
        spans=whole.spans[:spans], supports=whole.supports[: spans + 1], evaluated_spans=(evaluated,)
    )


def form(shape: cf.Shape) -> Numbers:
    """Dropper lengths and forces of the second span, and what the second support carries."""
    rows = [row for row in shape.dropper_schedule() if row.span == 2]
    found = {f"length of dropper {i} (m)": row.length_m for i, row in enumerate(rows, start=1)}
    found |= {f"force of dropper {i} (N)": row.force_N for i, row in enumerate(rows, start=1)}
    found["steady arm (N)"] = float(shape.steady_arm_forces[1])
    found["steady arm, sideways (N)"] = float(shape.steady_arm_lateral_forces[1])
    found["messenger support (N)"] = float(shape.support_forces[1])
    return found


def curve() -> cf.Catenary:
    """A line whose spans all lie in a curve to the left, its arms inside of it."""
    straight = line("en50318_2018_ac_simple", 4, 3)
    supports = tuple(support.replace(stagger=-0.2) for support in straight.supports)
    spans = tuple(span.replace(curve_radius=1200.0) for span in straight.spans)
    return straight.replace(name="curve", spans=spans, supports=supports)


def system(shape: cf.Shape) -> Numbers:
    """Norms of mass, damping, stiffness and constant forces over the coordinates that move.

    EA decides the norms of whole matrices; tension, bending and droppers decide those of the vertical part.
    """
    assembled = assemble(shape.catenary, shape.mesh, shape.installation)
    upwards = np.zeros((assembled.reference.size // (2 * assembled.axes), 2 * assembled.axes))
    upwards[:, assembled.axes - 1] = 1.0
    vertical = assembled.gather(upwards.ravel()) > 0
    forces = assembled.gather(assembled.force)
    found = {
        "sum of force magnitudes (N)": float(np.abs(forces).sum()),
        "sum of vertical force magnitudes (N)": float(np.abs(forces[vertical]).sum()),
    }
    for name, matrix in {
        "mass": assembled.free(assembled.mass),
        "damping": assembled.free(assembled.damping() + assembled.taut_damping()),
        "stiffness": assembled.tangent(0 * assembled.reference),
    }.items():
        part = matrix[vertical][:, vertical]
        found[f"{name}, trace"] = float(matrix.trace())
        found[f"{name}, Frobenius norm"] = float(np.sqrt(matrix.power(2).sum()))
        found[f"{name}, trace of the vertical part"] = float(part.trace())
        found[f"{name}, Frobenius norm of the vertical part"] = float(np.sqrt(part.power(2).sum()))
    return found


def statics(shape: cf.Shape) -> Numbers:
    """Elasticity at a support and at mid-span."""
    support, middle = shape.catenary.support_positions[[1, 2]].tolist()
    curve = cf.elasticity(shape, positions=[support, (support + middle) / 2])
    return {
        f"elasticity at {x:g} m (mm/N)": 1e3 * e for x, e in zip(curve.position, curve.values, strict=True)
    }


def run(shape: cf.Shape, pantograph: cf.Pantograph, speed_kmh: float, method: Any, step: float) -> Numbers:
    """Statistics and extremes."""
    time = cf.TimeSettings(step=step)
    result = cf.simulate(shape, [pantograph], speed=speed_kmh / 3.6, time=time, method=method)
    (statistics,) = result.contact_force_statistics()
    found = {name: value for name, value in statistics.as_dict().items() if isinstance(value, float)}
    found["max_support_uplift_mm"] = 1e3 * result.largest_support_uplift()
    found["largest_dropper_force_N"] = float(result.data["dropper_force"].values.max())
    found["last_contact_force_N"] = float(result.data["contact_force"].values[0, -1])
    return found


def compute() -> dict[str, Numbers]:
    """All numbers by case, then by name."""
    plane, space = line("en50318_2002", 4, 3), line("en50318_2018_ac_stitched", 4, 3)
    flat, deep = cf.find_form(plane), cf.find_form(space)
    head = cf.library.pantograph("EN 50318:2002")
    return {
        "en50318_2002: system": system(flat),
        "en50318_2018_ac_stitched: system": system(deep),
        "dc_3kv_twin: system": system(cf.find_form(line("dc_3kv_twin", 3, 2))),
        "en50318_2018_ac_simple in a curve: system": system(cf.find_form(curve())),
        "en50318_2002: form": form(flat),
        "en50318_2002: statics": statics(flat),
        "en50318_2002: linearised run, 250 km/h": run(flat, head, 250, "linearised", 1e-3),
        "en50318_2002: nonlinear run, 250 km/h": run(flat, head, 250, "nonlinear", 2e-3),
        "en50318_2018_ac_stitched: form": form(deep),
        "en50318_2018_ac_stitched: statics": statics(deep),
        "en50318_2018_ac_stitched: linearised run, 200 km/h": run(deep, head, 200, "linearised", 1e-3),
    }
