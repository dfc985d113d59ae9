"""Lines of several tension sections: overlaps by the rule and as written, on all engines."""

import json
from dataclasses import replace

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.contact import place
from catenary_fe.layout import read_catenary
from catenary_fe.results import quality
from catenary_fe.statics.newton import static_contact
from catenary_fe.views import plot_layout, plot_run_waves
from catenary_fe.views.film import scene
from catenary_fe.views.report.tables import schedule_table
from catenary_fe.views.waves import joined_wire
from tests.conftest import LAYOUTS

SPEED = 250 / 3.6


def section(spans: int, name: str = "en50318_2002") -> cf.Catenary:
    line = cf.load_catenary(LAYOUTS / f"{name}.toml")
    return line.replace(spans=line.spans[:spans], supports=line.supports[: spans + 1], evaluated_spans=None)


def raised(line: cf.Catenary, by: float) -> cf.Catenary:
    height = line.contact_wire_height + by
    supports = tuple(support.replace(contact_wire_height=height) for support in line.supports)
    return line.replace(supports=supports)


@pytest.fixture(scope="module")
def line() -> cf.Line:
    part = section(6)
    return cf.join_sections([part, part], [cf.Overlap(spans=3)], evaluated_spans=(3, 4, 5, 6, 7))


@pytest.fixture(scope="module")
def shape(line: cf.Line) -> cf.Shape:
    return cf.find_form(line)


@pytest.fixture(scope="module")
def run(shape: cf.Shape, pantograph: cf.Pantograph) -> cf.Run:
    return cf.simulate(shape, [pantograph], speed=SPEED)


def test_line_is_what_pantographs_run_along(line: cf.Line) -> None:
    assert line.begins == (0.0, 180.0)
    assert line.length == pytest.approx(540.0)
    assert line.common_zones == ((180.0, 360.0),)
    assert np.ptp(line.contact_wire_heights) == 0.0  # in service nothing is lifted
    assert read_catenary(json.loads(line.model_dump_json())) == line


@pytest.mark.parametrize(("spans", "name"), [(3, "re330"), (4, "re330"), (5, "re330"), (3, "en50318_2002")])
def test_wires_that_run_off_are_lifted_and_side_by_side(spans: int, name: str) -> None:
    part = section(9, name)
    a, b = cf.join_sections([part, part], [cf.Overlap(spans=spans, lift=0.3, distance=0.3)]).sections
    assert a.contact_wire_heights[-2] == pytest.approx(5.6)
    assert b.contact_wire_heights[1] == pytest.approx(5.6)
    assert np.all(a.contact_wire_heights[: 10 - 2] == 5.3)
    if a.is_spatial:
        apart = a.staggers[-spans:-1] - b.staggers[1:spans]
        assert np.abs(apart) == pytest.approx(np.full(spans - 1, 0.3))
        assert np.all(apart == apart[0])  # side by side: they do not cross


def test_lifted_wire_rises_by_itself(shape: cf.Shape, line: cf.Line) -> None:
    """A free wire is a parabola of its weight over its tension: level where it begins to rise."""
    wire = line.sections[0].contact_wire
    rise = np.sqrt(2 * 0.25 * wire.tension / (wire.mass_per_length * 9.81))
    x = np.linspace(300.0 - 0.6 * rise, 300.0, 30)
    height = shape.contact_wires[0].height(x) - 5.3
    assert height == pytest.approx(0.25 * ((x - 300.0 + rise) / rise) ** 2, abs=0.012)


def test_droppers_and_arms_pull_everywhere(shape: cf.Shape) -> None:
    assert shape.dropper_forces.min() > 10.0
    assert shape.dropper_forces.size == shape.system.droppers.length.size


def test_joined_system_is_its_sections(shape: cf.Shape, line: cf.Line) -> None:
    system, parts = shape.system, [part.system for part in shape.sections]
    assert system.size == sum(part.size for part in parts)
    assert system.mass.sum() == pytest.approx(sum(part.mass.sum() for part in parts), rel=1e-12)
    rest = np.zeros(system.dof.size)
    assert np.abs(system.gather(system.out_of_balance(rest))).max() < 1e-3
    moved = system.spread(np.random.default_rng(1).normal(size=system.size) * 1e-4)
    slope = (system.energy(1.001 * moved) - system.energy(0.999 * moved)) / 0.002
    assert slope == pytest.approx(-moved @ system.out_of_balance(moved), rel=1e-6)
    places = np.concatenate([path.x[path.supports] for path in system.contact_paths])
    assert set(np.round(places, 6)) == set(np.round(line.support_positions, 6))


