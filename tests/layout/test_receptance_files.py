"""Pantographs from tables of receptances: columns, faults, what stays of the table."""

from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout import recorded_pantograph
from catenary_fe.layout.rules import pantograph_warnings

FREQUENCIES = np.geomspace(0.2, 40.0, 60)
TWO_MASSES = cf.library.pantograph("EN 50318:2002")
RESPONSE = cf.pantograph_response(TWO_MASSES, FREQUENCIES.tolist())


def table(heading: str, values: np.ndarray, frequency: np.ndarray = FREQUENCIES, sign: float = 1.0) -> str:
    rows = zip(frequency, abs(values), sign * np.angle(values, deg=True), strict=True)
    return "\n".join(
        [f"Frequency [Hz],{heading},phase (deg)", *(",".join(map(repr, map(float, r))) for r in rows)]
    )


def written(folder: Path, text: str, keys: str = "uplift_force = 120.0") -> Path:
    (folder / "head.csv").write_text(text)
    path = folder / "head.toml"
    path.write_text(f'receptance = "head.csv"\n{keys}\n')
    return path


@pytest.mark.parametrize(
    ("heading", "values"),
    [
        ("receptance_m_per_N", RESPONSE.receptance),
        ("receptance [mm/N]", 1e3 * RESPONSE.receptance),
        ("apparent_mass_kg", RESPONSE.apparent_mass),
        ("dynamic stiffness (N/mm)", RESPONSE.dynamic_stiffness / 1e3),
    ],
)
def test_each_kind_of_table_is_the_same_pantograph(tmp_path, heading, values):
    found = cf.load_pantograph(written(tmp_path, table(heading, values)))
    assert isinstance(found, cf.ReceptancePantograph)
    np.testing.assert_allclose(found.measured[1], RESPONSE.receptance, rtol=1e-9)
    assert found.masses == pytest.approx((7.2, 15.0), rel=1e-6)
    heavier = cf.load_pantograph(
        written(tmp_path, table(heading, values * (1.01 if "mass" in heading else 1.0)))
    )
    assert heavier.masses[1] == pytest.approx(15.15 if "mass" in heading else 15.0, rel=1e-6)


def test_at_rest_the_head_presses_with_the_uplift(tmp_path):
    found = cf.load_pantograph(written(tmp_path, table("receptance_m_per_N", RESPONSE.receptance)))
    by_height = cf.pantograph_response(found)
    assert np.interp(0.0, by_height.height, by_height.force) == pytest.approx(120.0 * 4200 / 4250, rel=1e-6)
    free = cf.load_pantograph(
        written(
            tmp_path,
            table("receptance_m_per_N", RESPONSE.receptance),
            "uplift_force = 120.0\nstatic_stiffness = 0.0",
        )
    )
    np.testing.assert_allclose(cf.pantograph_response(free).force, 120.0, rtol=1e-9)


def test_a_record_needs_no_table(tmp_path):
    path = written(
        tmp_path, table("receptance_m_per_N", RESPONSE.receptance), 'mean_force = "EN 50367 AC"\norder = 2'
    )
    found = cf.load_pantograph(path)
    (tmp_path / "head.csv").unlink()
    again = recorded_pantograph(found.model_dump(mode="json"))
    assert again == found and again.assemble(spatial=False) == found.assemble(spatial=False)
    assert again.target_mean_force(70.0) == TWO_MASSES.replace(
        mean_force="EN 50367 AC", uplift_force=None
    ).target_mean_force(70.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (table("receptance_m_per_N", RESPONSE.receptance, sign=-1.0), "turn the phases' sign"),
        (table("receptance_m_per_N", RESPONSE.receptance, FREQUENCIES[::-1]), "frequencies must rise"),
        (table("receptance", RESPONSE.receptance), "the unit is missing"),
        (table("phase_rad", RESPONSE.receptance), "is there twice"),
        ("frequency_Hz,phase_deg\n1,-90\n", "0 columns of a magnitude"),
        ("frequency_Hz,receptance_m_per_N,phase_deg\n0,0.02,0\n1,,-90\n", "row 2, column frequency_Hz: is 0"),
        ("frequency_Hz,receptance_m_per_N,phase_deg\n1,0.02,-10\n", "1 frequencies: must be at least 12"),
    ],
)  # fmt: skip
def test_faults_of_a_table(tmp_path, text, said):
    with pytest.raises(cf.InputError) as error:
        cf.load_pantograph(written(tmp_path, text))
    assert said in str(error.value)


def test_a_table_lies_beside_its_file(tmp_path):
    path = written(tmp_path, "")
    path.write_text('receptance = "../head.csv"\nuplift_force = 100.0')
    with pytest.raises(cf.InputError, match="a table beside this file"):
        cf.load_pantograph(path)
    with pytest.raises(cf.InputError, match="load_pantograph reads a file with its table"):
        cf.ReceptancePantograph(receptance="head.csv", uplift_force=100.0)


def test_warnings(tmp_path):
    """Of a table that ends early, begins late, and is not that of masses, springs and dampers."""

    def warned(response: np.ndarray, keys: str = "", part: slice = slice(None)) -> str:
        text = table("receptance_m_per_N", response[part], FREQUENCIES[part])
        return "\n".join(
            pantograph_warnings(
                cf.load_pantograph(written(tmp_path, text, f"uplift_force = 120.0\n{keys}")), 70.0
            )
        )

    assert warned(RESPONSE.receptance) == ""
    part = slice(15, 45)
    assert "begins at" in warned(RESPONSE.receptance, part=part) and "ends at" in warned(
        RESPONSE.receptance, part=part
    )
    assert "begins at" not in warned(RESPONSE.receptance, "static_stiffness = 49.0", part)
    assert "another order" in warned(RESPONSE.receptance, "order = 1")
