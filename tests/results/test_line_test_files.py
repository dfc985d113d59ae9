"""Measurements from files: what headings say, and one clear line for each fault."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout.tables import FACTORS

X, FORCE = np.arange(100.0, 102.0, 0.25), np.array([100.0, 110, 120, 130, 120, 110, 100, 90])


def csv(folder, header, rows, sep=",", name="m.csv", encoding="utf-8"):
    path = folder / name
    path.write_text("\n".join([header, *(sep.join(map(str, row)) for row in rows)]) + "\n", encoding=encoding)
    return path


def only(test):
    (one,) = test.passes
    return one


@pytest.mark.parametrize(
    ("header", "factor"),
    [
        ("position [m],force [N]", (1, 1)), ("Position (m),Contact force (N)", (1, 1)),
        ("x_m,force_N", (1, 1)),
        ("chainage [km],force [kN]", (1e-3, 1e-3)), ("Chainage_mm,contact_force_kN", (1e3, 1e-3)),
    ],
)  # fmt: skip
def test_headings_with_units(tmp_path, header, factor):
    rows = zip(X * factor[0], FORCE * factor[1], strict=True)
    one = only(cf.read_line_test(csv(tmp_path, header, rows)))
    assert one.position == pytest.approx(X, abs=1e-9)
    assert one.force == pytest.approx(FORCE, abs=1e-9)
    assert one.name == "measured"


@pytest.mark.parametrize("sep", [";", "\t"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_decimal_commas_where_commas_do_not_separate(tmp_path, sep, encoding):
    rows = [
        (f"{a:.2f}".replace(".", ","), f"{b:.1f}".replace(".", ",")) for a, b in zip(X, FORCE, strict=True)
    ]
    test = cf.read_line_test(csv(tmp_path, f"position [m]{sep}force [N]", rows, sep, encoding=encoding))
    assert only(test).position == pytest.approx(X)
    assert only(test).force == pytest.approx(FORCE)
    assert "decimal commas" in " ".join(test.notes)


def test_units_in_a_row_of_their_own(tmp_path):
    rows = [("ms", "kN", "-"), *zip(1e3 * X, FORCE / 1e3, ["x"] * 8, strict=True)]
    test = cf.read_line_test(csv(tmp_path, "Time;Force;Remark", rows, ";"))
    assert only(test).time == pytest.approx(X)
    assert only(test).force == pytest.approx(FORCE)
    assert test.notes == (f"{tmp_path / 'm.csv'}: not read: Remark",)


def test_all_quantities(tmp_path):
    header = "time_s,position_m,speed [km/h],force_N,wire_height_m,uplift_support_5_mm,other"
    rows = [(0.1 * i, X[i], 180, FORCE[i], 5.3, "" if i else 40, "a") for i in range(8)]
    one = only(cf.read_line_test(csv(tmp_path, header, rows)))
    assert one.speed == pytest.approx(np.full(8, 50.0))
    assert one.height == pytest.approx(np.full(8, 5.3))
    assert one.uplift == {5: pytest.approx([0.04])}


def test_what_this_program_exports_is_read(tmp_path):
    header = "time_s,position_m,contact_force_N,contact_force_0_20_Hz_N,wire_height_m,mass_1_height_m"
    rows = [(0.1 * i, X[i], FORCE[i], 0, 5.3, 4.0) for i in range(8)]
    test = cf.read_line_test(csv(tmp_path, header, rows))
    assert only(test).force == pytest.approx(FORCE)
    assert "not read: contact_force_0_20_Hz_N, mass_1_height_m" in test.notes[0]
    header = "time_s,support_4_at_162.5_m_uplift_m,support_5_at_212.5_m_uplift_m"
    test = cf.read_line_test(csv(tmp_path, header, [(0, 0.01, 0.02), (1, 0.05, 0.01)]))
    assert {n: v.max() for n, v in only(test).uplift.items()} == {4: 0.05, 5: 0.02}
    assert "not used: time" in test.notes[0]


def test_passes_beside_each_other(tmp_path):
    rows = [(X[i], FORCE[i], 2 * FORCE[i] if i < 5 else "") for i in range(8)]
    test = cf.read_line_test(csv(tmp_path, "position [m],force 1 [N],force pass 2 [N]", rows))
    assert [p.name for p in test.passes] == ["pass 1", "pass 2"]
    assert test.passes[0].force == pytest.approx(FORCE)
    assert test.passes[1].force == pytest.approx(2 * FORCE[:5])
    assert test.passes[1].position == pytest.approx(X[:5])
    assert "pass 2: 3 rows at the end without values" in " ".join(test.notes)
    rows = [(X[i], FORCE[i], X[i] + 7, FORCE[i]) for i in range(8)]
    test = cf.read_line_test(csv(tmp_path, "position 1 [m],force 1 [N],position 2 [m],force 2 [N]", rows))
    assert test.passes[1].position == pytest.approx(X + 7)


def test_passes_below_each_other(tmp_path):
    rows = [(n, X[i], FORCE[i] + k) for k, n in enumerate(("1", "down")) for i in range(8)]
    test = cf.read_line_test(csv(tmp_path, "pass,position [m],force [N]", rows))
    assert [p.name for p in test.passes] == ["pass 1", "down"]
    assert test.passes[1].force == pytest.approx(FORCE + 1)


def test_passes_in_files(tmp_path):
    header, rows = "position [m],force [N]", list(zip(X, FORCE, strict=True))
    paths = [csv(tmp_path, header, rows, name=name) for name in ("first.csv", "second.csv")]
    assert [p.name for p in cf.read_line_test(paths).passes] == ["first", "second"]
    assert [p.name for p in cf.read_line_test([paths[0], paths[0]]).passes] == ["1: first", "2: first"]


def test_uplifts_by_support(tmp_path):
    rows = [(5, 40), (6, 50), (5, 45)]
    one = only(cf.read_line_test(csv(tmp_path, "support,uplift [mm]", rows)))
    assert {n: list(v) for n, v in one.uplift.items()} == {5: [0.04, 0.045], 6: [0.05]}
    path = csv(tmp_path, "uplift [mm]", [(40,), (41,)])
    assert only(cf.read_line_test(path, support=3)).uplift == {3: pytest.approx([0.04, 0.041])}
    with pytest.raises(
        cf.InputError, match=r"of which support\? name it uplift_support_5_mm, or say --support"
    ):
        cf.read_line_test(path)
    path = csv(tmp_path, "uplift_support_4_mm", [(40,), (41,)])
    with pytest.raises(
        cf.InputError, match="support = 3: no file has an uplift without a support of its own"
    ):
        cf.read_line_test(path, support=3)


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("s,CH 7", {"position[m]": "s", "force [N]": "CH 7"}),
        ("s [m],CH7 [N]", {"position": "s [m]", "force": ["ch7 [n]"]}),
        ("s (m),force [kN]", {"position": "s (m)", "force[kN]": "force [kN]"}),
        ("way_m,Kraft_N", {"chainage": "way_m", "contact_force": "Kraft_N"}),
    ],
)
def test_the_user_says_what_a_column_is(tmp_path, header, columns):
    factor = 1e-3 if "kN" in header else 1
    path = csv(tmp_path, header, zip(X, factor * FORCE, strict=True))
    one = only(cf.read_line_test(path, columns=columns))
    assert one.position == pytest.approx(X)
    assert one.force == pytest.approx(FORCE)


def test_what_the_user_says_goes_before_headings(tmp_path):
    rows = zip(X, FORCE, FORCE + 5, FORCE + 7, strict=True)
    path = csv(tmp_path, "position [m],force [N],sum [N],left [N]", rows)
    test = cf.read_line_test(path, columns={"force": "sum [N]"})
    assert only(test).force == pytest.approx(FORCE + 5)
    assert "not read: force [N], left [N]" in test.notes[0]
    two = cf.read_line_test(path, columns={"force": ["sum [N]", "left [N]"]})
    assert [p.force[0] for p in two.passes] == pytest.approx([105, 107])


def test_a_column_that_is_left_out(tmp_path):
    rows = [(f"12:00:{i:02d}", X[i], FORCE[i]) for i in range(8)]
    path = csv(tmp_path, "time [hh:mm:ss],position [m],force [N]", rows)
    with pytest.raises(
        cf.InputError, match=r"unit 'hh:mm:ss' does not fit a time.*--map time=- leaves it out"
    ):
        cf.read_line_test(path)
    test = cf.read_line_test(path, columns={"time": "-"})
    assert only(test).time is None and only(test).force == pytest.approx(FORCE)
    assert "not read: time [hh:mm:ss]" in test.notes[0]


def nonsense(position="position [m]", force="force [N]", rows=None):
    rows = rows or list(zip(X, FORCE, strict=True))
    return f"{position},{force}", rows


FAULTS = {
    "unit of another quantity": (nonsense(force="force [mm]"), r"row 1, column 2 \('force \[mm\]'\): unit"
                                 " 'mm' does not fit a force: must be one of N, kN"),
    "unit of a position": (nonsense(position="chainage [s]"), "unit 's' does not fit position, a length"),
    "no unit": (nonsense(force="force"), r"the unit is missing: write force \[N\], one of N, kN"),
    "no force": (nonsense(force="CH7"), "row 1: there is no column of force, height or uplift, but"),
    "no position": (nonsense(position="station"), r"row 1: column position \[m\] or time \[s\] is missing"),
    "twice": (nonsense(position="force_kN"), r"column 2 \('force \[N\]'\): force is there twice; say"),
    "decimal commas": (nonsense(rows=[("100,25", "90,1"), ("100,5", "91,3")]),
                       r"row 2: 4 cells for 2 columns \(and 1 more row like it\); look for decimal commas"),
    "not numbers": (nonsense(rows=[(1, 5), (2, "abc"), (3, "??")]),
                    r"row 3, column force \[N\]: 'abc' is not a number \(and 1 more row like it\)"),
    "not measured": (nonsense(rows=[(1, 5), (2, "NaN"), (3, ""), (4, 5)]),
                     r"row 3, column force \[N\]: is empty \(and 1 more row like it\); fill it, or leave"),
    "no place": (nonsense(rows=[(1, 5), ("", 6), (3, 7)]), r"row 3, column position \[m\]: is empty; fill"),
    "out of order": (nonsense(rows=[(1, 5), (3, 6), (2, 7), (4, 8)]), "position 3 = 2 m after 3 m: must go"),
    "no rows": (("position [m],force [N]", []), "there is no row below the header"),
    "one row": (nonsense(rows=[(1, 5)]), "must be a list of at least 2 numbers"),
    "all empty": (nonsense(rows=[(1, ""), (2, "")]), "must be a list of at least 2 numbers"),
    "labels and numbers": (("pass,position [m],force 1 [N],force 2 [N]", [(1, 1, 2, 3), (1, 2, 3, 4)]),
                           "a column pass and numbered columns: only one can say it"),
    "no label": (("pass,position [m],force [N]", [(1, 1, 2), ("", 2, 3)]), "row 3, column pass: is empty"),
    "no number of a support": (("support,uplift [mm]", [(5, 40), ("A", 50)]),
                               "row 3, column support: 'A' is no number of a support from 1"),
    "an uplift without value": (("uplift_support_5_mm,uplift_support_6_mm", [("", 40), ("", 41)]),
                                "the uplift of support 5 has no value"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_one_line(tmp_path, fault):
    (header, rows), said = FAULTS[fault]
    path = csv(tmp_path, header, rows)
    with pytest.raises(cf.InputError, match=said) as error:
        cf.read_line_test(path)
    (line,) = error.value.problems
    assert line.startswith(str(path)) and "\n" not in line


def test_commas_that_may_be_thousands(tmp_path):
    path = csv(tmp_path, "position [m];force [N]", [("1,250", "90"), ("1,500", "95")], ";")
    with pytest.raises(cf.InputError, match="row 2: 1,250 may be a decimal comma or a thousand"):
        cf.read_line_test(path)
    path = csv(tmp_path, "position [m];force [N]", [("1,25", "90.5"), ("1,5", "95.5")], ";")
    with pytest.raises(cf.InputError, match=r"row 2: 1,25 has a comma, 90.5 a point"):
        cf.read_line_test(path)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"froce": "a"}, "no quantity that is known; did you mean force"),
        ({"force[N]": "forc [N]"}, "no such column; did you mean force"),
        ({"force[kN]": "force [N]"}, "its unit is N, --map says kN; leave one out"),
        ({"force": 3}, "must be a heading, or several"),
        ({3: "force [N]"}, "must be a heading, or several"),
        ({"force": []}, "must be a heading, or several"),
        ("force", "must be headings by quantity"),
    ],
)
def test_maps_that_do_not_fit(tmp_path, columns, said):
    with pytest.raises(cf.InputError, match=said) as error:
        cf.read_line_test(csv(tmp_path, *nonsense()), columns=columns)
    assert len(error.value.problems) == 1


def test_every_kind_of_unit_has_factors():
    assert FACTORS["speed"]["km/h"] * 3.6 == pytest.approx(1) and FACTORS["time"]["ms"] == 1e-3


def test_a_workbook(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book, path = openpyxl.Workbook(), tmp_path / "m.xlsx"
    sheet = book.active
    sheet.append(["position [m]", "force [kN]", None])
    for row in zip(X.tolist(), (FORCE / 1e3).tolist(), strict=True):
        sheet.append(row)
    book.create_sheet("notes").append(["whatever"])
    book.save(path)
    test = cf.read_line_test(path)
    assert only(test).force == pytest.approx(FORCE)
    assert "sheet Sheet is read, not notes" in test.notes[0]
    sheet["B4"] = "abc"
    book.save(path)
    with pytest.raises(cf.InputError, match=r"row 4, column force \[kN\]: 'abc' is not a number"):
        cf.read_line_test(path)


def test_a_matlab_file(tmp_path):
    from scipy.io import savemat

    path = tmp_path / "m.mat"
    savemat(path, {"position_m": X, "force_N": FORCE, "note": "a text"})
    assert only(cf.read_line_test(path)).force == pytest.approx(FORCE)
    savemat(path, {"data": {"position_km": X / 1e3, "force_N": np.stack([FORCE, FORCE + 1], axis=1)}})
    test = cf.read_line_test(path)
    assert test.passes[1].force == pytest.approx(FORCE + 1)
    assert test.passes[1].position == pytest.approx(X)
    savemat(path, {"s": X, "F": FORCE})
    one = only(cf.read_line_test(path, columns={"position[m]": "s", "force[N]": "F"}))
    assert one.force == pytest.approx(FORCE)
    savemat(path, {"position_m": X[:-1], "force_N": FORCE})
    with pytest.raises(cf.InputError, match="columns of different lengths"):
        cf.read_line_test(path)


def test_a_tdms_file(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "m.tdms"
    waveform = {"wf_increment": 0.005, "wf_start_offset": 0.0, "unit_string": "N"}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject("group", "force", FORCE, properties=waveform)])
    one = only(cf.read_line_test(path))
    assert one.force == pytest.approx(FORCE)
    assert one.time == pytest.approx(0.005 * np.arange(8))
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("group", "chainage", X / 1e3, properties={"unit_string": "km"}),
            nptdms.ChannelObject("group", "Force (kN)", FORCE / 1e3),
        ])  # fmt: skip
    one = only(cf.read_line_test(path))
    assert one.position == pytest.approx(X)
    assert one.force == pytest.approx(FORCE)


def test_a_tdms_file_without_its_package(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "nptdms", None)
    (tmp_path / "m.tdms").write_bytes(b"TDSm")
    with pytest.raises(
        cf.InputError, match=r'needs the package npTDMS: pip install "catenary_fe\[measured\]"'
    ):
        cf.read_line_test(tmp_path / "m.tdms")


@pytest.mark.parametrize("kind", ["xlsx", "mat", "tdms", "csv"])
@pytest.mark.parametrize("content", [b"", b"nonsense " * 40, b"PK\x03\x04" + b"\0" * 200])
def test_damaged_files(tmp_path, kind, content):
    if kind == "tdms":
        pytest.importorskip("nptdms")
    path = tmp_path / f"m.{kind}"
    path.write_bytes(content)
    with pytest.raises(cf.InputError) as error:
        cf.read_line_test(path)
    (line,) = error.value.problems
    assert line.startswith(str(path)) and len(line) < 400


def test_a_matlab_file_of_the_new_kind(tmp_path):
    path = tmp_path / "m.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + b"\x89HDF\r\n\x1a\n" + b"\0" * 600)
    with pytest.raises(cf.InputError, match=r"version 7.3: save it with '-v7'"):
        cf.read_line_test(path)


@pytest.mark.parametrize("path", ["missing.csv", "m.doc", "run.nc", [], [3], ["missing.csv", None]])
def test_paths_of_no_measurement(tmp_path, monkeypatch, path):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(cf.InputError) as error:
        cf.read_line_test(path)
    assert len(error.value.problems) == 1
