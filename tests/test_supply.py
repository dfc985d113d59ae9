"""No code is executed from layout or result files, and all that the program reads comes with it."""

import ast
import json
import pickle
import sys
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from scipy.io import netcdf_file

import catenary_fe as cf
from catenary_fe.cli import main

SOURCES = sorted(Path(cf.__file__).parent.rglob("*.py"))
CALLS = {"eval", "exec", "compile", "__import__", "input", "execfile"}
ATTRIBUTES = {
    "system",
    "popen",
    "Popen",
    "check_output",
    "check_call",
    "loads_pickle",
    "unsafe_load",
    "full_load",
}
MODULES = {
    "pickle",
    "cPickle",
    "dill",
    "cloudpickle",
    "shelve",
    "marshal",
    "yaml",
    "jsonpickle",
    "subprocess",
}


def names_of(tree):
    """Modules imported, functions called, and methods called with their objects."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (("module", alias.name.split(".")[0]) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "module", (node.module or "").split(".")[0]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield "call", node.func.id
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            yield "attribute", node.func.attr
        elif isinstance(node, ast.keyword) and node.arg == "allow_pickle" and not is_false(node.value):
            yield "call", "allow_pickle"


def is_false(node):
    return isinstance(node, ast.Constant) and node.value is False


def dangers(source):
    bad = {"module": MODULES, "call": CALLS | {"allow_pickle"}, "attribute": ATTRIBUTES}
    return [name for kind, name in names_of(ast.parse(source)) if name in bad[kind]]


def test_the_package_has_nothing_that_executes_what_it_reads():
    assert len(SOURCES) > 100
    found = {path.name: dangers(path.read_text(encoding="utf-8")) for path in SOURCES}
    # the paper's figures are scripts of the checkout, run as such
    assert {name: names for name, names in found.items() if names} == {"program.py": ["subprocess"]}


@pytest.mark.parametrize(
    "source",
    [
        "import pickle",
        "from yaml import load",
        "x = eval(text)",
        "numpy.load(path, allow_pickle=True)",
        "import os; os.system(text)",
    ],
)
def test_the_search_finds_what_it_looks_for(source):
    assert dangers(source)


class Bomb:
    """Writes a file where it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.write_text, (Path(self.path), "gone off")


@pytest.fixture
def bomb(tmp_path):
    """Texts and bytes that would write this file if anything executed them."""
    target = tmp_path / "executed"
    yield target
    assert not target.exists()


def code(target):
    return f"__import__('pathlib').Path({str(target)!r}).write_text('gone off')"


def test_a_hostile_result(bomb, short_run, tmp_path, capsys):
    """A pickle where netCDF should be; code in every text of a run that is otherwise sound."""
    (tmp_path / "run.nc").write_bytes(pickle.dumps(Bomb(str(bomb))))
    with pytest.raises(cf.InputError, match="not a readable netCDF file"):
        cf.load_run(tmp_path / "run.nc")
    path = short_run.save(tmp_path / "sound.nc")
    for name in ("format", "catenary", "pantographs", "settings", "evaluated_spans", "warnings", "method"):
        with netcdf_file(path, "r", mmap=False) as read:
            texts = {key: getattr(read, key) for key in read._attributes}
        data = short_run.data.copy()
        data.attrs = {k: v.decode() if isinstance(v, bytes) else v for k, v in texts.items()}
        data.attrs[name] = f"!!python/object/apply:eval [{code(bomb)}]"
        data.to_netcdf(tmp_path / "run.nc", engine="scipy", format="NETCDF3_64BIT")
        code_of = main(["report", str(tmp_path / "run.nc"), "--quiet"])
        assert code_of == 3
        assert main(["rerun", str(tmp_path / "run.nc"), "--quiet"]) == 3
        assert "Traceback" not in capsys.readouterr().err


def test_a_hostile_layout(bomb, reference_layout, tmp_path, capsys):
    text = reference_layout.read_text()
    for hostile in (
        text.replace('name = "', f'name = "{{{{ {code(bomb)} }}}}', 1),
        text.replace("count = 10", f'count = "{code(bomb)}"'),
        f"!!python/object/apply:eval\n- {code(bomb)}\n",
        code(bomb),
        json.dumps({"py/reduce": [{"py/function": "builtins.eval"}, [code(bomb)]]}),
    ):
        path = tmp_path / "line.toml"
        path.write_text(hostile)
        main(["info", str(path)])
    path.write_bytes(pickle.dumps(Bomb(str(bomb))))
    assert main(["info", str(path)]) == 3
    assert "Traceback" not in capsys.readouterr().err


def test_a_hostile_case_of_a_sweep(bomb, reference_layout, tmp_path):
    """Records of finished cases are JSON; one that is a pickle is run again."""
    text = reference_layout.read_text().replace("count = 10", "count = 3")
    (tmp_path / "line.toml").write_text(text.replace("[5, 6]", "[2]"))
    arguments = ["sweep", tmp_path / "line.toml", "--speed-kmh", "200", "--pantograph", "DSA380",
                 "--jobs", "1", "--time-step-ms", "5", "--quiet", "-o", tmp_path / "out"]  # fmt: skip
    assert main([str(a) for a in arguments]) == 0
    table = (tmp_path / "out" / "sweep.csv").read_bytes()
    (record,) = (tmp_path / "out" / "cases").glob("*.json")
    record.write_bytes(pickle.dumps(Bomb(str(bomb))))
    assert main([str(a) for a in arguments]) == 0
    assert (tmp_path / "out" / "sweep.csv").read_bytes() == table


def test_data_files_are_in_the_package():
    root = resources.files("catenary_fe")
    for name in ("layout/library/pantographs.toml", "views/report/assets/report.html.j2"):
        assert root.joinpath(name).is_file(), name
    assert np.isfinite(cf.library.pantograph("DSA380").stages[0].mass)
    assert "pickle" in sys.modules  # of this test and of libraries: the search above is of our sources
