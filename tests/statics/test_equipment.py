"""Equipment within the spans, and contact wires without a messenger wire, against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

import catenary_fe as cf
from catenary_fe.fe.reduction import linear_model
from catenary_fe.layout import layout_warnings

G, T, RHO, L = 9.81, 10e3, 1.0, 50.0
STRING = cf.Wire(mass_per_length=RHO, tension=T, axial_stiffness=1e9)
DROPPERS = tuple(cf.Dropper(position=x) for x in (5.0, 15.0, 25.0, 35.0, 45.0))
ARM = cf.SteadyArm(stiffness=200.0, mass=0.8)
ENGINES = ("nonlinear", "linearised", "exudyn")


def bare(spans=1, *equipment, **others):
    """A contact wire held at its supports alone."""
    support = cf.Support(steady_arm=cf.SteadyArm(stiffness=1e6))
    line = {"contact_wire": STRING, "spans": (cf.Span(length=L, droppers=()),) * spans,
            "supports": (support,) * (spans + 1), "equipment": equipment}  # fmt: skip
    return cf.Catenary(**line | others)


def whole(*equipment, spans=5):
    return cf.Catenary.regular(
        spans=spans, span_length=L, droppers=DROPPERS, evaluated_spans=(3,), equipment=equipment,
        contact_wire=cf.library.wire("AC-120 CuMg", tension=15e3), pre_sag=0.02,
        messenger_wire=cf.library.wire("BzII 70", tension=15e3), damping=cf.RayleighDamping(beta=1e-4),
        support=cf.Support(messenger_stiffness=5e5, steady_arm=ARM),
    )  # fmt: skip


def sag(line, x):
    return line.contact_wire_height - cf.find_form(line).contact_wire_height(x)


@pytest.mark.parametrize("at", [0.0, 50.0, 100.0])
def test_a_contact_wire_without_messenger_sags_as_a_string(at):
    line = bare(3)
    assert sag(line, at + L / 2) == pytest.approx(RHO * G * L**2 / (8 * T), rel=1e-4)
    shape = cf.find_form(line)
    assert shape.steady_arm_forces[1:-1] == pytest.approx(RHO * G * L, rel=5e-3)
    assert [wire.name for wire in shape.system.wires] == ["contact wire"]


@pytest.mark.parametrize("at", [10.0, 25.0, 37.5])
def test_a_mass_at_a_point_sags_as_on_a_string(at):
    mass = 12.0
    more = sag(bare(1, cf.Equipment(x=at, mass=mass)), at) - sag(bare(), at)
    assert more == pytest.approx(mass * G * at * (L - at) / (T * L), rel=5e-3)


def test_a_mass_over_a_length_sags_by_less_and_a_stiff_one_by_less_still():
    """A soft piece of the length ℓ: m g (2 L - ℓ)/(8 T); a rigid one: m g (L - ℓ)/(4 T)."""
    mass, length = 12.0, 4.0
    wire = STRING.replace(bending_stiffness=1.0)
    # the weight of the wire itself has a bar to hang on, too: rho g l more in the middle is left out
    light = wire.replace(mass_per_length=1e-3)
    line = bare(1, cf.Equipment(x=25.0, mass=mass, length=length), contact_wire=light)
    stiff = line.equipment[0].replace(bending_stiffness=1e8)
    none = 1e-3 * G * L**2 / (8 * T)
    assert sag(line, 25.0) - none == pytest.approx(mass * G * (2 * L - length) / (8 * T), rel=1e-3)
    rigid = sag(line.replace(equipment=(stiff,)), 25.0) - none
    assert rigid == pytest.approx(mass * G * (L - length) / (4 * T), rel=1e-3)


def test_a_mass_at_mid_span_lowers_the_frequency_of_a_string():
    """Even shapes of a string with a mass in its middle, as a mass that reflects waves by
    r = -Z/(Z + 2 √(T ρ)), Z = i m ω: cot(ω L/2c) = m ω/(2 √(T ρ))."""
    mass, c = 12.0, np.sqrt(T / RHO)

    def even(omega):
        return np.cos(omega * L / (2 * c)) - mass * omega / (2 * np.sqrt(T * RHO)) * np.sin(
            omega * L / (2 * c)
        )

    wire = STRING.replace(axial_stiffness=1e8)
    modes = cf.solve_modes(cf.find_form(bare(1, cf.Equipment(x=25.0, mass=mass), contact_wire=wire)), count=6)
    upright = modes.frequencies[modes.along < 0.5]
    expected = [brentq(even, a, b) / (2 * np.pi) for a, b in ((1.0, 6.2), (12.6, 18.8))]
    assert upright[[0, 2]] == pytest.approx(expected, rel=1e-3)
    assert upright[1] == pytest.approx(c / L, rel=1e-3)  # odd: its node is at the mass
    assert modes.messenger is None and modes.count_by_kind()


def test_droppers_are_cut_with_the_equipment_in_place():
    items = (
        cf.Equipment(span=3, position=20.0, mass=15.0, length=1.6, bending_stiffness=3e3),
        cf.Equipment(x=75.0, mass=3.0),
    )
    with_it, without = cf.find_form(whole(*items)), cf.find_form(whole())
    assert with_it.height_errors == pytest.approx(0.0, abs=1e-9)
    more = with_it.dropper_forces - without.dropper_forces
    assert more.sum() == pytest.approx(18.0 * G, rel=1e-3)
    assert more[7] == pytest.approx(3.0 * G, rel=1e-3)
    assert more[11:13] == pytest.approx(7.5 * G, rel=0.02)
    mirrored = cf.find_form(with_it.catenary.mirrored())
    assert mirrored.dropper_forces[::-1] == pytest.approx(with_it.dropper_forces, abs=1e-6)
    # hung on the droppers of the line without it, the wire sags there
    lower = cf.find_heights(with_it.catenary, without.dropper_lengths).height_errors
    assert lower[11:13].max() < -0.004 and abs(lower[0]) < 1e-3


def test_a_mass_on_the_messenger_wire_is_carried_by_its_supports():
    item = cf.Equipment(x=130.0, mass=20.0, wire="messenger wire", length=1.0)
    with_it, without = cf.find_form(whole(item)), cf.find_form(whole())
    assert with_it.dropper_forces == pytest.approx(without.dropper_forces, abs=0.01)
    assert (with_it.support_forces - without.support_forces).sum() == pytest.approx(20.0 * G, rel=1e-3)


def test_of_two_contact_wires_each_has_half_of_it():
    line = whole(cf.Equipment(x=100.0, mass=8.0)).replace(contact_wire_spacing=0.04)
    bare_line = line.replace(equipment=())
    more = linear_model(cf.find_form(line).system).mass - linear_model(cf.find_form(bare_line).system).mass
    found = more.diagonal()
    assert found[np.abs(found) > 0.01] == pytest.approx(4.0)


@pytest.mark.parametrize("line", ["equipment", "no messenger"])
def test_engines_agree(line, pantograph):
    item = cf.Equipment(span=3, position=20.0, mass=12.0, length=1.6, bending_stiffness=3e3)
    stiff = {"contact_wire": cf.library.wire("AC-120 CuMg", tension=15e3)}
    alone = bare(4, damping=cf.RayleighDamping(beta=1e-4), evaluated_spans=(3,), **stiff)
    shape = cf.find_form(whole(item) if line == "equipment" else alone)
    speed, runs = (40.0 if line == "equipment" else 14.0), {}
    for method in ENGINES:
        run = cf.simulate(shape, [pantograph], speed=speed, positions=[45.0], method=method)
        runs[method] = run.contact_force_statistics()[0]
    for method in ("linearised", "exudyn"):
        assert runs[method].std == pytest.approx(runs["nonlinear"].std, rel=0.03), method
        assert runs[method].mean == pytest.approx(runs["nonlinear"].mean, abs=0.5), method
    if line == "equipment":
        without = cf.simulate(cf.find_form(whole()), [pantograph], speed=speed, positions=[45.0])
        assert runs["nonlinear"].max > without.contact_force_statistics()[0].max + 20.0


FAULTS = {
    "no place": ({"mass": 1.0}, "x, or span and position: give exactly one"),
    "two places": ({"mass": 1.0, "x": 3.0, "span": 1, "position": 3.0}, "give exactly one"),
    "half a place": ({"mass": 1.0, "span": 1}, "give exactly one"),
    "nothing": ({"mass": 0.0, "x": 3.0}, "has no effect; give one of them"),
    "stiff at a point": ({"mass": 1.0, "x": 3.0, "bending_stiffness": 1e3}, "has no effect without a length"),
    "no such span": ({"mass": 1.0, "span": 9, "position": 3.0}, "span = 9: the line has spans"),
    "beyond the span": ({"mass": 1.0, "span": 2, "position": 60.0}, "lies outside span 2 of 50 m"),
    "over the end": ({"mass": 1.0, "x": 249.5, "length": 2.0}, "reaches from 248.5 to 250.5 m"),
    "beside a clamp": ({"mass": 1.0, "x": 105.005}, "clamp, anchor or support at 105 m; move it there"),
}  # fmt: skip


@pytest.mark.parametrize("case", FAULTS)
def test_what_cannot_be_there_is_refused(case):
    values, said = FAULTS[case]
    with pytest.raises(cf.InputError, match=said):
        whole(cf.Equipment(**values))


def test_pieces_on_one_another_are_refused():
    first, second = cf.Equipment(x=110.0, mass=1.0, length=3.0), cf.Equipment(x=112.0, mass=1.0, length=3.0)
    with pytest.raises(cf.InputError, match=r"equipment 2 begins at 110\.5 m, before equipment 1 ends"):
        whole(first, second)
    assert whole(first, second.replace(wire="messenger wire"))


WITHOUT = {
    "droppers": ({"spans": (cf.Span(length=L, droppers=DROPPERS),)}, "messenger_wire is missing"),
    "stitch wires": ({"stitch_wire": cf.StitchWire(**STRING.model_dump(), length=14.0)}, "has nothing to be"),
    "equipment": ({"equipment": (cf.Equipment(x=9.0, mass=1.0, wire="messenger wire"),)}, "line has none"),
}  # fmt: skip


@pytest.mark.parametrize("case", WITHOUT)
def test_what_needs_a_messenger_wire_is_refused_without(case):
    values, said = WITHOUT[case]
    line = bare()
    with pytest.raises(cf.InputError, match=said):
        line.replace(**values)


def test_a_support_that_holds_nothing_is_refused_without_messenger_and_inert_values_are_warned_of():
    with pytest.raises(cf.InputError, match="support 2: neither a steady_arm nor droppers hold"):
        bare(2, supports=(cf.Support(),) * 3)
    supports = (cf.Support(steady_arm=ARM, messenger_stiffness=5e5),) * 3
    (warning,) = layout_warnings(bare(2, supports=supports))
    assert "messenger_stiffness = 500000 has no effect without a messenger_wire" in warning
