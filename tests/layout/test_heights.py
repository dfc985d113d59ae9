"""Heights of the contact wire at supports: form, runs on every engine, gradients."""

from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf

CASES = Path(__file__).parents[1] / "cases"
DROPPERS = tuple(cf.Dropper(position=x) for x in (5.0, 15.0, 25.0, 35.0, 45.0))
HEIGHTS = (5.5, 5.5, 5.45, 5.4, 5.35, 5.35)


def line(heights, **arm):
    support = cf.Support(messenger_stiffness=5e5, steady_arm=cf.SteadyArm(stiffness=200.0, mass=0.8, **arm))
    regular = cf.Catenary.regular(
        spans=len(heights) - 1, span_length=50.0, droppers=DROPPERS, contact_wire_height=5.5,
        contact_wire=cf.library.wire("AC-120 CuMg", tension=15e3),
        messenger_wire=cf.library.wire("BzII 70", tension=15e3), support=support,
        damping=cf.RayleighDamping(beta=1e-4), evaluated_spans=(3,),
    )  # fmt: skip
    supports = [s.replace(contact_wire_height=h) for s, h in zip(regular.supports, heights, strict=True)]
    return regular.replace(supports=tuple(supports))


@pytest.fixture(scope="module")
def falling():
    return cf.find_form(line(HEIGHTS))


def test_the_wire_has_its_heights_at_supports_and_droppers(falling):
    catenary = falling.catenary
    assert falling.contact_wire_height(catenary.support_positions) == pytest.approx(HEIGHTS, abs=1e-9)
    assert falling.height_errors == pytest.approx(0.0, abs=1e-9)
    assert catenary.design_line(125.0) == pytest.approx(5.425)
    assert falling.dropper_forces.min() > 50.0
    rows = falling.support_schedule()
    assert [round(row.arms[0].contact_wire_height_m, 6) for row in rows] == list(HEIGHTS)


def test_the_case_that_could_not_be_said(falling):
    """Supports say what its droppers say."""
    told = cf.load_catenary(CASES / "falling_wire.toml")
    heights = (5.5, 5.45, 5.4, 5.35)
    supports = [s.replace(contact_wire_height=h) for s, h in zip(told.supports, heights, strict=True)]
    spans = [
        span.replace(droppers=tuple(d.replace(height_offset=None) for d in span.droppers))
        for span in told.spans
    ]
    shape = cf.find_form(told.replace(supports=tuple(supports), spans=tuple(spans)))
    assert shape.contact_wire_height(shape.catenary.support_positions) == pytest.approx(heights, abs=1e-9)
    assert shape.dropper_forces.min() > 0


def test_a_bend_of_the_design_loads_its_arm_with_the_tension(falling):
    """15 N for a change of 1 in 1000 at the crest, as the hand has it."""
    level = cf.find_form(line((5.5,) * 6))
    assert falling.steady_arm_forces[1] - level.steady_arm_forces[1] == pytest.approx(15.0, rel=0.03)
    assert falling.steady_arm_forces[2] == pytest.approx(level.steady_arm_forces[2], abs=0.5)


def test_a_line_that_is_lower_as_a_whole_is_the_same_line(pantograph):
    """All supports 0.2 m lower, the base with them: the same force on every engine."""
    high, low = cf.find_form(line((5.5,) * 6)), cf.find_form(line((5.3,) * 6))
    for method in ("nonlinear", "linearised", "exudyn"):
        forces = [
            cf.simulate(
                shape,
                [pantograph],
                speed=50.0,
                positions=[40.0],
                method=method,
                time=cf.TimeSettings(step=2e-3),
            )
            .data["contact_force"]
            .values
            for shape in (high, low)
        ]
        assert forces[1] == pytest.approx(forces[0], abs=0.05), method


@pytest.mark.parametrize("base", ["contact wire", "rail"])
def test_engines_agree_on_a_falling_wire(falling, pantograph, base):
    head = pantograph.replace(base=base)
    runs = {
        method: cf.simulate(falling, [head], speed=50.0, positions=[40.0], method=method)
        for method in ("nonlinear", "linearised", "exudyn")
    }
    force = {method: run.data["contact_force"].values[0] for method, run in runs.items()}
    assert force["exudyn"] == pytest.approx(force["nonlinear"], abs=1.5)
    assert np.std(force["linearised"] - force["nonlinear"]) < 0.03 * np.std(force["nonlinear"])
    for name in ("force balance", "pantograph energy", "energy balance"):
        (check,) = [check for check in runs["nonlinear"].checks if check.name == name]
        assert check.passed, name


def test_a_base_on_the_rail_pushes_harder_where_the_wire_is_lower(falling, pantograph):
    """By its spring of 50 N/m times 0.15 m at the end."""
    follows, rail = (
        cf.simulate(falling, [pantograph.replace(base=base)], speed=10.0, positions=[90.0])
        for base in ("contact wire", "rail")
    )
    more = (rail.data["contact_force"] - follows.data["contact_force"]).values[0]
    assert more[-2000:].mean() == pytest.approx(50.0 * 0.15, rel=0.1)


def test_an_elastic_pantograph_counts_from_what_its_base_follows(falling):
    ends = []
    for base in ("contact wire", "rail"):
        head = cf.ElasticPantograph(force=100.0, stiffness=100.0, base=base)
        run = cf.simulate(falling, [head], speed=50.0, positions=[40.0])
        ends.append(run.data["contact_force"].values[0, -1])
    assert ends[1] - ends[0] == pytest.approx(15.0, rel=0.1)  # 0.15 m times 100 N/m


def test_gradients_are_judged_against_the_speed(falling, pantograph, caplog):
    run = cf.simulate(falling, [pantograph], speed=270 / 3.6, positions=[40.0], method="linearised")
    steep = [w for w in run.warnings if "gradient of -1 ‰ is above the 0 ‰" in w]
    assert len(steep) == 3 and steep[0].startswith("span 2")
    rows = {row.name: row for row in cf.criteria_rows(run, "AC")}
    assert rows["gradient of the contact wire"].passed is False
    slow = cf.simulate(falling, [pantograph], speed=200 / 3.6, positions=[40.0], method="linearised")
    rows = {row.name: row for row in cf.criteria_rows(slow, "AC")}
    assert (rows["gradient of the contact wire"].limit, rows["change of the gradient"].limit) == (2.0, 1.0)
    assert rows["gradient of the contact wire"].passed and rows["change of the gradient"].passed
    assert not [w for w in slow.warnings if "‰" in w]


def test_modal_runs_refuse_it(falling, pantograph):
    modes = cf.solve_modes(falling, count=5)
    with pytest.raises(cf.InputError, match="changes its height"):
        cf.modal_run(falling, modes, pantograph, speed=50.0)
