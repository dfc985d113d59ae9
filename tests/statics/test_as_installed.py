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
    """Heights [m] of the contact wire at the lower clamps, and dropper forces [N], of pieces of string.

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
    built = wire.as_built or cf.AsBuilt()
    length = length + built.at("dropper_length", ups)
    top_z = top_z + built.at("messenger_wire_height", masts)
    ratio = {name: 1 + float(built.at(f"{name}_wire_tension", 0.0)) for name in nodes}

    def forces(z):
        rise = np.interp(ups, nodes["messenger"], z[n:]) - np.interp(lows, nodes["contact"], z[:n])
        now = np.hypot(rise, lows - ups)
        pull = np.maximum(stiffness * (now - length), 0)
        return pull, pull * rise / now

    def out_of_balance(z):
        total = []
        _, lift = forces(z)
        for name, own, params, sign, places in (
            ("contact", z[:n], CONTACT, 1, lows),
            ("messenger", z[n:], MESSENGER, -1, ups),
        ):
            x, h = nodes[name], np.diff(nodes[name])
            middle, weight = (x[:-1] + x[1:]) / 2, np.full(h.size, params.mass_per_length)
            for wear in wire.wear if name == "contact" else ():
                begin, end = wear.ends(wire)
                weight[(middle > begin) & (middle < end)] *= wear.area_left
            slope = ratio[name] * params.tension * np.diff(own) / h
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
            ends = (arm_z if name == "contact" else top_z)[[0, -1]]
            force[at[[0, -1]]] = own[[0, -1]] - ends
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
    "built otherwise": line(
        as_built=cf.AsBuilt(
            contact_wire_tension=-0.04,
            messenger_wire_tension=0.05,
            dropper_length=[[0.0, 0.0], [60.0, 0.01], [90.0, -0.015], [150.0, 0.0]],
            messenger_wire_height=[[0.0, 0.005], [50.0, 0.02], [100.0, -0.01], [150.0, 0.0]],
        )
    ),
    "lengths by chance": line(as_built=cf.AsBuilt(dropper_length={"deviation": 0.006, "seed": 2})),
    "all": line(
        {(1, 5): {"state": "missing"}, (2, 2): {"clamp_shift": 0.2}, (3, 1): {"state": "broken"}},
        wear=[cf.Wear(begin=0.0, end=150.0, area_left=0.85)],
        as_built=cf.AsBuilt(dropper_length=0.004, contact_wire_tension=0.03),
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_strings_by_hand(name):
    changed = CHANGES[name]
    shape, design = cf.find_form(changed), cf.find_form(changed.as_designed())
    longer = (changed.as_built or cf.AsBuilt()).at("dropper_length", changed.dropper_positions)
    cut = design.dropper_lengths[changed.hanging] + longer
    assert shape.dropper_lengths == pytest.approx(cut, abs=1e-12)
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
    """Between outer droppers it rises with the messenger wire: T₁ u₁ + T₂ u₂ = Δw s²/2, s from mid-span."""
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


def test_a_slid_clamp_and_its_mirror_image():
    changed = CHANGES["all"]
    shape, image = cf.find_form(changed), cf.find_form(changed.mirrored())
    x = np.linspace(0, 3 * SPAN, 301)
    assert image.contact_wire_height(3 * SPAN - x) == pytest.approx(shape.contact_wire_height(x), abs=1e-7)
    assert image.dropper_forces[::-1] == pytest.approx(shape.dropper_forces, abs=1e-3)


def test_lengths_of_a_table_and_a_missing_dropper():
    """Given lengths that are those of the design: the same line."""
    changed = CHANGES["all"]
    lengths = cf.find_form(changed.as_designed()).dropper_lengths
    assert lengths.size == changed.hanging.size == len(changed.droppers) + 2
    shape, given = cf.find_form(changed), cf.find_form(changed.with_dropper_lengths(lengths))
    assert given.contact_wire_z == pytest.approx(shape.contact_wire_z, abs=1e-6)
    assert "2 droppers" not in given.lengths_note
    assert "1 dropper missing, 1 dropper broken, 1 clamp slid, 1 range of worn" in given.lengths_note


@pytest.mark.parametrize("arm", [ARM, cf.SteadyArm(length=1.0, mass_per_length=0.7, clamp_mass=0.2)])
def test_all_engines_run_on_it(arm):
    """At rest it stays where it was hung; engines agree."""
    stagger = 0.2 if arm.length else 0.0
    supports = [
        cf.Support(messenger_stiffness=3e5, steady_arm=arm, stagger=stagger * (-1) ** i) for i in range(4)
    ]
    changed = line(
        {(1, 4): {"state": "missing"}, (2, 2): {"clamp_shift": 0.3}, (2, 4): {"state": "broken"}},
        contact_wire=CONTACT.replace(bending_stiffness=120.0),
        supports=supports,
        wear=[cf.Wear(span=2, area_left=0.8)],
        damping=cf.RayleighDamping(beta=1e-3),
    )
    shape = cf.find_form(changed)
    assert cf.solve_statics(shape).contact_wire_z == pytest.approx(shape.contact_wire_z, abs=1e-9)
    head = cf.library.pantograph("EN 50318:2002")
    runs = {}
    for method in ("nonlinear", "linearised", "exudyn") if not arm.length else ("nonlinear", "linearised"):
        run = cf.simulate(shape, [head], speed=50.0, method=method)
        runs[method] = run.contact_force_statistics()[0]
        assert run.data.sizes["dropper"] == len(changed.droppers) == 13
    for statistics in runs.values():
        assert statistics.mean == pytest.approx(runs["nonlinear"].mean, rel=5e-3)
        assert statistics.std == pytest.approx(runs["nonlinear"].std, rel=1e-2)
    lifts = cf.elasticity(shape, positions=[75.0, 85.0]).values
    design = cf.elasticity(cf.find_form(changed.as_designed()), positions=[75.0, 85.0]).values
    assert lifts[1] > 1.03 * design[1]


def test_a_link_keeps_its_pivot():
    """Where its wire gets lighter, the link turns about the design's pivot, and takes the wire sideways."""
    arm = cf.SteadyArm(length=1.0, mass_per_length=0.7, clamp_mass=0.2)
    supports = [cf.Support(steady_arm=arm, stagger=0.2 * (-1) ** i) for i in range(4)]
    worn = line({(2, 1): {"state": "missing"}}, supports=supports, wear=[cf.Wear(span=1, area_left=0.8)])
    shape, design = cf.find_form(worn), cf.find_form(worn.as_designed())
    moved = shape.contact_wire_height(SPAN) - design.contact_wire_height(SPAN)
    pivots = shape.system.arms.pivot - design.system.arms.pivot
    assert abs(moved) > 5e-3
    assert np.abs(pivots).max() < 1e-4
    sideways = shape.wires[0].lateral(SPAN) - design.wires[0].lateral(SPAN)
    assert abs(sideways) > 1e-3


