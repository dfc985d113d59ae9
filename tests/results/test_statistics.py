"""Filter and statistics against signals whose answers are known."""

import numpy as np
import pytest

from catenary_fe.results import ForceStatistics, band_pass, force_statistics, governing, low_pass, spectrum

STEP = 1e-3
T = np.arange(0, 20, STEP)


def sine(frequency, amplitude=1.0):
    return amplitude * np.sin(2 * np.pi * frequency * T)


def late(signal):
    return signal[10_000:]  # the filter's start is over


@pytest.mark.parametrize(("kind", "gain"), [("causal", 1 / np.sqrt(2)), ("zero-phase", 0.5)])
def test_gain_at_the_cut_off(kind, gain):
    assert late(low_pass(sine(20), STEP, kind=kind)).max() == pytest.approx(gain, rel=2e-3)


@pytest.mark.parametrize("frequency", [2.0, 10.0, 30.0, 40.0])
def test_sixth_order_butterworth(frequency):
    expected = 1 / np.sqrt(1 + (frequency / 20) ** 12)
    # 5 %: the digital filter's frequency axis is warped towards half the sampling frequency
    assert late(low_pass(sine(frequency), STEP)).max() == pytest.approx(expected, rel=0.05)


def test_a_constant_passes_from_the_first_sample_on():
    assert low_pass(np.full(500, 120.0), STEP) == pytest.approx(120.0)


def test_causal_filter_delays_and_zero_phase_does_not():
    signal = np.exp(-(((T - 10) / 0.05) ** 2))
    assert T[low_pass(signal, STEP).argmax()] == pytest.approx(10.03, abs=0.006)
    assert T[low_pass(signal, STEP, kind="zero-phase").argmax()] == pytest.approx(10.0, abs=2e-3)


def test_bands_split_the_variance():
    signal = 120 + sine(2, 20) + sine(12, 10)
    inside = T > 10
    s = force_statistics(name="x", force=signal, height=sine(1, 0.02), inside=inside, step=STEP)
    assert s.mean == pytest.approx(120, abs=0.01)
    assert s.std_0_5 == pytest.approx(20 / np.sqrt(2), rel=0.01)
    assert s.std_5_20 == pytest.approx(10 / np.sqrt(2), rel=0.01)
    assert s.std == pytest.approx(np.hypot(20, 10) / np.sqrt(2), rel=0.01)
    assert s.statistical_max - s.statistical_min == pytest.approx(6 * s.std)
    assert s.contact_loss == 0
    assert s.contact_point_range == pytest.approx(0.04, rel=1e-3)


def test_contact_loss_is_the_share_of_time_without_force():
    signal = np.where((T % 1) < 0.1, 0.0, 100.0)
    s = force_statistics(name="x", force=signal, height=T, inside=T > 10, step=STEP)
    assert s.contact_loss == pytest.approx(0.1, abs=1e-3)


def test_only_the_window_counts():
    signal = np.where(T < 10, 500.0, 100.0)
    s = force_statistics(name="x", force=signal, height=T, inside=T > 15, step=STEP)
    assert (s.max, s.min) == (pytest.approx(100, abs=1e-3), pytest.approx(100, abs=1e-3))


def test_cut_off_above_half_the_sampling_rate_is_refused():
    with pytest.raises(ValueError, match="must lie below half"):
        low_pass(T, 0.05)


def test_band_pass_keeps_the_band():
    signal = sine(1) + sine(10) + sine(60)
    assert late(band_pass(signal, STEP, 5, 20)).max() == pytest.approx(1, rel=0.02)


def test_spectrum_finds_the_tone():
    frequency, amplitude = spectrum(100 + sine(7, 3.0), STEP)
    assert frequency[amplitude.argmax()] == pytest.approx(7, abs=0.06)
    assert amplitude.max() == pytest.approx(3, rel=0.01)


def test_a_slow_cut_off_is_allowed_and_zero_is_not():
    assert low_pass(sine(0.1), STEP, 0.5).max() == pytest.approx(1, rel=0.01)
    with pytest.raises(ValueError, match="cut-off = 0 Hz"):
        low_pass(T, STEP, 0.0)


@pytest.mark.parametrize("kind", ["causal", "zero-phase"])
def test_many_signals_are_filtered_as_each_alone(kind):
    signals = np.array([[sine(3), 5 + sine(30)], [sine(11), np.exp(-T)], [T, 1 - T]])
    together = low_pass(signals, STEP, kind=kind)
    assert together.shape == signals.shape
    for i in range(3):
        for j in range(2):
            assert together[i, j] == pytest.approx(low_pass(signals[i, j], STEP, kind=kind), abs=1e-12)


