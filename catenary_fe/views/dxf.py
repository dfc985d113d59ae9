"""The long section of a line as DXF, for CAD programs."""

from __future__ import annotations

from importlib.util import find_spec
from io import StringIO
from pathlib import Path

import numpy as np

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, number
from catenary_fe.results.files import write_text
from catenary_fe.statics import Shape

_LAYERS = {"CONTACT_WIRE": 1, "MESSENGER_WIRE": 5, "STITCH_WIRE": 3, "DROPPERS": 8, "MASTS": 7, "TEXT": 7}
_TEXT = 0.12  # [m] height of letters


def check_dxf() -> None:
    """Raises InputError where the package that writes DXF is not there."""
    if find_spec("ezdxf") is None:
        raise InputError('a DXF file needs the package ezdxf: pip install "catenary_fe[dxf]"')


@checked
def write_dxf(shape: Shape, path: str | Path, *, exaggeration: float = 1.0) -> Path:
    """Write the long section of a line at rest as a DXF file; returns its path.

    x is the place along the line and y the height above the rail, in m. Wires, droppers, masts (from the rail
    to the messenger wire) and texts (supports with height and stagger, droppers with their lengths in mm) are
    on layers of their own.

    exaggeration : by which heights are stretched

    Raises InputError where ezdxf is missing, or the file cannot be written.
    """
    number("exaggeration", exaggeration, least=0.1, most=100.0)
    check_dxf()
    from ezdxf.filemanagement import new

    document = new("R2010", units=6)  # metres
    for name, colour in _LAYERS.items():
        document.layers.add(name, color=colour)
    space = document.modelspace()

    def draw(layer: str, points: list[tuple[float, float]]) -> None:
        space.add_lwpolyline([(x, z * exaggeration) for x, z in points], dxfattribs={"layer": layer})

    def write(text: str, x: float, z: float) -> None:
        placed = {"layer": "TEXT", "insert": (x, z * exaggeration), "height": _TEXT, "rotation": 90}
        space.add_text(text, dxfattribs=placed)

    for i, wire in enumerate(shape.wires):
        layer = shape.mesh.wire_name(i).upper().replace(" ", "_")
        draw(layer, list(zip(wire.x.tolist(), wire.z.tolist(), strict=True)))
    at = shape.catenary.dropper_positions.tolist()
    upper, lower = shape.mesh.upper.wire, shape.mesh.lower.wire
    for i, (x, row) in enumerate(zip(at, shape.dropper_schedule(), strict=True)):
        low, high = (float(np.interp(x, shape.wires[w].x, shape.wires[w].z)) for w in (lower[i], upper[i]))
        draw("DROPPERS", [(x, low), (x, high)])
        write(f"{row.dropper}: {row.cut_length_mm} mm", x + _TEXT, low)
    for mast in shape.support_schedule():
        arm = mast.arms[0]
        top = mast.messenger_wire_height_m or arm.contact_wire_height_m
        draw("MASTS", [(mast.chainage_m, 0.0), (mast.chainage_m, top)])
        text = f"{mast.support}: {mast.chainage_m:.3f} m, wire {arm.contact_wire_height_m:.3f} m"
        write(f"{text}, stagger {1e3 * arm.stagger_m:.0f} mm", mast.chainage_m - _TEXT, 0.2)
    content = StringIO()
    document.write(content)
    write_text(path, content.getvalue())
    return Path(path)
