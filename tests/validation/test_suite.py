"""The registry is complete, the runner runs, the report says everything."""

import json
from dataclasses import asdict, replace
from pathlib import Path

import pytest

import validation
from catenary_fe.layout import InputError
from validation import CASES, Checks, run_cases, run_negative_controls, write_report
from validation.check import compare, compare_curves
from validation.report import report_text

FILES = sorted(p.stem for p in (Path(validation.__file__).parent / "cases").glob("*.py") if p.stem[0] != "_")


def example(**changed):
    check = compare("sag", 0.2936, 0.2935, 1e-3, source="textbook", reason="cubic elements", unit="m")
    return replace(check, **{"case": "sag", **changed})


def test_every_file_is_a_case_under_its_own_name():
    assert sorted(CASES) == FILES
    assert all(case.name == name for name, case in CASES.items())


def test_every_case_says_what_it_is_and_what_its_negative_control_has_wrong():
    for case in CASES.values():
        assert case.kind in ("verification", "validation")
        assert case.title and case.text and case.off


def test_number_passes_up_to_its_tolerance():
    options = {"source": "s", "reason": "r"}
    assert compare("q", 1.009, 1.0, 0.01, **options).passed
    assert not compare("q", 1.011, 1.0, 0.01, **options).passed
    assert compare("q", 0.009, 0.0, 0.01, **options, absolute=True).passed


def test_curve_error_is_relative_to_the_reference():
    check = compare_curves("q", [0, 1, 2], [1.1, 1.1, 1.1], [1, 1, 1], 0.05, source="s", reason="r")
    assert check.error == pytest.approx(0.1)
    assert not check.passed


def test_no_number_is_no_pass():
    assert not compare("q", float("nan"), 1.0, 0.01, source="s", reason="r").passed


def test_results_come_in_order_from_two_processes_and_progress_ends_at_one():
    shares = []
    names = ["sag", "point_force", "natural_frequencies"]
    alone = run_cases(names, quick=True)
    together = run_cases(names, quick=True, jobs=2, progress=shares.append)
    assert list(alone) == list(together)
    assert shares[-1] == 1
    assert list(dict.fromkeys(check.case for check in together)) == names


def test_unknown_case_is_named_with_the_known_ones():
    with pytest.raises(InputError, match=r"'sga' is unknown; there are .*sag"):
        run_cases(["sga"])
    with pytest.raises(InputError, match="sga"):
        run_negative_controls(["sga"])


def test_rows_are_json():
    text = json.dumps([asdict(check) for check in run_cases(["sag"], quick=True)], allow_nan=False)
    assert json.loads(text)[0]["case"] == "sag"


def test_report_marks_what_missed_and_separates_the_kinds():
    missed = example(quantity="sag of another", error=0.5, passed=False)
    published = example(case="en50318_2002_300", reference="110 to 120")
    text = report_text([example(), missed, published], {"sag"})
    assert "**2 of 3 checks pass.** Missed: sag, sag of another." in text
    assert text.count("**MISSED**") == 1
    assert text.index("## Verification") < text.index("`sag`") < text.index("## Validation")
    assert text.index("## Validation") < text.index("`en50318_2002_300`")
    assert "cubic elements" in text and "textbook" in text
    assert "pictures/sag.png" in text and "pictures/en50318_2002_300.png" not in text


def test_report_is_written_with_its_pictures(tmp_path):
    path = write_report(Checks([example()], {"sag": b"png"}), tmp_path)
    assert path.read_text(encoding="utf-8").startswith("# Validation report")
    assert (tmp_path / "pictures" / "sag.png").read_bytes() == b"png"


def test_pictures_are_drawn_unless_quick():
    assert run_cases(["sag"], quick=True).pictures == {}
    assert run_cases(["sag"]).pictures["sag"].startswith(b"\x89PNG")
