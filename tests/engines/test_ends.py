"""What holds the wires along the track: weights, springs, fixed ends, midpoint, friction."""

import numpy as np
import pytest
from scipy.optimize import brentq

import catenary_fe as cf
from catenary_fe.layout.terminations import slowest_contact_wire
from catenary_fe.statics.loaded import LoadedLine
from catenary_fe.statics.newton import solve_loaded
from tests.conftest import LAYOUTS

SPEED = 250 / 3.6
FIXED, WEIGHTS = cf.SectionEnd(kind="fixed"), cf.SectionEnd(kind="weights")
SPRING = cf.SectionEnd(kind="spring", stiffness=2e4)


def section(spans: int = 6, name: str = "en50318_2002", **others: object) -> cf.Catenary:
    line = cf.load_catenary(LAYOUTS / f"{name}.toml")
    return line.replace(
        spans=line.spans[:spans], supports=line.supports[: spans + 1], evaluated_spans=None, **others
    )


def one_span(**others: object) -> cf.Catenary:
    """A contact wire and a messenger wire that hang by themselves."""
    line = section(1, **others)
    return line.replace(spans=(cf.Span(length=60.0, droppers=()),))


def rest_tensions(line: cf.Catenary) -> list[np.ndarray]:
    system = cf.find_form(line, cf.MeshSettings(contact_wire_element=0.5, messenger_wire_element=0.5)).system
    return system.tensions(np.zeros(system.dof.size))


@pytest.mark.parametrize("name", ["en50318_2002", "re330"])
def test_ends_of_all_kinds_hang_alike_as_installed(name: str) -> None:
    """Ends change what a line does, not how it hangs: its installed tensions are the nominal ones."""
    usual = cf.find_form(section(4, name))
    for begin, end, midpoint in (
        (FIXED, FIXED, None),
        (WEIGHTS, FIXED, None),
        (WEIGHTS, WEIGHTS, 3),
        (cf.SectionEnd(kind="spring", stiffness=2e3), FIXED, None),
    ):
        shape = cf.find_form(section(4, name, begin=begin, end=end, midpoint=midpoint))
        assert shape.dropper_lengths == pytest.approx(usual.dropper_lengths, abs=1e-9)
        system = shape.system
        assert np.abs(system.gather(system.out_of_balance(np.zeros(system.dof.size)))).max() < 1e-4


def test_sag_and_tension_of_a_fixed_wire_under_more_load() -> None:
    """H² (H − H₀ + E A (g₀ L)²/(24 H₀²)) = E A (g L)²/24: a parabola between fixed ends."""
    line = one_span(begin=FIXED, end=FIXED)
    wire, L = line.messenger_wire, 60.0
    shape = cf.find_form(line, cf.MeshSettings(contact_wire_element=0.5, messenger_wire_element=0.5))
    system = shape.system
    own, more = 9.81 * wire.mass_per_length, 20.0
    on_messenger = system.elements()[:, 0] >= 2 * system.axes * system.wires[1].first
    load = system.distributed(np.where(on_messenger, -more, 0.0))
    moved, left = solve_loaded(system, load, np.zeros(system.dof.size))
    assert left is None
    H0, EA = wire.tension, wire.axial_stiffness

    def equation(H: float) -> float:
        return H**2 * (H - H0 + EA * (own * L) ** 2 / (24 * H0**2)) - EA * ((own + more) * L) ** 2 / 24

    H = brentq(equation, H0, 10 * H0)
    assert H > 1.2 * H0
    assert system.tensions(moved)[1].mean() == pytest.approx(H, rel=5e-3)
    middle = system.row(1, 30.0)
    sag = line.messenger_support_heights[0] - middle @ (system.reference + moved)
    assert sag == pytest.approx((own + more) * L**2 / (8 * H), rel=5e-3)
    weights = cf.find_form(one_span()).system
    under_weights, _ = solve_loaded(
        weights,
        weights.distributed(
            np.where(weights.elements()[:, 0] >= 2 * weights.axes * weights.wires[1].first, -more, 0.0)
        ),
        np.zeros(weights.dof.size),
    )
    assert weights.tensions(under_weights)[1].mean() == pytest.approx(H0, rel=5e-3)


