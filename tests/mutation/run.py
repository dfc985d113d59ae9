"""Mutation testing: are the tests able to fail? ``python tests/mutation/run.py [TARGET ...]``.

One small change at a time is made to a module (a mutant), and the module's quick tests are run on it; a
mutant that no test notices survives. Files are left alone: a mutant lives in a child process, where the
changed source runs in the module. mutmut and cosmic-ray do the same more widely, but write mutants to files
and start anew for each, which with this package's libraries takes several times as long as the tests.

--sample N --seed S : of each target, N mutants drawn by chance
--only NUMBER : one mutant, with what the tests say
"""

from __future__ import annotations

import argparse
import ast
import copy
import importlib
import io
import os
import pkgutil
import random
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
_STATICS = [
    "tests/statics/test_rules.py",
    "tests/statics/test_form.py",
    "tests/space/test_bad_designs.py",
    "tests/space/test_statics_in_space.py",
    "tests/space/test_stitch_and_twin_wires.py",
]
_SHAPES = ["tests/results/test_shapes.py"]
_RUNS = ["tests/results/test_run_values.py", *_SHAPES]
_FILES = ["tests/results/test_stored_files.py"]
_TABLES = ["tests/results/test_comparison.py"]
_CONTACT = "tests/engines/test_contact_forces.py"
TARGETS = {  # module: tests that are quick and touch it
    "catenary_fe.results.statistics": ["tests/results/test_statistics.py", *_RUNS],
    "catenary_fe.results.signal": ["tests/results/test_statistics.py"],
    "catenary_fe.results.criteria": ["tests/results/test_criteria.py"],
    "catenary_fe.results.quantities": ["tests/results/test_quantities.py", "tests/results/test_csv_files.py"],
    "catenary_fe.results.run": _RUNS,
    "catenary_fe.results.modes": _SHAPES,
    "catenary_fe.results.wires": _SHAPES,
    "catenary_fe.results.comparison": _TABLES,
    "catenary_fe.results.export": _TABLES,
    "catenary_fe.results.files": _FILES,
    "catenary_fe.statics.form_finding": _STATICS,
    "catenary_fe.statics.cut_wires": _STATICS,
    "catenary_fe.statics.rules": _STATICS,
    "catenary_fe.engines.exudyn.contact": [
        "tests/engines/test_exudyn_contacts.py",
        _CONTACT,
        "tests/engines/test_elastic_pantograph.py",
    ],
    "catenary_fe.results.quality": [
        "tests/results/test_pantograph_balances.py",
        "tests/results/test_quality_values.py",
    ],
    "catenary_fe.results.check": ["tests/results/test_quality_values.py"],
    "catenary_fe.engines.linearised.doubts": ["tests/engines/test_doubts.py"],
    "catenary_fe.engines.contact_solver": ["tests/engines/test_forces_of_a_step.py"]
    + [
        f"{_CONTACT}::{name}"
        for name in (
            "test_a_link_pulls_along_itself",
            "test_the_law_is_solved_exactly",
            "test_a_link_that_swings_is_on_its_circle",
            "test_a_dropper_is_brought_to_its_law",
            "test_it_says_how_far_motions_went",
            "test_linearised_steps[slack-3.0-4.0]",
        )
    ],
    "catenary_fe.engines.nonlinear.forces": ["tests/engines/test_window_of_a_force.py"]
    + [
        f"{_CONTACT}::{name}"
        for name in (
            "test_a_dropper_that_is_not_taut_lacks_stiffness",
            "test_nonlinear_steps_in_the_plane",
            "test_nonlinear_steps_in_space",
        )
    ],
}
COMPILED = ("linearised.forces", "nonlinear.forces")  # changed source does not reach compiled code
LONGEST = 3.0, 20.0  # times what the tests take, and seconds: a mutant that takes longer is caught
OTHER = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.MatMult: ast.Mult,
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
    ast.And: ast.Or, ast.Or: ast.And, ast.BitOr: ast.BitAnd, ast.BitAnd: ast.BitOr,
}  # fmt: skip
REVERSED = {ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt}


class Mutants:
    """All mutants of a source, each with a line that says what it is."""

    def __init__(self, source: str) -> None:
        self._tree = ast.parse(source)
        self.found = [
            (line, name, change) for node in self._nodes(self._tree) for line, name, change in _changes(node)
        ]

    def _nodes(self, node: ast.AST) -> Iterator[ast.AST]:
        """Nodes in order, but for what is no behaviour: annotations, texts, types, the words of errors."""
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "decorator_list"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if not isinstance(child, ast.AST) or isinstance(
                    child, ast.Import | ast.ImportFrom | ast.JoinedStr
                ):
                    continue
                if isinstance(child, ast.keyword) and child.arg == "strict":
                    continue  # of zip: a check of one's own code
                if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                    continue
                yield child
                yield from self._nodes(child)

    def describe(self, number: int) -> str:
        """Line and change."""
        line, name, _ = self.found[number]
        return f"{line}: {name}"

    def tree(self, number: int) -> ast.Module:
        """The changed source."""
        _, _, change = self.found[number]
        undo = change()
        changed = copy.deepcopy(self._tree)
        undo()
        return ast.fix_missing_locations(changed)


