"""Linearised runs in space against nonlinear ones: stagger, stitch wires, twin wires, rolling heads."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.exudyn.run import Trip, drive
from catenary_fe.studies.linearised import LinearisedLine

SPEED, STEPS = 275 / 3.6, 300


def cut(path, spans):
    """The first spans of a layout."""
    line = cf.load_catenary(path)
    return line.replace(
        spans=line.spans[:spans], supports=line.supports[: spans + 1], evaluated_spans=(spans - 1,)
    )


@pytest.mark.parametrize("layout", ["en50318_2018_ac_simple", "en50318_2018_ac_stitched", "dc_3kv_twin"])
def test_the_first_steps_agree(reference_layout, layout):
    line = cut(reference_layout.parent / f"{layout}.toml", 3)
    head = cf.Panhead(width=1.6, strips=2, strip_distance=0.4, spring_distance=0.9)
    pantograph = cf.library.pantograph("EN 50318:2018 AC").replace(
        mean_force=None, uplift_force=140.0, head=head, contact_damping=20.0
    )
    shape = cf.find_form(line)
    assert shape.mesh.first_nodes.size - 1 > 1 and shape.wires[0].y.any()
    start = np.array([line.support_positions[1] - 12.0])  # past an arm, where the wire turns
    trip = Trip(SPEED, start, STEPS, cf.TimeSettings(tolerance=1e-5))
    theirs = drive(line, shape.mesh, shape.installation, [(pantograph, 140.0)], trip)
    (ours,) = LinearisedLine(shape).run([RunCase([pantograph], SPEED, start, (STEPS + 0.5) * SPEED * 1e-3)])
    assert isinstance(ours, cf.Run)
    force = theirs.contact_force
    spread = np.std(force)
    assert ours.data["contact_force"].values[0, 0] == pytest.approx(force[0, 0], abs=0.05)
    assert np.std(ours.data["contact_force"].values - force) < 0.05 * spread
    masses = ours.data["mass_height"].values[0] - line.contact_wire_height
    assert masses == pytest.approx(theirs.mass_heights[0], abs=1e-3)
    assert ours.data["wire_height"].values - line.contact_wire_height == pytest.approx(
        theirs.wire_height, abs=1e-3
    )
