"""The paper command on small scripts: progress, index page, a figure that fails, bad questions."""

import json

import pytest

from catenary_fe.cli import main

GOOD = '''"""Fig. {number}: a <picture>."""
import json, pathlib, sys
folder, name = pathlib.Path(sys.argv[1]), pathlib.Path(__file__).stem
(folder / f"{{name}}.png").write_bytes(b"picture")
facts = {{"caption": "force & wave", "numbers": {{"c (m/s)": 122.6}}}}
(folder / f"{{name}}.json").write_text(json.dumps(facts))
'''
BAD = '"""Fig. 2: one that fails."""\nraise ValueError("no such wire")\n'
SILENT = '"""Fig. 3: one that draws nothing."""\n'


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    folder = tmp_path / "models" / "paper"
    folder.mkdir(parents=True)
    (folder / "paper_common.py").write_text("")
    (folder / "fig01_good.py").write_text(GOOD.format(number=1))
    (folder / "fig02_bad.py").write_text(BAD)
    (folder / "fig03_silent.py").write_text(SILENT)
    (folder / "text_good.py").write_text(GOOD.format(number=9))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


def test_all_figures_one_of_which_fails(capsys, checkout):
    code, out, err = call(capsys, "paper", "-o", "pictures")
    assert code == 1
    assert "2 figures drawn, 2 failed" in out
    assert "fig02_bad: FAILED" in err
    page = (checkout / "pictures" / "index.html").read_text()
    assert "2 of 4 figures failed: fig02_bad, fig03_silent" in page
    assert "no such wire" in page
    assert "ended with code 0 and drew nothing" in page
    assert 'src="fig01_good.png"' in page
    assert "Fig. 1: a &lt;picture&gt;." in page
    assert "force &amp; wave" in page
    assert page.index("fig01_good.png") < page.index("text_good.png")


def test_some_figures(capsys, checkout):
    code, out, err = call(
        capsys, "paper", "1", "text_good", "-o", "pictures", "--json", "--quiet", "--jobs", 1
    )
    assert (code, err) == (0, "")
    drawn = json.loads(out)
    assert drawn["failed"] == {}
    assert drawn["figures"]["fig01_good"]["numbers"] == {"c (m/s)": 122.6}
    assert list(drawn["figures"]) == ["fig01_good", "text_good"]


def test_what_an_earlier_run_left_is_not_taken_for_a_picture(capsys, checkout):
    (checkout / "pictures").mkdir()
    (checkout / "pictures" / "fig03_silent.png").write_bytes(b"old")
    (checkout / "pictures" / "fig03_silent.json").write_text('{"caption": "", "numbers": {}}')
    assert call(capsys, "paper", "3", "-o", "pictures")[0] == 1


def test_bad_questions(capsys, checkout):
    code, _, err = call(capsys, "paper", "4")
    assert code == 3
    assert "figure 4: there is none; give a number or part of a name of: fig01_good, fig02_bad" in err
    (checkout / "file").write_text("")
    code, _, err = call(capsys, "paper", "1", "-o", checkout / "file")
    assert code == 3
    assert "cannot be written" in err
