"""What a report says at its head, and its table of uplifts, on runs whose histories are given."""

import json

import numpy as np
import pytest
from made_runs import made_line, made_pantograph, made_run

import catenary_fe as cf
from catenary_fe.results import Criterion
from catenary_fe.views.report.headline import (
    closest,
    criteria_bars,
    governing_figures,
    key_figures,
    why_it_governs,
)
from catenary_fe.views.report.tables import uplift_table
from catenary_fe.views.style import pantograph_colour


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
    shown = {figure.name: figure.values for figure in key_figures(run, "causal", s)}
    return shown, why_it_governs(run, s, rows)


def test_the_headline_has_both_pantographs_and_says_which_governs():
    """The trailing one misses σ; where both are good, the one with the larger σ governs."""
    run = two_heads(20.0, 40.0)
    shown, why = headline(run)
    assert [value.text for value in shown["standard deviation"]] == [
        f"{s.std:.1f} N" for s in run.contact_force_statistics()
    ]
    for values in (shown["mean force"], shown["actual minimum, maximum"]):
        assert [(value.who, value.governs) for value in values] == [("lead", False), ("trail", True)]
        assert [value.colour for value in values] == [pantograph_colour(0), pantograph_colour(1)]
    assert len(shown["largest uplift at a support"]) == 1
    assert why == "The pantograph that governs is trail, which misses a criterion."
    assert "trail, which misses a criterion by most" in headline(two_heads(36.0, 40.0))[1]
    shown, why = headline(two_heads(25.0, 20.0))
    assert "governs is lead, whose σ is the largest share of its mean force, 0.22." in why
    assert set(shown) >= {"contact loss over 5 ms", "largest uplift at a support"}


def test_the_headline_of_one_pantograph_and_of_none(short_run):
    shown, why = headline(short_run, "AC")
    (loss,) = shown["contact loss over 5 ms"]
    assert (why, loss.text, loss.who, loss.governs) == ("", "0.00 %", "", False)


def test_the_headline_of_a_run_that_ended_early():
    """The leading one had passed the evaluated spans, the trailing one had not; then neither."""
    why = json.dumps({"reason": "stopped", "reached_s": 1.95, "planned_s": 6.0})
    heads = made_pantograph(name="lead"), made_pantograph(name="trail")
    for times, texts in ((1951, ["not passed"]), (0, ["not passed"])):
        run = made_run(None, *heads, start=(5.0, 4.9), times=times or 501, partial=why)
        found = {figure.name: [v.text for v in figure.values] for figure in key_figures(run, "causal", None)}
        if times:
            mean = f"{run.figures()[0].mean:.1f} N"
            assert found["mean force"] == [mean, *texts]
            assert "largest uplift at a support" not in found
        else:
            assert found == {"evaluated spans": texts}


def test_bars_of_criteria_have_one_scale():
    """At 60 % and 120 % of their limits: the longer bar fills its room, the mark is at 100 % for both."""
    limit = {"limit": 100.0, "unit": "N", "source": "test"}
    rows = [
        Criterion(name="mean force", value=100.0, tolerance=0.1, **limit),
        Criterion(name="force", value=60.0, **limit),
        Criterion(name="loss", value=1.0, **limit | {"limit": None}),
    ]
    assert closest(rows)[0] == "Closest to its limit: force,"
    assert [bar.share for bar in criteria_bars(rows)] == ["100 %", "60 %", ""]
    rows += [Criterion(name="peak", value=120.0, **limit)]
    bars = criteria_bars(rows)
    assert [bar.width for bar in bars] == pytest.approx([100 / 1.2, 50, 0, 100])
    assert {round(bar.limit, 6) for bar in bars} == {round(100 / 1.2, 6)}
    assert [bar.verdict for bar in bars] == ["passed", "passed", "not judged", "missed"]
    said, bar = closest(rows)
    assert (said, bar.share) == ("Farthest beyond its limit: peak,", "120 %")
    (far,) = criteria_bars([Criterion(name="peak", value=900.0, **limit)])
    assert (far.share, far.width, far.limit) == ("over 200 %", 100, 50)
    assert closest([]) == ("", None)


def test_uplifts_are_those_that_are_judged():
    uplift = np.repeat([[0.9], [0.01], [0.02], [0.03], [0.04], [0.05], [0.9]], 2001, axis=1)
    table = uplift_table(made_run(support_uplift=uplift))
    assert [row[:3] for row in table.rows] == [
        (str(n), f"{50 * n - 50}", f"{10 * n - 10:.1f}") for n in range(2, 7)
    ]
    assert [row[3] for row in table.rows] == ["", "yes", "yes", "yes", ""]
