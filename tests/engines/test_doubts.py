"""When a linearised run doubts itself: the rule, its words, and that both methods agree elsewhere."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.linearised.doubts import slack_doubts, tension_doubts
from catenary_fe.fe.reduction import Gaps

STEP = 2e-3


@pytest.fixture(scope="module")
def re330(reference_layout):
    """Contact wire 27 kN, messenger wire 21 kN, stitch wires 3.5 kN, the first of them at support 2."""
    return cf.load_catenary(reference_layout.with_name("re330.toml"))


# contact wire, messenger wire, stitch wires at supports 2 and 3
GAPS = Gaps(
    wire=np.array([0, 0, 1, 1, 2, 3]),
    ends=np.array([[60, 65], [65, 70], [60, 65], [74, 79.17], [60, 65], [130, 135]]),
    tension=np.array([27e3, 27e3, 17.5e3, 21e3, 3.5e3, 3.5e3]),
)


@cache
def system_of(line):
    return cf.find_form(line).system


def said(line, *newtons, gaps=GAPS):
    changes, steps = np.array(newtons, dtype=float), 100 * np.arange(len(newtons))
    return tension_doubts(system_of(line), line.support_positions, gaps, changes, steps, STEP)


def test_a_stitch_wire_that_changes_by_9_percent_is_not_worth_a_word(re330):
    assert said(re330, 80, 60, 330, 350, 315, 300) == []


def test_tension_is_judged_by_what_carries_there(re330):
    """1.5 % of 27 kN for the contact wire, of 48 kN for what hangs over it."""
    assert said(re330, 404, 0, 719, 719, 719, 719) == []
    (contact,) = said(re330, 406, 0, 0, 0, 0, 0)
    assert (
        "contact wire in span 1, between 60 and 65 m, changes by 406 N at 0.00 s, 1.5 % of its own, 27 kN;"
        in contact
    )
    (messenger,) = said(re330, 0, 0, 0, 960, 0, 0)
    assert (
        "messenger wire in span 2, between 74 and 79.17 m, changes by 960 N at 0.60 s, 2.0 % of" in messenger
    )
    assert "that of contact and messenger wires together, 48 kN" in messenger
    (stitch,) = said(re330, 0, 0, 0, 725, 0, 730)
    assert "the stitch wire at support 3 changes by 730 N at 1.00 s" in stitch
    assert stitch.endswith("run again with the method nonlinear")


def test_two_contact_wires_carry_together(reference_layout):
    twin = cf.load_catenary(reference_layout.with_name("dc_3kv_twin.toml"))
    gaps = replace(GAPS, wire=np.array([0, 1, 2, 2, 2, 2]))
    own, together = twin.contact_wire.tension, 2 * twin.contact_wire.tension + twin.messenger_wire.tension
    assert said(twin, 0, 0.0149 * own, 0.0149 * together, 0, 0, 0, gaps=gaps) == []
    assert "the left contact wire in span 2," in said(twin, 0, 0.0151 * own, 0, 0, 0, 0, gaps=gaps)[0]
    assert "the right contact wire in span 2," in said(twin, 0.0151 * own, 0, 0, 0, 0, 0, gaps=gaps)[0]
    assert f"together, {together / 1e3:.4g} kN" in said(twin, 0, 0, 0.0151 * together, 0, 0, 0, gaps=gaps)[0]


def test_a_dropper_that_shortens_too_far_is_named(re330):
    shortening, steps = np.zeros(len(re330.droppers)), np.zeros(len(re330.droppers), dtype=int)
    shortening[[3, 9]], steps[9] = 0.0999, 350
    assert slack_doubts(re330, shortening, steps, STEP) == []
    shortening[9] = 0.123
    (text,) = slack_doubts(re330, shortening, steps, STEP)
    assert "dropper 3 of span 2, at 88.33 m, is slack at 0.70 s and shortens by 123 mm;" in text
    assert slack_doubts(re330, np.zeros(0), np.zeros(0, dtype=int), STEP) == []


@pytest.mark.slow
@pytest.mark.parametrize(("uplift", "doubts"), [(160.0, 0), (250.0, 0), (1000.0, 2)])
def test_where_it_is_silent_both_methods_agree(re330, uplift, doubts):
    """σ within 0.5 %, the filtered force within 3 % of it; pushed by 1000 N, it is 15 % off."""
    line = re330.replace(spans=re330.spans[:6], supports=re330.supports[:7], evaluated_spans=(3, 4))
    head = cf.library.pantograph("DSA380").replace(
        mean_force=None, uplift_force=uplift, aerodynamic_force=cf.AerodynamicForce()
    )
    shape = cf.find_form(line)
    ours, theirs = (
        cf.simulate(shape, [head], speed=300 / 3.6, method=method) for method in ("linearised", "nonlinear")
    )
    assert sum(w.startswith("linearised run: ") for w in ours.warnings) == doubts
    inside = ours.window(0)
    a, b = (run.filtered_contact_force()[0, inside] for run in (ours, theirs))
    off, sigma = np.sqrt(np.mean((a - b) ** 2)), b.std()
    assert (off < 0.03 * sigma) == (doubts == 0)
    if not doubts:
        assert a.std() == pytest.approx(sigma, rel=0.005)
