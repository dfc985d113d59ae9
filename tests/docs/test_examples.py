"""The documentation's examples, run page by page as they are printed: files are written, commands typed."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(page for page in DOCS.rglob("*.md") if re.search(r"^```(sh|python)$", page.read_text(), re.M))
BLOCK = re.compile(r"^```(sh|toml|python)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


EXTRAS = {"fmu": ("pythonfmu", "fmpy")}  # what a page cannot do without


def test_there_are_examples():
    assert len(PAGES) >= 8


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_page(page, tmp_path):
    for package in EXTRAS.get(page.stem, ()):
        pytest.importorskip(package)
    here = Path(sys.executable).parent
    environment = os.environ | {
        "PATH": f"{here}{os.pathsep}{os.environ['PATH']}",
        "OPENBLAS_NUM_THREADS": "1",
    }
    for number, (language, text) in enumerate(BLOCK.findall(page.read_text(encoding="utf-8"))):
        if language == "toml":
            name = re.match(r"# file: (\S+)\n", text)
            assert name, f"{page}: its first line must name the file"
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
            continue
        if language == "python":
            (tmp_path / f"example_{number}.py").write_text(text, encoding="utf-8")
            text = f"python example_{number}.py"
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", text],
            cwd=tmp_path, env=environment, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, f"{page}:\n{text}\n{done.stdout}\n{done.stderr}"
    CLAIMS.get(page.stem, lambda folder: None)(tmp_path)


def tutorial(folder):
    """The numbers that the tutorial names."""
    import catenary_fe as cf

    first, second, third = (
        cf.load_run(folder / f"{name}_run" / "run.nc") for name in ("first", "second", "third")
    )
    statistics = [run.contact_force_statistics()[0] for run in (first, second, third)]
    assert [s.std for s in statistics] == pytest.approx([39, 21, 34], abs=1)
    assert statistics[0].mean == pytest.approx(114, abs=1)
    assert statistics[0].statistical_min == pytest.approx(-2, abs=1)
    assert statistics[1].statistical_min == pytest.approx(52, abs=1)
    assert 1e3 * first.largest_support_uplift() == pytest.approx(79, abs=1)
    assert second.largest_support_uplift() / first.largest_support_uplift() == pytest.approx(0.5, abs=0.05)
    assert any("298" in w or "of the contact wire's wave speed" in w for w in first.warnings)
    assert 0.7 * 3.6 * first.catenary.contact_wire.wave_speed == pytest.approx(298, abs=0.5)
    assert (folder / "first_run" / "report.html").stat().st_size > 1e6


def tutorial_real_line(folder):
    """What the search is said to gain, up to which speed the line is good, and what the pack says."""
    found = json.loads((folder / "design" / "design.json").read_text(encoding="utf-8"))
    start, best = (found["nonlinear"][which] for which in ("start", "best"))
    assert start["objective"] == pytest.approx(31, abs=1) and start["largest_share_of_limit"] > 1
    assert best["objective"] == pytest.approx(18, abs=1) and best["largest_share_of_limit"] <= 1
    made = json.loads((folder / "speeds" / "sweep.json").read_text(encoding="utf-8"))
    missed = {
        case["values"]["speed_kmh"]: {row["name"] for row in case["criteria"] if row["passed"] is False}
        for case in made["cases"]
    }
    assert not missed[200] and not missed[250] and missed[300] == {"twice the uplift at steady arms"}
    verdicts = json.loads((folder / "pack" / "conform.json").read_text(encoding="utf-8"))["verdicts"]
    assert len(verdicts) == 7 and all(row["passed"] for row in verdicts)
    assert all((folder / "pack" / row["file"]).is_file() for row in verdicts)


def form_of(folder):
    return json.loads((folder / "form.json").read_text(encoding="utf-8"))


def whole_line(folder):
    """The hand calculation of a dropper's force, and the verdict."""
    force = form_of(folder / "form")["droppers"][8]["force_N"]
    by_hand = 9.81 * 1.07 * 8.4 - 18e3 * 8 * 0.025 / 42**2 * 8.4 + 2
    assert force == pytest.approx(73, abs=0.5) == pytest.approx(by_hand, abs=1)
    figures = json.loads((folder / "run250" / "summary.json").read_text(encoding="utf-8"))["pantographs"][0]
    assert figures["std_N"] < 0.3 * figures["mean_N"]


def curves(folder):
    """T L/R on each arm, inwards."""
    pulls = form_of(folder / "curve")["steady_arm_lateral_forces_N"]
    assert pulls[1:-1] == pytest.approx([-833] * 3, rel=0.01)


def changing_heights(folder):
    """The tension on a change of gradient of 1 in 1000, at the crest and where the wire levels out."""
    arms = form_of(folder / "bridge")["steady_arm_forces_N"]
    assert arms[3] - arms[4] == pytest.approx(15, abs=0.5)
    assert arms[4] - arms[6] == pytest.approx(15, abs=0.5)


def given_lengths(folder):
    """A middle dropper 10 mm too long lets the wire down by nearly half of it, against its neighbours."""
    errors = [row["contact_wire_height_error_mm"] for row in form_of(folder / "site")["droppers"]]
    assert [m - n for m, n in zip(errors[2::5], errors[1::5], strict=True)] == pytest.approx(
        [-4.6] * 3, abs=0.4
    )


def sections_and_overlaps(folder):
    """The lift at the last mast, a force that goes over without loss, and where."""
    import catenary_fe as cf

    supports = form_of(folder / "overlap")["supports"]
    heights = [row["contact_wire_height_m"] for row in supports if row["section"] == 1]
    assert heights[-2] == pytest.approx(5.6, abs=1e-3)
    run = cf.load_run(folder / "overlap_250")
    assert run.contact_force_statistics()[0].contact_loss == 0.0
    forces, x = run.data["section_force"].values[0], run.data["position"].values[0]
    both = x[(forces > 0).all(axis=0)]
    begin, end = run.catenary.common_zones[0]
    assert begin < both.min() < (begin + end) / 2 < both.max() < end


CLAIMS = {
    "sections_and_overlaps": sections_and_overlaps,
    "tutorial": tutorial,
    "tutorial_real_line": tutorial_real_line,
    "whole_line": whole_line,
    "curves": curves,
    "changing_heights": changing_heights,
    "given_lengths": given_lengths,
}


def test_what_the_pages_say_of_file_sizes():
    """A run of ten spans at 300 km/h, by the sizes of its arrays; see Films and pictures."""
    import catenary_fe as cf

    shape = cf.find_form(cf.load_catenary(DOCS.parent / "models" / "layouts" / "en50318_2002.toml"))
    frames = (shape.catenary.length - 20) / (300 / 3.6) / 0.01
    wires = 4 * frames * (shape.contact_wire_x.size + shape.messenger_wire_x.size)
    assert wires / 1e6 == pytest.approx(4, abs=0.6)
