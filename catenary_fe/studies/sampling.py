"""Samples of the unit cube, and Sobol' indices of groups of its columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import one_of, whole

Floats = NDArray[np.float64]
Sampling = Literal["latin-hypercube", "sobol"]
CONFIDENCE = 0.95
RESAMPLES = 999
MOST = 100_000  # samples


def unit_cube(sampling: Sampling, samples: int, dimension: int, seed: int) -> Floats:
    """Numbers between 0 and 1, shape (samples, dimension); the same seed, the same numbers.

    Raises InputError for a number of samples that the sampling does not have.
    """
    from scipy.stats import qmc

    one_of("sampling", sampling, get_args(Sampling))
    whole("samples", samples, least=1, most=MOST)
    if sampling == "latin-hypercube":
        found: Floats = qmc.LatinHypercube(dimension, seed=np.random.default_rng(seed)).random(samples)
        return found
    check_power_of_two(samples, "Sobol' sequences are even")
    if dimension > qmc.Sobol.MAXDIM:
        raise InputError(
            f"scatter: {dimension} numbers a sample are more than a Sobol' sequence has, {qmc.Sobol.MAXDIM};"
            " draw members together, or take a Latin hypercube"
        )
    sequence = qmc.Sobol(dimension, scramble=True, seed=np.random.default_rng(seed))
    found = sequence.random_base2(samples.bit_length() - 1)
    return np.clip(found, 1e-12, 1 - 1e-12)  # of 30 bits: a 0 would be a distribution's end


def check_power_of_two(samples: int, why: str) -> None:
    """Raises InputError with the nearest powers."""
    if samples & (samples - 1):
        low = 1 << (samples.bit_length() - 1)
        raise InputError(
            f"samples = {samples}: {why} with a power of two alone; take {low} or {2 * low} samples"
        )


def two_cubes(samples: int, dimension: int, seed: int) -> tuple[Floats, Floats]:
    """Two independent Sobol' samples of the cube, shapes (samples, dimension)."""
    both = unit_cube("sobol", samples, 2 * dimension, seed)
    return both[:, :dimension], both[:, dimension:]


def exchanged(a: Floats, b: Floats, groups: Sequence[slice]) -> list[Floats]:
    """For each group of columns: the first sample with this group's columns of the second one."""
    found = []
    for group in groups:
        mixed = a.copy()
        mixed[:, group] = b[:, group]
        found.append(mixed)
    return found


@dataclass(frozen=True)
class Indices:
    """Sobol' indices: the share of an outcome's variance that each group of inputs brings.

    first : shape (outcomes, groups), alone
    total : likewise, alone and together with others
    first_range, total_range : shape (2, outcomes, groups), where they lie with 95 % confidence (bootstrap)
    samples : that they are computed from
    """

    first: Floats
    total: Floats
    first_range: Floats
    total_range: Floats
    samples: int


def group_indices(f_a: Floats, f_b: Floats, f_ab: Floats, seed: int) -> Indices:
    """Sobol' indices by the estimators of Saltelli 2010, as scipy has them, with a bootstrap.

    f_a, f_b : shape (outcomes, samples), outcomes of two independent samples
    f_ab : shape (groups, outcomes, samples), of the first sample with each group's columns of the second one
    seed : of the bootstrap

    Samples any of whose outcomes is nan are left out; of what remains, the largest power of two is taken.
    Raises InputError where fewer than two remain.
    """
    from scipy.stats import bootstrap

    good = np.isfinite(f_a).all(axis=0) & np.isfinite(f_b).all(axis=0) & np.isfinite(f_ab).all(axis=(0, 1))
    count = 1 << (int(good.sum()).bit_length() - 1) if good.sum() > 1 else 0
    if not count:
        raise InputError(
            "sensitivity: fewer than two samples ran with all their exchanged values; take more samples, or"
            " narrower distributions"
        )
    taken = np.flatnonzero(good)[:count]
    f_a, f_b, f_ab = f_a[:, taken], f_b[:, taken], f_ab[:, :, taken]

    def both(numbers: NDArray[np.int64]) -> Floats:
        return _estimated(f_a[:, numbers], f_b[:, numbers], f_ab[:, :, numbers])

    found = bootstrap(
        (np.arange(count),), lambda numbers: both(numbers).ravel(), vectorized=False, method="percentile",
        n_resamples=RESAMPLES, confidence_level=CONFIDENCE, random_state=np.random.default_rng(seed),
    ).confidence_interval  # fmt: skip
    first, total = both(np.arange(count))
    ranges = np.array([found.low, found.high]).reshape(2, 2, *first.shape)
    return Indices(first, total, ranges[:, 0], ranges[:, 1], count)


def _estimated(f_a: Floats, f_b: Floats, f_ab: Floats) -> Floats:
    """First and total indices, shape (2, outcomes, groups)."""
    from scipy.stats import sobol_indices

    found = sobol_indices(func={"f_A": f_a, "f_B": f_b, "f_AB": f_ab}, n=f_a.shape[1])
    shape = f_a.shape[0], f_ab.shape[0]
    return np.array([np.reshape(each, shape) for each in (found.first_order, found.total_order)])


def quantile_range(values: Floats, share: float, seed: int) -> tuple[float, float]:
    """Where a quantile lies with 95 % confidence, by bootstrap."""
    from scipy.stats import bootstrap

    if values.size < 2 or np.ptp(values) == 0:
        return float(values.min()), float(values.max())
    found = bootstrap(
        (values,), lambda x, axis: np.quantile(x, share, axis=axis), method="percentile",
        n_resamples=RESAMPLES, confidence_level=CONFIDENCE, random_state=np.random.default_rng(seed),
    ).confidence_interval  # fmt: skip
    return float(found.low), float(found.high)
