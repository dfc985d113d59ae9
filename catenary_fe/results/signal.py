"""The filter of contact-force measurements, and statistics of filtered signals."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.arguments import one_of

Floats = NDArray[np.float64]
FilterKind = Literal["causal", "zero-phase"]

CUT_OFF = 20.0  # [Hz] EN 50317 (secondary source)
ORDER = 6  # Butterworth, EN 50317 (secondary source)


def low_pass(signal: Floats, step: float, cut_off: float = CUT_OFF, kind: FilterKind = "causal") -> Floats:
    """Sixth-order Butterworth low-pass along the last axis.

    signal : any shape (..., times)
    step : [s] between samples
    cut_off : [Hz]
    kind : "causal" runs forward once, as a measuring filter does, and delays; "zero-phase" runs forward and
        back, which doubles the attenuation

    Raises ValueError where the cut-off is not below half the sampling frequency, InputError for another kind.
    """
    return _filter(signal, step, cut_off, "lowpass", kind)


def band_pass(signal: Floats, step: float, lower: float, upper: float, kind: FilterKind = "causal") -> Floats:
    """What passes a sixth-order high-pass at ``lower`` [Hz] and a sixth-order low-pass at ``upper`` [Hz]."""
    return _filter(_filter(signal, step, upper, "lowpass", kind), step, lower, "highpass", kind)


def high_pass(signal: Floats, step: float, cut_off: float, kind: FilterKind = "causal") -> Floats:
    """What passes a sixth-order high-pass at ``cut_off`` [Hz]."""
    return _filter(signal, step, cut_off, "highpass", kind)


def _filter(signal: Floats, step: float, cut_off: float, band: str, kind: FilterKind) -> Floats:
    from scipy.signal import sosfilt, sosfiltfilt

    one_of("filter", kind, get_args(FilterKind))
    if not 0 < cut_off < 0.5 / step:
        raise ValueError(
            f"cut-off = {cut_off:g} Hz: must lie below half of the {1 / step:g} samples a second"
        )
    sections, settled = _designed(cut_off, band, step)
    if kind == "zero-phase":
        filtered: Floats = sosfiltfilt(sections, signal, axis=-1)
        return filtered
    # start as if the first value had lasted forever: no step at the start
    state = settled.reshape(settled.shape[0], *(1,) * (signal.ndim - 1), 2) * signal[..., :1]
    filtered, _ = sosfilt(sections, signal, axis=-1, zi=state)
    return filtered


@lru_cache(maxsize=64)
def _designed(cut_off: float, band: str, step: float) -> tuple[Floats, Floats]:
    """Sections of the filter, and their state after a 1 that has lasted forever."""
    from scipy.signal import butter, sosfilt_zi

    sections: Floats = butter(ORDER, cut_off, btype=band, fs=1 / step, output="sos")
    return sections, sosfilt_zi(sections)


def spectrum(signal: Floats, step: float) -> tuple[Floats, Floats]:
    """Frequencies [Hz] and amplitudes of a signal's Fourier series, its mean removed, Hann window."""
    window = np.hanning(signal.size)
    amplitude: Floats = np.abs(np.fft.rfft((signal - signal.mean()) * window)) * 2 / window.sum()
    frequency: Floats = np.arange(amplitude.size) / (signal.size * step)
    return frequency, amplitude
