"""The assembled line: its forces, tangent and energy belong together, and are what Exudyn assembles."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import exudyn as exu
import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve

import catenary_fe as cf
from catenary_fe.engines.exudyn.solver import solve_static
from catenary_fe.fe.assembly import assemble
from catenary_fe.fe.system import System

LAYOUTS = sorted((Path(__file__).parents[2] / "models" / "layouts").glob("*.toml"))


def first_spans(path: Path, count: int = 3) -> cf.Catenary:
    whole = cf.load_catenary(path).without_dropper_lengths()  # they are those of the whole line
    return whole.replace(
        spans=whole.spans[:count], supports=whole.supports[: count + 1], evaluated_spans=(2,)
    )


def curved(path: Path) -> cf.Catenary:
    """All spans in a curve to the left, the arms inside of it."""
    line = first_spans(path)
    supports = tuple(s.replace(stagger=-0.2) for s in line.supports)
    return line.replace(
        name="curve", spans=tuple(s.replace(curve_radius=1200.0) for s in line.spans), supports=supports
    )


LINES = {path.stem: (first_spans, path) for path in LAYOUTS}
LINES["curve"] = curved, LAYOUTS[0].with_name("en50318_2018_ac_simple.toml")


@pytest.fixture(scope="module", params=LINES)
def shape(request) -> cf.Shape:
    make, path = LINES[request.param]
    return cf.find_form(make(path))


@pytest.fixture(scope="module")
def system(shape) -> System:
    return assemble(shape.catenary, shape.mesh, shape.installation)


@pytest.fixture(scope="module")
def moved(system) -> np.ndarray:
    """Millimetres to all sides, slopes of some 1e-3: droppers and arms turn, some droppers go slack."""
    free = 2e-3 * np.random.default_rng(1).normal(size=system.size)
    return system.spread(free)


def test_the_installed_line_is_in_balance(system):
    assert np.abs(system.gather(system.out_of_balance(0 * system.reference))).max() < 1e-9


def test_forces_are_the_slope_of_the_energy(system, moved):
    way = system.spread(np.random.default_rng(2).normal(size=system.size))
    step = 1e-6
    slope = (system.energy(moved + step * way) - system.energy(moved - step * way)) / (2 * step)
    assert -system.out_of_balance(moved) @ way == pytest.approx(slope, rel=1e-5)


def test_the_tangent_is_the_slope_of_the_forces(system, moved):
    way = np.random.default_rng(3).normal(size=system.size)
    step = 1e-7
    ends = [system.gather(system.out_of_balance(moved + s * step * system.spread(way))) for s in (-1, 1)]
    expected = (ends[0] - ends[1]) / (2 * step)
    found = system.tangent(moved, taut=False) @ way
    assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_parts_of_the_stiffness_add_up(system):
    whole = system.tangent(0 * system.reference)
    parts = system.free(system.wire_stiffness() + system.spring_stiffness())
    assert abs(whole - parts).max() < 1e-9 * abs(whole).max()


@dataclass(frozen=True)
class Assembled:
    """What Exudyn assembles at one state, over the wires' coordinates."""

    mass: np.ndarray
    forces: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


def assembled_by_exudyn(mbs: exu.MainSystem, moved: np.ndarray) -> Assembled:
    """Mass, forces, tangent and damping at displacements; nodes of the wires must be the system's first.

    The forces are without the reactions of constraints. The tangent is in closed form for the cables, and by
    numerical differentiation for what has user functions: droppers.
    """
    settings = exu.SimulationSettings()
    settings.solution.file.write = settings.solution.sensors.active = False
    settings.solution.solverInformationFileName = ""
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.timeIntegration.verboseMode = 0
    n = moved.size
    rest = np.zeros(mbs.systemData.ODE2Size() - n)
    mbs.systemData.SetODE2Coordinates(np.concatenate([moved, rest]), exu.ConfigurationType.Initial)
    solver = exu.MainSolverImplicitSecondOrder()
    assert solver.InitializeSolver(mbs, settings)
    solver.ComputeMassMatrix(mbs)
    solver.ComputeODE2RHS(mbs)
    mass, forces = np.array(solver.GetSystemMassMatrix()), np.array(solver.GetSystemResidual())
    solver.ComputeJacobianODE2RHS(mbs, scalarFactor_ODE2=-1.0, scalarFactor_ODE2_t=0.0)
    stiffness = np.array(solver.GetSystemJacobian())
    solver.ComputeJacobianODE2RHS(mbs, scalarFactor_ODE2=0.0, scalarFactor_ODE2_t=-1.0)
    damping = np.array(solver.GetSystemJacobian())
    return Assembled(mass[:n, :n], forces[:n], stiffness[:n, :n], damping[:n, :n])


@pytest.fixture(scope="module")
def exudyn_at(shape) -> Iterator[Callable[[np.ndarray], Assembled]]:
    """What Exudyn assembles of the line, at given displacements."""
    model = cf.exudyn_model(shape)
    yield lambda moved: assembled_by_exudyn(model.mbs, moved)
    model.release()


