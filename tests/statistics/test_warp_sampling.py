"""Every map of `core/warp.py` against its density.

Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared, Sidak over its cases).
"""

import numpy as np
import pytest
from chi_squared import DISK, SPHERE, TRIANGLE, ChiSquaredTest, cap

from artist_py.core import warp


def rows(function):
    """An adapter: uniform numbers (n, 2) to rows of what `function` maps each pair to."""
    return lambda numbers: np.array([np.asarray(function(u, v))[:3] for u, v in numbers.tolist()])


def cone(one_minus_cos_max):
    return ChiSquaredTest(
        rows(lambda u, v: warp.square_to_cone(u, v, one_minus_cos_max)),
        lambda w: np.full(len(w), 1.0 / (2.0 * np.pi * one_minus_cos_max)),
        cap(one_minus_cos_max),
        samples=20_000,
        bins=(10, 20),
    )


def power_cosine(n, domain, bins):
    # Narrow lobes need a power of the cosine that does not lose its digits.
    def density(w):
        sin_squared = w[:, 0] ** 2 + w[:, 1] ** 2
        power = np.exp(0.5 * n * np.log1p(-np.minimum(sin_squared, 1.0 - 1e-15)))
        return np.where(w[:, 2] > 0.0, (n + 1.0) / (2.0 * np.pi) * power, 0.0)

    sample = rows(lambda u, v: warp.square_to_power_cosine(u, v, n))
    return ChiSquaredTest(sample, density, domain, samples=20_000, bins=bins)


def cosine_density(w):
    return np.maximum(w[:, 2], 0.0) / np.pi


def uniform(area):
    return lambda points: np.full(len(points), 1.0 / area)


CASES = {
    "disk": ChiSquaredTest(rows(warp.square_to_disk), uniform(np.pi), DISK, samples=20_000),
    "cosine hemisphere": ChiSquaredTest(
        rows(warp.square_to_cosine_hemisphere), cosine_density, SPHERE, samples=20_000
    ),
    "sphere": ChiSquaredTest(rows(warp.square_to_sphere), uniform(4.0 * np.pi), SPHERE, samples=20_000),
    "triangle": ChiSquaredTest(rows(warp.square_to_triangle), uniform(0.5), TRIANGLE, samples=20_000),
    "hemisphere": cone(1.0),
    "cone": cone(0.1),
    "needle": cone(1e-13),
    "even power cosine": power_cosine(0.0, SPHERE, (20, 40)),
    "power cosine": power_cosine(20.0, SPHERE, (40, 20)),
    "narrow power cosine": power_cosine(1e9, cap(2.5e-8), (20, 20)),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_samples_follow_their_density(case):
    case.assert_passes(len(CASES))
