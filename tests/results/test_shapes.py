"""Wires over time, elasticity, modes and modal runs, of given shapes."""

import numpy as np
import pytest
from made_runs import HEIGHT, made_line, made_run

import catenary_fe as cf
from catenary_fe.results.modes import ModalRun, Modes, WireShapes
from catenary_fe.results.wires import Elasticity, contact_wires

TIMES, X = np.array([0.0, 0.1, 0.3]), np.linspace(0, 300, 31)


def stored(times=TIMES, **wires):
    """Wires that rise with 2 t + t², in single precision, and hang by a parabola."""
    variables = {"wire_time": ("wire_time", times)}
    for n, wire in enumerate(wires or ("messenger_wire", "left_contact_wire", "contact_wire"), start=1):
        static, place = HEIGHT + n + 1e-4 * (X - 150) ** 2, f"{wire}_x"
        variables[place] = (place, X + n)
        variables[f"static_{wire}_height"] = (place, static)
        rise = (2 * times + times**2)[:, None]
        variables[f"{wire}_height"] = (("wire_time", place), (static + rise).astype(np.float32))
    run = made_run(extra=variables)
    return cf.Run(run.data.set_coords([n for n in variables if not n.endswith("e_height") or "static" in n]))


def test_wires_over_time():
    """Contact wires first, the right one before the left one, whatever the order of the variables."""
    wires = stored().wires()
    assert [w.name for w in wires] == ["contact wire", "left contact wire", "messenger wire"]
    assert [w.touched for w in wires] == [True, True, False]
    assert contact_wires(wires) == list(wires[:2])
    for wire, n in zip(wires, (3, 2, 1), strict=True):
        assert np.array_equal(wire.x, X + n)
        assert np.array_equal(wire.time, TIMES)
        assert wire.static == pytest.approx(HEIGHT + n + 1e-4 * (X - 150) ** 2)
        assert wire.height.shape == (3, 31)
        assert wire.height.dtype == wire.static.dtype == float
        assert wire.uplift == pytest.approx(np.outer([0, 0.21, 0.69], np.ones(31)), abs=1e-6)
        assert wire.velocity == pytest.approx(np.outer([2.1, 2.2, 2.4], np.ones(31)), rel=1e-4)


@pytest.mark.parametrize("times", [TIMES[:0], TIMES[:1], None])
def test_runs_without_wires(times):
    run = made_run() if times is None else stored(times)
    with pytest.raises(
        cf.InputError, match="the run holds no wire shapes; run again with --store-wire-ms 10"
    ):
        run.wires()


def test_two_times_are_enough():
    assert stored(TIMES[:2]).wires()[0].velocity.shape == (2, 31)


def test_a_picture_of_waves():
    axes = stored(np.linspace(0, 4, 41)).plot_waves()
    assert axes.get_xlabel().endswith("(m)")
    assert stored(np.linspace(0, 4, 41)).plot_waves(ax=axes) is axes


def test_elasticity():
    curve = Elasticity(np.array([0.0, 1.0, 2.0]), np.array([0.03, 0.05, 0.04]), 100.0, np.array([0.0]))
    assert curve.values == pytest.approx([3e-4, 5e-4, 4e-4])
    assert curve.non_uniformity == pytest.approx(2 / 8)
    axes = curve.plot()
    assert axes.get_ylabel().endswith("(mm/N)")
    assert curve.plot(ax=axes) is axes


LINE = made_line((50.0,) * 4)  # bays of 10 m between droppers
NODES = np.linspace(0, 200, 401)


def sine(half_waves, length=200.0):
    """Shape and slope of so many half-waves in each length."""
    k = np.pi * half_waves / length
    return np.sin(k * NODES), k * np.cos(k * NODES)


def bay(half_waves, number):
    """Half-waves in one bay only."""
    inside = np.abs(NODES - 10 * number - 5) <= 5
    return tuple(np.where(inside, values, 0.0) for values in sine(half_waves, 10.0))


def modes(contact, messenger=None, along=None, sideways=None, line=LINE, frequencies=None, scale=0.01):
    """Modes with given shapes of the contact wire, each (values, slopes), and of the messenger wire."""
    n = len(contact)
    wires = [
        WireShapes(NODES, np.array([scale * s[0] for s in shapes]), np.array([scale * s[1] for s in shapes]))
        for shapes in (contact, messenger or contact)
    ]
    frequencies = np.arange(1.0, n + 1) if frequencies is None else np.asarray(frequencies)
    shares = (np.asarray(share or [0.0] * n) for share in (along, sideways))
    return Modes(line, frequencies, *wires, *shares, 0.01 * np.arange(n))


def test_shapes_between_nodes_are_cubic():
    shapes = WireShapes(
        np.array([0.0, 2.0]), np.array([[0.0, 8.0], [1.0, 5.0]]), np.array([[0.0, 12.0], [2, 2]])
    )
    assert shapes.at([0, 1, 2]) == pytest.approx(np.array([[0, 1, 8], [1, 3, 5]]))
    assert shapes.at([1, 1.5]).shape == (2, 2)


