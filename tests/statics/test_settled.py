"""A line at rest under temperature, wind and ice, against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

import catenary_fe as cf
from catenary_fe.layout import GRAVITY
from catenary_fe.statics.newton import solve_loaded
from tests.conftest import LAYOUTS

FIXED, WEIGHTS = cf.SectionEnd(kind="fixed"), cf.SectionEnd(kind="weights", ratio=3.0)
ALPHA = 1.7e-5


def section(name: str, spans: int, **others: object) -> cf.Catenary:
    line = cf.load_catenary(LAYOUTS / f"{name}.toml")
    return line.replace(
        spans=line.spans[:spans], supports=line.supports[: spans + 1], evaluated_spans=None, **others
    )


def one_span(**others: object) -> cf.Catenary:
    """A contact wire and a messenger wire that hang by themselves."""
    line = section("en50318_2002", 1, **others)
    return line.replace(spans=(cf.Span(length=60.0, droppers=()),))


@pytest.fixture(scope="module")
def stitched() -> cf.Shape:
    line = section("re330", 6, begin=FIXED, end=WEIGHTS)
    supports = tuple(support.replace(mast_position=3.5) for support in line.supports)
    return cf.find_form(line.replace(supports=supports))


def change_of_state(H0: float, EA: float, g0: float, g: float, L: float, warmer: float) -> float:
    """[N] H² [H − H₀ + EA (g₀ L)²/(24 H₀²) + EA α ΔT] = EA (g L)²/24: Kießling et al., eq. 5.57."""
    at_first = EA * (g0 * L) ** 2 / (24 * H0**2)
    return brentq(
        lambda H: H**2 * (H - H0 + at_first + EA * ALPHA * warmer) - EA * (g * L) ** 2 / 24, 10.0, 1e6
    )


def elastic_catenary(H0: float, EA: float, g0: float, more: float, L: float, warmer: float) -> float:
    """[N] horizontal pull of a wire between two points at one height, without approximation."""

    def span(H: float, length: float, weight: float) -> float:
        return 2 * H / weight * np.arcsinh(weight * length / (2 * H)) + H * length / EA

    length = brentq(lambda s: span(H0, s, g0) - L, 0.9 * L, 1.1 * L)
    longer = length * (1 + ALPHA * warmer)
    weight = (g0 * length + more * L) / longer
    return brentq(lambda H: span(H, longer, weight) - L, 10.0, 1e6)


@pytest.mark.parametrize("temperature", [-40.0, -10.0, 15.0, 60.0])
@pytest.mark.parametrize("ice", [0.0, 7.5])
def test_wires_between_fixed_ends_change_their_state(temperature: float, ice: float) -> None:
    line = one_span(begin=FIXED, end=FIXED)
    weather = cf.Conditions(temperature=temperature, ice={"load": ice} if ice else None)
    rows = {wire.name: wire for wire in cf.case_rows(cf.settle(cf.find_form(line), weather)).wires}
    for kind in ("contact_wire", "messenger_wire"):
        wire = getattr(line, kind)
        g0 = GRAVITY * wire.mass_per_length
        given = wire.tension, wire.axial_stiffness, g0
        tension = rows[kind.replace("_", " ")].tension_N
        cubic = change_of_state(*given, g0 + ice, 60.0, temperature - 15.0)
        exact = elastic_catenary(*given, ice, 60.0, temperature - 15.0)
        assert tension == pytest.approx(cubic, rel=3e-3), kind
        assert tension == pytest.approx(exact, rel=1e-3), kind
        sag = rows[kind.replace("_", " ")].largest_sag_m
        assert sag == pytest.approx((g0 + ice) * 60.0**2 / (8 * exact), rel=3e-3), kind
        if temperature == 60.0:  # a wire that is 1 K off is found out
            other = elastic_catenary(*given, ice, 60.0, temperature - 16.0)
            assert tension != pytest.approx(other, rel=1e-3), kind


def test_compensated_wires_move_and_keep_their_tension(stitched: cf.Shape) -> None:
    settled = cf.settle(stitched, cf.Conditions(temperature=55.0))
    case, length = cf.case_rows(settled), stitched.catenary.length
    before = stitched.system.tensions(np.zeros(stitched.system.dof.size))
    after = settled.system.tensions(np.zeros(stitched.system.dof.size))
    assert after[0].mean() == pytest.approx(before[0].mean(), rel=1e-3)
    shift = ALPHA * 40.0 * stitched.catenary.support_positions
    inner = case.supports[1:-1]
    assert [s.cantilever_shift_mm for s in inner] == pytest.approx(1e3 * shift[1:-1], rel=3e-3)
    travel = case.supports[-1].device_travel_mm
    assert travel is not None
    assert list(travel.values()) == pytest.approx([3e3 * ALPHA * 40.0 * length] * 2, rel=3e-3)
    messenger = stitched.catenary.messenger_staggers[1:-1]
    by_hand = np.degrees(np.arcsin(shift[1:-1] / (3.5 - messenger)))
    assert [s.cantilever_rotation_deg for s in inner] == pytest.approx(by_hand, rel=3e-3)


def test_droppers_lengthen_as_their_wires(stitched: cf.Shape) -> None:
    hot = cf.settle(stitched, cf.Conditions(temperature=65.0)).system.droppers
    assert hot.length == pytest.approx(stitched.system.droppers.length * (1 + ALPHA * 50.0), rel=1e-12)


def test_arms_without_a_messenger_wire_go_along_with_the_contact_wire() -> None:
    """Else the links would lean along the track, and hold the wire back."""
    arm = cf.SteadyArm(length=1.2, clamp_mass=0.2)
    wire = cf.library.wire("AC-107", tension=8e3)
    line = cf.Catenary(
        contact_wire=wire,
        spans=[cf.Span(length=30.0, droppers=())] * 6,
        supports=[cf.Support(steady_arm=arm, stagger=0.3 * (-1) ** i) for i in range(7)],
    )
    settled = cf.settle(cf.find_form(line), cf.Conditions(temperature=45.0))
    assert np.abs(settled.system.arms.span(settled.system.reference)[:, 0]).max() < 1e-5
    moved = [s.cantilever_shift_mm for s in cf.case_rows(settled).supports[1:-1]]
    assert moved == pytest.approx([1e3 * ALPHA * 30.0 * 30.0 * n for n in range(1, 6)], rel=0.02)


def test_cantilevers_draw_the_wires_as_they_swing(stitched: cf.Shape) -> None:
    """By R − √(R² − s²), R from the hinge to the arm's pivot; without a mast's place it is not drawn."""
    line = stitched.catenary
    free = cf.find_form(
        line.replace(supports=tuple(support.replace(mast_position=None) for support in line.supports))
    )
    hot = cf.Conditions(temperature=55.0)
    drawn, still = (cf.case_rows(cf.settle(shape, hot)).supports[5] for shape in (stitched, free))
    assert still.cantilever_rotation_deg is None
    pivot = stitched.system.arms.pivot[4]
    reach, shift = 3.5 - pivot[1], drawn.cantilever_shift_mm / 1e3
    towards = reach - np.sqrt(reach**2 - shift**2)
    assert drawn.stagger_m - still.stagger_m == pytest.approx(towards, rel=0.03)
    assert towards > 5e-3
    supports = tuple(support.replace(mast_position=0.25) for support in line.supports)
    with pytest.raises(cf.InputError, match=r"reaches 0\.\d\d m: it cannot swing so far"):
        cf.settle(cf.find_form(line.replace(supports=supports)), cf.Conditions(temperature=140.0))


def test_blow_off_of_a_tensioned_wire() -> None:
    """q L²/(8 T), q = ½ ρ v² C G d."""
    line = one_span(spatial=True)
    wind = cf.Wind(speed=30.0, direction=60.0, span_factor=0.75)
    wire = line.contact_wire.replace(diameter=0.0144)
    line = line.replace(contact_wire=wire)
    settled = cf.settle(cf.find_form(line), cf.Conditions(wind=wind))
    q = 0.5 * 1.25 * (30.0 * np.sin(np.radians(60.0))) ** 2 * 0.75 * 0.0144
    by_hand = q * 60.0**2 / (8 * wire.tension)
    assert settled.wires[0].lateral(30.0) == pytest.approx(by_hand, rel=0.01)
    assert settled.wires[0].lateral(30.0) != pytest.approx(1.03 * by_hand, rel=0.01)
    calm = cf.settle(cf.find_form(line), cf.Conditions(wind=wind.replace(direction=0.0)))
    assert calm.wires[0].lateral(30.0) == pytest.approx(0.0, abs=1e-9)


def test_ice_weighs_and_widens() -> None:
    line = one_span(spatial=True)
    line = line.replace(contact_wire=line.contact_wire.replace(diameter=0.0132))
    shape, wind = cf.find_form(line), cf.Wind(speed=20.0)
    bare = cf.settle(shape, cf.Conditions(wind=wind))
    iced = cf.settle(shape, cf.Conditions(wind=wind, ice=cf.Ice(load=5.0, wires=("contact_wire",))))
    outside = np.sqrt(0.0132**2 + 4 * 5.0 / (np.pi * 700.0 * GRAVITY))
    ratio = iced.wires[0].lateral(30.0) / bare.wires[0].lateral(30.0)
    assert ratio == pytest.approx(outside / 0.0132, rel=2e-3)
    lower = bare.wires[0].height(30.0) - iced.wires[0].height(30.0)
    assert lower == pytest.approx(5.0 * 60.0**2 / (8 * line.contact_wire.tension), rel=2e-3)
    assert bare.wires[1].height(30.0) == pytest.approx(iced.wires[1].height(30.0), abs=1e-9)
    up = (np.arange(shape.system.dof.size) % 6 == 2).astype(float)
    masses = [up @ s.system.mass @ up for s in (iced, bare)]
    assert masses[0] - masses[1] == pytest.approx(5.0 * 60.0 / GRAVITY, rel=2e-4)


def test_effects_add_up_in_any_order(stitched: cf.Shape) -> None:
    weather = cf.Conditions(temperature=-20.0, wind=cf.Wind(speed=20.0), ice=cf.Ice(load=3.5))
    effects = weather.effects(15.0)
    ends = [cf.settle(stitched, each).wires[0] for each in (weather, effects, effects[::-1])]
    for wire in ends[1:]:
        assert wire.y == pytest.approx(ends[0].y, abs=1e-7)
        assert wire.z == pytest.approx(ends[0].z, abs=1e-7)


def test_a_scripts_own_effect() -> None:
    class Snow(cf.Effect):
        """On the messenger wire, more and more along the line."""

        def load(self, part: cf.WirePart) -> np.ndarray:
            found = part.nothing
            if part.kind == "messenger_wire":
                found[2] = -4.0 * part.x / 60.0
            return found

    shape = cf.find_form(one_span())
    settled = cf.settle(shape, [Snow()])
    x = np.array([15.0, 45.0])
    lower = shape.wires[1].height(x) - settled.wires[1].height(x)
    by_hand = 4.0 * (60.0 * x - x**3 / 60.0) / (6 * shape.catenary.messenger_wire.tension)
    assert lower == pytest.approx(by_hand, rel=3e-3)
    assert np.abs(shape.wires[0].z - settled.wires[0].z).max() < 1e-6
    with pytest.raises(cf.InputError, match="int is no effect"):
        cf.settle(shape, [3])


def test_temperature_over_the_place() -> None:
    """Of a tunnel's mouth: what is inside keeps its length."""
    line = section("en50318_2002", 6)
    settled = cf.settle(cf.find_form(line), cf.Conditions(temperature=((180.0, 15.0), (180.1, 45.0))))
    moved = [s.cantilever_shift_mm for s in cf.case_rows(settled).supports[1:-1]]
    assert moved[:3] == pytest.approx([0.0, 0.0, 0.0], abs=0.3)
    assert moved[3:] == pytest.approx([1e3 * ALPHA * 30.0 * x for x in (60.0, 120.0)], rel=0.01)