GONE = {"clamp_shift": 0.1, "state": "missing"}
REFUSED = {
    "past the next one": ({(1, 2): {"clamp_shift": 11.0}}, (), "clamp_shift puts its clamp at 26 m"),
    "past a support": ({(1, 1): {"clamp_shift": -5.5}}, (), "dropper 1: .* past the support at 0 m"),
    "too far": ({(1, 3): {"clamp_shift": 1.2}}, (), r"more than its length of 0\.828 m reaches"),
    "of one that is gone": ({(2, 3): GONE}, (), "of a dropper that is missing"),
    "some lengths": ({(2, 3): {"length": 0.9, "state": "missing"}}, (), "14 of 15 droppers have none"),
    "no span": ({}, [{"span": 4}], "wear 1: span = 4: the line has spans 1 to 3"),
    "off the line": ({}, [{"begin": 1.0, "end": 151.0}], "must lie between the line's ends"),
    "twice": ({}, [{"span": 1}, {"span": 1}], "wear 2: .* overlaps with wear 1"),
    "one of one": ({}, [{"span": 1, "contact_wire": 2}], "there is one contact wire"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be(case):
    changed, wear, said = REFUSED[case]
    with pytest.raises(cf.InputError, match=said) as caught:
        cf.find_form(line(changed, wear=[cf.Wear(area_left=0.9, **each) for each in wear]))
    assert len(caught.value.problems) == 1


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"span": 1, "begin": 0.0, "end": 3.0}, "give exactly one"),
        ({"begin": 0.0}, "give exactly one"),
        ({"begin": 3.0, "end": 2.0}, "end = 2 m does not lie behind begin = 3 m"),
    ],
)
def test_no_range_of_wear(values, said):
    with pytest.raises(cf.InputError, match=said):
        cf.Wear(area_left=0.9, **values)