def assert_equal_to_rounding(system: System, theirs: Assembled, moved: np.ndarray) -> None:
    """Mass 1e-14; forces 5e-6 N, rounding of EA ε at x = 200 m; tangent 1e-8, droppers differentiated."""
    assert abs(system.mass - theirs.mass).max() < 1e-14 * np.abs(theirs.mass).max()
    assert system.out_of_balance(moved) == pytest.approx(theirs.forces, abs=5e-6)
    stiffness = system.transformation.T @ theirs.stiffness @ system.transformation
    assert abs(system.tangent(moved, taut=False) - stiffness).max() < 1e-8 * np.abs(stiffness).max()


def test_exudyn_assembles_the_same_at_rest(system, exudyn_at):
    rest = 0 * system.reference
    theirs = exudyn_at(rest)
    assert_equal_to_rounding(system, theirs, rest)
    damping = system.damping() + system.taut_damping()
    assert abs(damping - theirs.damping).max() < 2e-8 * np.abs(theirs.damping).max()


def test_exudyn_assembles_the_same_in_motion(system, moved, exudyn_at):
    """Of its droppers, some are slack."""
    total = system.reference + moved
    assert (system.droppers.tension(system.droppers.span(total)) == 0).any()
    assert_equal_to_rounding(system, exudyn_at(moved), moved)


def test_a_dropper_that_is_stiffer_by_a_thousandth_is_seen(system, moved, exudyn_at):
    """Negative control."""
    stiffness = system.droppers.stiffness.copy()
    taut = np.argmax(system.droppers.tension(system.droppers.span(system.reference + moved)))
    stiffness[taut] *= 1.001
    other = replace(system, droppers=replace(system.droppers, stiffness=stiffness))
    theirs = exudyn_at(moved)
    assert np.abs(other.out_of_balance(moved) - theirs.forces).max() > 1e-3
    with pytest.raises(AssertionError):
        assert_equal_to_rounding(other, theirs, moved)


def test_further_linear_stiffness_and_damping_reach_exudyn(shape, system, moved):
    """A spring and damper between contact and messenger wire in the middle of the line."""
    wire, messenger = system.wires[0], next(w for w in system.wires if not w.contact)
    middle = wire.x[-1] / 2
    nodes = [w.first + int(np.abs(w.x - middle).argmin()) for w in (wire, messenger)]
    row = np.zeros((1, system.dof.size))
    row[0, 2 * system.axes * np.array(nodes) + system.axes - 1] = 1.0, -1.0
    between = csr_matrix(row.T @ row)
    other = replace(system, linear_stiffness=5e4 * between, linear_damping=300.0 * between)
    changed = replace(shape)
    vars(changed)["system"] = other
    model = cf.exudyn_model(changed)
    at_rest, theirs = (assembled_by_exudyn(model.mbs, q) for q in (0 * moved, moved))
    model.release()
    assert_equal_to_rounding(other, theirs, moved)
    with pytest.raises(AssertionError):
        assert_equal_to_rounding(system, theirs, moved)
    damping = other.damping() + other.taut_damping()
    assert abs(damping - at_rest.damping).max() < 2e-8 * np.abs(at_rest.damping).max()


def test_exudyn_finds_the_same_equilibrium(shape):
    model = cf.exudyn_model(shape)
    solve_static(model.mbs, what="the same line")
    found = model.mbs.systemData.GetODE2Coordinates()
    force = exu.OutputVariableType.ForceLocal
    tensions = [model.mbs.GetObjectOutput(dropper, force) for dropper in model.droppers]
    model.release()
    assert np.abs(found).max() < 1e-6  # [m] from where the wires were installed
    assert tensions == pytest.approx(shape.dropper_forces, abs=0.1)


def test_without_the_balance_the_wires_hang_millimetres_elsewhere(shape):
    """Negative control: what the balance is for."""
    bare = replace(shape.installation, balance=0 * shape.installation.balance)
    system = assemble(shape.catenary, shape.mesh, bare)
    residual = system.gather(system.out_of_balance(0 * system.reference))
    assert np.abs(residual).max() > 1.0


def hung_elsewhere(line: cf.Catenary, at_clamps: float) -> float:
    """[m], the largest distance to where the wires would hang without the balance, by the tangent."""
    shape = cf.find_form(line, cf.MeshSettings(at_clamps=at_clamps))
    system = assemble(shape.catenary, shape.mesh, shape.installation)
    forces = system.gather(shape.installation.balance)
    moved = system.spread(spsolve(system.tangent(0 * system.reference).tocsc(), forces))
    return float(np.abs(moved.reshape(-1, 2 * system.axes)[:, : system.axes]).max())


def test_the_balance_vanishes_with_the_elements(shape):
    """What form finding leaves out or counts twice, the balance would hide: but not on short elements."""
    coarse, fine = (hung_elsewhere(shape.catenary, length) for length in (0.5, 0.02))
    assert 3e-4 < coarse < 4e-3
    assert fine < 0.06 * coarse


@pytest.mark.parametrize("name", ["en50318_2002", "re330"])
def test_the_system_of_form_finding_is_the_assembled_one(name):
    find, path = LINES[name]
    shape = cf.find_form(find(path))
    again = assemble(shape.catenary, shape.mesh, shape.installation)
    for field in ("reference", "force", "dof", "ground_stiffness"):
        np.testing.assert_array_equal(getattr(shape.system, field), getattr(again, field))
    assert np.abs(again.gather(again.out_of_balance(0 * again.reference))).max() < 1e-4
    assert np.abs(shape.installation.balance).max() > 1  # negative control: what this takes
