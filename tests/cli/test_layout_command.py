"""Layouts from tables and rules at the command line, and the tables that a crew takes along."""

import csv
import json

import openpyxl
import pytest

import catenary_fe as cf
from catenary_fe.cli import main


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A line by rules, its form and its tables."""
    folder = tmp_path_factory.mktemp("built")
    spans = ["--spans", "65,2x60,50", "--name", "four spans"]
    assert main(["layout", "build", "Re 250", *spans, "-o", str(folder / "line.toml"), "--quiet"]) == 0
    assert main(["form", str(folder / "line.toml"), "--xlsx", "-o", str(folder / "form"), "--quiet"]) == 0
    return folder


def from_table(built, output, *arguments):
    tables = [str(built / "form" / f"{kind}_schedule.csv") for kind in ("support", "dropper")]
    return main(["layout", "from-table", *tables, "-o", str(output), *arguments])


@pytest.mark.parametrize("origin", ["base", "line"])
def test_the_tables_of_form_are_read_again(built, origin, tmp_path, capsys):
    """There and back: the wire hangs where the design has it, within what a tenth of a millimetre moves."""
    base = ["--base", str(built / "line.toml")] if origin == "base" else ["--line", "Re 250"]
    assert from_table(built, tmp_path / "again.toml", *base, "--name", "four spans") == 0
    said = capsys.readouterr()
    assert "results, which are not read: installed_length_m, force_N" in said.err
    line, again = (cf.load_catenary(path) for path in (built / "line.toml", tmp_path / "again.toml"))
    assert again.gives_dropper_lengths
    assert again.stitch_wire_lengths.tolist() == line.stitch_wire_lengths.tolist()
    shape = cf.find_form(again)
    assert abs(shape.height_errors).max() < 1e-4
    plain = [s.replace(steady_arm=s.steady_arm.replace(side=None)) for s in again.supports]
    assert again.without_dropper_lengths().replace(supports=plain, source=line.source) == line


def test_a_crew_reads_whole_millimetres(built):
    with (built / "form" / "dropper_schedule.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[:5] == ["section", "span", "from_support", "to_support", "dropper"]
    assert all(abs(int(row["cut_length_mm"]) - 1e3 * float(row["length_m"])) <= 0.5 for row in rows)


def test_a_workbook_has_the_numbers_of_the_tables(built, tmp_path):
    book = openpyxl.load_workbook(built / "form" / "schedules.xlsx")
    for sheet, table in (("droppers", "dropper"), ("supports", "support")):
        with (built / "form" / f"{table}_schedule.csv").open(encoding="utf-8") as file:
            wanted = list(csv.reader(file))
        found = [list(row) for row in book[sheet].iter_rows(values_only=True)]
        assert found[0] == wanted[0] and len(found) == len(wanted)
        for row, texts in zip(found[1:], wanted[1:], strict=True):
            for value, text in zip(row, texts, strict=True):
                same = isinstance(value, int | float) and value == pytest.approx(float(text), abs=1e-9)
                assert same or text == ("" if value is None else value)
    assert book["droppers"]["I2"].number_format == "0.0000"
    again = tmp_path / "form"
    assert main(["form", str(built / "line.toml"), "--xlsx", "-o", str(again), "--quiet"]) == 0
    assert (again / "schedules.xlsx").read_bytes() == (built / "form" / "schedules.xlsx").read_bytes()


def test_a_workbook_without_its_package_is_refused_before_the_work(built, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("catenary_fe.results.export.find_spec", lambda name: None)
    assert main(["form", str(built / "line.toml"), "--xlsx", "-o", str(tmp_path / "form")]) == 3
    assert 'pip install "catenary_fe[xlsx]"' in capsys.readouterr().err
    assert not (tmp_path / "form").exists()


def test_usage(built, tmp_path, capsys):
    assert from_table(built, tmp_path / "x.toml") == 2
    assert from_table(built, tmp_path / "x.toml", "--base", "a.toml", "--line", "Re 250") == 2
    assert main(["form", str(built / "line.toml"), "--xlsx"]) == 2
    assert (
        main(["layout", "from-table", str(built / "form" / "support_schedule.csv"), "--line", "Re 250"]) == 2
    )
    capsys.readouterr()
    assert main(["layout", "build", "Re 250", "--spans", "65,60m", "-o", str(tmp_path / "x.toml")]) == 3
    assert "--spans 65,60m: '60m' is no length in m, nor so many: 60 or 10x60" in capsys.readouterr().err
    assert main(["layout", "build", "Re 250", "--spans", "99999x60", "-o", str(tmp_path / "x.toml")]) == 3
    assert not list(tmp_path.iterdir())


def test_json(built, tmp_path, capsys):
    assert from_table(built, tmp_path / "x.toml", "--line", "Re 250", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["file"] == str(tmp_path / "x.toml") and found["spans"] == 4
    assert [len(headings) for headings in found["not_read"].values()] == [10, 4]


def test_a_fault_is_one_line(built, tmp_path, capsys):
    table = tmp_path / "masts.csv"
    table.write_text("chainage_m;stagger_mm\n0;200\n60;-0,25\n", "utf-8")
    assert main(["layout", "from-table", str(table), "--line", "Re 250", "-o", str(tmp_path / "x.toml")]) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {table}: row 3, column stagger_mm: -0,25 is a number with a comma")
    assert not (tmp_path / "x.toml").exists()