@pytest.mark.parametrize("half_waves", range(1, 7))
def test_the_line_as_a_whole(half_waves):
    kind = modes([sine(half_waves)]).kind(0)
    assert (kind.kind, kind.half_waves) == ("whole line", half_waves)
    assert kind.symmetry == ("symmetric" if half_waves % 2 else "antisymmetric")
    waves = "half-wave" if half_waves == 1 else "half-waves"
    assert str(kind) == f"{kind.symmetry}, whole line, {half_waves} {waves}"


@pytest.mark.parametrize("half_waves", range(1, 7))
def test_bays_between_clamps_that_stay(half_waves):
    mode = modes([sine(half_waves, 10.0), bay(half_waves, 4)])
    kind = mode.kind(0)
    assert (kind.kind, kind.half_waves) == ("bays", half_waves)
    assert mode.kind(1).symmetry == "neither"
    assert str(mode.kind(1)) == f"bays in shape {half_waves}"
    assert str(kind) == f"antisymmetric, bays in shape {half_waves}"  # of twenty bays


def test_along_the_track():
    kinds = modes([sine(1)] * 5, along=[0.5, 0.51, 0.9, 0.2, 0.3], sideways=[0, 0, 0, 0.7, 0.25]).kinds()
    assert [k.kind for k in kinds] == ["whole line", "along", "along", "sideways", "along"]
    assert str(kinds[3]) == "sideways"
    assert (str(kinds[1]), kinds[1].half_waves, kinds[1].symmetry) == ("along the track", 0, "neither")


def mixed(first, second, share):
    """Two shapes in one; both have the same mean square, of which the second has this share."""
    return tuple(np.sqrt(1 - share) * a + np.sqrt(share) * b for a, b in zip(first, second, strict=True))


@pytest.mark.parametrize(("share", "kind"), [(0.49, "whole line"), (0.51, "bays")])
def test_what_has_more_energy_names_the_mode(share, kind):
    assert modes([mixed(sine(1), sine(2, 10.0), share)]).kind(0).kind == kind


@pytest.mark.parametrize(
    ("share", "symmetry"),
    [(0.0, "symmetric"), (0.12, "symmetric"), (0.18, "neither"), (0.82, "neither"), (0.88, "antisymmetric")],
)
def test_symmetry_is_a_correlation_of_seven_tenths(share, symmetry):
    """Of a symmetric and an antisymmetric shape in one, the correlation is 1 - 2 times the share."""
    assert modes([mixed(sine(1), sine(2), share)]).kind(0).symmetry == symmetry


def test_heavier_wires_count_more():
    """The contact wire swings in bays, the messenger wire as a whole, equally far."""
    for masses, kind, symmetry in (((1.0, 2.0), "whole line", "neither"), ((2.0, 1.0), "bays", "neither"),
                                   ((1.0, 10.0), "whole line", "symmetric"), ((10.0, 1.0), "bays",
                                   "antisymmetric")):  # fmt: skip
        contact, messenger = (w.replace(mass_per_length=m) for w, m in
                              zip((LINE.contact_wire, LINE.messenger_wire), masses, strict=True))  # fmt: skip
        line = LINE.replace(contact_wire=contact, messenger_wire=messenger)
        found = modes([sine(2, 10.0)], [sine(1)], line=line).kind(0)
        assert (found.kind, found.symmetry) == (kind, symmetry)


def test_half_waves_are_counted_on_both_wires_with_their_masses():
    messenger = LINE.messenger_wire.replace(mass_per_length=2.0)
    line = LINE.replace(messenger_wire=messenger)
    against = [tuple(-share * a for a in sine(3)) for share in (0.25, 0.1)]
    found = modes([sine(1)] * 2, against, line=line)
    assert [kind.half_waves for kind in found.kinds()] == [3, 1]


@pytest.mark.parametrize(("dip", "half_waves"), [(-0.015, 1), (-0.025, 5)])
def test_half_waves_of_clamps_that_hardly_move_are_not_counted(dip, half_waves):
    values, slopes = sine(1)
    values = np.where(np.isin(NODES, (60.0, 130.0)), dip, values)
    assert modes([(values, slopes)]).kind(0).half_waves == half_waves


def test_a_contact_wire_without_an_arm_swings_across_the_support():
    """A triangle over the support at 50 m: a bay's first shape, or two chords between held places."""
    arms = (cf.Support(steady_arm=cf.SteadyArm(stiffness=100.0)),) * 5
    free = made_line((50.0,) * 4, dropper_every=40.0)
    triangle = np.interp(NODES, [40.0, 50.0, 90.0], [0.0, 1.0, 0.0])
    shapes = [(triangle, 0 * NODES)], [(0 * NODES, 0 * NODES)]
    assert str(modes(*shapes, line=free).kind(0)) == "bays in shape 1"
    assert modes(*shapes, line=free.replace(supports=arms)).kind(0).kind == "whole line"
    # the messenger wire always lies on its supports, and both wires at the line's ends
    assert modes(*shapes[::-1], line=free).kind(0).kind == "whole line"


