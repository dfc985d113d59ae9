"""What the README shows works as it stands there; its shell and Python blocks are run by CI."""

import re
from pathlib import Path

import numpy as np

import catenary_fe as cf

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def test_layout_and_pantograph_files(tmp_path):
    layout, pantograph = blocks("toml")
    (tmp_path / "layout.toml").write_text(layout)
    (tmp_path / "pantograph.toml").write_text(pantograph)
    catenary = cf.load_catenary(tmp_path / "layout.toml")
    assert len(catenary.spans) == 5
    assert cf.layout_warnings(catenary) == []
    assert np.abs(cf.find_form(catenary).height_errors).max() < 1e-4
    assert cf.load_pantograph(tmp_path / "pantograph.toml").mean_force == "EN 50367 AC"


def test_what_a_newcomer_copies_is_short():
    run, look, docs, test = blocks("sh")
    for block in (run, docs, test):
        assert len(block.strip().splitlines()) == 1
    assert len(look.strip().splitlines()) <= 4
    compile(blocks("python")[0], "README", "exec")