def test_force_hands_over_without_loss(run: cf.Run) -> None:
    (force,) = run.contact_force_statistics()
    assert force.contact_loss == 0.0
    assert force.std < 31.0  # the reference model's range at this speed
    each = run.data["section_force"].values[0]
    assert each.sum(axis=0) == pytest.approx(run.data["contact_force"].values[0], abs=1e-9)
    x = run.data["position"].values[0]
    assert not each[1, x < 180].any()
    assert not each[0, x > 360].any()
    assert run.data["wire_height"].values.max() < 5.42  # of the wire that it meets, not of the lifted one
    both = x[(each > 0).all(axis=0)]
    assert 240 < both.min() < 270 < both.max() < 300  # in the common span


def test_energy_balance_holds_over_the_overlap(run: cf.Run) -> None:
    scale = np.abs(run.data["lost_work"].values).max()
    assert np.abs(run.missing_energy).max() < 2e-3 * scale


def test_engines_agree_on_an_overlap(shape: cf.Shape, run: cf.Run, pantograph: cf.Pantograph) -> None:
    (ours,) = run.contact_force_statistics()
    inside = run.window(0)
    for method, rms in (("linearised", 0.03), ("exudyn", 0.03)):
        other = cf.simulate(shape, [pantograph], speed=SPEED, method=method)
        x = other.data["position"].values[0]
        assert not other.data["section_force"].values[0, 1, x < 180].any(), method
        assert other.data["wire_height"].values[0, 0] == pytest.approx(
            run.data["wire_height"].values[0, 0], abs=1e-4
        ), method
        gap = other.filtered_contact_force()[0] - run.filtered_contact_force()[0]
        assert np.sqrt((gap[inside] ** 2).mean()) < rms * ours.std, method
        uplift = other.data["support_uplift"].values - run.data["support_uplift"].values
        assert np.abs(uplift[:, x < 360]).max() < 1e-3, method  # there the first section is left


def test_without_lift_the_wires_share_the_force(pantograph: cf.Pantograph) -> None:
    """In the middle of the overlap of two lines that are mirror images both wires carry the same."""
    part = section(6)

    def forces(raised_by: float) -> np.ndarray:
        pair = [part, raised(part, raised_by).mirrored()]
        both = cf.join_sections(pair, [cf.Overlap(spans=4, as_written=True)])
        middle = np.array([sum(both.common_zones[0]) / 2])
        placed = place([pantograph], np.array([120.0]), middle, spatial=False)
        (at_rest,) = static_contact(cf.find_form(both).system, placed)[1]
        return at_rest.forces

    alike = forces(0.0)
    assert alike[0] == pytest.approx(alike[1], rel=1e-6)
    assert -np.diff(forces(1e-3))[0] > 2.0  # 1 mm higher, and the other one carries more


@pytest.mark.parametrize("method", ["nonlinear", "linearised"])
def test_a_wire_far_above_changes_nothing(method: str, pantograph: cf.Pantograph) -> None:
    part = section(6)
    single = cf.find_form(part)
    both = cf.find_form(cf.join_sections([part, raised(part, 5.0)], [cf.Overlap(spans=3, as_written=True)]))
    alone = cf.simulate(single, [pantograph], speed=SPEED, method=method)
    beside = cf.simulate(both, [pantograph], speed=SPEED, method=method)
    x = alone.data["position"].values[0]
    n = int((x < 300.0).sum())
    ours, theirs = (r.data["contact_force"].values[0, :n] for r in (beside, alone))
    assert np.abs(ours - theirs).max() < 1e-3 * theirs.std()


def test_mirror_image_of_a_line(line: cf.Line) -> None:
    image = line.mirrored()
    assert image.mirrored() == line
    ours, theirs = cf.find_form(line), cf.find_form(image)
    x = np.linspace(1.0, line.length - 1.0, 200)

    def served(shape: cf.Shape, at: np.ndarray) -> np.ndarray:
        wires = [w for w in shape.contact_wires]
        return np.array([min(w.height([s])[0] for w in wires if w.x[0] <= s <= w.x[-1]) for s in at.tolist()])

    assert served(ours, x) == pytest.approx(served(theirs, line.length - x), abs=2e-5)


