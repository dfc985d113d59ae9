"""Layout and pantograph files: what is written is what is built; what is wrong is said at once."""

import json
import tomllib
from pathlib import Path

import jsonschema
import pytest

import catenary_fe as cf
from catenary_fe.layout import conditions_schema, layout_schema, pantograph_schema, study_schema
from catenary_fe.layout.toml import LARGEST_FILE
from catenary_fe.layout.variation import varied_pantograph


def faults(path):
    with pytest.raises(cf.InputError) as caught:
        cf.load_catenary(path)
    for line in caught.value.problems:
        assert line.startswith(str(path))
    return [line.removeprefix(f"{path}: ") for line in caught.value.problems]


@pytest.fixture
def edited(reference_layout, tmp_path):
    def edit(*changes):
        text = reference_layout.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "layout.toml"
        path.write_text(text)
        return path

    return edit


def test_reference_layout(reference):
    assert reference.length == 600
    assert len(reference.droppers) == 90
    assert reference.dropper_positions[9] == 65
    assert reference.contact_wire.mass_per_length == 1.35  # filled in from the library
    assert reference.spans_to_evaluate == (5, 6)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("tension = 20e3", "tension = -20e3", "contact_wire.tension = -20000.0: must be greater than 0"),
        ("tension = 20e3", 'tension = "20e3"', "contact_wire.tension = '20e3': must be a number"),
        ("tension = 20e3", "", "contact_wire.tension is missing; add it: [N]"),
        ("mass = 0.3", "mas = 0.3", "unknown key support.steady_arm.mas; did you mean 'mass'?"),
        ("count = 10", "count = 0", "span 1: count = 0: must be at least 1"),
        ("length = 60.0", "length = 50.0", "span 1: dropper 9 at 55 m lies outside the 50 m span"),
        ("10.5, 17.0", "17.0, 10.5", "span 1: dropper 3 at 10.5 m does not come after"),
        ("[5.0,", '["five",', "span 1: droppers 1: 'five' is neither a position in metres nor a table"),
        (
            'library = "EN 50318:2002 contact wire"',
            'library = "EN 50318:2002 contact wir"',
            "contact_wire: no wire 'EN 50318:2002 contact wir' in the library; near names:",
        ),
        ("evaluated_spans = [5, 6]", "evaluated_spans = [5, 11]", "evaluated_spans names span 11"),
        ("[damping]", "[[damping]]", "damping = [{'beta': 0.0001}]: must be a table"),
        ("count = 10", "count = 10.5", "span 1: count = 10.5: must be a whole number"),
    ],
)
def test_a_fault_in_a_file(edited, old, new, said):
    (line,) = faults(edited((old, new)))
    assert line.startswith(said)


def test_several_faults_of_a_file_come_together(edited):
    found = faults(
        edited(
            ("tension = 20e3", "tension = 0"), ("beta = 1e-4", "beta = -1"), ("length = 60.0", "length = 1.0")
        )
    )
    # the outermost droppers lie beyond the short span too
    assert [line.split(":")[0] for line in found] == [
        "contact_wire.tension = 0", *["span 1"] * 9, "damping.beta = -1",
    ]  # fmt: skip


def test_faults_of_every_kind_come_together(edited):
    """Values, keys, droppers out of place, and numbers of spans and supports that the line does not have."""
    found = faults(
        edited(
            ("tension = 20e3", "tension = -20e3"),
            ("tension = 16e3", "tenson = 16e3"),
            ("evaluated_spans = [5, 6]", "evaluated_spans = [5, 60]"),
            ("[5.0,", "[{ position = 5.0, length = 1.5 },"),
            ("[[span]]", "[[supports]]\nat = 40\n[[supports]]\nat = 3\n[[supports]]\nat = 3\n[[span]]"),
        )
    )
    said = (
        "contact_wire.tension = -20000.0: must be greater than 0",
        "messenger_wire.tension is missing",
        "unknown key messenger_wire.tenson; did you mean 'tension'?",
        "supports: at = 40: the line has supports 1 to 11",
        "supports: at = 3 is there twice",
        "evaluated_spans names span 60: the line has spans 1 to 10",
        *[f"span {i}: dropper 1 with a length of 1.5 m is longer than" for i in range(1, 11)],
    )
    assert len(found) == len(said)
    assert all(line.startswith(start) for line, start in zip(found, said, strict=True))


