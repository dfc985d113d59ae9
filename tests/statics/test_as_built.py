"""A line that was built otherwise than it was drawn."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout import layout_text
from catenary_fe.layout.as_built import deviations
from catenary_fe.layout.files import layout_bytes
from catenary_fe.layout.installed import worn_depth
from tests.conftest import LAYOUTS


def planar(**built) -> cf.Catenary:
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    return line.replace(as_built=cf.AsBuilt(**built))


def spatial(**built) -> cf.Catenary:
    line = cf.load_catenary(LAYOUTS / "re250.toml")
    part = {"spans": line.spans[:6], "supports": line.supports[:7], "evaluated_spans": (3, 4)}
    return line.replace(as_built=cf.AsBuilt(**built), **part)


def test_the_drawing_is_what_it_was():
    """Deviations move no design height, no base of a pantograph, and as_designed takes them back."""
    line = planar(dropper_length=0.004, contact_wire_height={"deviation": 0.002}, pre_sag=0.01)
    drawn = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    assert line.as_designed() == drawn
    assert line.design_heights.tolist() == drawn.design_heights.tolist()
    assert not line.changes_height and not cf.find_form(line).system.base_line.varies
    assert "3 deviations as built" in cf.find_form(line).lengths_note


def test_heights_that_were_set_are_met():
    """At droppers and arms; between the lines' ends nothing else holds the wire."""
    waves = {"deviation": 0.002, "shortest_wave": 20.0, "longest_wave": 60.0, "seed": 5}
    line = planar(contact_wire_height=waves, pre_sag=0.01)
    shape = cf.find_form(line)
    assert line.as_built is not None
    x = line.support_positions
    off = line.as_built.at("contact_wire_height", x)
    assert shape.contact_wire_height(x) - line.contact_wire_height == pytest.approx(off, abs=1e-9)
    droppers = line.dropper_positions
    sags = [0.04 * share * (1 - share) for share in np.linspace(0, 1, 3)]
    wanted = line.as_built.at("contact_wire_height", droppers)
    errors = shape.height_errors - wanted
    middle = errors[4::9]
    assert middle == pytest.approx(-sags[1] * np.ones(10), abs=1e-9)
    assert errors[::9] == pytest.approx(np.zeros(10), abs=1e-9)


ELSEWHERE = [[0.0, 0.0], [130.0, 0.0], [195.0, 0.03], [260.0, -0.02], [390.0, 0.0]]


def bare(arm: cf.SteadyArm) -> cf.Catenary:
    """A light wire without droppers, drawn and built with arms elsewhere."""
    line = spatial().as_designed()
    return line.replace(
        contact_wire=line.contact_wire.replace(mass_per_length=0.2),
        spans=[cf.Span(length=span.length, droppers=()) for span in line.spans],
        messenger_wire=None,
        stitch_wire=None,
        supports=[cf.Support(stagger=2 * s.stagger, steady_arm=arm) for s in line.supports],
        system_height=1.2,
        as_built=cf.AsBuilt(stagger=ELSEWHERE),
    )


def test_springs_that_stand_elsewhere_hold_the_wire_there():
    """Without droppers it is a polygon, and the pull on an arm that of its bend there."""
    built = bare(cf.SteadyArm(stiffness=300.0))
    shape = cf.find_form(built)
    at = shape.mesh.wires[0].supports
    assert shape.wires[0].y[at] == pytest.approx(built.staggers, abs=1e-12)
    assert built.staggers[3] - built.supports[3].stagger == pytest.approx(0.03)
    tension, span = built.contact_wire.tension, built.spans[0].length
    bends = np.diff(np.diff(built.staggers) / span)
    assert shape.steady_arm_lateral_forces[1:-1] == pytest.approx(-tension * bends, rel=4e-3)
    assert shape.steady_arm_lateral_forces[1:-1] != pytest.approx(-1.01 * tension * bends, rel=4e-3)


def test_pivots_of_links_stand_elsewhere():
    """A link's force points to its pivot; found from it, that has moved as said and no further."""
    built = bare(cf.SteadyArm(length=1.15, mass_per_length=0.78))
    pivots = []
    for line in (built.as_designed(), built):
        shape = cf.find_form(line)
        at, force = shape.mesh.wires[0].supports, shape.installation.arm_forces[0]
        place = np.column_stack([shape.wires[0].y[at], shape.wires[0].z[at]])[1:-1]
        reach = force[1:-1] / np.linalg.norm(force[1:-1], axis=1)[:, None]
        pivots.append(place + 1.15 * reach)
    moved = pivots[1] - pivots[0]
    off = built.staggers[1:-1] - built.as_designed().staggers[1:-1]
    assert np.abs(off).max() == pytest.approx(0.03)
    assert moved == pytest.approx(np.column_stack([off, 0 * off]), abs=1e-6)


