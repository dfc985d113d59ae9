"""A wire in gusts: against Green's function, closed forms of limits, and fields driven through its modes."""

import numpy as np
import pytest
from scipy import signal, stats
from theory_checks import beam_with

from catenary_fe.theory import (
    Gusts,
    String,
    generate_gusts,
    natural_frequencies,
    spectrum_of_string_response,
    static_uniform_load,
    variance_of_string_response,
)

WIRE, LENGTH = String(tension=15e3, mass_per_length=1.35), 50.0
VALUES = {"mean_speed": 30.0, "intensity": 0.15, "length_scale": 60.0, "decay": 10.0}
GUSTS = Gusts(**VALUES)
CASE = {"length": LENGTH, "damping": 0.9, "load_per_speed": 0.4}
PLACES = np.array([0.25, 0.5]) * LENGTH


def changed(**values):
    """The gusts with other values."""
    return Gusts(**(VALUES | values))


def response_over(f):
    """|H_n|² [m⁴/N²] of the modes' amplitudes to their load, n = 1 … 200, at frequencies f."""
    natural = natural_frequencies(WIRE, 200, length=LENGTH)
    omega = 2.0 * np.pi * np.asarray(f)[..., None]
    mass = WIRE.mass_per_length * LENGTH / 2.0
    return 1.0 / (mass * np.abs(natural**2 - omega**2 + 1j * omega * 0.9 / WIRE.mass_per_length)) ** 2


def joint(green, decay):
    """∫∫ G(s) G*(s') exp(−a|s − s'|) ds ds' over the wire: twice the part with s' before s, cell by cell."""
    edges = np.linspace(0.0, LENGTH, 201)
    nodes, weights = (part / 2.0 for part in np.polynomial.legendre.leggauss(6))
    cell = edges[1]
    inside = cell * (0.5 + nodes)  # of a cell, from its beginning
    s = edges[:-1, None] + inside
    before = edges[:-1, None, None] + inside[:, None] * (0.5 + nodes)  # from the cell's beginning to s
    started = inside * np.sum(weights * green(before) * np.exp(-decay * (s[..., None] - before)), axis=2)
    whole = cell * np.sum(weights * green(s) * np.exp(-decay * (edges[1:, None] - s)), axis=1)
    carried = np.zeros(edges.size, dtype=complex)  # what all cells before have at an edge
    for i, part in enumerate(whole):
        carried[i + 1] = carried[i] * np.exp(-decay * cell) + part
    inner = started + carried[:-1, None] * np.exp(-decay * inside)
    return 2.0 * cell * np.sum(weights * green(s) * np.conj(inner)).real


@pytest.mark.parametrize("decay", [0.0, 1.0, 10.0, 60.0])
@pytest.mark.parametrize("f", [0.02, 1.0, 1.054, 2.7, 6.0])
def test_spectrum_equals_greens_function(f, decay):
    """Of the string at rest at its ends, without a mode."""
    omega, tension = 2.0 * np.pi * f, WIRE.tension
    kappa = np.sqrt((WIRE.mass_per_length * omega**2 - 1j * omega * 0.9) / tension)
    for place in PLACES:

        def green(s, x=place):
            near, far = np.minimum(s, x), LENGTH - np.maximum(s, x)
            return np.sin(kappa * near) * np.sin(kappa * far) / (tension * kappa * np.sin(kappa * LENGTH))

        direct = 0.4**2 * GUSTS.spectrum(f) * joint(green, decay * f / 30.0)
        gusts, other = changed(decay=decay), changed(decay=1.01 * decay + 0.1)
        modal = spectrum_of_string_response(WIRE, place, f, gusts, **CASE, modes=200)
        assert modal == pytest.approx(direct, rel=1e-5)
        off = spectrum_of_string_response(WIRE, place, f, other, **CASE, modes=200)
        assert off != pytest.approx(direct, rel=1e-5)