def _changes(node: Any) -> Iterator[tuple[int, str, Any]]:
    line = getattr(node, "lineno", 0)

    def swap(attribute: str, value: Any) -> Any:
        def change() -> Any:
            before = getattr(node, attribute)
            setattr(node, attribute, value)
            return lambda: setattr(node, attribute, before)

        return change

    text = ast.unparse(node).split("\n")[0][:90] if isinstance(node, ast.expr | ast.stmt) else ""
    match node:
        case ast.BinOp(op=op) | ast.BoolOp(op=op) | ast.AugAssign(op=op) if type(op) in OTHER:
            new = OTHER[type(op)]
            yield line, f"{text}: {type(op).__name__} -> {new.__name__}", swap("op", new())
        case ast.Compare(ops=[op]):
            for table in (OTHER, REVERSED):
                if new := table.get(type(op)):
                    yield line, f"{text}: {type(op).__name__} -> {new.__name__}", swap("ops", [new()])
        case ast.Constant(value=bool(value)):
            yield line, f"{value} -> {not value}", swap("value", not value)
        case ast.Constant(value=int(value) | float(value)):
            yield line, f"{value} -> {value + 1}", swap("value", value + 1)
        case ast.UnaryOp(op=ast.Not() | ast.USub()):
            if isinstance(node.op, ast.USub):
                yield line, f"{text}: sign", swap("op", ast.UAdd())
            else:
                yield line, f"{text}: without not", _double(node)
        case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
            yield line, f"{text}: condition turned", swap("test", ast.UnaryOp(ast.Not(), test))
        case ast.Return(value=value) if value is not None and not _is_none(value):
            yield line, f"{text}: returns None", swap("value", ast.Constant(None))
        case ast.Continue():
            yield line, "continue -> break", _replaced(node)
        case ast.Call(keywords=[*_, ast.keyword(arg=str())]):
            for i, keyword in enumerate(node.keywords):
                if keyword.arg == "strict":
                    continue
                rest = [k for k in node.keywords if k is not keyword]
                yield line, f"{text}: without argument {keyword.arg} ({i})", swap("keywords", rest)


def _is_none(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and value.value is None


def _double(node: ast.UnaryOp) -> Any:
    """``not x`` as ``not not x``."""

    def change() -> Any:
        before = node.operand
        node.operand = ast.UnaryOp(ast.Not(), before)
        return lambda: setattr(node, "operand", before)

    return change


def _replaced(node: Any) -> Any:
    def change() -> Any:
        node.__class__ = ast.Break
        return lambda: setattr(node, "__class__", ast.Continue)

    return change


def replace_module(name: str, tree: ast.Module) -> None:
    """Run another source in a loaded module; what it defines goes to all modules that had it from there."""
    module = sys.modules[name]
    before = dict(module.__dict__)
    exec(compile(tree, str(path_of(name)), "exec"), module.__dict__)
    new = {id(before[key]): value for key, value in module.__dict__.items() if key in before}
    defined = {id(v) for v in before.values() if getattr(v, "__module__", None) == name}
    for other in [m for key, m in sys.modules.items() if key.startswith("catenary_fe")]:
        for key, value in list(vars(other).items()):
            if id(value) in defined and id(value) in new:
                setattr(other, key, new[id(value)])


def caught(module: str, tree: ast.Module, tests: list[str], shown: bool, seconds: float = 600) -> bool:
    """Run the tests on a mutant in a child process, for so long at most."""
    child = os.fork()
    if child == 0:
        signal.alarm(round(seconds))
        code = 1
        try:
            import pytest

            said = io.StringIO()
            with redirect_stdout(said), redirect_stderr(said):
                replace_module(module, tree)
                code = int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "-p", "no:randomly", *tests]))
            if shown:
                sys.__stdout__.write(said.getvalue())
                sys.__stdout__.flush()
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    return status != 0


def load() -> None:
    """Import all that the children need, once."""
    import hypothesis  # noqa: F401
    import pytest  # noqa: F401
    import scipy.signal  # noqa: F401
    import xarray  # noqa: F401

    import catenary_fe

    for info in pkgutil.walk_packages(catenary_fe.__path__, "catenary_fe."):
        if not info.name.endswith("__main__") and ".cli" not in info.name:
            importlib.import_module(info.name)


def path_of(module: str) -> Path:
    """The module's file."""
    return ROOT / (module.replace(".", "/") + ".py")


def main() -> None:
    """Print the survivors of each target and how many were caught."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("targets", nargs="*", help="modules, or ends of their names; unset: all")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    options = parser.parse_args()
    os.chdir(ROOT)
    chosen = [m for m in TARGETS if not options.targets or any(m.endswith(t) for t in options.targets)]
    compiled = [m for m in chosen if m.endswith(COMPILED)]
    if compiled == chosen:
        os.environ["NUMBA_DISABLE_JIT"] = "1"
    elif compiled:
        chosen = [m for m in chosen if m not in compiled]
        print(f"not without being named, as they run without a compiler: {', '.join(compiled)}")
    load()
    for module in chosen:
        tests = TARGETS[module]
        mutants, begin = Mutants(path_of(module).read_text(encoding="utf-8")), time.monotonic()
        untouched = ast.parse(path_of(module).read_text(encoding="utf-8"))
        assert not caught(module, untouched, tests, False), f"{module}: its tests fail as they are"
        longest = LONGEST[0] * (time.monotonic() - begin) + LONGEST[1]
        numbers = list(range(len(mutants.found)))
        if options.sample and options.sample < len(numbers):
            numbers = sorted(random.Random(options.seed).sample(numbers, options.sample))
        if options.only is not None:
            numbers = [options.only]
        survivors = []
        for number in numbers:
            if not caught(module, mutants.tree(number), tests, options.only is not None, longest):
                survivors.append(number)
                print(f"  survived {number}: line {mutants.describe(number)}", flush=True)
        share = 100 * (1 - len(survivors) / len(numbers))
        print(
            f"{module}: {len(numbers) - len(survivors)} of {len(numbers)} caught, {share:.0f} %"
            f" ({len(mutants.found)} mutants in all, {time.monotonic() - begin:.0f} s)",
            flush=True,
        )


if __name__ == "__main__":
    main()
