"""Every command on a line of three tension sections: most wires are not in most pictures."""

import csv
import json

import pytest

from catenary_fe.cli import main


@pytest.fixture(scope="module")
def layout(reference_layout, tmp_path_factory):
    """Three sections of six spans, which overlap by three."""
    text = reference_layout.read_text(encoding="utf-8").replace("count = 10", "count = 6")
    text = text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [3, 4, 5, 6]")
    path = tmp_path_factory.mktemp("line") / "layout.toml"
    path.write_text(text + "\n[overlap]\nspans = 3\n[[further_sections]]\ncount = 2\n", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def run(layout):
    folder = layout.parent / "run"
    command = ["run", layout, "--pantograph", "EN 50318:2002", "--speed-kmh", 200, "--method", "linearised"]
    assert main([str(a) for a in (*command, "--store-wire-ms", 50, "-o", folder)]) == 0
    return folder


def test_run_and_its_pictures(run):
    assert (run / "handover.png").stat().st_size > 1e4
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    assert summary["pantographs"][0]["contact_loss_percent"] == 0.0


@pytest.mark.parametrize(
    "words",
    [
        ["info", "LAYOUT", "-o", "OUT"],
        ["info", "LAYOUT", "--spans", "9-12", "-o", "OUT"],
        ["form", "LAYOUT", "-o", "OUT"],
        ["static", "LAYOUT", "--force", 100, "-o", "OUT"],
        ["sweep", "LAYOUT", "--speed-kmh", "180:200:20", "--pantograph", "EN 50318:2002", "-o", "OUT"],
        ["sweep", "LAYOUT", "--speed-kmh", 200, "--pantograph", "EN 50318:2002", "--vary",
         "overlap.lift=0.25:0.3:2", "-o", "OUT"],
        ["report", "RUN", "-o", "OUT.html"],
        ["export", "RUN", "-o", "OUT"],
        ["film", "RUN", "--spans", "4-5", "-o", "OUT.gif"],
        ["waves", "RUN", "-o", "OUT.png"],
        ["compare", "RUN", "RUN"],
        ["rerun", "RUN", "-o", "OUT"],
        ["layout", "dxf", "LAYOUT", "-o", "OUT.dxf"],
    ],
    ids=lambda words: " ".join(map(str, words[:2])),
)  # fmt: skip
def test_command(words, layout, run, tmp_path):
    places = {"LAYOUT": str(layout), "RUN": str(run), "OUT": str(tmp_path / "out")}
    given = []
    for word in map(str, words):
        for name, place in places.items():
            word = word.replace(name, place) if word.startswith(name) else word
        given.append(word)
    assert main(given) == 0


def test_tables_count_along_the_line(layout, tmp_path):
    assert main(["form", str(layout), "-o", str(tmp_path / "form")]) == 0
    with (tmp_path / "form" / "support_schedule.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert [row["section"] for row in rows] == ["1"] * 7 + ["2"] * 7 + ["3"] * 7
    assert float(rows[7]["chainage_m"]) == 180.0


def test_modes_are_of_one_section(layout, capsys):
    assert main(["modes", str(layout)]) == 3
    assert "3 tension sections" in capsys.readouterr().err