@pytest.mark.parametrize(
    "built",
    [
        {"contact_wire_tension": 0.04},
        {"messenger_wire_tension": {"deviation": 0.03, "seed": 7}},
        {"stagger": {"deviation": 0.02}},
        {"messenger_wire_height": {"deviation": 0.02}},
        {"dropper_length": {"deviation": 0.003}},
        {"contact_wire_height": {"deviation": 0.001, "shortest_wave": 30.0, "longest_wave": 60.0}},
    ],
)
def test_a_line_in_space_is_in_balance_and_the_same_in_a_mirror_and_a_file(built):
    line = spatial(**built)
    shape, image = cf.find_form(line), cf.find_form(line.mirrored())
    system = shape.system
    assert np.abs(system.gather(system.out_of_balance(np.zeros(system.dof.size)))).max() < 1e-9
    x = np.linspace(1.0, line.length - 1.0, 50)
    assert image.contact_wire_height(line.length - x) == pytest.approx(shape.contact_wire_height(x), abs=1e-9)
    assert np.abs(shape.wires[0].z - cf.find_form(line.as_designed()).wires[0].z).max() > 3e-4
    assert "as_built" in layout_text(line)


def test_tensions_are_those_of_the_wires():
    line = spatial(contact_wire_tension=0.04, messenger_wire_tension=-0.03)
    system = cf.find_form(line).system
    mid = [float(np.median(wire.tension)) for wire in system.wires[:2]]
    assert mid == pytest.approx(
        [1.04 * line.contact_wire.tension, 0.97 * line.messenger_wire.tension], rel=1e-9
    )
    drawn = cf.solve_modes(cf.find_form(line.as_designed()), count=1).frequencies[0]
    assert cf.solve_modes(cf.find_form(line), count=1).frequencies[0] != pytest.approx(drawn, rel=1e-3)


def test_what_is_drawn_by_chance():
    """Same seed, same numbers; other seeds and other kinds, others; of the right deviation and waves."""
    x = np.linspace(0, 5000, 4001)
    by_itself = cf.AsBuilt(
        dropper_length={"deviation": 0.004, "seed": 3}, stagger={"deviation": 0.004, "seed": 3}
    )
    lengths, staggers = by_itself.at("dropper_length", x), by_itself.at("stagger", x)
    assert lengths.tolist() == by_itself.at("dropper_length", x).tolist()
    assert lengths.std() == pytest.approx(0.004, rel=0.05)
    assert abs(np.corrcoef(lengths, staggers)[0, 1]) < 0.06
    assert abs(np.corrcoef(lengths[1:], lengths[:-1])[0, 1]) < 0.06
    waves = cf.AsBuilt(
        contact_wire_height={"deviation": 0.004, "shortest_wave": 20.0, "longest_wave": 60.0, "seed": 3}
    ).at("contact_wire_height", x)
    assert waves.std() == pytest.approx(0.004, rel=0.05)
    power = np.abs(np.fft.rfft(waves)) ** 2
    number = np.fft.rfftfreq(x.size, x[1] - x[0])
    assert power[(number > 1 / 63) & (number < 1 / 19)].sum() > 0.97 * power.sum()


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: planar(stagger=0.02), "as_built.stagger leaves the vertical plane; set spatial = true"),
        (lambda: planar(dropper_length=0.6), "must be a number from -0.5 to 0.5"),
        (lambda: planar(dropper_length={"deviation": -1.0}), "dropper_length: deviation = -1.0: must be"),
        (lambda: planar(dropper_length={"deviation": 0.4}), "deviation = 0.4: must be at most 0.167"),
        (lambda: planar(dropper_length={"std": 0.4}), "did you mean|unknown key"),
        (lambda: planar(pre_sag={"deviation": 0.01, "shortest_wave": 5.0}), "give both or neither"),
        (lambda: planar(dropper_length=[[5.0, 0.0], [1.0, 0.0]]), "does not come after"),
        (
            lambda: planar(
                contact_wire_tension={"deviation": 0.01, "shortest_wave": 5.0, "longest_wave": 9.0}
            ),
            "a wire has one tension",
        ),
        (
            lambda: planar(contact_wire_height=0.01).with_dropper_lengths(np.ones(90)),
            "no effect beside lengths of all droppers",
        ),
    ],
)
def test_what_is_refused(make, said):
    with pytest.raises(cf.InputError, match=said):
        make()


