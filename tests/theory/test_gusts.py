"""Gusts: closed forms of the spectrum, and fields against it in bounds that a tenth of a value off leaves."""

import os
import subprocess
import sys

import numpy as np
import pytest
from scipy import integrate, special, stats

from catenary_fe.theory import Gusts, generate_gusts
from tests.conftest import refused_in_one_line

VALUES = {"mean_speed": 25.0, "intensity": 0.16, "length_scale": 80.0, "decay": 10.0}
GUSTS, SIGMA = Gusts(**VALUES), 4.0
STATIONS = np.array([0.0, 6.0, 15.0, 400.0])
SEEDS, DURATION, CUT_OFF, RATE = 400, 240.0, 4.0, 10.0  # [-], [s], [Hz], [Hz] of the samples
T = np.arange(int(DURATION * RATE)) / RATE
WINDOW = np.hanning(T.size + 1)[:-1]
# every third Fourier coefficient up to the cut-off: under this window, these are independent of each other
KEPT = slice(3, int(CUT_OFF * DURATION) - 3, 3)


def changed(**values):
    """The gusts with other values."""
    return Gusts(**(VALUES | values))


@pytest.fixture(scope="module")
def histories():
    """[m/s] shape (seeds, stations, instants)."""
    made = [
        generate_gusts(GUSTS, STATIONS, duration=DURATION, seed=seed, cut_off=CUT_OFF)
        for seed in range(SEEDS)
    ]
    return np.array([field.at(T) for field in made])


def coefficients(histories):
    """Fourier coefficients of windowed histories."""
    return np.fft.rfft(histories * WINDOW, axis=-1)[..., KEPT]