def test_a_length_that_nobody_hangs():
    lengths = cf.find_form(line()).dropper_lengths.copy()
    lengths[7] = 0.05
    with pytest.raises(
        cf.InputError, match=r"span 2: dropper 3 .* hangs 3\d\d mm above its design height"
    ) as caught:
        cf.find_form(line().with_dropper_lengths(lengths))
    assert len(caught.value.problems) == 1


def test_against_the_design():
    rows = cf.against_design(cf.find_form(CHANGES["broken"]))
    assert [row.state for row in rows] == [""] * 6 + ["broken", "", "missing"] + [""] * 6
    gone, beside = rows[6], rows[7]
    assert (gone.force_N, gone.length_m) == (0.0, None)
    assert gone.height_difference_mm == pytest.approx(
        1e3 * (gone.contact_wire_height_m - gone.design_height_m)
    )
    assert gone.height_difference_mm < -5
    assert beside.force_difference_N == pytest.approx(beside.force_N - beside.design_force_N)
    assert beside.force_difference_N > 40
    assert sum(abs(row.force_difference_N) for row in cf.against_design(cf.find_form(line()))) < 1e-6


def test_a_line_of_sections():
    """What has changed on one section stays there, and is numbered as the section has it."""
    section = line()
    spans = section.spans + section.spans[:2]
    plain = section.replace(spans=spans, supports=(section.supports[0],) * 6)
    gone = spans[1].droppers[2].replace(state="missing")
    droppers = tuple(gone if d.position == gone.position else d for d in spans[1].droppers)
    changed = plain.replace(
        spans=(spans[0], spans[1].replace(droppers=droppers), *spans[2:]),
        wear=[cf.Wear(span=1, area_left=0.8)],
    )
    overlap = cf.Overlap(spans=3)
    whole = cf.join_sections([changed, plain], [overlap])
    shape, design = cf.find_form(whole), cf.find_form(whole.as_designed())
    assert (whole.departs_from_design, whole.as_designed().departs_from_design) == (True, False)
    assert shape.dropper_forces.size == design.dropper_forces.size - 1 == len(whole.droppers)
    assert shape.dropper_lengths.tolist() == design.dropper_lengths[whole.hanging].tolist()
    rows = cf.against_design(shape)
    assert [(r.section, r.span, r.dropper) for r in rows if r.state == "missing"] == [(1, 2, 3)]
    moved = [max(abs(r.height_difference_mm) for r in rows if r.section == n) for n in (1, 2)]
    assert moved[0] > 10
    assert moved[1] < 1e-6
    assert "1 dropper missing, 1 range of worn contact wire" in shape.lengths_note


def test_elements_of_a_worn_wire():
    """Mass and EA with the area, EI with its square; the tension stays; half an element counts by half."""
    stiff = CONTACT.replace(bending_stiffness=150.0)
    worn = line(contact_wire=stiff, wear=[cf.Wear(begin=60.0, end=85.4, area_left=0.7)])
    shape = cf.find_form(worn)
    now, new = shape.system, cf.find_form(worn.as_designed()).system
    x = shape.mesh.wires[0].x
    inside = np.flatnonzero((x[:-1] >= 60.0) & (x[1:] <= 85.4))
    assert inside.size > 10
    for cables, power in (("axial_stiffness", 1), ("bending_stiffness", 2)):
        ratio = getattr(now.cables, cables)[inside] / getattr(new.cables, cables)[inside]
        assert ratio == pytest.approx(np.full(inside.size, 0.7**power))
    n = x.size - 1
    lost = (new.mass_per_length[:n] - now.mass_per_length[:n]) @ np.diff(x)
    assert lost == pytest.approx(0.3 * 25.4 * stiff.mass_per_length, rel=1e-9)
    held = -(now.cables.axial_stiffness * now.cables.rest_strain)[:n]
    assert held == pytest.approx(np.full(n, CONTACT.tension))
    assert (now.mass_per_length[n:] == new.mass_per_length[n:]).all()
