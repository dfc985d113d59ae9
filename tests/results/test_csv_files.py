"""Numbers in CSV files have the digits that their units are worth."""

import pytest

from catenary_fe.results.export import cell, write_csv
from catenary_fe.results.quantities import OF_HISTORIES, decimals_of


@pytest.mark.parametrize(
    ("column", "value", "text"),
    [
        ("chainage_m", 79.17, "79.170"),
        ("length_m", 1.355969015136405, "1.3560"),
        ("contact_wire_height_error_mm", -0.0007, "0.00"),
        ("force_N", 98.5066, "98.5"),
        ("arm_stiffness_N_per_m", 300.0, "300.0"),
        ("elasticity_mm_per_N", 0.31159194, "0.3116"),
        ("contact_wire.tension", 20e3, "20000"),
        ("speed_kmh", 250.0, "250"),
        ("span", 3, 3),
        ("hangs_on", "messenger wire", "messenger wire"),
        ("arm_side", None, None),
    ],
)
def test_digits(column, value, text):
    assert cell(value, decimals_of(column)) == text


def test_a_history_keeps_micrometres():
    assert cell(3.728e-5, decimals_of("support_2_at_54_m_uplift_m", OF_HISTORIES)) == "0.000037"


def test_a_file(tmp_path):
    write_csv(tmp_path / "a.csv", ["span", "force_N"], [[1, 2.04], [2, float("nan")]])
    assert (tmp_path / "a.csv").read_bytes() == b"span,force_N\r\n1,2.0\r\n2,nan\r\n"
