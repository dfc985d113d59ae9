"""Runs in space: against the plane, and heads that roll or have two strips."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli.folder import Folder, output_folder
from catenary_fe.cli.run import write_run
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.exudyn.run import ExudynEngine


@pytest.fixture(scope="module")
def chain():
    return cf.library.pantograph("EN 50318:2018 AC").replace(mean_force=None, uplift_force=140.0)


def test_a_flat_line_gives_the_same_contact_force(flat, pantograph):
    runs = [
        cf.simulate(cf.find_form(line), [pantograph], speed=250 / 3.6)
        for line in (flat, flat.replace(spatial=True))
    ]
    plane, space = (run.filtered_contact_force()[0] for run in runs)
    assert np.abs(space - plane).max() < 0.005 * plane.mean()
    assert space[2000:].std() == pytest.approx(plane[2000:].std(), rel=5e-3)


def settled(shape, pantograph, seconds=0.02):
    """A pantograph that has just come to rest under the wire, 14 m behind a support."""
    case = RunCase([pantograph], 0.01, np.array([69.0]), 0.01 * seconds)
    return ExudynEngine(shape).run(case, np.array([140.0]))


def test_a_rolling_head_tilts_under_an_eccentric_wire(staggered_shape, chain):
    """Static: φ = F y / (k b²/4), and the head is lower under the wire than in its middle."""
    b = 0.8
    level = settled(staggered_shape, chain)
    rolling = settled(staggered_shape, chain.replace(head=cf.Panhead(spring_distance=b)))
    force, y = rolling.contact_force[0, 0], float(staggered_shape.contact_wires[0].lateral(69.0))
    assert abs(y) > 0.05
    assert force == pytest.approx(level.contact_force[0, 0], rel=1e-2)
    tilt = -force * y / (7000 * b**2 / 4)  # the wire pushes down
    head, wire = rolling.mass_heights[0][0, 0], rolling.wire_height[0, 0]
    assert head + tilt * y - wire == pytest.approx(force / 50e3, rel=2e-3)
    assert level.mass_heights[0][0, 0] - level.wire_height[0, 0] == pytest.approx(force / 50e3, rel=1e-2)


def test_two_strips_share_the_force(staggered_shape, chain):
    head = cf.Panhead(strips=2, strip_distance=0.5)
    one, two = (
        settled(staggered_shape, chain),
        settled(staggered_shape, chain.replace(head=head)),
    )
    assert two.mass_heights[0].shape[0] == one.mass_heights[0].shape[0] + 1
    assert two.contact_force[0] == pytest.approx(one.contact_force[0], rel=0.01)
    # each strip's spring carries its half: k/2 under F/2 is as short as k under F
    front, rear, middle = two.mass_heights[0][:3, 0]
    assert (front + rear) / 2 - middle == pytest.approx(-one.contact_force[0, 0] / 7000, rel=0.02)


def test_a_wire_beyond_the_head_is_refused(staggered_shape, chain):
    narrow = chain.replace(head=cf.Panhead(width=0.3))
    with pytest.raises(cf.InputError, match=r"leaves the head at .* m \(span .\): it lies 0\.\d+ m from"):
        cf.simulate(staggered_shape, [narrow], speed=250 / 3.6)


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ({"strips": 2}, "strips = 2 and strip_distance belong together"),
        ({"roll_inertia": 1.0}, "roll_inertia has no effect without spring_distance"),
        ({"width": 0.0}, "width = 0.0: must be"),
    ],
)
def test_heads_that_cannot_be(head, said):
    with pytest.raises(cf.InputError, match=said):
        cf.Panhead(**head)


def test_energy_of_an_undamped_run_in_space(staggered, chain):
    """As in the plane; links, clamps and the head's roll are in the balance."""
    free = chain.replace(stages=tuple(s.replace(damping=0.0) for s in chain.stages))
    supports = tuple(s.replace(messenger_damping=0.0) for s in staggered.supports)
    shape = cf.find_form(staggered.replace(damping=cf.RayleighDamping(), supports=supports))
    time = cf.TimeSettings(step=1e-3, tolerance=1e-6, spectral_radius=1.0)
    case = RunCase([free], 250 / 3.6, np.array([15.0]), 1.5 * 250 / 3.6)
    history = ExudynEngine(shape, time, energy=True).run(case, np.array([140.0]))
    gained = history.energy - history.energy[0]
    driven = history.driven_work[::50]
    base = history.mass_heights[0][-1]
    work = np.abs(driven).max() + np.abs(140 * (base - base[0])).max()
    assert work > 10
    assert np.abs(driven - gained).max() < 0.01 * work


def test_a_run_in_space_has_a_plan_among_its_pictures(staggered_shape, pantograph, tmp_path, monkeypatch):
    step = cf.TimeSettings(step=4e-3)
    run = cf.simulate(staggered_shape, [pantograph], speed=70.0, method="linearised", time=step)
    drawn = {}
    monkeypatch.setattr(Folder, "picture", lambda self, name, ax: drawn.update({name: ax}))
    with output_folder(str(tmp_path)) as folder:
        write_run(folder, staggered_shape, run, run.summary())
    assert "straight track" in drawn["plan.png"].get_title(loc="left")
    assert (tmp_path / "support_schedule.csv").read_text().count("\n") == 6
