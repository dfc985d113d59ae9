"""The reference pages: every key and every name of the interface, whole, readable, under its public path."""

import html
import re
import subprocess
import sys
import tomllib
from importlib import import_module
from pathlib import Path

import pytest
from docutils import nodes
from pydantic import BaseModel

import catenary_fe as cf
from catenary_fe.results.quantities import FORCE, OF_RUN

DOCS = Path(__file__).parents[2] / "docs"
OTHERS = "howto,*.md,reference/commands.md"
UNREADABLE = "FieldInfo", "Annotated[", "AfterValidator", "ndarray[", "NoneType", "FloatArray", "Type:"


@pytest.fixture(scope="module")
def key_tables():
    sys.path.insert(0, str(DOCS))
    try:
        yield import_module("key_tables")
    finally:
        sys.path.remove(str(DOCS))


@pytest.fixture(scope="module")
def directives():
    """What the interface's page documents, by public path."""
    page = (DOCS / "reference" / "python.md").read_text(encoding="utf-8")
    return re.findall(r"^\.\. auto(class|exception|function|module):: (\S+)$", page, re.M)


def owner_of(path):
    """The object that a dotted path is an attribute of."""
    words = path.split(".")[:-1]
    found = import_module(words[0])
    for i, word in enumerate(words[1:], start=2):
        found = getattr(found, word, None) or import_module(".".join(words[:i]))
    return found


def test_the_table_of_key_figures_is_that_of_the_program(key_tables):
    _, *rows = key_tables.figures_table().findall(nodes.row)
    texts = [[cell.astext() for cell in row] for row in rows]
    shown = {key: (unit, decimals) for key, _, _, unit, decimals in texts}
    assert list(shown) == [q.key for q in (*FORCE.values(), *OF_RUN)]
    assert shown["std_N"] == ("N", "1") and shown["contact_loss_percent"] == ("% of the time", "2")


def test_directives_name_public_paths(directives):
    for kind, path in directives:
        *_, name = path.split(".")
        if kind == "module":
            assert import_module(path).__all__
            continue
        owner = owner_of(path)
        listed = getattr(owner, "__all__", None) or dir(cf.library)
        assert name in listed, f"{path} is not public"
        if owner is not cf.library:
            at_the_top = getattr(cf, name, None) if name in cf.__all__ else None
            assert path == f"catenary_fe.{name}" or getattr(owner, name) is not at_the_top, path


def test_the_whole_interface_is_documented(directives):
    shown = {path for _, path in directives}
    assert {f"catenary_fe.{name}" for name in cf.__all__ if name != "library"} <= shown


@pytest.mark.parametrize("kind", ["layout", "pantograph", "conditions", "study"])
def test_every_key_has_unit_meaning_and_example(key_tables, kind):
    schema = key_tables.SCHEMAS[kind]()
    tables, examples = key_tables.tables_of(schema), key_tables.examples_of(kind)
    properties = {"": schema.get("properties", {})}
    properties |= {name: part.get("properties", {}) for name, part in schema.get("$defs", {}).items()}
    assert {t.name for t in tables} >= {name for name, keys in properties.items() if keys}
    for table in tables:
        shown = {key.name: key for key in table.keys}
        for name, part in properties[table.name].items():
            if part.get("deprecated"):
                continue
            key, numbers = shown[name], "'number'" in str(part)
            assert key.meaning and key.allowed, (table.name, name)
            has_unit = key.unit != "–" or "[" in key.meaning  # of a list of pairs, each has its own
            assert has_unit or not numbers or key.tables, f"{table.name}.{name} has no unit"
            assert key_tables.example_of(table, key, tables, examples), f"{table.name}.{name}: no example"


def test_examples_are_files_that_load(key_tables):
    for path in sorted(key_tables.EXAMPLES.glob("*.toml")):
        record = tomllib.loads(path.read_text(encoding="utf-8"))
        if path.stem.startswith("layout"):
            loaded = cf.load_catenary(path)
        elif path.stem.startswith("conditions"):
            loaded = cf.load_conditions(path)
        elif path.stem.startswith("study"):
            loaded = cf.load_study(path)
        else:
            loaded = cf.load_pantograph(path)
        assert loaded.name == record["name"]


def test_drawings_name_keys_that_exist(key_tables):
    from matplotlib.text import Text

    drawings = import_module("drawings")
    known = {
        key.name
        for schema in key_tables.SCHEMAS.values()
        for table in key_tables.tables_of(schema())
        for key in table.keys
    }
    for name, draw in drawings.DRAWINGS.items():
        texts = [t for t in draw().findobj(Text) if t.get_text() and t.get_family() == ["monospace"]]
        words = {w for t in texts for w in re.findall(r"[a-z_]{4,}", t.get_text())} - {"span"}
        assert words, name
        assert words <= known, f"{name}: {words - known}"
    assert {"support", "span", "steady_arm", "signs"} <= set(drawings.DRAWINGS)


def text_of(page):
    """What a reader sees, on one line."""
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    cells = re.sub(r"</(?:td|th|tr|p|li|dt|dd)>", " ", body)
    return " ".join(html.unescape(re.sub(r"<[^>]+>", "", cells)).split())


def plain(text):
    """As :func:`text_of` has it: without backticks, with typographic quotes undone."""
    for written, shown in {"`": "", "‘": "'", "’": "'", "“": '"', "”": '"'}.items():
        text = text.replace(written, shown)
    return " ".join(text.split())


def test_rendered_pages_are_readable_and_whole(key_tables, tmp_path):
    """One build of the reference, as a reader gets it."""
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-D", f"exclude_patterns={OTHERS}", "-D", "html_theme=basic",
         "-D", "root_doc=reference/python", DOCS, tmp_path],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    pages = {name: plain(text_of((tmp_path / "reference" / f"{name}.html").read_text(encoding="utf-8")))
             for name in ("python", "files")}  # fmt: skip
    for name, page in pages.items():
        assert not [word for word in UNREADABLE if word in page], name
    for schema in key_tables.SCHEMAS.values():
        for table in key_tables.tables_of(schema()):
            for key in table.keys:
                row = f"{key.name} {key.unit} {key.default} {key.allowed} {key.meaning}"
                assert plain(row) in pages["files"], f"files: {table.name}.{key.name} is torn or missing"
    models = [getattr(cf, n) for n in cf.__all__]
    for model in (m for m in models if isinstance(m, type) and issubclass(m, BaseModel)):
        for key in key_tables.keys_of(model.model_json_schema()):
            unit = "" if key.unit == "–" else f"[{key.unit}] "
            entry = plain(f"{key.name} – {unit}{key.meaning}")
            assert entry in pages["python"], f"{model.__name__}.{key.name} is torn or missing"