def test_elasticity_is_that_of_the_lower_wire(shape: cf.Shape) -> None:
    places = [75.0, 243.0, 297.0, 450.0]  # the last but one is where the first section's wire is lifted
    first, second = (
        cf.elasticity(part, positions=np.array(own)).uplift
        for part, own in zip(shape.sections, ([75.0, 243.0], [117.0, 270.0]), strict=True)
    )
    assert cf.elasticity(shape, positions=places).uplift == pytest.approx([*first, *second], rel=1e-9)
    lifted = cf.elasticity(shape.sections[1], positions=[63.0]).uplift[0]
    assert abs(lifted / first[1] - 1) > 0.01  # the other wire there


def test_uplift_at_a_mast_is_when_the_pantograph_is_there(run: cf.Run) -> None:
    x, uplift = run.data["position"].values[0], run.data["support_uplift"].values
    masts = run.data["support_position"].values
    assert x[uplift[2:-1].argmax(axis=1)] == pytest.approx(masts[2:-1], abs=25.0)
    assert np.all(uplift[2:-1].max(axis=1) > 0.02)


def test_spans_beside_an_overlap_need_not_be_equal(line: cf.Line) -> None:
    assert quality.beside_overlaps(line) == {3, 4, 5, 6, 7}  # the overlap's 4 to 6, and one on each side
    assert quality.beside_overlaps(line.sections[0]) == set()


def test_tables_of_a_span_have_the_droppers_of_both_sections(shape: cf.Shape, line: cf.Line) -> None:
    table = schedule_table(shape)
    rows = [row for row, spans in zip(table.rows, table.spans, strict=True) if spans == (5, 5)]
    inside = (line.dropper_positions > 240) & (line.dropper_positions < 300)
    assert len(rows) == np.count_nonzero(inside)
    assert {row[0] for row in rows} == {"1", "2"}


def test_equipment_of_a_later_section_is_drawn(line: cf.Line) -> None:
    clamp = cf.Equipment(name="clamp", x=250.0, mass=5.0, length=1.0)
    second = line.sections[1].replace(equipment=(clamp,))
    ax = plot_layout(line.replace(sections=(line.sections[0], second)), spans=[8])
    (drawn,) = [each for each in ax.lines if each.get_label() == "equipment"]
    assert drawn.get_xdata().mean() == pytest.approx(430.0)
    assert np.all(np.isfinite(drawn.get_ydata()))


