"""A line that has changed since its droppers were cut, against strings solved by hand in one system."""

import numpy as np
import pytest
from scipy.optimize import root

import catenary_fe as cf

GRAVITY, SPAN = 9.81, 50.0
POSITIONS = (5.0, 15.0, 25.0, 35.0, 45.0)
CONTACT = cf.Wire(mass_per_length=1.07, tension=15e3, axial_stiffness=1.2e7)
MESSENGER = cf.Wire(mass_per_length=0.6, tension=12e3, axial_stiffness=8e6)
ARM = cf.SteadyArm(stiffness=250.0, mass=0.8)


def line(changed: dict[tuple[int, int], dict] | None = None, **others) -> cf.Catenary:
    """Three spans of strings; values of droppers that differ by numbers of span and dropper."""
    spans = [
        cf.Span(
            length=SPAN,
            pre_sag=0.03,
            droppers=[
                cf.Dropper(
                    position=x,
                    stiffness=1e5,
                    mass_per_length=0.1,
                    messenger_clamp_mass=0.2,
                    contact_wire_clamp_mass=0.15,
                    **(changed or {}).get((i, n), {}),
                )
                for n, x in enumerate(POSITIONS, start=1)
            ],
        )
        for i in (1, 2, 3)
    ]
    return cf.Catenary(
        **{
            "contact_wire": CONTACT,
            "messenger_wire": MESSENGER,
            "spans": spans,
            "supports": [cf.Support(messenger_stiffness=3e5, steady_arm=ARM)] * 4,
        }
        | others
    )


def by_hand(wire: cf.Catenary, design: cf.Shape) -> tuple[np.ndarray, np.ndarray]:
    """Heights [m] of the contact wire at the lower clamps, and dropper forces [N], of straight pieces of string.

    Exact: under its weight a string's ends pull as those of a straight one with half the weight at each.
    Arms and supports keep the force and height that they have in the design.
    """
    length = design.dropper_lengths[wire.hanging]
    ups, lows = wire.dropper_positions, wire.lower_clamp_positions
    masts = wire.support_positions
    loads: list[tuple[float, float, str]] = []  # place, [N], wire
    number = 0
    for i, span in enumerate(wire.spans):
        for d in span.droppers:
            x = masts[i] + d.position
            half = d.mass_per_length * length[number] / 2 if d.state is None else 0.0
            if d.state != "missing":
                loads.append((x + d.clamp_shift, GRAVITY * (d.contact_wire_clamp_mass + half), "contact"))
                loads.append((x, GRAVITY * (d.messenger_clamp_mass + half), "messenger"))
            number += d.state is None
    edges = [end for wear in wire.wear for end in wear.ends(wire)]
    nodes = {
        "contact": np.unique(np.r_[masts, lows, [x for x, _, w in loads if w == "contact"], edges]),
        "messenger": np.unique(np.r_[masts, ups, [x for x, _, w in loads if w == "messenger"]]),
    }
    n = nodes["contact"].size
    arms = design.installation.arm_forces[0, :, -1]
    arm_z = design.wires[0].height(masts)
    top, top_z = design.support_forces, design.messenger_wire.height(masts)
    stiffness = np.array([d.stiffness for d in wire.droppers])

    def forces(z):
        rise = np.interp(ups, nodes["messenger"], z[n:]) - np.interp(lows, nodes["contact"], z[:n])
        now = np.hypot(rise, lows - ups)
        pull = np.maximum(stiffness * (now - length), 0)
        return pull, pull * rise / now

    def out_of_balance(z):
        total = []
        pull, lift = forces(z)
        for name, own, params, sign, places in (
            ("contact", z[:n], CONTACT, 1, lows),
            ("messenger", z[n:], MESSENGER, -1, ups),
        ):
            x, h = nodes[name], np.diff(nodes[name])
            middle, weight = (x[:-1] + x[1:]) / 2, np.full(h.size, params.mass_per_length)
            for wear in wire.wear if name == "contact" else ():
                begin, end = wear.ends(wire)
                weight[(middle > begin) & (middle < end)] *= wear.area_left
            slope = params.tension * np.diff(own) / h
            force = np.zeros(x.size)
            force[:-1] += slope - GRAVITY * weight * h / 2
            force[1:] -= slope + GRAVITY * weight * h / 2
            for place, load, which in loads:
                force[np.searchsorted(x, place - 1e-9)] -= load if which == name else 0
            np.add.at(force, np.searchsorted(x, places - 1e-9), sign * lift)
            at = np.searchsorted(x, masts - 1e-9)
            if name == "contact":
                force[at[1:-1]] += arms[1:-1] - ARM.stiffness * (own[at] - arm_z)[1:-1]
                force[at[1:-1]] -= GRAVITY * ARM.mass
            else:
                force[at[1:-1]] += top[1:-1] - 3e5 * (own[at] - top_z)[1:-1]
            force[at[[0, -1]]] = (own - (arm_z[0] if name == "contact" else top_z[0]))[[0, -1]]
            total.append(force)
        return np.concatenate(total)

    start = np.r_[np.full(n, 5.3), design.messenger_wire.height(nodes["messenger"])]
    found = root(out_of_balance, start, tol=1e-12)
    assert np.abs(out_of_balance(found.x)).max() < 1e-6
    return np.interp(lows, nodes["contact"], found.x[:n]), forces(found.x)[0]


