"""Designs: closed forms for the searches, single runs for their worth, a search that was stopped."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main
from catenary_fe.studies import optimise as searching
from catenary_fe.studies.design import Evaluation, _used
from tests.engines.test_scatter import LINE as THREE_SPANS

LINE = (
    THREE_SPANS.replace("tension = 20e3", "tension = 14e3")
    .replace("tension = 16e3", "tension = 12e3")
    .replace("count = 3", "count = 4")
    + "evaluated_spans = [3]\n"
)
STUDY = """
layout = "line.toml"
pantographs = ["EN 50318:2002"]
speed_kmh = [180, 220]
"""
TENSION = '[design]\n"contact_wire.tension" = { between = [10e3, 20e3] }\n'
COARSE = {"time": cf.TimeSettings(step=4e-3), "mesh": cf.MeshSettings(contact_wire_element=4.0)}


@pytest.fixture
def study(tmp_path):
    """Writes a study, and returns it as read."""
    (tmp_path / "line.toml").write_text(LINE)

    def written(text, head=STUDY):
        (tmp_path / "study.toml").write_text(head + text)
        return cf.load_study(tmp_path / "study.toml")

    return written


class Formula:
    """A problem whose designs are worth what two formulas say."""

    def __init__(self, bounds, start, worth, used, whole=False):
        self.bounds, self.start = np.array(bounds, dtype=float), np.array(start, dtype=float)
        self.are_whole = np.array([whole] * len(start))
        self.study = SimpleNamespace(criteria="AC", seed=1, scatter={})
        self.names, self._worth, self._used = [f"x{n}" for n in range(len(start))], worth, used

    def evaluate_all(self, designs, progress=None, **_):
        return [
            Evaluation(x=x, values={}, objective=float(self._worth(x)), used=float(self._used(x)), cases=[])
            for x in designs
        ]


@pytest.mark.parametrize(("search", "most", "off"), [("local", 60, 0.01), ("global", 900, 0.02)])
def test_a_quadratic_and_a_constrained_closed_form(search, most, off):
    """(x − 1)² + 4 (y + 2)² is smallest at (1, −2); with x + y ≥ 2 at (3.4, −1.4), by Lagrange."""
    bounds, worth = [(-5, 5), (-5, 5)], lambda x: (x[0] - 1) ** 2 + 4 * (x[1] + 2) ** 2 + 1
    look = {"local": searching._local, "global": searching._global}[search]

    def best(used):
        problem, seen = Formula(bounds, (3.0, 3.0), worth, used), []
        begin = problem.evaluate_all([problem.start])[0]

        def see(designs):
            found = problem.evaluate_all(designs)
            seen.extend(found)
            return found

        look(problem, see, begin, most)
        return min(seen, key=searching._rank).x

    assert best(lambda x: 0.0) == pytest.approx([1.0, -2.0], abs=10 * off)
    # minimum of (x − 1)² + 4 (y + 2)² on x + y = 2: x = 1 + 4 t, y = −2 + t, 5 t = 3
    limited = best(lambda x: 1 + (2 - x[0] - x[1]) / 10)
    assert limited == pytest.approx([1 + 12 / 5, -2 + 3 / 5], abs=10 * off)
    assert limited.sum() >= 2 - 1e-9


def test_whole_numbers_are_found_by_the_global_search_alone():
    problem = Formula(
        [(0, 9), (0, 9)], (8, 1), lambda x: (x[0] - 3.4) ** 2 + (x[1] - 6.6) ** 2, lambda x: 0, True
    )
    seen = []

    def see(designs):
        found = problem.evaluate_all(designs)
        seen.extend(found)
        return found

    begin = problem.evaluate_all([problem.start])[0]
    with pytest.raises(cf.InputError, match="x0: whole numbers are found by the global search alone"):
        searching._local(problem, see, begin, 10)
    searching._global(problem, see, begin, 200)
    assert min(seen, key=searching._rank).x.tolist() == [3.0, 7.0]


def test_a_design_is_worth_what_its_runs_are(study, tmp_path):
    problem = cf.DesignProblem(study(TENSION), folder=tmp_path / "out", jobs=1, **COARSE)
    assert problem.names == ["contact_wire.tension"]
    assert problem.start.tolist() == [14e3]
    found = problem.evaluate([16e3])
    assert problem.line([16e3]).contact_wire.tension == 16e3
    shape = cf.find_form(problem.line([16e3]), COARSE["mesh"])
    head = cf.library.pantograph("EN 50318:2002")
    sigma = [
        cf.simulate(shape, [head], speed=v / 3.6, method="linearised", time=COARSE["time"])
        .contact_force_statistics()[0].std
        for v in (180, 220)
    ]  # fmt: skip
    assert [row["std_N"] for row in found.cases] == pytest.approx(sigma, rel=1e-9)
    assert found.objective == pytest.approx(max(sigma), rel=1e-9)
    assert found.used == 0.0
    mean = problem.study.objective.replace(over="mean")
    problem.study = problem.study.replace(objective=mean, criteria="AC")
    again = problem.evaluate([16e3])
    assert again.objective == pytest.approx(np.mean(sigma), rel=1e-9)
    assert again.used > 0.3 and again.is_good == (again.used <= 1)


def test_places_tied_apart_and_numbers_of_droppers(study, tmp_path):
    text = """[design]