def test_friction_takes_tension_towards_the_midpoint() -> None:
    """T η (1 − loss)^i behind i supports, from both ends."""
    tensioned = cf.SectionEnd(kind="weights", efficiency=0.95)
    line = section(6, begin=tensioned, end=tensioned, midpoint=4, tension_loss=0.01)
    shape = cf.find_form(line)
    (contact, messenger), wires = shape.system.tensions(np.zeros(shape.system.dof.size)), shape.system.wires
    behind = np.array([0, 1, 2, 2, 1, 0])
    for tension, wire, kind in (
        (contact, wires[0], line.contact_wire),
        (messenger, wires[1], line.messenger_wire),
    ):
        middles = np.searchsorted(wire.x, np.arange(30.0, 360.0, 60.0))
        assert tension[middles] == pytest.approx(kind.tension * 0.95 * 0.99**behind, rel=2e-3)
    system = shape.system
    assert np.abs(system.gather(system.out_of_balance(np.zeros(system.dof.size)))).max() < 1e-3


def test_weights_at_both_ends_make_a_section_its_own_mirror_image(pantograph: cf.Pantograph) -> None:
    line = section(4, begin=WEIGHTS, end=WEIGHTS, midpoint=3)
    assert line.mirrored().replace(spans=line.spans, supports=line.supports) == line
    state = cf.solve_statics(cf.find_form(line), [(75.0, 150.0)])
    image = cf.solve_statics(cf.find_form(line.mirrored()), [(165.0, 150.0)])
    x = np.linspace(5.0, 235.0, 60)
    ours = np.interp(x, state.contact_wire_x, state.contact_wire_z)
    theirs = np.interp(240.0 - x, image.contact_wire_x, image.contact_wire_z)
    assert ours == pytest.approx(theirs, abs=2e-6)


def test_a_line_that_runs_the_other_way_is_the_mirror_image() -> None:
    line = section(4)
    image = line.mirrored()
    assert (image.begin.kind, image.end.kind) == ("weights", "fixed")
    assert image.mirrored() == line
    ours, theirs = cf.find_form(line), cf.find_form(image)
    assert ours.contact_wire_z == pytest.approx(theirs.contact_wire_z[::-1], abs=1e-9)
    one = cf.elasticity(ours, positions=[90.0], force=200.0).uplift
    assert cf.elasticity(theirs, positions=[150.0], force=200.0).uplift == pytest.approx(one, rel=2e-3)


@pytest.mark.parametrize(
    "ends",
    [
        {"begin": FIXED, "end": FIXED},
        {"begin": WEIGHTS, "end": WEIGHTS, "midpoint": 3},
        {"end": cf.SectionEnd(kind="weights", messenger_wire=cf.Termination(kind="fixed"))},
        {"end": cf.SectionEnd(kind="spring", stiffness=3e3)},
        {"end": cf.SectionEnd(kind="weights", ratio=3.0, efficiency=0.97), "tension_loss": 0.005},
    ],
    ids=["fixed", "midpoint", "half-compensated", "spring", "inertia and friction"],
)
def test_engines_agree_on_ends(ends: dict, pantograph: cf.Pantograph) -> None:
    line = section(4, **ends).replace(evaluated_spans=(3,))
    shape = cf.find_form(line)
    runs = [
        cf.simulate(shape, [pantograph], speed=SPEED, method=method)
        for method in ("nonlinear", "linearised", "exudyn")
    ]
    forces = [run.filtered_contact_force()[0][run.window(0)] for run in runs]
    spread = forces[0].std()
    assert np.sqrt(((forces[1] - forces[0]) ** 2).mean()) < 0.04 * spread
    assert np.sqrt(((forces[2] - forces[0]) ** 2).mean()) < 0.01 * spread
    lost = np.abs(runs[0].data["lost_work"].values).max()
    assert np.abs(runs[0].missing_energy).max() < 3e-3 * lost  # 0.15 to 0.22 %, with usual ends too


def test_weights_are_a_mass_to_the_wire() -> None:
    """T/(g i) of weights that move i times as far: T i/g."""
    light, heavy = (
        cf.find_form(section(4, end=cf.SectionEnd(kind="weights", ratio=ratio))).system
        for ratio in (None, 3.0)
    )
    more = (heavy.mass - light.mass).diagonal()
    last = 2 * light.axes * (light.wires[0].first + light.wires[0].x.size - 1)
    assert more[last] == pytest.approx(20e3 * 3.0 / 9.81, rel=1e-3)
    assert light.force == pytest.approx(heavy.force, abs=1e-6)  # on pulleys: they do not weigh on the wire


