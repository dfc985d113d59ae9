"""The package as a whole: quick to import, silent, everything it names is there."""

import re
import subprocess
import sys
from pathlib import Path

import catenary_fe as cf


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_importing_loads_no_heavy_library():
    code = (
        "import sys, catenary_fe\n"
        "print([m for m in ('matplotlib', 'exudyn', 'scipy', 'xarray', 'pydantic') if m in sys.modules])"
    )
    assert run(code).strip() == "[]"


def test_describing_a_catenary_loads_neither_solver_nor_pictures():
    code = (
        "import sys, catenary_fe as cf\n"
        "cf.library.pantograph('DSA380')\n"
        "print([m for m in ('matplotlib', 'exudyn', 'scipy', 'xarray') if m in sys.modules])"
    )
    assert run(code).strip() == "[]"


def test_one_room_imports_exudyn_and_a_default_run_does_not(reference_layout):
    package = Path(cf.__file__).parent
    importers = {
        path.relative_to(package).parent.as_posix()
        for path in package.rglob("*.py")
        if re.search(r"^\s*(import|from) exudyn", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert importers == {"engines/exudyn"}
    code = (
        "import sys, catenary_fe as cf\n"
        f"c = cf.load_catenary({str(reference_layout)!r})\n"
        "c = c.replace(spans=c.spans[:3], supports=c.supports[:4], evaluated_spans=(2,))\n"
        "shape = cf.find_form(c)\n"
        "cf.elasticity(shape, positions=[80.0]), cf.solve_modes(shape, count=3)\n"
        "for method in ('nonlinear', 'linearised'):\n"
        "    cf.simulate(shape, [cf.library.pantograph('EN 50318:2002')], speed=60.0, method=method)\n"
        "print('exudyn' in sys.modules)"
    )
    assert run(code).strip() == "False"


def test_a_run_prints_nothing_and_writes_nothing(tmp_path, reference_layout):
    code = (
        "import os, catenary_fe as cf\n"
        f"c = cf.load_catenary({str(reference_layout)!r})\n"
        "c = c.replace(spans=c.spans[:3], supports=c.supports[:4], evaluated_spans=(2,))\n"
        f"os.chdir({str(tmp_path)!r})\n"
        "cf.simulate(cf.find_form(c), [cf.library.pantograph('EN 50318:2002')], speed=60.0)\n"
    )
    assert run(code) == ""
    assert list(tmp_path.iterdir()) == []


def test_all_names_exist():
    for name in cf.__all__:
        assert getattr(cf, name) is not None
    assert set(cf._ROOM_OF) == set(cf.__all__)
