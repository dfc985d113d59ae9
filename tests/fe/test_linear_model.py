"""The reduced linear model against the whole one: the same answers with half the coordinates."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe.assembly import assemble
from catenary_fe.fe.cable import hermite
from catenary_fe.fe.reduction import linear_model


@pytest.fixture(scope="module")
def reduced(short_shape):
    return linear_model(short_shape.system)


@pytest.fixture(scope="module")
def whole(short_shape):
    return short_shape.system


def receptance(mass, damping, stiffness, row, frequency):
    from scipy.sparse.linalg import spsolve

    omega = 2 * np.pi * frequency
    matrix = (stiffness + 1j * omega * damping - omega**2 * mass).tocsc()
    return row @ spsolve(matrix, row.astype(complex))


@pytest.mark.parametrize("frequency", [0.0, 0.5, 1.5, 3.0])
@pytest.mark.parametrize("position", [10.0, 90.0, 120.0, 152.0])
def test_receptance_of_the_contact_wire(reduced, whole, short_shape, frequency, position):
    line = reduced.contacts[0]
    e = int(np.searchsorted(line.x, position, side="right")) - 1
    weights = hermite((position - line.x[e]) / (line.x[e + 1] - line.x[e]), line.lengths[e])
    row = np.zeros(reduced.size)
    row[line.dof[e : e + 2].ravel()] = weights
    ours = receptance(reduced.mass, reduced.damping, reduced.stiffness, row, frequency)
    (path,) = whole.contact_paths
    filled = np.zeros(whole.dof.size)
    filled[path.index[e : e + 2].ravel()] = weights
    damping = whole.free(whole.damping() + whole.taut_damping())
    parts = whole.free(whole.mass), damping, whole.tangent(0 * filled)
    theirs = receptance(*parts, whole.gather(filled), frequency)
    # statics agree to rounding; near a resonance the mass that moves along between clamps shows
    assert ours == pytest.approx(theirs, rel=1e-4 if frequency == 0 else 0.02)
    assert reduced.size < 0.6 * whole.size


def test_matrices_are_symmetric_and_narrow(reduced):
    for matrix in (reduced.mass, reduced.damping, reduced.stiffness):
        assert abs(matrix - matrix.T).max() <= 1e-12 * abs(matrix).max()
    rows, columns = reduced.stiffness.nonzero()
    assert np.abs(rows - columns).max() < 40
    assert reduced.tensions.min() >= 0


def test_tension_coordinates_have_no_mass(reduced):
    assert abs(reduced.mass[reduced.tensions]).max() == 0
    assert (reduced.stiffness.diagonal()[reduced.tensions] < 0).all()


def damped(shape, kind, alpha=0.0, beta=0.0, **changes):
    """Damping matrix of a run's model of a shape; some parts changed that do not move it."""
    line = shape.catenary.replace(damping=cf.RayleighDamping(alpha=alpha, beta=beta), **changes)
    system = assemble(line, shape.mesh, shape.installation)
    if kind == "linear":
        return linear_model(system).damping
    return system.free(system.damping() + system.taut_damping())


def with_supports(line, **changes):
    return tuple(s.replace(**changes) for s in line.supports)


@pytest.mark.parametrize("kind", ["linear", "nonlinear"])
def test_rayleigh_damping_leaves_springs_of_supports_and_arms_alone(short_shape, kind):
    line = short_shape.catenary
    (arm,) = {s.steady_arm for s in line.supports[1:-1]}
    before = damped(short_shape, kind, beta=1e-3)
    stiffer = with_supports(
        line, messenger_stiffness=3e5, steady_arm=arm.replace(stiffness=9 * arm.stiffness)
    )
    after = damped(short_shape, kind, beta=1e-3, supports=stiffer)
    assert abs(after - before).max() <= 1e-6 * abs(before).max()
    own = with_supports(line, messenger_damping=50.0, steady_arm=arm.replace(damping=7.0))
    more = (damped(short_shape, kind, beta=1e-3, supports=own) - before).diagonal()
    assert sorted(more[more > 1e-3]) == pytest.approx([7.0] * 3 + [50.0] * 3, rel=1e-3)


def test_rayleigh_damping_of_wires_and_droppers(short_shape):
    """Of the wires β times their stiffness of EA, EI and tension; of a dropper β k beside its own damping."""
    line, beta, k, own = short_shape.catenary, 1e-3, 1e5, 30.0
    assert {d.stiffness for d in line.droppers} == {k}
    spans = tuple(s.replace(droppers=tuple(d.replace(damping=own) for d in s.droppers)) for s in line.spans)
    changed = line.replace(spans=spans, damping=cf.RayleighDamping(beta=beta))
    system = assemble(changed, short_shape.mesh, short_shape.installation)
    model = linear_model(system)
    for found in (model.dropper_damping, system.droppers.damping):
        assert found == pytest.approx(np.full(len(line.droppers), own + beta * k))
    rows, places = model.dropper_rows, model.heights[model.heights >= 0]
    wires_damping = model.damping - rows.T @ ((own + beta * k) * rows)
    wires_stiffness = model.stiffness - rows.T @ (k * rows)
    bent = np.zeros(model.size)
    bent[places] = np.cos(np.arange(places.size))
    bent[model.contacts[0].dof[model.contacts[0].supports, 0]] = 0.0  # there arms and supports hold the wires
    damped_by, held_by = (matrix @ bent for matrix in (wires_damping, beta * wires_stiffness))
    away = np.setdiff1d(places, at_springs(short_shape, model))
    assert damped_by[away] == pytest.approx(held_by[away], abs=1e-3 * np.abs(held_by).max())


def at_springs(shape, model):
    """Numbers of the heights at supports, of both wires."""
    mesh = shape.mesh
    nodes = [mesh.first_nodes[i] + wire.supports for i, wire in enumerate(mesh.wires)]
    return model.heights[np.concatenate(nodes)]


@pytest.mark.parametrize("kind", ["linear", "nonlinear"])
def test_mass_damping_is_of_the_wires_alone(short_shape, kind):
    line = short_shape.catenary
    heavy = tuple(
        s.replace(
            droppers=tuple(d.replace(messenger_clamp_mass=5.0, mass_per_length=2.0) for d in s.droppers)
        )
        for s in line.spans
    )
    before, after = (damped(short_shape, kind, alpha=0.1, spans=spans) for spans in (line.spans, heavy))
    assert abs(before - after).max() <= 1e-9 * abs(before).max()
    wires = (line.contact_wire.mass_per_length + line.messenger_wire.mass_per_length) * line.length
    if kind == "linear":
        model = linear_model(short_shape.system)
        up = np.zeros(model.size)
        up[model.heights[model.heights >= 0]] = 1.0
        assert up @ before @ up == pytest.approx(0.1 * wires, rel=0.02)  # without the ends, which are held
