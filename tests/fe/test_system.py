"""The assembled line: its forces, tangent and energy belong together, and are what Exudyn assembles."""

from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import catenary_fe as cf
from catenary_fe.engines.exudyn.model import build_model
from catenary_fe.engines.exudyn.solver import release, solve_static
from catenary_fe.fe.system import System, assemble

LAYOUTS = sorted((Path(__file__).parents[2] / "models" / "layouts").glob("*.toml"))


def first_spans(path: Path, count: int = 3) -> cf.Catenary:
    whole = cf.load_catenary(path)
    return whole.replace(
        spans=whole.spans[:count], supports=whole.supports[: count + 1], evaluated_spans=(2,)
    )


@pytest.fixture(scope="module", params=LAYOUTS, ids=lambda path: path.stem)
def shape(request) -> cf.Shape:
    return cf.find_form(first_spans(request.param))


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


def test_exudyn_finds_the_same_equilibrium(shape):
    model = build_model(shape.catenary, shape.mesh, shape.installation)
    model.mbs.Assemble()
    solve_static(model.mbs, what="the same line")
    found = model.mbs.systemData.GetODE2Coordinates()
    tensions = model.dropper_forces()
    release(model.mbs)
    assert np.abs(found).max() < 1e-6  # [m] from where the wires were installed
    assert tensions == pytest.approx(shape.dropper_forces, abs=0.1)


def test_without_the_balance_the_wires_hang_millimetres_elsewhere(shape):
    """Negative control: what the balance is for."""
    from dataclasses import replace

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
