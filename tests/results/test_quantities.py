"""The table of figures: complete, and read by all that shows or writes them."""

from dataclasses import fields

import pytest
from made_runs import made_run

import catenary_fe as cf
from catenary_fe.results.comparison import COMPARED, key_figures
from catenary_fe.results.quantities import FACTORS, FORCE, OF_RUN, UPLIFT, figure_rows
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