CHANGES = {
    "missing": line({(2, 3): {"state": "missing"}}),
    "next to an arm": line({(2, 1): {"state": "missing"}}),
    "broken": line({(2, 2): {"state": "broken"}, (2, 4): {"state": "missing"}}),
    "slid": line({(2, 3): {"clamp_shift": 0.25}, (1, 2): {"clamp_shift": -0.1}}),
    "worn": line(wear=[cf.Wear(span=2, area_left=0.8), cf.Wear(begin=110.0, end=125.0, area_left=0.7)]),
    "all": line(
        {(1, 5): {"state": "missing"}, (2, 2): {"clamp_shift": 0.2}, (3, 1): {"state": "broken"}},
        wear=[cf.Wear(begin=0.0, end=150.0, area_left=0.85)],
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_strings_by_hand(name):
    changed = CHANGES[name]
    shape, design = cf.find_form(changed), cf.find_form(changed.as_designed())
    assert shape.dropper_lengths.tolist() == design.dropper_lengths[changed.hanging].tolist()
    heights, forces = by_hand(changed, design)
    z = np.concatenate([wire.z for wire in shape.wires])[shape.mesh.nodes(shape.mesh.lower)]
    x = np.linspace(0, 3 * SPAN, 301)
    assert np.abs(shape.contact_wire_height(x) - design.contact_wire_height(x)).max() > 5e-3
    assert z == pytest.approx(heights, abs=2e-5)
    assert shape.dropper_forces == pytest.approx(forces, abs=0.05)


def test_a_missing_dropper_by_formula():
    """Its neighbours carry its share, and the wire between them sags like a string of twice the length."""
    changed = CHANGES["missing"]
    shape, design = cf.find_form(changed), cf.find_form(changed.as_designed())
    before, after = design.dropper_forces[5:10], shape.dropper_forces[5:9]
    assert changed.dropper_numbers[5:9].tolist() == [1, 2, 4, 5]
    assert after.sum() == pytest.approx(before.sum() - GRAVITY * 0.15, rel=5e-3)
    assert (after - before[[0, 1, 3, 4]])[1:3].min() > 0.4 * before[2]
    ends = shape.contact_wire_height([65.0, 85.0])
    sag = ends.mean() - float(shape.contact_wire_height(75.0))
    assert sag == pytest.approx(GRAVITY * CONTACT.mass_per_length * 20.0**2 / (8 * CONTACT.tension), rel=2e-3)


def test_a_wire_of_uniform_wear_by_formula():
    """It rises with the messenger wire between its outer droppers: T₁ u₁ + T₂ u₂ = Δw s²/2, s from mid-span."""
    share, s = 0.8, 20.0
    worn = line(wear=[cf.Wear(begin=0.0, end=150.0, area_left=share)])
    new, design = cf.find_form(worn), cf.find_form(worn.as_designed())
    bent = 0.0
    for wire in (0, 1):  # droppers stretch between them: their bending moments together are exact
        after, before = (shape.wires[wire].height([75.0, 75.0 - s]) for shape in (new, design))
        bent += (CONTACT, MESSENGER)[wire].tension * float(np.diff(before - after)[0])
    lost = (1 - share) * GRAVITY * CONTACT.mass_per_length
    assert bent == pytest.approx(lost * s**2 / 2, rel=1e-3)
    assert new.contact_wire_height(75.0) - design.contact_wire_height(75.0) > 0.02


def test_nothing_changed_is_nothing():
    same = line({(2, 3): {"clamp_shift": 0.0}}, wear=[cf.Wear(span=1, area_left=1.0)])
    shape, design = cf.find_form(same), cf.find_form(same.as_designed())
    assert shape.contact_wire_z == pytest.approx(design.contact_wire_z, abs=1e-8)
    assert shape.dropper_forces == pytest.approx(design.dropper_forces, abs=1e-3)
