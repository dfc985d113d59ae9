"""The pack for an assessor: what it says, where its numbers are, and how it is repeated."""

import csv
import hashlib
import json
import re
import shlex

import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from catenary_fe.studies.reference_models import in_ranges, reference_line

COARSE = ["--time-step-ms", "2", "--element-m", "4", "--jobs", "1", "--quiet"]


@pytest.fixture(scope="module")
def weak(short, tmp_path_factory):
    """A layout with a fifth less tension, which is too little for 300 km/h."""
    path = tmp_path_factory.mktemp("line") / "weak.toml"
    wire = short.contact_wire.replace(tension=0.8 * short.contact_wire.tension)
    cf.save_catenary(short.replace(contact_wire=wire), path)
    return path


def command(layout, folder, *more):
    return main(
        ["conform", str(layout), "--pantograph", "EN 50318:2002", "--speed-kmh", "200", "300",
         "--distance-m", "40", *COARSE, *more, "-o", str(folder)]
    )  # fmt: skip


@pytest.fixture(scope="module")
def folder(weak, tmp_path_factory):
    out = tmp_path_factory.mktemp("conform") / "out"
    assert command(weak, out) == 1
    return out


@pytest.fixture(scope="module")
def record(folder):
    return json.loads((folder / "conform.json").read_text(encoding="utf-8"))


def test_the_model_is_the_layout_file(reference):
    """The package's own model and the file that users see are one."""
    same = {"name", "source"}
    assert reference_line().model_dump(exclude=same) == reference.model_dump(exclude=same)


def test_a_figure_beyond_its_range_is_found():
    figures = dict.fromkeys(("statistical_max_N", "max_N"), 200.0) | {"mean_N": 115.0, "std_N": 31.2}
    figures |= {"statistical_min_N": 30.0, "min_N": 60.0, "contact_loss_percent": 0.0}
    rows = in_ranges({"pantographs": [figures], "max_support_uplift_mm": 50.0}, 250)
    assert [row.name for row in rows if not row.passed] == ["standard deviation"]


def test_the_installation_passes_and_the_weak_line_misses(folder, record):
    verdicts = {row["part"]: row for row in record["verdicts"]}
    assert verdicts["known answers, here"]["passed"] and verdicts["line at rest"]["passed"]
    assert "16 of 16" in verdicts["EN 50318:2002 reference model, here"]["verdict"]
    fast = verdicts["300 km/h, one pantograph"]
    assert not fast["passed"] and "standard deviation" in fast["verdict"] and "speed" in fast["verdict"]
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert (
        fast["verdict"] in page and "300 km/h, one pantograph" in re.search(r'class="missed">(.*?)<', page)[1]
    )


def test_every_number_is_in_a_file_of_the_folder(folder, record):
    page = (folder / "report.html").read_text(encoding="utf-8")
    links = set(re.findall(r'href="([^"#][^"]*)"', page))
    assert len(links) > 15 and all((folder / link).exists() for link in links)
    with (folder / "criteria.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    own = json.loads((folder / "runs" / "300_kmh_one" / "summary.json").read_text(encoding="utf-8"))
    sigma = next(r for r in rows if (r["run"], r["name"]) == ("300_kmh_one", "standard deviation"))
    assert float(sigma["value"]) == pytest.approx(own["pantographs"][0]["std_N"], rel=1e-9)
    run = cf.load_run(folder / "runs" / "300_kmh_one")
    assert run.contact_force_statistics()[0].std == pytest.approx(float(sigma["value"]), rel=1e-9)
    changed = [row["changed"] for row in record["refined"]]
    assert changed == ["as run", "elements halved", "steps halved", "linearised"]
    assert all(abs(row["std_N_change_percent"]) > 1e-6 for row in record["refined"][1:])


def test_the_inputs_repeat_the_pack(folder, record, weak):
    inputs = record["inputs"]
    words = shlex.split(inputs["command"])
    assert words[:3] == ["catenary-fe", "conform", "layout.toml"] and words.count("--speed-kmh") == 2
    assert (folder / "inputs" / "layout.toml").read_bytes() == weak.read_bytes()
    for name, sum_ in inputs["files_sha256"].items():
        assert hashlib.sha256((folder / "inputs" / name).read_bytes()).hexdigest() == sum_


def test_a_measurement_is_compared_with_the_run_at_its_speed(weak, folder, tmp_path, capsys):
    run = cf.load_run(folder / "runs" / "200_kmh_one")
    table = tmp_path / "pass.csv"
    force = 1.2 * run.filtered_contact_force()[0]
    rows = zip(run.data["position"].values[0], force, strict=True)
    table.write_text("position [m],force [N]\n" + "\n".join(f"{x:.3f},{f:.3f}" for x, f in rows))
    assert command(weak, folder, "--measured", str(table), "--measured-speed-kmh", "205",
                   "--measured-filtered") == 1  # fmt: skip
    said = capsys.readouterr().err
    assert "missed: line test: deviations beyond EN 50318's limits (recalled), from 200_kmh_one" in said
    assert (folder / "measured" / "line_test.html").is_file()
    assert (folder / "inputs" / "measured_1.csv").read_bytes() == table.read_bytes()


def test_options_of_a_line_test_without_one_are_refused(weak, tmp_path, capsys):
    assert command(weak, tmp_path / "out", "--measured-filtered") == 2
    assert "are of --measured tables" in capsys.readouterr().err