def test_a_settled_line_is_at_rest_where_it_is(stitched: cf.Shape) -> None:
    """Displacements count from there, and the forces at its supports carry all that acts."""
    weather = cf.Conditions(temperature=40.0, wind=cf.Wind(speed=25.0), ice=cf.Ice(load=2.0))
    settled = cf.settle(stitched, weather)
    system = settled.system
    none = np.zeros(system.dof.size)
    assert np.abs(system.gather(system.out_of_balance(none))).max() < 1e-3
    moved, left = solve_loaded(system, none, none)
    assert left is None
    assert np.abs(moved).max() < 1e-6
    held = [_held(cf.case_rows(cf.settle(stitched, each))) for each in (cf.Conditions(), weather)]
    lengths = np.array([np.diff(wire.x).sum() for wire in stitched.system.wires])
    assert held[1][0] - held[0][0] == pytest.approx(2.0 * lengths.sum(), rel=1e-3)
    assert weather.wind is not None
    parts = [cf.WirePart(w.kind, w.wire, w.x[:1]) for w in stitched.system.wires]
    drag = [float(weather.wind.resistance(part, weather.ice)[0]) * 25.0**2 for part in parts]
    assert held[1][1] - held[0][1] == pytest.approx(-(drag * lengths).sum(), rel=1e-3)
    with pytest.raises(cf.InputError, match="already under conditions"):
        cf.settle(settled, weather)
    with pytest.raises(cf.InputError, match=r"give what cf\.settle returned"):
        cf.case_rows(stitched)