def test_a_deviation_of_a_wire_that_is_not_there_is_refused():
    wire = cf.Wire(mass_per_length=1.0, tension=1e4, axial_stiffness=1e7)
    for name in ("messenger_wire_tension", "messenger_wire_height", "dropper_length"):
        with pytest.raises(cf.InputError, match=f"as_built.{name} has no effect on a line without"):
            cf.Catenary(
                contact_wire=wire,
                spans=[cf.Span(length=50.0, droppers=())],
                supports=[cf.Support()] * 2,
                as_built=cf.AsBuilt(**{name: 0.01}),
            )


@pytest.mark.parametrize("left", [0.95, 0.8, 0.7])
def test_the_depth_of_wear_by_counting(left):
    """A circle cut at the depth has the area that is left."""
    depth = worn_depth(cf.Wear(span=1, area_left=left), 0.0148)
    y, z = np.meshgrid(*[np.linspace(-0.0074, 0.0074, 2001)] * 2)
    inside = y**2 + z**2 < 0.0074**2
    assert (inside & (z > -0.0074 + depth)).sum() / inside.sum() == pytest.approx(left, abs=2e-3)


def test_a_pantograph_runs_on_what_wear_has_left(pantograph):
    """Far inside of a long worn range and without it the force is the same; where it comes, it is not."""
    line = planar().as_designed()
    surface = []
    for transition in (None, 4.0):
        worn = line.replace(
            wear=[cf.Wear(begin=250.0, end=600.0, area_left=0.85, transition=transition)],
            evaluated_spans=(4, 5),
        )
        shape = cf.find_form(worn)
        surface.append(shape.system.wires[0].irregularity)
        run = cf.simulate(shape, [pantograph], speed=60.0, method="linearised")
        surface.append(
            np.interp([230.0, 252.0], run.data["position"].values[0], run.data["contact_force"].values[0])
        )
    assert surface[0] is None
    depth = worn_depth(worn.wear[0], 2 * np.sqrt(1.35 / 8900 / np.pi))
    assert surface[2].at(240.0)[0] == 0.0 and surface[2].at(599.9)[0] == pytest.approx(depth, rel=1e-9)
    assert surface[2].at(250.0)[0] == pytest.approx(depth / 2, rel=1e-6)
    assert surface[3][0] == pytest.approx(surface[1][0], abs=1e-6)
    assert abs(surface[3][1] - surface[1][1]) > 5.0


def test_sections_of_a_line_deviate_by_themselves():
    section = spatial(dropper_length=0.002)
    line = cf.load_catenary(LAYOUTS / "re250_1200m.toml")
    assert not line.departs_from_design
    assert section.departs_from_design and section.as_built is not None
    two = cf.join_sections([section, section.as_designed()], [cf.Overlap()])
    assert two.departs_from_design and two.as_built is None
    assert [part.departs_from_design for part in two.sections] == [True, False]
    lengths = cf.find_form(two).dropper_lengths - cf.find_form(two.as_designed()).dropper_lengths
    first = len(two.sections[0].droppers)
    assert lengths[:first] == pytest.approx(np.full(first, 0.002)) and not lengths[first:].any()
    assert deviations(section.as_designed(), "dropper_length", [1.0]).tolist() == [0.0]


def test_deviations_from_a_table_of_their_own(tmp_path):
    """As written in the layout; kept whole; faults by row and column."""
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    plain = cf.save_catenary(line, tmp_path / "plain.toml").read_text(encoding="utf-8")
    (tmp_path / "cut.csv").write_text("x_m;dropper_length_mm\n0;0\n300;6\n600;-3\n", encoding="utf-8")
    head, spans = plain.split("\n[[span]]", 1)
    named = tmp_path / "named.toml"
    named.write_text(f'{head}\n[as_built]\ndropper_length = "cut.csv"\n\n[[span]]{spans}', encoding="utf-8")
    read = cf.load_catenary(named)
    assert read == line.replace(
        as_built=cf.AsBuilt(dropper_length=((0.0, 0.0), (300.0, 0.006), (600.0, -0.003)))
    )
    (tmp_path / "kept.toml").write_bytes(layout_bytes(named))
    (tmp_path / "cut.csv").write_text("x_m;dropper_length_mm\n0;0\n300;six\n", encoding="utf-8")
    assert cf.load_catenary(tmp_path / "kept.toml") == read
    with pytest.raises(cf.InputError, match=r"as_built.dropper_length: .*cut.csv: row 3, column"):
        cf.load_catenary(named)
    (tmp_path / "cut.csv").unlink()
    with pytest.raises(cf.InputError, match="no such"):
        cf.load_catenary(named)
