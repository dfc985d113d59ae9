"""What a report says at its head, and its table of uplifts, on runs whose histories are given."""

import numpy as np
from made_runs import made_line, made_pantograph, made_run

import catenary_fe as cf
from catenary_fe.views.report.tables import governing_figures, key_figures, uplift_table, why_it_governs


def two_heads(lead, trail, **others):
    """Two pantographs of 115 N mean force whose σ is so large, at 180 km/h."""
    time = 1e-3 * np.arange(4001)
    force = 115 + np.sqrt(2) * np.array([[lead], [trail]]) * np.sin(2 * np.pi * 3 * time)
    pantographs = made_pantograph(name="lead"), made_pantograph(name="trail")
    return made_run(
        made_line(), *pantographs, start=(8.0, 5.0), step=1e-3, times=4001, contact_force=force, **others
    )


def headline(run, system="DC 3 kV"):
    rows = cf.criteria_rows(run, system)
    s = governing_figures(run, "causal", rows)
    shown = {item["name"]: item["value"] for item in key_figures(run, s)}
    return shown, why_it_governs(run, s, rows)


def test_the_headline_is_of_the_pantograph_that_governs():
    """The trailing one misses σ; where both are good, the one with the larger σ is shown."""
    run = two_heads(20.0, 40.0)
    shown, why = headline(run)
    assert shown["standard deviation"] == f"{run.contact_force_statistics()[1].std:.1f} N"
    assert why == "The figures are those of the pantograph that governs: trail, which misses a criterion."
    assert "trail, which misses a criterion by most" in headline(two_heads(36.0, 40.0))[1]
    shown, why = headline(two_heads(25.0, 20.0))
    assert "governs: lead, whose σ is the largest share of its mean force, 0.22." in why
    assert set(shown) >= {"contact loss over 5 ms", "largest uplift at a support"}


def test_the_headline_of_one_pantograph_and_of_none(short_run):
    shown, why = headline(short_run, "AC")
    assert (why, shown["contact loss over 5 ms"]) == ("", "0.00 %")
    assert key_figures(short_run, None) == [{"name": "evaluated spans", "value": "not passed"}]


def test_uplifts_are_those_that_are_judged():
    uplift = np.repeat([[0.9], [0.01], [0.02], [0.03], [0.04], [0.05], [0.9]], 2001, axis=1)
    table = uplift_table(made_run(support_uplift=uplift))
    assert [row[:3] for row in table.rows] == [
        (str(n), f"{50 * n - 50}", f"{10 * n - 10:.1f}") for n in range(2, 7)
    ]
    assert [row[3] for row in table.rows] == ["", "yes", "yes", "yes", ""]