def test_what_is_too_much_at_once_comes_step_by_step(stitched: cf.Shape, monkeypatch) -> None:
    """Where Newton's method finds no rest with all loads at once, here made so; the rest is the same."""
    weather = cf.Conditions(temperature=-5.0, ice=cf.Ice(load=3.0), wind=cf.Wind(speed=10.0))
    direct, calls = cf.settle(stitched, weather), []

    def fails_at_first(system, load, guess):
        calls.append(system.force)
        moved, left = solve_loaded(system, load, guess)
        return moved, (load + 1.0 if len(calls) == 1 else left)

    monkeypatch.setattr("catenary_fe.statics.settled.solve_loaded", fails_at_first)
    stepped = cf.settle(stitched, weather)
    assert len({force.sum() for force in calls}) >= 10
    assert stepped.settlement.moved == pytest.approx(direct.settlement.moved, abs=1e-5)


def _held(case: object) -> tuple[float, float]:
    """[N] up and to the left on all wires."""
    each = [support.forces_N for support in case.supports]
    return tuple(sum(f[f"messenger_{way}"] + f[f"arms_{way}"] for f in each) for way in ("up", "left"))


def test_arms_that_the_wind_pushes_are_named(stitched: cf.Shape, pantograph: cf.Pantograph) -> None:
    """358 N of stagger pull against the wind's 65 m: arms whose wire is blown to their pivot push."""
    T, q = stitched.catenary.contact_wire.tension, 0.5 * 1.25 * 0.0124
    limit = np.sqrt(T * 4 * 0.2 / 65.0 / (q * 65.0))
    for share, pushed in ((0.6, False), (1.3, True)):
        settled = cf.settle(stitched, cf.Conditions(wind=cf.Wind(speed=share * limit)))
        case = cf.case_rows(settled)
        assert bool(case.pushed_arms) == (not case.holds) == pushed
    with pytest.raises(cf.InputError, match=r"at support \d the wind pushes the steady arm"):
        cf.simulate(settled, [pantograph], speed=60.0, method="linearised")


def test_wind_needs_a_line_in_space() -> None:
    with pytest.raises(cf.InputError, match="set spatial = true in the layout"):
        cf.settle(cf.find_form(section("en50318_2002", 2)), cf.Conditions(wind=cf.Wind(speed=10.0)))


def test_several_sections_settle_side_by_side(reference: cf.Catenary) -> None:
    part = reference.replace(spans=reference.spans[:6], supports=reference.supports[:7], evaluated_spans=None)
    line = cf.join_sections([part, part], [cf.Overlap(spans=3)])
    weather = cf.Conditions(temperature=45.0)
    whole = cf.case_rows(cf.settle(cf.find_form(line), weather))
    alone = cf.case_rows(cf.settle(cf.find_form(line.sections[0]), weather))
    shifts = [s.cantilever_shift_mm for s in whole.supports if s.section == 1]
    assert shifts[1:-1] == pytest.approx([s.cantilever_shift_mm for s in alone.supports][1:-1], rel=1e-6)
    assert [s.support for s in whole.supports] == [1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 9, 10]
