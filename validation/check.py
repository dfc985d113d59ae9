"""A number that was computed, beside the number it must meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

NO_REFERENCE = "none known"


@dataclass(frozen=True, kw_only=True)
class Check:
    """One comparison.

    case : name of the case
    engine : that computed it; empty where none did
    quantity : what is compared
    computed, reference : in ``unit``; of a curve its root mean square, of a range its text
    error : relative to the reference unless ``unit`` or ``reason`` say otherwise
    tolerance : largest error that passes
    source : of the reference
    passed : None where the reference is too unsure to judge by, or there is none: shown, not counted
    reason : why the tolerance is what it is, in one sentence
    negative_control : that of the case, wrong on purpose, must fail this check
    """

    case: str = ""
    engine: str = ""
    quantity: str
    computed: float | str
    reference: float | str
    error: float
    tolerance: float
    source: str
    passed: bool | None
    unit: str = ""
    reason: str
    negative_control: bool = True


def compare(
    quantity: str,
    computed: float,
    reference: float,
    tolerance: float,
    *,
    source: str,
    reason: str,
    unit: str = "",
    absolute: bool = False,
    negative_control: bool = True,
) -> Check:
    """Check a number; ``absolute``: the error is the difference itself, not its share of the reference."""
    error = abs(computed - reference) / (1.0 if absolute else abs(reference))
    return Check(
        quantity=quantity,
        computed=float(computed),
        reference=float(reference),
        error=float(error),
        tolerance=tolerance,
        source=source,
        passed=bool(error <= tolerance),
        unit=unit,
        reason=reason,
        negative_control=negative_control,
    )


def compare_curves(
    quantity: str,
    x: ArrayLike,
    computed: ArrayLike,
    reference: ArrayLike,
    tolerance: float,
    *,
    source: str,
    reason: str,
    unit: str = "",
    negative_control: bool = True,
) -> Check:
    """Check a curve over ``x``: root mean square of the difference over that of the reference."""
    x, computed, reference = (np.asarray(values, dtype=float) for values in (x, computed, reference))
    error = rms(x, computed - reference) / rms(x, reference)
    return Check(
        quantity=quantity,
        computed=rms(x, computed),
        reference=rms(x, reference),
        error=error,
        tolerance=tolerance,
        source=source,
        passed=bool(error <= tolerance),
        unit=unit,
        reason=reason,
        negative_control=negative_control,
    )


def rms(x: ArrayLike, values: ArrayLike) -> float:
    """Root mean square over ``x`` by the trapezoidal rule."""
    x, values = np.asarray(x, dtype=float), np.asarray(values, dtype=float)
    return float(np.sqrt(np.trapezoid(values**2, x) / np.ptp(x)))