def expected(gusts, separation=0.0):
    """Mean products of two places' coefficients: the cross spectrum up to the cut-off, leakage included.

    The spectrum is written anew here, and taken eight times finer than the coefficients.
    """
    size = 8 * T.size
    f = np.abs(np.fft.fftfreq(size, 1.0 / RATE))
    time, sigma = gusts.length_scale / gusts.mean_speed, gusts.intensity * gusts.mean_speed
    one_sided = 4.0 * sigma**2 * time / (1.0 + 70.8 * (f * time) ** 2) ** (5 / 6)
    cross = one_sided * np.exp(-gusts.decay * f * separation / gusts.mean_speed) * (f <= CUT_OFF)
    covariance = np.fft.ifft(cross / 2.0) * RATE
    windows = np.fft.ifft(np.abs(np.fft.fft(WINDOW, size)) ** 2)
    return np.fft.fft(covariance * windows).real[::8][: T.size // 2 + 1][KEPT]


def missed_bands(power):
    """In how many of six bands a sum of complex Gaussians' squares of mean 1 leaves what chance allows.

    power : shape (seeds, coefficients); twice a sum of n of them is chi-square of 2n degrees, and all six
        bands together stay in their intervals in 99 % of cases
    """
    cuts = np.geomspace(8, power.shape[1], 7).astype(int)
    missed = 0
    for low, high in zip([0, *cuts[1:-1]], cuts[1:], strict=True):
        band = power[:, low:high]
        tail = stats.chi2.cdf(2.0 * band.sum(), 2 * band.size)
        missed += 2.0 * min(tail, 1.0 - tail) < 0.01 / 6
    return missed


def missed_by_spectrum(histories, gusts, station):
    """The periodograms of one station against the spectrum."""
    return missed_bands(np.abs(coefficients(histories[:, station])) ** 2 / expected(gusts))


def missed_by_coherence(histories, gusts, one, other):
    """Difference and sum of two stations against their spectra S (1 ∓ coh): chi-square, and free of bias.

    The usual estimate of the squared coherence γ² over n coefficients is not: it is (1 − γ²)²/n too large.
    """
    own = expected(gusts)
    ratio = expected(gusts, abs(STATIONS[one] - STATIONS[other])) / own
    first, second = coefficients(histories[:, one]), coefficients(histories[:, other])
    missed = 0
    for sign in (-1.0, 1.0):
        missed += missed_bands(np.abs(first + sign * second) ** 2 / (2.0 * own * (1.0 + sign * ratio)))
    return missed


def test_spectrum_has_the_variance_and_the_scale():
    assert integrate.quad(GUSTS.spectrum, 0.0, np.inf, limit=200)[0] == pytest.approx(SIGMA**2, rel=1e-6)
    for f in (0.01, 0.3, 20.0):
        share = integrate.quad(GUSTS.spectrum, 0.0, f, limit=200)[0] / SIGMA**2
        assert GUSTS.share_below(f) == pytest.approx(share, rel=1e-9)
    assert GUSTS.share_below([0.0, 1e9]) == pytest.approx([0.0, 1.0], abs=1e-5)
    # the printed form, and the scale as the integral of the correlation over time: a quarter of S(0)
    n = 0.3 * 80.0 / 25.0
    assert 0.3 * GUSTS.spectrum(0.3) == pytest.approx(
        16.0 * 4.0 * n / (1.0 + 70.8 * n * n) ** (5 / 6), rel=3e-4
    )
    assert GUSTS.spectrum(0.0) / 4.0 == pytest.approx(SIGMA**2 * 80.0 / 25.0)


@pytest.mark.parametrize("lag", [0.1, 1.0, 5.0])
def test_spectrum_is_the_transform_of_karmans_correlation(lag):
    back = integrate.quad(GUSTS.spectrum, 0.0, np.inf, weight="cos", wvar=2.0 * np.pi * lag, limlst=200)[0]

    def correlation(scale):
        s = lag * 25.0 / (1.339 * scale)
        return 2.0 ** (2 / 3) / special.gamma(1 / 3) * s ** (1 / 3) * special.kv(1 / 3, s)

    assert 1.0 - back / SIGMA**2 == pytest.approx(1.0 - correlation(80.0), rel=1e-3)
    assert 1.0 - back / SIGMA**2 != pytest.approx(1.0 - correlation(81.0), rel=1e-3)


def test_coherence_is_that_of_amplitudes_and_positive_definite():
    assert GUSTS.coherence(0.5, [-10.0, 0.0]) == pytest.approx([np.exp(-2.0), 1.0])
    apart = STATIONS[:, None] - STATIONS
    for f in (0.001, 0.1, 2.0):
        assert np.linalg.eigvalsh(GUSTS.coherence(f, apart)).min() > 0.0
    assert np.all(changed(decay=0.0).coherence(f, apart) == 1.0)


@pytest.mark.parametrize("station", range(4))
def test_field_has_the_spectrum(histories, station):
    assert missed_by_spectrum(histories, GUSTS, station) == 0
    for off in (0.9, 1.1):
        assert missed_by_spectrum(histories, changed(length_scale=off * 80.0), station) > 0
        assert missed_by_spectrum(histories, changed(intensity=off * 0.16), station) > 0


@pytest.mark.parametrize(("one", "other"), [(0, 1), (1, 2), (0, 2)])
def test_field_has_the_coherence(histories, one, other):
    assert missed_by_coherence(histories, GUSTS, one, other) == 0
    for off in (0.9, 1.1):
        assert missed_by_coherence(histories, changed(decay=10.0 * off), one, other) > 0


def test_far_stations_share_slow_gusts_only(histories):
    assert missed_by_coherence(histories, GUSTS, 0, 3) == 0
    assert missed_by_coherence(histories, changed(decay=1.0), 0, 3) > 0


def test_no_gust_is_late(histories):
    """The imaginary part of the cross spectrum is zero within its error; with a delay of 50 ms it is not."""

    def lateness(delay):
        first, second = coefficients(histories[:, 0]), coefficients(histories[:, 1])
        f = np.fft.rfftfreq(T.size, 1.0 / RATE)[KEPT]
        products = (first * np.conj(second) * np.exp(2j * np.pi * f * delay)).imag / expected(GUSTS)
        return abs(products.mean()) / (products.std() / np.sqrt(products.size))

    assert lateness(0.0) < 2.6
    assert lateness(0.05) > 5.0


def test_field_has_the_variance(histories):
    share = generate_gusts(GUSTS, [0.0], duration=DURATION, seed=0, cut_off=CUT_OFF).variance_share
    assert share == pytest.approx(float(GUSTS.share_below(CUT_OFF)), rel=1e-4)
    own = np.mean(histories[:, [0, 3]] ** 2, axis=(1, 2))
    error = stats.sem(own)
    assert error < 0.02 * SIGMA**2
    assert abs(own.mean() - share * SIGMA**2) < stats.t.ppf(0.995, SEEDS - 1) * error
    assert abs(own.mean() - share * (1.1 * SIGMA) ** 2) > stats.t.ppf(0.995, SEEDS - 1) * error
    first, _, last = (np.mean(part[:, 0] ** 2, axis=1) for part in np.array_split(histories, 3, axis=2))
    assert stats.ttest_ind(first, last).pvalue > 0.01  # it is as gusty in the end as in the beginning
    assert stats.ttest_ind(first, 1.21 * last).pvalue < 0.01


def test_field_is_gaussian(histories):
    apart = histories[:, [0, 3], :: int(20.0 * RATE)].ravel()  # 20 s: six times L/U
    deviation = SIGMA * np.sqrt(float(GUSTS.share_below(CUT_OFF)))
    assert stats.kstest(apart, stats.norm(scale=deviation).cdf).pvalue > 0.01
    assert stats.kstest(apart, stats.norm(scale=1.2 * deviation).cdf).pvalue < 0.01
    power = np.abs(coefficients(histories[:, 0])) ** 2 / expected(GUSTS)
    assert stats.kstest(power.ravel(), "expon").pvalue > 0.01  # at each frequency, too
    assert power.std(axis=0).mean() == pytest.approx(1.0, abs=0.1)  # with phases alone by chance: 0


@pytest.mark.parametrize(
    ("speed", "scale", "line"), [(5.0, 300.0, 300.0), (25.0, 80.0, 1200.0), (40.0, 20.0, 6.0)]
)
def test_period_is_long_enough(speed, scale, line):
    """Covariances over places and times of frequencies k/period against those of all frequencies."""
    gusts = changed(mean_speed=speed, length_scale=scale)
    stations, lags = [0.0, line], np.array([0.0, 10.0, 30.0])
    period = generate_gusts(gusts, stations, duration=30.0, seed=0, cut_off=2.0).period

    def covariance(per_period):
        step = 1.0 / (per_period * period)
        f = step * np.arange(int(2.0 / step) + 1)
        weights = np.full(f.size, step)
        weights[0] *= 0.5
        cosines = np.cos(2.0 * np.pi * np.outer(lags, f))
        cross = [gusts.spectrum(f) * gusts.coherence(f, apart) for apart in (0.0, line / 2.0, line)]
        return cosines @ (np.array(cross) * weights).T / gusts.standard_deviation**2

    assert period > 30.0
    assert np.max(np.abs(covariance(1) - covariance(50))) < 0.005
    assert np.max(np.abs(covariance(0.1) - covariance(50))) > 0.005


def test_end_knows_nothing_of_the_start():
    ends = []
    for seed in range(300):
        field = generate_gusts(GUSTS, [0.0], duration=30.0, seed=seed, cut_off=1.0)
        ends.append(field.at([0.0, 0.2, 30.0])[0])
    start, soon, end = np.transpose(ends)
    assert abs(np.corrcoef(start, end)[0, 1]) < 2.6 / np.sqrt(300)
    assert np.corrcoef(start, soon)[0, 1] > 0.8


def test_field_is_smooth_between_its_instants():
    """In steps of 1 ms nothing lies above the cut-off: images of a cubic spline, images of straight lines."""
    field = generate_gusts(GUSTS, [0.0, 6.0], duration=30.0, seed=3, cut_off=CUT_OFF)
    fine = np.arange(30000) * 1e-3
    window = np.blackman(fine.size) ** 2
    above = np.fft.rfftfreq(fine.size, 1e-3) > 1.2 * CUT_OFF

    def share_above(histories):
        power = np.abs(np.fft.rfft(histories * window)) ** 2
        return power[..., above].sum() / power.sum()

    assert field.step == pytest.approx(1.0 / 32.0)
    u = field.at(fine)
    assert share_above(u) < 1e-8
    coarse = np.arange(0.0, 30.0, field.step)
    assert share_above([np.interp(fine, coarse, row) for row in field.at(coarse)]) > 1e-6
    second = np.diff(u, 2) / 1e-6
    assert np.max(np.abs(np.diff(second))) < 0.05 * np.max(np.abs(second))  # ü does not jump


def test_same_seed_same_bytes():
    def make(stations=STATIONS, seed=7):
        return generate_gusts(GUSTS, stations, duration=20.0, seed=seed).at(np.linspace(0.0, 20.0, 501))

    assert make().tobytes() == make().tobytes()
    assert np.corrcoef(make().ravel(), make(seed=8).ravel())[0, 1] < 0.9
    turned = [2, 0, 3, 1]
    assert np.array_equal(make(STATIONS[turned]), make()[turned])
    code = (
        "import hashlib, numpy as np; from catenary_fe.theory import Gusts, generate_gusts; "
        f"u = generate_gusts(Gusts(**{VALUES}), {STATIONS.tolist()}, duration=20.0, seed=7)"
        ".at(np.linspace(0.0, 20.0, 501)); print(hashlib.sha256(u.tobytes()).hexdigest())"
    )
    hashes = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2")
    ]
    assert hashes[0] == hashes[1] and len(hashes[0].strip()) == 64


