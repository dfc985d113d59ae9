"""The table of figures: complete, and read by all that shows or writes them."""

from dataclasses import fields

import pytest
from made_runs import made_run

import catenary_fe as cf
from catenary_fe.results.comparison import COMPARED, key_figures
from catenary_fe.results.export import cell
from catenary_fe.results.quantities import (
    FACTORS,
    FORCE,
    OF_HISTORIES,
    OF_RUN,
    UPLIFT,
    decimals_of,
    figure_rows,
    in_short,
)
from catenary_fe.views.report.tables import statistics_table

ENDS = {"N": "_N", "mm": "_mm", "ms": "_ms", "%": "_percent", "": ""}


def test_each_statistic_of_the_force_is_in_the_table_once():
    own = {field.name for field in fields(cf.ForceStatistics)} - {"pantograph", "filter"}
    assert set(FORCE) == own
    keys = [q.key for q in (*FORCE.values(), *OF_RUN)]
    assert len(set(keys)) == len(keys) == len({q.label for q in (*FORCE.values(), *OF_RUN)})


@pytest.mark.parametrize("quantity", [*FORCE.values(), *OF_RUN], ids=lambda q: q.key)
def test_a_key_ends_with_the_unit_that_is_shown(quantity):
    assert quantity.key.endswith(ENDS[quantity.unit])
    assert quantity.si(quantity.shown(0.25)) == 0.25
    assert quantity.shown(1) == {"mm": 1000, "ms": 1000, "%": 100}.get(quantity.unit, 1)
    assert f"({quantity.unit}" in quantity.label if quantity.unit else "(" not in quantity.label
    assert quantity.unit in FACTORS


def test_texts_have_the_decimals_of_the_unit():
    assert [UPLIFT.number(v) for v in (51.06, None)] == ["51.1", "–"]
    shown = {q.unit: q.number(1.23456) for q in (*FORCE.values(), *OF_RUN)}
    assert shown == {"N": "1.2", "mm": "1.2", "ms": "1.2", "%": "1.23", "": "1"}
    assert FORCE["long_contact_loss"].label == "contact loss over 5 ms (% of the time)"
    rows = figure_rows([FORCE["std"], FORCE["long_losses"]], [{"std_N": 34.26, "losses_over_5_ms": 3}, {}])
    assert rows == [("standard deviation σ (N)", "34.3", "–"), ("number of losses over 5 ms", "3", "–")]


def test_summary_report_and_comparison_show_the_same():
    run = made_run()
    summary = run.summary()
    assert list(summary["pantographs"][0]) == ["name", *(q.key for q in FORCE.values())]
    assert all(q.key in summary for q in OF_RUN)
    table = statistics_table(run, "causal")
    compared = key_figures([run, run], ["a", "b"])[0].values
    assert list(compared) == [q.key for q in COMPARED]
    for (label, text), quantity in zip(table.rows, FORCE.values(), strict=True):
        assert (label, text) == (quantity.label, quantity.number(compared[quantity.key]))


def test_one_line_of_a_picture_and_heads_of_columns():
    (s,) = made_run().contact_force_statistics()
    low, high = FORCE["min"], FORCE["max"]
    assert in_short(s, ("mean", "std")) == f"mean {s.mean:.1f} N, σ {s.std:.1f} N"
    assert in_short(s, ("min", "max")) == f"min {s.min:.1f} N, max {s.max:.1f} N"
    assert low.text(s) == f"{s.min:.1f} N" and FORCE["long_losses"].text(s) == str(s.long_losses)
    heads = [q.short_label for q in (low, high, FORCE["long_contact_loss"], UPLIFT)]
    assert heads == ["min (N)", "max (N)", "loss > 5 ms (%)", "uplift (mm)"]


@pytest.mark.parametrize(
    ("column", "text"),
    [
        ("elasticity_mm_per_N", "0.1235"), ("arm_stiffness_N_per_m", "0.1"), ("wire_tension_kN", "0.123"),
        ("uplift_mm", "0.12"), ("chainage_m", "0.123"), ("length_m", "0.1235"),
        ("installed_length_m", "0.1235"), ("force_N", "0.1"), ("frequency_Hz", "0.1235"),
        ("arm_inclination_deg", "0.12"), ("contact_loss_percent", "0.123"), ("damping_ratio", "0.123457"),
        ("wall_s", "0.1235"), ("speed_kmh", "0.123456789"),
    ],
)  # fmt: skip
def test_numbers_in_files_have_the_decimals_that_their_unit_is_worth(column, text):
    assert cell(0.123456789, decimals_of(column)) == text


def test_histories_have_more_decimals_than_schedules():
    shown = [cell(0.123456789, decimals_of(f"x_{unit}", OF_HISTORIES)) for unit in ("m", "N", "s", "mm")]
    assert shown == ["0.123457", "0.12", "0.123457", "0.12"]