def test_droppers_are_reported_beside_other_faults_of_their_span(edited):
    found = faults(edited(("10.5, 17.0", "70.5, -17.0"), ("count = 10", "count = 0")))
    assert [line.split(";")[0] for line in found] == [
        "span 1: dropper 2 at 70.5 m lies outside the 60 m span",
        "span 1: dropper 3 at -17 m lies outside the 60 m span",
        "span 1: count = 0: must be at least 1",
    ]


def test_files_that_are_not_layouts(tmp_path):
    path = tmp_path / "a.toml"
    assert faults(path)[0].startswith("no such layout file")
    path.write_text("name = 'x' name = 'y'")
    assert faults(path)[0].startswith("not a TOML file: ")
    path.write_text("a = 1\na = 2")
    assert faults(path)[0].startswith("not a TOML file: ")
    path.write_bytes(b"name = '\xff'")
    assert faults(path)[0].startswith("not a text in UTF-8")
    path.write_text("a = " + "[" * 5000 + "]" * 5000)
    assert faults(path)[0].startswith("not a TOML file: ")
    with path.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    assert faults(path)[0].startswith("larger than")
    assert faults(tmp_path)[0].startswith("cannot be read")


def test_droppers_with_values_of_their_own(edited):
    path = edited(
        ("[5.0, 10.5,", "[5.0, { position = 10.5, stiffness = 2e5, height_offset = 0.01 },"),
        ("count = 10", "count = 2"),
        ("evaluated_spans = [5, 6]", ""),
    )
    catenary = cf.load_catenary(path)
    assert [d.stiffness for d in catenary.droppers[:3]] == [1e5, 2e5, 1e5]
    assert catenary.design_heights[1] == pytest.approx(5.31)


def test_mistuned_spans_and_supports(edited):
    path = edited(
        (
            "[[span]]",
            "[[supports]]\nat = 2\nsystem_height = 1.4\n\n[[span]]\nlength = 50.0\ndroppers = [25]\n[[span]]",
        ),
    )
    catenary = cf.load_catenary(path)
    assert len(catenary.spans) == 11
    assert catenary.support_positions[1] == 50
    assert catenary.messenger_support_heights[:3] == pytest.approx([6.5, 6.7, 6.5])
    assert catenary.supports[1].steady_arm == catenary.supports[2].steady_arm


def test_a_support_that_is_not_there(edited):
    (line,) = faults(edited(("[[span]]", "[[supports]]\nat = 12\n[[span]]")))
    assert line == "supports: at = 12: the line has supports 1 to 11"


def test_pantograph_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\nuplift_force = 100\nstages = [{ mass = 10, stiffness = 50 }]')
    assert cf.load_pantograph(path).uplift_force == 100
    path.write_text("uplift_force = 100\nstages = [{ mas = 10, stiffness = 50 }]")
    with pytest.raises(cf.InputError, match="did you mean 'mass'") as caught:
        cf.load_pantograph(path)
    assert len(caught.value.problems) == 2


def test_schemas_accept_the_layouts_and_know_the_keys(reference_layout):
    schema = layout_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    for path in sorted(reference_layout.parent.glob("*.toml")):
        jsonschema.validate(tomllib.loads(path.read_text()), schema)
    schemas = {
        "layout": schema,
        "pantograph": pantograph_schema(),
        "conditions": conditions_schema(),
        "study": study_schema(),
    }
    for name, current in schemas.items():
        path = reference_layout.parents[1] / "schemas" / f"{name}.schema.json"
        committed = json.loads(path.read_text())
        assert committed == current, f"run: catenary-fe schema {name} > models/schemas/{name}.schema.json"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"name": "x", "tensoin": 1}, schema)
    text = json.dumps(pantograph_schema())
    assert "EN 50367 AC" in text
    assert "[N] constant force on the lowest mass" in text


