"""Merge radii, sizes and lamps at the ends of what is allowed: nothing that is not finite, and the right mean.

The sphere of spheres.py, with paths of up to 100 edges, a merge radius of 1e-7 or 0.5 of the scene's, a scene of 1e-4
or 1e5 units, and a lamp of 1e-5 of its size, against the closed form. Merges over half of the scene leave out what
came from below the horizon, in `ppm` exactly the share r^2 / 8; with the other techniques of `vcm` they get a weight,
so that it is less there, and the same in a scene of any size. A correct program fails one of the 8 tests by chance with
probability 2e-3 (Sidak); the standard error of the whole is about 0.15 %. All techniques, as vcm has them, are tested
with the small radius in both scenes; of the rest `make slow` tests one scene of the two, since what only a method does
does not depend on scale.
"""

import math

import numpy as np
import pytest
from rendering import render, with_render
from scipy import stats
from spheres import patches, sphere, visible_patches

SEEDS, ITERATIONS, LENGTH = 10, 40, 100
LAMP_RADIUS = 1e-5
TINY, HUGE = 1e-4, 1e5
SLOW_TINY = [pytest.param(TINY, marks=pytest.mark.slow), HUGE]
SLOW_HUGE = [TINY, pytest.param(HUGE, marks=pytest.mark.slow)]
SMALL, LARGE = 1e-7, 0.5
LOST = LARGE**2 * 3 / 8  # of the bounding radius, sqrt(3) that of the sphere
FALSE_ALARM = 1e-4
PRECISION = 4e-3


def estimates(integrator, scale, radius, first_seed=1):
    """R, G and B of the two paints in independent renders, (seeds, 2, 3), and what they should be, (2, 3)."""
    compiled = sphere(
        lamps=False,
        scale=scale,
        lamp_radius=LAMP_RADIUS,
        integrator=integrator,
        max_path_length=LENGTH,
        merging={"radius": radius, "alpha": 1, "light_paths": 4 if integrator == "ppm" else 1},
    )
    split = np.linalg.pinv(visible_patches(compiled).reshape(-1, 2))
    found = []
    for seed in range(first_seed, first_seed + SEEDS):
        film = render(with_render(compiled, seed=seed), ITERATIONS).film
        assert film.rejected_count == 0
        found.append(split @ film.rgb.reshape(-1, 3))
    lost = LOST if integrator == "ppm" and radius == LARGE else 0.0
    return np.array(found), patches(lamps=False).radiance(None, lost)[:2, :3]


def assert_agree(deviation):
    """The mean over seeds (first axis) of relative deviations is 0: each by itself and all together."""
    for each in (deviation, deviation.mean(axis=(1, 2), keepdims=True)):
        error = each.std(axis=0, ddof=1) / math.sqrt(len(each))
        assert error.max() < PRECISION
        t = np.abs(each.mean(axis=0)) / (error + 1e-6)
        alarm = 1 - (1 - FALSE_ALARM) ** (1 / each[0].size)
        assert t.max() < stats.t.isf(0.5 * alarm, len(each) - 1), (each.mean(axis=0), error)


@pytest.mark.parametrize("scale", SLOW_TINY)
def test_bidirectional(scale):
    found, truth = estimates("bpt", scale, SMALL)
    assert_agree(found / truth - 1)


@pytest.mark.parametrize("scale", [TINY, HUGE])
def test_smallest_radius(scale):
    found, truth = estimates("vcm", scale, SMALL)
    assert_agree(found / truth - 1)


@pytest.fixture(scope="module")
def unscaled():
    """VCM's estimates with the large radius in a sphere of radius 1."""
    found, truth = estimates("vcm", 1.0, LARGE, first_seed=101)
    deviation = (found / truth - 1).mean()
    assert -LOST < deviation < 0
    return found


@pytest.mark.parametrize("scale", SLOW_TINY)
def test_largest_radius(scale, unscaled):
    found, truth = estimates("vcm", scale, LARGE)
    assert -LOST < (found / truth - 1).mean() < 0
    assert_agree((found - unscaled) / truth)


@pytest.mark.parametrize("scale", SLOW_HUGE)
def test_largest_radius_without_weights(scale):
    found, truth = estimates("ppm", scale, LARGE)
    assert_agree(found / truth - 1)