def test_slow_gusts_that_are_the_same_everywhere_act_as_a_steady_load():
    """(k σ ℓ²/8T)² at mid-span; of a beam likewise."""
    slow = changed(decay=0.0, length_scale=1e6)
    sag = 0.4 * slow.standard_deviation * LENGTH**2 / (8.0 * WIRE.tension)
    case = {**CASE, "damping": 5.0}
    assert variance_of_string_response(WIRE, LENGTH / 2, slow, **case) == pytest.approx(sag**2, rel=5e-4)
    stiff = beam_with(2e5)
    sags = static_uniform_load(stiff, PLACES, length=LENGTH, load=0.4 * slow.standard_deviation)
    variances = variance_of_string_response(stiff, PLACES, slow, **case)
    assert variances == pytest.approx(sags**2, rel=5e-4)
    assert variance_of_string_response(beam_with(0.0), PLACES, slow, **case) != pytest.approx(
        sags**2, rel=5e-4
    )


def test_gusts_that_are_white_in_time_and_the_same_everywhere():
    """Two modes of one damping β = c/ρ under white noise of the density S₀ share 2β/[(ω_n² − ω_m²)² +
    2β² (ω_n² + ω_m²)] S₀/2 of their loads' product.
    """
    white = changed(decay=0.0, length_scale=1e-4)
    n = np.arange(1, 400, 2)
    squares = natural_frequencies(WIRE, 400, length=LENGTH)[::2] ** 2
    beta = 0.9 / WIRE.mass_per_length
    loads = 0.4 * 4.0 / (np.pi * n * WIRE.mass_per_length) * (-1.0) ** (n // 2)
    shared = 2.0 * beta / ((squares[:, None] - squares) ** 2 + 2.0 * beta**2 * (squares[:, None] + squares))
    closed = 0.5 * white.spectrum(0.0) * loads @ shared @ loads
    computed = variance_of_string_response(WIRE, LENGTH / 2, white, **CASE)
    assert computed == pytest.approx(closed, rel=1e-4)
    alone = 0.5 * white.spectrum(0.0) * np.sum(loads**2 * np.diag(shared))
    assert computed != pytest.approx(alone, rel=1e-4)  # modes are not independent of each other


def test_gusts_that_are_white_along_the_wire():
    """exp(−a|Δx|) → (2/a) δ(Δx): each mode for itself, S_v = k² S (2/a) (ℓ/2) Σ |H_n|² sin²."""
    f = np.array([0.3, 1.05, 2.0, 4.0])
    white = changed(decay=1e6)
    shapes = np.sin(np.outer(np.arange(1, 201) * np.pi / LENGTH, PLACES)) ** 2
    closed = 0.4**2 * white.spectrum(f) * LENGTH * 30.0 / (1e6 * f)
    computed = spectrum_of_string_response(WIRE, PLACES, f, white, **CASE, modes=200)
    assert computed == pytest.approx(closed[:, None] * (response_over(f) @ shapes), rel=1e-3)


def test_lightly_damped_wire_answers_at_its_resonances():
    """Variance of each mode: its load's density at ω_n over 4 β ω_n² and its mass squared."""
    beta, mass = 1e-6, WIRE.mass_per_length * LENGTH / 2.0
    natural = natural_frequencies(WIRE, 60, length=LENGTH)
    f, k = natural / (2.0 * np.pi), np.arange(1, 61) * np.pi / LENGTH
    a = 10.0 * f / 30.0
    both = 1.0 - (-1.0) ** np.arange(1, 61) * np.exp(-a * LENGTH)
    joint = a * LENGTH / (a**2 + k**2) + 2.0 * k**2 * both / (a**2 + k**2) ** 2
    each = 0.4**2 * GUSTS.spectrum(f) * joint / (4.0 * beta * natural**2 * mass**2)
    closed = each @ np.sin(np.outer(k, PLACES)) ** 2
    case = {**CASE, "damping": beta * WIRE.mass_per_length}
    assert variance_of_string_response(WIRE, PLACES, GUSTS, **case) == pytest.approx(closed, rel=1e-4)


@pytest.mark.parametrize("damping", [0.02, 0.9, 50.0])
@pytest.mark.parametrize("decay", [0.0, 10.0])
def test_variance_is_the_integral_of_the_spectrum(damping, decay):
    """Against a sum in even steps, and more modes."""
    case, gusts = {**CASE, "damping": damping}, changed(decay=decay)
    step = 2e-4
    f = np.arange(0.5 * step, 40.0, step)
    total = step * spectrum_of_string_response(WIRE, PLACES, f, gusts, **case, modes=30).sum(axis=0)
    computed = variance_of_string_response(WIRE, PLACES, gusts, **case)
    assert computed == pytest.approx(total, rel=1e-4)
    assert computed == pytest.approx(
        variance_of_string_response(WIRE, PLACES, gusts, **case, modes=150), rel=1e-4
    )


@pytest.fixture(scope="module")
def variances():
    """[m²] of the deflection in 60 histories, shape (seeds, places): gusts every half metre through modes.

    Each mode's equation is solved exactly for loads that are straight between instants.
    """
    stations, step, modes = np.linspace(0.0, LENGTH, 101), 0.02, 10
    natural = natural_frequencies(WIRE, modes, length=LENGTH)
    shapes = np.sin(np.outer(np.arange(1, modes + 1) * np.pi / LENGTH, stations))
    steps = np.full(stations.size, stations[1])
    steps[[0, -1]] *= 0.5
    mass, beta = WIRE.mass_per_length * LENGTH / 2.0, 0.9 / WIRE.mass_per_length
    filters = [
        signal.cont2discrete(([1.0 / mass], [1.0, beta, omega**2]), step, method="foh") for omega in natural
    ]
    t = np.arange(0.0, 300.0, step)
    found = []
    for seed in range(60):
        field = generate_gusts(GUSTS, stations, duration=300.0, seed=seed, cut_off=6.0)
        loads = (0.4 * shapes * steps) @ field.at(t)
        motions = [signal.lfilter(b[0], a, load) for (b, a, _), load in zip(filters, loads, strict=True)]
        deflection = np.sin(np.outer(PLACES / LENGTH, np.arange(1, modes + 1) * np.pi)) @ motions
        found.append(np.mean(deflection[:, t > 30.0] ** 2, axis=1))  # the start is forgotten: exp(−10)
    return np.array(found)


@pytest.mark.parametrize("place", [0, 1])
def test_variance_equals_that_of_histories(variances, place):
    """Within the error of the mean over seeds, at 99 %, 2 % large; a tenth of a value off is outside."""
    mean, error = variances[:, place].mean(), stats.sem(variances[:, place])
    bound = stats.t.ppf(0.995, 59) * error

    def missed(gusts, **values):
        case = {**CASE, **values}
        return abs(variance_of_string_response(WIRE, PLACES[place], gusts, **case) - mean) > bound

    assert error < 0.02 * mean
    assert not missed(GUSTS)
    for off in (0.9, 1.1):
        assert missed(changed(intensity=off * 0.15))
        assert missed(changed(mean_speed=off * 30.0))
        assert missed(GUSTS, load_per_speed=off * 0.4)
    for decay in (5.0, 7.0, 20.0):  # 5: were the coherence of squares, not of amplitudes
        assert missed(changed(decay=decay))


def test_shapes_of_answers():
    f = np.ones((2, 3))
    assert spectrum_of_string_response(WIRE, PLACES, f, GUSTS, **CASE).shape == (2, 3, 2)
    assert variance_of_string_response(WIRE, 3.0, GUSTS, **CASE).shape == ()
    ends = variance_of_string_response(WIRE, [0.0, LENGTH], GUSTS, **CASE)
    assert np.all(ends < 1e-30)
    one = variance_of_string_response(WIRE, PLACES, GUSTS, **CASE, modes=1)
    assert one[0] == pytest.approx(0.5 * one[1])


CASES = [
    ({"damping": 0.0}, "damping = 0 N s/m²: must be positive and finite; give some"),
    ({"length": -1.0}, "length = -1 m"),
    ({"load_per_speed": np.nan}, "load_per_speed = nan N s/m²"),
    ({"modes": 0}, "count = 0"),
    ({"x": 51.0}, "x = 51 m: must lie on the wire"),
    ({"gusts": 30.0}, "gusts = 30.0: must be a theory.Gusts"),
    ({"wire": 3.0}, "wire = 3.0: must be a theory.String"),
]


@pytest.mark.parametrize(("values", "message"), CASES)
def test_bad_input_is_refused_in_one_line(values, message):
    given = {"wire": WIRE, "x": 25.0, "gusts": GUSTS, **CASE, **values}
    for function, more in ((variance_of_string_response, {}), (spectrum_of_string_response, {"f": 1.0})):
        with pytest.raises(ValueError, match=message) as caught:
            function(**given, **more)
        text = str(caught.value)
        assert "\n" not in text
        assert " = " in text and ": " in text and "; " in text  # what = value: rule; remedy