CASES = Path(__file__).parents[1] / "cases"


def test_a_byte_order_mark_is_read(tmp_path):
    assert cf.load_catenary(CASES / "windows_bom.toml").name == "plain line"
    path = tmp_path / "pantograph.toml"
    path.write_text("\ufeffuplift_force = 60.0\nstages = [{ mass = 7.0, stiffness = 7000.0 }]\n", "utf-8")
    assert cf.load_pantograph(path).uplift_force == 60.0


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("height = 5,5", "line 2: 5,5 is a number with a comma: write a point before decimals (5.5), and"),
        ("steady_arm = { mass = 0,8, stiffness = 1 }", "line 2: 0,8 is a number with a comma"),
        ("tension = 15 000", "line 2: 15 000 is a number with blanks: write 15000"),
        ("library = “AC-120”", "line 2, column 11: typographic quote “ (U+201C): write \" in its place"),
        ("library = ‘AC-120’ # it's", "line 2, column 11: typographic quote ‘ (U+2018)"),
        ("tension\u00a0= 15e3", "line 2, column 8: no-break or other special blank (U+00A0)"),
        ("curve_radius = −300.0", "line 2, column 16: dash − (U+2212): write an ordinary hyphen"),
        ("name = 'a – “b”' c", "not a TOML file: "),  # inside a text they are right
    ],
)  # fmt: skip
def test_usual_slips_are_named_with_their_line(tmp_path, line, said):
    path = tmp_path / "a.toml"
    path.write_text(f'name = "“Łódź” – 5,5"\n{line}\n', "utf-8")
    (found,) = faults(path)
    assert found.startswith(said)


def test_other_encodings_are_named(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes('a = 1\nname = "Łódź"\n'.encode("cp1250"))
    assert faults(path) == ["not a text in UTF-8 (line 2, byte 14); save it as UTF-8"]
    path.write_text("name = 'x'", "utf-16")
    assert faults(path)[0].startswith("a text in UTF-16")


def test_spans_and_supports_are_called_by_their_numbers_on_site(edited):
    path = edited(
        ("[[span]]", "[[span]]\nlength = 60.0\ndroppers = [30.0]\ncount = 4\n[[span]]"),
        ("[[span]]", '[[supports]]\nat = 7\nsystem_height = "1.2"\n[[supports]]\nstagger = 0.2\n[[span]]'),
        ("count = 10", "count = 0"),
    )
    assert [line.split(" = 0")[0].split(" is ")[0] for line in faults(path)] == [
        "supports: at = 7: system_height = '1.2': must be a number; it",
        "entry 2 of [[supports]]: at",
        "span 5 (entry 2 of [[span]]): count",
    ]


def test_elastic_pantographs_in_files(tmp_path):
    path, law = tmp_path / "elastic.toml", "law = [[-0.1, 150.0], [0.2, 60.0]]\n"
    path.write_text("name = 'soft'\nforce = 120.0\nstiffness = 400.0\n")
    assert cf.load_pantograph(path) == cf.ElasticPantograph(name="soft", force=120.0, stiffness=400.0)
    path.write_text(law)
    assert cf.load_pantograph(path).contact_force(0.05) == pytest.approx(105.0)
    jsonschema.validate(tomllib.loads(law), pantograph_schema())
    assert varied_pantograph(str(path), {"pantograph.law.1.2": 90.0}).contact_force(-1.0) == 90.0
    for text, said in (
        ("force = 120.0\n" + law, "force and law: give exactly one"),
        (law + "uplift_force = 60.0\n", "unknown key uplift_force; known keys: base, force, law"),
        ("law = [[0.2, 60.0], [-0.1, 150.0]]\n", "law: after 60 N at 0.2 m comes 150 N"),
        (law + "stages = [{ mass = 7.0, stiffness = 7e3 }]\n", "unknown key law"),
    ):
        path.write_text(text)
        with pytest.raises(cf.InputError) as caught:
            cf.load_pantograph(path)
        assert any(line.startswith(f"{path}: {said}") for line in caught.value.problems)
