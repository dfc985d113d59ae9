"""What linearised runs keep beyond the matrices: without it they are further from the nonlinear run."""

from dataclasses import replace

import numpy as np
import pytest
from kernels import drive

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.factor import packed_rows
from catenary_fe.engines.nonlinear.run import NonlinearEngine
from catenary_fe.results.signal import low_pass
from catenary_fe.studies.linearised import LinearisedLine


def without(line, part):
    """The same catenary, without its swinging links or its inclined elements, whose stiffness it keeps."""
    setup = line.engine.setup
    if part == "stretch":
        whole = packed_rows(setup.model.stiffness)
        setup = replace(setup, operator=setup.operator._replace(stiffness=whole))
    none = type(getattr(setup.line, part))(*(_cut(array) for array in getattr(setup.line, part)))
    other = LinearisedLine(line.shape)
    other.engine.setup = replace(setup, line=setup.line._replace(**{part: none}))
    return other


def _cut(part):
    return type(part)(*(array[:0] for array in part)) if isinstance(part, tuple) else part[:0]


@pytest.mark.parametrize(
    ("layout", "part"), [("en50318_2002", "stretch"), ("en50318_2018_ac_simple", "links")]
)
def test_each_term_brings_it_closer(reference_layout, layout, part):
    catenary = cf.load_catenary(reference_layout.parent / f"{layout}.toml")
    catenary = catenary.replace(
        spans=catenary.spans[:4], supports=catenary.supports[:5], evaluated_spans=(3,)
    )
    shape, speed, start, steps = cf.find_form(catenary), 275 / 3.6, np.array([10.0]), 2000
    head = cf.library.pantograph("EN 50318:2018 AC").replace(mean_force=None, uplift_force=150.0)
    theirs = drive(NonlinearEngine(shape.system), [(head, 150.0)], speed, start, steps).contact_force[0]
    whole, off = LinearisedLine(shape), []
    for line in (whole, without(whole, part)):
        (run,) = line.run([RunCase([head], speed, start, (steps + 0.5) * speed * 1e-3)])
        off.append(np.std(low_pass(run.data["contact_force"].values[0] - theirs, 1e-3)))
    assert off[0] < 0.85 * off[1]  # 0.73 found with the first, less with the second