def test_stations_at_one_place_and_full_coherence():
    instants = np.linspace(0.0, 5.0, 11)
    u = generate_gusts(GUSTS, [3.0, 9.0, 3.0], duration=5.0, seed=1).at(instants)
    assert np.array_equal(u[0], u[2]) and not np.allclose(u[0], u[1], atol=0.1)
    same = generate_gusts(changed(decay=0.0), [3.0, 900.0], duration=5.0, seed=1).at(instants)
    assert np.array_equal(same[0], same[1])


def test_instants_of_any_shape():
    field = generate_gusts(GUSTS, STATIONS, duration=5.0, seed=1)
    instants = np.array([[0.0, 5.0, 2.5], [1.0, 4.999, 0.001]])
    u = field.at(instants)
    assert u.shape == (4, 2, 3) and field.at(2.5).shape == (4,)
    assert np.array_equal(u[:, 0, 2], field.at(2.5))
    assert not field.stations.flags.writeable and not field.coefficients.flags.writeable
    assert STATIONS.flags.writeable


FIELD = {"duration": 10.0, "seed": 1}
CASES = [
    (lambda: changed(mean_speed=0.0), "mean_speed = 0 m/s: must be positive"),
    (lambda: changed(intensity=16.0), "intensity = 16: must be at most 1; use 0.15 for 15 %"),
    (lambda: changed(intensity=0.0), "intensity = 0"),
    (lambda: changed(length_scale=np.nan), "length_scale = nan m"),
    (lambda: changed(decay=-1.0), "decay = -1"),
    (lambda: GUSTS.spectrum([1.0, -0.1]), "f = -0.1 Hz: must not be negative"),
    (lambda: GUSTS.coherence(-0.1, 5.0), "f = -0.1 Hz"),
    (lambda: generate_gusts(25.0, [0.0], **FIELD), "gusts = 25.0: must be a theory.Gusts"),
    (lambda: generate_gusts(GUSTS, 3.0, **FIELD), r"stations = an array of shape \(\): must be a list"),
    (lambda: generate_gusts(GUSTS, [], **FIELD), r"stations = an array of shape \(0,\)"),
    (lambda: generate_gusts(GUSTS, [0.0, np.inf], **FIELD), "stations = nan or inf"),
    (lambda: generate_gusts(GUSTS, [0.0], duration=0.0, seed=1), "duration = 0 s"),
    (lambda: generate_gusts(GUSTS, [0.0], duration=1.0, seed=1.5), "seed = 1.5: must be a whole number"),
    (lambda: generate_gusts(GUSTS, [0.0], duration=1.0, seed=-1), "seed = -1"),
    (lambda: generate_gusts(GUSTS, [0.0], **FIELD, cut_off=-2.0), "cut_off = -2 Hz"),
    (lambda: generate_gusts(GUSTS, [0.0, 1e9], **FIELD), "cut_off = 20 Hz: a period of 4e.08 s has"),
    (
        lambda: generate_gusts(GUSTS, np.arange(2000.0), duration=1e4, seed=1),
        "duration = 10000 s: the field has",
    ),
    (lambda: generate_gusts(GUSTS, [0.0], **FIELD).at([1.0, 10.1]), "t = 10.1 s: must be between 0 s and"),
    (lambda: generate_gusts(GUSTS, [0.0], **FIELD).at(-0.1), "t = -0.1 s"),
]


@pytest.mark.parametrize(("call", "message"), CASES)
def test_bad_input_is_refused_in_one_line(call, message):
    refused_in_one_line(call, message)