"span.*.droppers" = { between = [2, 6], evenly = 5.0 }
"span.*.droppers.1" = { between = [6.0, 12.0] }
"pantograph.stages.1.mass" = { between = [5.0, 9.0] }
"support.steady_arm.stiffness" = { between = [100.0, 180.0] }
"""
    problem = cf.DesignProblem(study(text), folder=tmp_path / "out", jobs=1, **COARSE)
    assert problem.start.tolist() == [2.0, 10.0, 7.2, 180.0]  # the last one moved to its bound
    values = problem.values([4, 7.5, 6.0, 150.0])
    assert values["span.1.droppers"] == [5.0, 15.0, 25.0, 35.0]
    assert values["pantograph.stages.1.mass"] == 6.0
    line = problem.line([4, 7.5, 6.0, 150.0])
    assert [d.position for d in line.spans[3].droppers] == [7.5, 15.0, 25.0, 35.0]
    assert problem.evaluate([4, 11.0, 6.0, 150.0]).error == ""
    assert problem.evaluate([4, 15.0, 6.0, 150.0]).error != ""  # two droppers in one place


def test_a_search_that_was_stopped_ends_with_the_same_design(study, tmp_path, capsys):
    """Also by the command, whose folder has the best line; runs that are kept are not run again."""
    study(TENSION + '"span.*.pre_sag" = { between = [0.0, 0.03] }\n')
    command = ["optimise", str(tmp_path / "study.toml"), "--most", "16", "--no-nonlinear", "--jobs", "1",
               "--time-step-ms", "4", "--element-m", "4", "--json", "-o"]  # fmt: skip
    assert main([*command, str(tmp_path / "out")]) == 0
    whole = json.loads(capsys.readouterr().out)
    assert whole["best"]["objective"] < 0.97 * whole["start"]["objective"]
    kept = sorted((tmp_path / "out" / "cases").glob("*.json"))
    for record in kept[::2]:
        record.unlink()
    assert main([*command, str(tmp_path / "out")]) == 0
    assert json.loads(capsys.readouterr().out) == whole
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names >= {"best.toml", "history.csv", "design.json", "way.png", "cases"}
    line = cf.load_catenary(tmp_path / "out" / "best.toml")
    tension = next(v["best"] for v in whole["variables"] if v["place"] == "contact_wire.tension")
    assert line.contact_wire.tension == pytest.approx(tension, rel=1e-9)


def test_start_and_best_are_confirmed_and_tried_on_fresh_samples(study, tmp_path):
    text = TENSION + '[scatter]\n"as_built.contact_wire_tension" = { uniform = [-0.05, 0.05] }\n'
    text += '[objective]\nfigure = "max_N"\nsamples = 2\n'
    problem = cf.DesignProblem(study(text, STUDY.replace("180, 220", "200") + 'criteria = "AC"\n'),
                               folder=tmp_path / "out", jobs=1, **COARSE)  # fmt: skip
    found = cf.optimise(problem, most=4, fresh=3)
    assert len(found.history) <= 5
    assert [len(e.cases) for e in found.history] == [3] * len(found.history)
    assert [len(e.cases) for e in found.confirmed] == [1, 1]
    assert found.confirmed[0].objective == pytest.approx(found.start.cases[0]["max_N"], rel=0.06)
    assert len(found.fresh.cases) == 4
    assert found.fresh.cases[1]["max_N"] != found.best.cases[1]["max_N"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "nothing is to be designed"),
        ('[design]\n"contact_wire.tensoin" = { between = [1, 2] }\n', "tensoin"),
        ('[design]\n"contact_wire.tension" = { between = [2, 1] }\n', "the first bound must be below"),
        ('[design]\n"contact_wire.tension" = 3\n', "must be a table, such as { between"),
        (
            '[design]\n"contact_wire.tension" = { between = [9e3, 2e4], evenly = 5.0 }\n',
            "evenly is of droppers",
        ),
        (TENSION + "[objective]\nsamples = 3\n", "nothing scatters"),
    ],
)
def test_what_is_no_design_is_refused(study, tmp_path, text, said):
    with pytest.raises(cf.InputError) as error:
        cf.DesignProblem(study(text), folder=tmp_path / "out")
    assert said in str(error.value)


def test_a_limit_with_a_tolerance_is_used_as_the_criterion_has_it():
    given = {"name": "mean force", "unit": "N", "source": "", "limit": 100.0}
    within = cf.Criterion(value=100.3, tolerance=0.5, **given)
    assert within.used > 1 and within.passed
    assert _used(within) == 0.0  # the run sets it there itself: no margin that a design could change
    assert _used(cf.Criterion(value=100.6, tolerance=0.5, **given)) == pytest.approx(1.006)
    at_limit = cf.Criterion(value=100.0, relation="above", **given)
    assert at_limit.passed is False and _used(at_limit) > 1