@pytest.mark.parametrize(("a", "b"), [(0.0, 40.0), (190.0, 200.0)])
def test_the_first_and_the_last_bay_end_at_the_line_s_ends(a, b):
    inside = (a <= NODES) & (b >= NODES)
    shape = np.where(inside, np.sin(2 * np.pi * (NODES - a) / (b - a)), 0.0), 0 * NODES
    line = made_line((50.0,) * 4, dropper_every=40.0)
    assert str(modes([shape], [(0 * NODES, 0 * NODES)], line=line).kind(0)) == "bays in shape 2"


@pytest.mark.parametrize(("share", "kind"), [(0.85, "bays"), (1.15, "whole line")])
def test_long_bays_count_by_their_length(share, kind):
    """A bay of 40 m swings, chords stand over 100 m: at a share of 1 they have as much energy."""
    line = made_line((50.0,) * 4, dropper_every=40.0)
    swing = np.where(NODES <= 40, np.sin(np.pi * NODES / 40), 0.0)
    # chords from 0 to 1 and back over 40 + 10 + 40 + 10 m, a third of the length times the square
    chords = np.interp(NODES, [50, 90, 100, 140, 150], [0, 1, 0, 1, 0])
    arms = (cf.Support(steady_arm=cf.SteadyArm(stiffness=100.0)),) * 5
    shape = swing + np.sqrt(share * (40 / 2) / (100 / 3)) * chords, 0 * NODES
    found = modes([shape], [(0 * NODES, 0 * NODES)], line=line.replace(supports=arms)).kind(0)
    assert found.kind == kind


def test_modes_up_to_a_frequency():
    whole = modes([sine(1), sine(2), sine(3), sine(4)], along=[0.1, 0.2, 0.3, 0.4])
    some = whole.below(3.0)  # itself too
    assert len(whole) == 4
    assert len(some) == 3
    assert np.array_equal(some.frequencies, [1.0, 2.0, 3.0])
    assert np.array_equal(some.along, [0.1, 0.2, 0.3])
    assert np.array_equal(some.sideways, [0.0, 0.0, 0.0])
    assert np.array_equal(some.damping_ratios, [0.0, 0.01, 0.02])
    for part, of in ((some.contact, whole.contact), (some.messenger, whole.messenger)):
        assert np.array_equal(part.x, NODES)
        assert np.array_equal(part.values, of.values[:3])
        assert np.array_equal(part.slopes, of.slopes[:3])
    assert len(whole.below(0.9)) == 0


def test_compliance_is_the_sum_of_all_modes():
    found = modes([sine(1), sine(2)], frequencies=[0.5, 0.8], scale=1.0).compliance([50.0, 100.0])
    first, second = 1 / np.pi**2, 1 / (1.6 * np.pi) ** 2
    assert found == pytest.approx([first / 2 + second, first])


def test_a_table_of_modes():
    mode = modes([sine(2), sine(1, 10.0), bay(3, 4)], along=[0.0, 0.0, 1.0])
    rows = mode.table()
    assert rows[0] == {
        "mode": 1, "frequency_Hz": 1.0, "damping_ratio": 0.0, "kind": "whole line", "half_waves": 2,
        "symmetry": "antisymmetric",
    }  # fmt: skip
    assert [(r["mode"], r["kind"]) for r in rows] == [(1, "whole line"), (2, "bays"), (3, "along")]
    assert mode.count_by_kind() == {"whole line": 1, "bays 1": 1, "along": 1}


@pytest.mark.parametrize("number", [-1, 3])
def test_modes_are_numbered_from_0(number):
    mode = modes([sine(1)] * 3)
    assert mode.kind(0) == mode.kind(2)
    with pytest.raises(cf.InputError, match=f"mode {number}: computed: 3 modes, numbered from 0"):
        mode.kind(number)


def test_a_picture_of_a_mode():
    axes = modes([sine(1)]).plot(0)
    assert axes.get_xlabel().endswith("(m)")
    assert modes([sine(1)]).plot(0, ax=axes) is axes


def test_a_modal_run_is_a_sum_of_shapes():
    time = np.linspace(0, 1, 5)
    run = ModalRun(
        modes=modes([sine(1), sine(2)], scale=1.0),
        time=time, position=50 * time, contact_force=100 + 3 * time,
        wire_height=HEIGHT + time, mass_height=np.empty((0, 5)),
        coordinates=np.column_stack([time, 2 * time]),
    )  # fmt: skip
    expected = time[:, None] * (np.sin(np.pi * X / 200) + 2 * np.sin(2 * np.pi * X / 200))
    assert run.uplift(X[X <= 200]) == pytest.approx(expected[:, X <= 200], abs=1e-5)
    assert run.uplift([100.0], every=2) == pytest.approx(time[::2, None])
    force = 100 + 3 * time + np.array([0, 1, 0, -1, 0])
    assert run.error_against(force) == pytest.approx(np.sqrt(0.4) / force.std())
    assert run.error_against(HEIGHT + 1.1 * time, "wire_height") == pytest.approx(
        0.1 * np.sqrt(np.mean(time**2)) / (1.1 * time.std())
    )
