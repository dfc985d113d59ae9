"""``compare --scatter``: a measurement in the bands of a scatter study, and outside of them."""

import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main
from tests.engines.test_scatter import LINE as THREE_SPANS

LINE = THREE_SPANS.replace("count = 3", "count = 4") + "evaluated_spans = [3]\n"
STUDY = """
layout = "line.toml"
pantographs = ["EN 50318:2002"]
speed_kmh = [180, 200]
[scatter]
"contact_wire.tension" = { relative_uniform = 0.1 }
"pantograph.uplift_force" = { uniform = [110.0, 130.0] }
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A study's bands, and a run of its nominal line."""
    place = tmp_path_factory.mktemp("bands")
    (place / "line.toml").write_text(LINE)
    (place / "study.toml").write_text(STUDY)
    study = cf.load_study(place / "study.toml")
    assert main(["scatter", str(place / "study.toml"), "--samples", "12", "--jobs", "1", "--quiet",
                 "-o", str(place / "bands")]) == 0  # fmt: skip
    shape = cf.find_form(cf.load_catenary(place / "line.toml"))
    head = cf.library.pantograph(study.pantographs[0])
    (place / "run").mkdir()
    cf.simulate(shape, [head], speed=200 / 3.6, method="linearised").save(place / "run/run.nc")
    return place


def measured(folder, path, factor=1.0):
    """The nominal run's force every 0.2 m, with a newton of noise; its deviations from the mean enlarged."""
    run = cf.load_run(folder / "run")
    x = np.arange(60.0, 140.0, 0.2)
    force = np.interp(x, run.data["position"].values[0], run.data["contact_force"].values[0])
    force = force.mean() + factor * (force - force.mean()) + np.random.default_rng(1).normal(0, 1, x.size)
    np.savetxt(path, np.column_stack([x, force]), "%.5f", ";", header="position [m];force [N]", comments="")
    return path


def compared(capsys, folder, path, *more):
    code = main(["compare", str(folder / "run"), str(path), "--shift-m", "0", *map(str, more)])
    out, err = capsys.readouterr()
    return code, out, err


def test_a_line_within_the_scatter_is_inside(capsys, folder, tmp_path):
    path = measured(folder, tmp_path / "m.csv")
    more = "--scatter", folder / "bands", "-o", tmp_path / "out"
    code, out, _ = compared(capsys, folder, path, *more, "--json")
    assert code == 0
    found = json.loads(out)["scatter"]
    assert found["samples"] == 12
    assert found["force_inside_percent"]["measured"] > 90
    rows = {row["figure"]: row for row in found["figures"]}
    assert set(rows) == {"mean_N", "std_N", "statistical_max_N", "statistical_min_N", "max_N", "min_N"}
    assert rows["mean_N"]["inside"]["measured"] and rows["std_N"]["inside"]["measured"]
    assert rows["mean_N"]["low_5"] < rows["mean_N"]["measured"]["measured"] < rows["mean_N"]["high_95"]
    page = (tmp_path / "out" / "line_test.html").read_text()
    assert "in the bands of the scatter study" in page


def test_one_that_vibrates_more_is_outside(capsys, folder, tmp_path):
    path = measured(folder, tmp_path / "m.csv", factor=1.5)
    code, out, err = compared(capsys, folder, path, "--scatter", folder / "bands")
    assert code == 1 and "standard deviation" in err  # of the comparison's own limit
    table = out.split("in the bands of the scatter study")[1]
    assert "outside" in next(row for row in table.splitlines() if "standard deviation" in row)
    assert "inside" in next(row for row in table.splitlines() if "mean force" in row)


def test_forces_are_compared_as_the_study_filters_them(capsys, folder, tmp_path):
    path = measured(folder, tmp_path / "m.csv")
    code, _, err = compared(capsys, folder, path, "--scatter", folder / "bands", "--filter", "zero-phase")
    assert code == 3 and "the study's forces are filtered causally" in err


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda place: (place / "bands.csv").unlink(), "bands.csv is missing; give the folder"),
        (lambda place: (place / "force_band.csv").write_text("x\n1\n"), "the study's tables cannot be read"),
        (lambda place: (place / "bands.csv").write_text(
            (place / "bands.csv").read_text().replace("200", "210")), "at 200 km/h; there are: 180 km/h, EN"),
    ],
)  # fmt: skip
def test_what_is_no_study_of_this_run_is_refused(capsys, folder, tmp_path, change, said):
    place = tmp_path / "bands"
    place.mkdir()
    for name in ("bands.csv", "force_band.csv"):
        (place / name).write_text((folder / "bands" / name).read_text())
    change(place)
    code, _, err = compared(capsys, folder, measured(folder, tmp_path / "m.csv"), "--scatter", place)
    assert code == 3 and said in err