def test_weights_that_move_slowly_hold_the_end_in_a_run(pantograph: cf.Pantograph) -> None:
    """Their inertia T i/g, tonnes, keeps a wire's end where it is while a pantograph passes."""

    def largest(end: cf.SectionEnd) -> float:
        shape = cf.find_form(section(4, end=end).replace(evaluated_spans=(3,)))
        run = cf.simulate(shape, [pantograph], speed=SPEED)
        return float(run.data["tension_change"].values[0].max())

    free, heavy = largest(WEIGHTS), largest(cf.SectionEnd(kind="weights", ratio=3.0))
    fixed = largest(FIXED)
    assert heavy == pytest.approx(fixed, rel=0.05)
    assert abs(free / fixed - 1) > 0.15  # and a light end behaves otherwise


@pytest.mark.parametrize(
    ("others", "words"),
    [
        ({"begin": WEIGHTS}, "weights at both ends and no midpoint"),
        ({"midpoint": 3}, "midpoint has no effect"),
        ({"begin": WEIGHTS, "midpoint": 1}, "must be a support inside the section, 2 to 4"),
        ({"begin": WEIGHTS, "midpoint": 9}, "must be a support inside the section, 2 to 4"),
        ({"end": FIXED, "tension_loss": 0.01}, "no effect between fixed ends"),
        ({"begin": WEIGHTS, "midpoint_position": 240.0}, "outside the section; it counts"),
        ({"begin": WEIGHTS, "midpoint_position": 30.005}, "from a dropper or support"),
        ({"begin": WEIGHTS, "midpoint": 3, "midpoint_position": 90.0}, "give one of them"),
        ({"midpoint_position": 90.0}, "midpoint has no effect"),
        ({"begin": SPRING, "end": SPRING, "tension_loss": 0.01}, "has no direction"),
        ({"end": cf.SectionEnd(kind="weights", efficiency=0.4)}, "leave it 40 % of its tension"),
    ],
)
def test_ends_that_do_not_go_together(others: dict, words: str) -> None:
    with pytest.raises(cf.InputError, match=words):
        section(4, **others)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ({"kind": "spring"}, "a spring needs one"),
        ({"kind": "weights", "stiffness": 1e3}, "nothing else has one"),
        ({"kind": "fixed", "ratio": 3.0}, "ratio has no effect"),
        ({"kind": "fixed", "efficiency": 0.9}, "efficiency has no effect"),
        (
            {"kind": "weights", "ratio": 3.0, "contact_wire": FIXED, "messenger_wire": FIXED},
            "ratio has no eff",
        ),
    ],
)
def test_terminations_of_no_kind(kind: dict, words: str) -> None:
    with pytest.raises(cf.InputError, match=words):
        cf.SectionEnd(**kind)


def test_a_section_held_within_a_span_is_its_own_mirror_image() -> None:
    """Static answers, near the ends too, to rounding and to what leaving out the line far away does."""
    line = section(5, begin=WEIGHTS, end=WEIGHTS, midpoint_position=150.0)
    assert line.mirrored() == line.replace(evaluated_spans=line.mirrored().evaluated_spans)
    x = np.array([10.0, 62.0, 90.0, 147.0])
    found = cf.elasticity(cf.find_form(line), positions=np.concatenate([x, 300.0 - x]), force=200.0).uplift
    assert found[:4] == pytest.approx(found[:3:-1], rel=1e-6)
    aside = line.replace(midpoint_position=100.0)
    assert aside.mirrored().midpoint_position == pytest.approx(200.0)


@pytest.mark.parametrize("ends", [{}, {"begin": FIXED, "end": FIXED}, {"end": SPRING}])
def test_static_answers_of_the_mirror_image(ends: dict) -> None:
    """Near both ends, corrected part by part: the same as with Newton's method, and the mirror image."""
    line = section(6, **ends)
    x = np.array([10.0, 62.0, 90.0])
    ours = cf.elasticity(cf.find_form(line), positions=x, force=200.0).uplift
    image = cf.find_form(line.mirrored())
    theirs = cf.elasticity(image, positions=360.0 - x, force=200.0).uplift[::-1]
    assert theirs == pytest.approx(ours, rel=4e-4)
    exact = LoadedLine(image)
    for place, lift in zip(360.0 - x, theirs, strict=True):
        row = exact.load([place], [1.0])
        assert lift == pytest.approx(float(row @ exact.solve([place], [200.0])), rel=4e-4)