def test_films_hang_droppers_on_their_own_section(shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    run = cf.simulate(shape, [pantograph], speed=SPEED, method="linearised", store_wire=0.1)
    seen = scene(run)
    sections = np.array([wire.section for wire in seen.wires])[seen.dropper_ends]
    counts = [len(part.catenary.droppers) for part in shape.sections]
    assert np.array_equal(sections, np.repeat([[1, 1], [2, 2]], counts, axis=0))
    shuffled = cf.Run(run.data[sorted(run.data.data_vars, reverse=True)])  # as a file may hold them
    assert [wire.name for wire in shuffled.wires()[:2]] == ["contact wire", "section 2 contact wire"]
    again = scene(shuffled)
    assert np.array_equal(np.array([w.section for w in again.wires])[again.dropper_ends], sections)
    at, rest = seen.pantograph_x[0], seen.rest[0]
    for frame, x in enumerate(at):  # a head is under a wire that is there, and pushes it up
        heights = [seen.heights(i, frame) for i in range(len(seen.wires))]
        assert 5.25 < seen.head_height(0, frame, heights) < 5.5, x
    assert np.all(np.abs(rest - 5.3) < 0.02), at[np.abs(rest - 5.3).argmax()]


def test_waves_are_those_of_both_sections(shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    """Each section's wire up to the middle of the overlap, at 270 m."""
    run = cf.simulate(shape, [pantograph], speed=SPEED, method="linearised", store_wire=0.1)
    shown = plot_run_waves(run, quantity="deflection", spans=range(1, 10))
    assert shown.get_xlim() == pytest.approx((0.0, 540.0), abs=5.0)
    first, second = run.wires()[:2]
    joined = joined_wire(run, "contact wire")
    assert np.all(np.diff(joined.x) > 0)
    for at, of in ((100.0, first), (250.0, first), (290.0, second), (500.0, second)):
        own, there = np.abs(joined.x - at).argmin(), np.abs(of.x - at).argmin()
        assert joined.height[:, own] == pytest.approx(of.height[:, there], abs=0)
    assert np.array_equal(joined_wire(run, "section 2 contact wire").x, second.x)


def test_an_effect_on_the_line_is_not_lost(shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    def heavier(system):
        weight = system.distributed(np.full(system.mass_per_length.size, -0.5))
        return replace(system, force=system.force + weight)

    changed = shape.with_effect(heavier)
    runs = [cf.simulate(s, [pantograph], speed=SPEED, method="linearised") for s in (shape, changed)]
    heights = [run.data["wire_height"].values[0].mean() for run in runs]
    assert heights[1] < heights[0] - 1e-3
    with pytest.raises(cf.InputError, match="without what with_effect added"):
        cf.elasticity(changed, positions=[75.0])


def test_lateral_distance_and_head(pantograph: cf.Pantograph) -> None:
    """Wires that run off leave the head, at a height at which they do not matter."""
    part = section(9, "re330")
    shape = cf.find_form(
        cf.join_sections([part, part], [cf.Overlap(spans=3)], evaluated_spans=(4, 5, 6, 7, 8))
    )
    head = cf.library.pantograph("DSA380")
    run = cf.simulate(shape, [head], speed=SPEED, method="linearised", time=TimeSettings(step=2e-3))
    assert run.contact_force_statistics()[0].contact_loss == 0.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"spans": 2}, "takes at least 3"),
        ({"as_written": True, "lift": 0.3}, "lift has no effect"),
        ({"spans": 7}, "its sections have 6 and 6 spans"),
        ({"lift": 1.3}, "leaves no dropper"),
    ],
)
def test_faults_of_overlaps(change: dict, words: str) -> None:
    part = section(6)
    with pytest.raises(cf.InputError, match=words):
        cf.join_sections([part, part], [cf.Overlap(**({"spans": 3} | change))])


def test_sections_that_do_not_fit_are_named() -> None:
    part, overlap = section(6), [cf.Overlap(spans=3)]
    longer = part.replace(spans=tuple(span.replace(length=61.0) for span in part.spans))
    with pytest.raises(cf.InputError, match="shared span 1 is 60 m in the section before and 61 m"):
        cf.join_sections([part, longer], overlap)
    with pytest.raises(cf.InputError, match="contact_wire_height differs"):
        cf.join_sections([part, part.replace(contact_wire_height=5.5)], overlap)
    cut = part.with_dropper_lengths(cf.find_form(part).dropper_lengths)
    with pytest.raises(cf.InputError, match="overlap 1: droppers have lengths"):
        cf.join_sections([part, cut], overlap)
    with pytest.raises(cf.InputError, match="there must be one between"):
        cf.join_sections([part, part, part], overlap)
    line = cf.join_sections([part, part], overlap)
    with pytest.raises(cf.InputError, match="belongs to a tension section"):
        line.replace(contact_wire=part.messenger_wire)
    with pytest.raises(cf.InputError, match="2 tension sections"):
        cf.solve_modes(cf.find_form(line), count=3)


def test_layout_file_of_several_sections(tmp_path, reference_layout) -> None:
    text = reference_layout.read_text(encoding="utf-8").replace("evaluated_spans = [5, 6]", "")
    path = tmp_path / "line.toml"
    path.write_text(
        text
        + "\n[overlap]\nspans = 4\nlift = 0.3\n\n[[further_sections]]\ncount = 2\n\n[[further_sections]]\n"
        '[further_sections.overlap]\nkind = "insulated"\n',
        encoding="utf-8",
    )
    line = cf.load_catenary(path)
    assert isinstance(line, cf.Line)
    assert [overlap.spans for overlap in line.overlaps] == [4, 4, 3]
    assert line.overlaps[2].gap == 0.4
    assert len(line.spans) == 4 * 10 - 4 - 4 - 3
    path.write_text(text + "\n[overlap]\nspans = 4\n", encoding="utf-8")
    with pytest.raises(cf.InputError, match="no effect on a line of one section"):
        cf.load_catenary(path)
