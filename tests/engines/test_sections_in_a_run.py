"""A run computes the sections that pantographs are on: the same as all of them, and at what they cost."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_matrix

import catenary_fe as cf
from catenary_fe.engines import checkpoint
from catenary_fe.engines.linearised import batch
from catenary_fe.engines.nonlinear import run as nonlinear
from catenary_fe.engines.sections import Computed, Rows, sections_met
from catenary_fe.fe.system import TimeLoad

SPEED = 250 / 3.6


@pytest.fixture(scope="module")
def shape(reference: cf.Catenary) -> cf.Shape:
    part = reference.replace(spans=reference.spans[:5], supports=reference.supports[:6], evaluated_spans=None)
    line = cf.join_sections([part] * 3, [cf.Overlap(spans=3)] * 2, evaluated_spans=(4, 5, 6))
    return cf.find_form(line)


@pytest.mark.parametrize(("method", "error"), [("nonlinear", 1e-4), ("linearised", 0.02)])
def test_the_force_is_that_with_all_sections(shape, pantograph, monkeypatch, method, error) -> None:
    """Linearised, where the columns of compliances end is not the same: 1e-6 of a column."""
    heads = {
        "pantographs": [pantograph, pantograph],
        "positions": [90.0, 10.0],
        "speed": SPEED,
        "method": method,
    }
    run = cf.simulate(shape, store_wire=0.02, **heads)
    for module in (batch, nonlinear):
        monkeypatch.setattr(module, "sections_met", lambda *_: (0, 3))
    whole = cf.simulate(shape, store_wire=0.02, **heads)
    gap = run.data["contact_force"].values - whole.data["contact_force"].values
    assert np.abs(gap).max() < error
    last = run.data["position"].values[-1]
    on_first = last < 300
    uplift, every = run.data["support_uplift"].values, whole.data["support_uplift"].values
    assert uplift[:, on_first] == pytest.approx(every[:, on_first], abs=1e-5)
    assert np.ptp(uplift[:2, last > 330], axis=1).max() == 0.0  # left: as it was then
    assert np.ptp(every[:2, last > 330], axis=1).max() > 1e-4
    assert uplift.max(axis=1) == pytest.approx(every.max(axis=1), abs=1e-6)
    name = "section_2_contact_wire_height"
    wires, all_wires = run.data[name].values, whole.data[name].values
    times = run.data["wire_time"].values < run.data["time"].values[on_first][-1]
    assert wires[times] == pytest.approx(all_wires[times], abs=1e-5)


def test_a_run_over_sections_goes_on_with_the_same_bytes(shape, pantograph, tmp_path, monkeypatch) -> None:
    """Stopped on the second section, when the first one is computed no more."""
    monkeypatch.setattr(checkpoint, "INTERVAL", 0.0)
    file, run = tmp_path / "state.npz", {"speed": SPEED, "store_wire": 0.02}

    def stop(share: float) -> None:
        if share > 0.6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cf.simulate(shape, [pantograph], checkpoint=file, progress=stop, **run)
    with np.load(file) as kept:
        assert kept["sections"].tolist() == [1, 3]
    on = cf.simulate(shape, [pantograph], checkpoint=file, **run)
    whole = cf.simulate(shape, [pantograph], **run)
    for name, values in whole.data.variables.items():
        assert np.array_equal(values, on.data[name], equal_nan=values.dtype.kind == "f"), name


def test_a_load_in_time_acts_on_all_sections(shape, pantograph) -> None:
    def shaken(system):
        load = system.distributed(np.full(system.first.size, 1.0))
        return replace(system, time_loads=(TimeLoad(load, lambda times: np.sin(20.0 * times)),))

    loaded = shape.with_effect(shaken)
    for method in ("nonlinear", "linearised"):
        run = cf.simulate(loaded, [pantograph], speed=SPEED, method=method)
        moved = np.ptp(run.data["support_uplift"].values[:, :200], axis=1)
        assert moved[1:5].min() > 0 and moved[-5:-1].min() > 0, method


def test_sections_met(shape) -> None:
    paths = shape.system.contact_paths

    class Strip:
        def __init__(self, wire: int, position: float) -> None:
            self.wire, self.position = wire, position

    on = [Strip(wire, position) for position in (0.0, -60.0) for wire in range(3)]
    second = paths[1].x[0]
    assert sections_met(paths, on, 70.0, 72.0) == (0, 1)
    assert sections_met(paths, on, second - 2.0, second) == (0, 2)
    assert sections_met(paths, on, paths[0].x[-1] + 60.0, paths[0].x[-1] + 61.0)[0] == 0
    assert sections_met(paths, on, paths[0].x[-1] + 60.1, paths[0].x[-1] + 61.0) == (1, 3)


def test_rows_are_filled_up_to_eights() -> None:
    rows = Rows.of(np.array([0, 5, 13, 15]))
    assert rows.starts.tolist() == [0, 8, 16, 24]
    assert rows.place.tolist() == [*range(5), *range(8, 18)]
    assert rows.number(np.array([-1, 5, 14])).tolist() == [-1, 8, 17]
    assert rows.spread(np.ones((2, 15))).sum(axis=1).tolist() == [15.0, 15.0]
    full = rows.matrix(csr_matrix(np.arange(225.0).reshape(15, 15)), 2.0).toarray()
    assert full[8, 17] == 5 * 15 + 14
    assert full[5, 5] == full[23, 23] == 2.0
    assert np.count_nonzero(full) == 224 + 9


def test_what_is_not_computed_is_held() -> None:
    computed = Computed(4)
    computed.add((0, 2), 0, 3)
    computed.add((1, 2), 3, 4)
    computed.add((1, 4), 4, 5)
    computed.steps[2] = 0  # never
    values = np.array(
        [[1.0, 2, 3, 4, 0, 0], [1.0, 2, 3, 4, 5, 6], [7.0, 0, 0, 0, 0, 0], [9.0, 0, 0, 0, 0, 6]]
    )
    computed.hold(values, np.arange(4), np.arange(6))
    held = [[1, 2, 3, 4, 4, 4], [1, 2, 3, 4, 5, 6], [7, 7, 7, 7, 7, 7], [9, 9, 9, 9, 9, 6]]
    assert values.tolist() == held