def test_friction_falls_from_each_device_to_where_the_wire_is_held() -> None:
    """A messenger wire that is fixed at its begin loses all the way to it, past the midpoint of the other."""
    pulled = cf.SectionEnd(kind="weights", efficiency=0.96)
    half = cf.SectionEnd(kind="weights", messenger_wire=cf.Termination(kind="fixed"))
    line = section(5, begin=half, end=pulled, midpoint_position=150.0, tension_loss=0.01)
    assert line.mirrored().mirrored() == line
    system = cf.find_form(line).system
    contact, messenger = system.tensions(np.zeros(system.dof.size))
    kept = 0.99 ** np.arange(5)
    for tension, wire, shares in (
        (contact, system.wires[0], [1.0, 0.99, 0.96 * 0.99**2, 0.96 * 0.99, 0.96]),
        (messenger, system.wires[1], 0.96 * kept[::-1]),
    ):
        nominal = (line.contact_wire if wire.contact else line.messenger_wire).tension
        at = np.searchsorted(wire.x, 60.0 * np.arange(5) + [20.0, 20.0, 40.0, 20.0, 20.0])
        assert tension[at] == pytest.approx(nominal * np.array(shares), rel=2e-3)
    along = [system.dof[2 * system.axes * (w.first + w.x.searchsorted(150.0 - 1e-6))] for w in system.wires]
    assert (along[0] < 0, along[1] < 0) == (True, False)  # the anchor holds the contact wire alone


def test_friction_lowers_wave_speed_and_lateral_pulls() -> None:
    line = section(6, "re330", begin=WEIGHTS, end=cf.SectionEnd(kind="weights", efficiency=0.9), midpoint=2)
    full = line.replace(end=WEIGHTS)
    ratio = slowest_contact_wire(line).wave_speed / slowest_contact_wire(full).wave_speed
    assert ratio == pytest.approx(np.sqrt(0.9), rel=1e-12)
    assert line.lateral_pulls[2:-1] == pytest.approx(0.9 * full.lateral_pulls[2:-1], rel=1e-12)


def test_arms_pull_less_by_friction() -> None:
    """Droppers plumb, so that arms alone hold the wire to the side: T (y' before − y' behind) of each arm."""
    ends = {"begin": WEIGHTS, "end": cf.SectionEnd(kind="weights", efficiency=0.9), "midpoint": 2}
    line = section(6, "en50318_2018_ac_simple", **ends)
    line = line.replace(supports=tuple(s.replace(messenger_stagger="follows") for s in line.supports))
    full = line.replace(end=WEIGHTS)
    less, more = (-cf.find_form(each).steady_arm_lateral_forces[2:-1] for each in (line, full))
    assert less == pytest.approx(line.lateral_pulls[2:-1], rel=5e-3)
    by_hand = (full.lateral_pulls - line.lateral_pulls)[2:-1]
    assert more - less == pytest.approx(by_hand, rel=2.5e-3)


def test_the_tension_of_fixed_wires_is_not_judged(pantograph: cf.Pantograph) -> None:
    for ends, judged in (({}, True), ({"begin": FIXED, "end": FIXED}, False)):
        run = cf.simulate(cf.find_form(section(4, **ends)), [pantograph], speed=SPEED, method="linearised")
        assert ("tension drift" in {check.name for check in run.checks}) == (judged and "wire" in run.data)


def test_where_a_section_ends_does_not_matter_where_its_ends_are_real(pantograph: cf.Pantograph) -> None:
    """The same spans of lines of 20 and 30 spans; an end that weighs nothing moves along and reflects waves.

    Waves along the track, some 3.5 km/s fast, pass droppers and supports: of 5 % in σ with light ends 0.5 %
    are left with weights of ratio 3.
    """

    def spread(end: cf.SectionEnd, spans: int) -> float:
        whole = section(1, end=end)
        line = whole.replace(
            spans=whole.spans * spans,
            supports=section(10).supports[1:2] * (spans + 1),
            evaluated_spans=tuple(range(8, 14)),
        )
        run = cf.simulate(cf.find_form(line), [pantograph], speed=SPEED, method="linearised")
        return run.contact_force_statistics()[0].std

    heavy = cf.SectionEnd(kind="weights", ratio=3.0)
    assert spread(heavy, 20) == pytest.approx(spread(heavy, 30), rel=0.01)
    assert abs(spread(WEIGHTS, 20) / spread(WEIGHTS, 30) - 1) > 0.03
