"""Runs as sums of eigenforms: towards the full run as the cut-off rises, and exact where they must be."""

import numpy as np
import pytest

import catenary_fe as cf

SPEED = 200 / 3.6
HEADS = {
    "constant": cf.ElasticPantograph(force=30.0),
    "elastic": cf.ElasticPantograph(force=50.0, stiffness=1000.0),
    "points": cf.ElasticPantograph(law=((-0.5, 550.0), (0.05, 0.0))),
    "masses": cf.library.pantograph("EN 50318:2002").replace(uplift_force=40.0),
}


@pytest.fixture(scope="module")
def modes(short_shape):
    return cf.solve_modes(short_shape, below=200.0)


@pytest.mark.parametrize("head", HEADS)
def test_it_tends_to_the_full_run(short_shape, modes, head):
    full = cf.simulate(short_shape, [HEADS[head]], speed=SPEED)
    height = full.data["wire_height"].values[0]
    errors = [
        cf.modal_run(short_shape, modes.below(f), HEADS[head], speed=SPEED).error_against(
            height, of="wire_height"
        )
        for f in (10.0, 40.0, 200.0)
    ]
    assert errors[0] > errors[1] > errors[2]
    # 1 to 2 % left: modes above 200 Hz, a time integration of second order in the full run, the wires' large
    # stiffness against being stretched
    assert errors[2] < 0.03


def test_a_law_of_points_is_the_line_through_them(short_shape, modes):
    runs = [cf.modal_run(short_shape, modes, HEADS[h], speed=SPEED) for h in ("elastic", "points")]
    assert runs[0].contact_force == pytest.approx(runs[1].contact_force, abs=1e-6)


def test_masses_start_in_static_contact(short_shape, modes):
    run = cf.modal_run(short_shape, modes, HEADS["masses"], speed=SPEED)
    depth = run.mass_height[0, 0] - run.wire_height[0]
    assert run.contact_force[0] == pytest.approx(50e3 * depth)
    assert run.contact_force[0] == pytest.approx(40.0 - 50.0 * (run.mass_height[1, 0] - 5.3))


def test_the_step_is_exact_for_a_force_at_rest(short_shape, modes):
    """Under a constant force that hardly moves, at rest at first, each mode swings as 1 - cos ωt."""
    run = cf.modal_run(
        short_shape, modes, HEADS["constant"], speed=1e-6, start=100.0, distance=1e-6, step=0.01, at_rest=True
    )
    undamped = modes.damping_ratios * 2 * np.pi * modes.frequencies * run.time[-1] < 0.01
    omega = 2 * np.pi * modes.frequencies
    phase = run.time[:20, None] * omega
    static = 30.0 * modes.contact.at([100.0])[:, 0] / omega**2
    exact = static * (1 - np.cos(phase))
    early = phase[-1] * modes.damping_ratios < 5e-4
    # the force comes within the first step, evenly from 0: a delay of half a step
    assert early.any() and not undamped.all()
    delayed = static * (1 - np.cos(phase - 0.005 * omega))
    found = run.coordinates[:20]
    assert np.abs(found - delayed)[5:, early].max() < 0.05 * np.abs(exact).max()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"speed": 0.0}, "must be above 0"),
        ({"start": -1.0}, "must lie on the line"),
        ({"distance": 500.0}, "must lie on the line"),
    ],
)
def test_bad_questions(short_shape, modes, change, said):
    with pytest.raises(cf.InputError, match=said):
        cf.modal_run(short_shape, modes, HEADS["constant"], **({"speed": SPEED} | change))


def test_what_it_cannot_do(short_shape, modes, pantograph):
    with pytest.raises(cf.InputError, match="no damper"):
        cf.modal_run(short_shape, modes, pantograph.replace(contact_damping=10.0), speed=SPEED)
    with pytest.raises(cf.InputError, match="no mode is left"):
        cf.modal_run(short_shape, modes.below(0.1), pantograph, speed=SPEED)