@pytest.mark.parametrize(("kind", "gain"), [("causal", 1 / np.sqrt(2)), ("zero-phase", 0.5)])
@pytest.mark.parametrize(("frequency", "slow", "quick", "all_"), [(5, 1, 1, None), (20, 0, 1, 1)])
def test_bands_end_at_5_and_20_hz_with_the_filter_asked_for(kind, gain, frequency, slow, quick, all_):
    """Each edge of a band lets this filter's share pass."""
    s = force_statistics(
        name="x", force=sine(frequency, np.sqrt(2)), height=T, inside=T > 10, step=STEP, filter=kind
    )
    assert s.std_0_5 == pytest.approx(slow * gain, abs=0.01)
    assert s.std_5_20 == pytest.approx(quick * gain, rel=0.015)
    if all_:
        assert s.std == pytest.approx(gain, rel=0.015)
    assert s.filter == kind


def test_a_faint_force_is_no_loss_of_contact():
    signal = np.where((T % 1) < 0.1, 0.0, 0.5)
    s = force_statistics(name="x", force=signal, height=T, inside=T > 10, step=STEP)
    assert s.contact_loss == pytest.approx(0.1, abs=1e-3)


def test_numbers_by_name_in_display_units():
    s = ForceStatistics(
        pantograph="P", mean=120.0, std=30.0, std_0_5=10.0, std_5_20=20.0, statistical_max=210.0,
        statistical_min=31.0, max=180.0, min=60.0, contact_loss=0.015, long_contact_loss=0.0125,
        long_losses=2, longest_loss=0.008, contact_point_range=0.0425, filter="causal",
    )  # fmt: skip
    assert ForceStatistics.from_dict(s.as_dict() | {"more": 1}, "causal") == s
    assert s.as_dict() == {
        "name": "P", "mean_N": 120.0, "std_N": 30.0, "std_0_5_Hz_N": 10.0, "std_5_20_Hz_N": 20.0,
        "statistical_max_N": 210.0, "statistical_min_N": 31.0, "max_N": 180.0, "min_N": 60.0,
        "contact_loss_percent": pytest.approx(1.5), "contact_loss_over_5_ms_percent": pytest.approx(1.25),
        "losses_over_5_ms": 2, "longest_loss_ms": pytest.approx(8.0),
        "contact_point_range_mm": pytest.approx(42.5),
    }  # fmt: skip
    assert str(s) == (
        "P: mean 120.0 N, standard deviation 30.0 N, statistical maximum 210.0 N and minimum 31.0 N, actual"
        " maximum 180.0 N and minimum 60.0 N, contact loss 1.50 %, 1.25 % in 2 losses longer"
        " than 5 ms, the longest 8.0 ms"
    )


def losing(*spans, samples=2000, first=0, last=2000, step=STEP):
    """A force that is lost from one sample to before another, evaluated from ``first`` to before ``last``."""
    force, inside = np.full(samples, 100.0), np.zeros(samples, dtype=bool)
    for a, b in spans:
        force[a:b] = 0.0
    inside[first:last] = True
    s = force_statistics(name="x", force=force, height=force, inside=inside, step=step)
    return s.contact_loss, s.long_contact_loss, s.long_losses, s.longest_loss


def test_a_loss_is_long_above_5_ms():
    """Each sample stands for a step of 1 ms; scattered ones are no loss, however many."""
    assert losing() == (0, 0, 0, 0)
    assert losing((10, 15)) == (5 / 2000, 0, 0, pytest.approx(0.005))
    assert losing((10, 16)) == (6 / 2000, 6 / 2000, 1, pytest.approx(0.006))
    scattered = [(n, n + 1) for n in range(100, 400, 2)]
    assert losing(*scattered) == (150 / 2000, 0, 0, pytest.approx(0.001))
    assert losing((0, 7), (30, 34), (1990, 2000)) == (21 / 2000, 17 / 2000, 2, pytest.approx(0.01))
    assert losing((10, 12), step=2e-3)[1:] == (0, 0, pytest.approx(0.004))
    assert losing((10, 13), step=2e-3)[1:] == (3 / 2000, 1, pytest.approx(0.006))


def test_a_loss_counts_by_what_of_it_lies_in_the_window():
    """Its length is that of the whole loss; one outside is none."""
    assert losing((95, 103), first=100) == (3 / 1900, 3 / 1900, 1, pytest.approx(0.008))
    assert losing((80, 100), (300, 302), first=100) == (2 / 1900, 0, 0, pytest.approx(0.002))


def figures(name, mean, std):
    record = dict.fromkeys(ForceStatistics.none_as_dict(name), 0.0)
    return ForceStatistics.from_dict(record | {"name": name, "mean_N": mean, "std_N": std}, "causal")


def test_the_pantograph_that_governs():
    """By the limit missed by most, else by the larger share of σ; those without figures never."""
    lead, trail = figures("lead", 150.0, 30.0), figures("trail", 100.0, 25.0)
    assert governing([lead, trail]) == governing([None, trail, lead]) == "trail"
    assert governing([lead, trail], {"lead": 1.01}) == "lead"
    assert governing([lead, trail], {"lead": 1.01, "trail": 1.2}) == "trail"
    assert governing([lead, None]) == "lead"
    assert governing([None]) is None
