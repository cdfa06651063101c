"""The chi-squared test itself: it accepts what is right about as often as it says, and rejects what is wrong."""

import numpy as np
import pytest
from chi_squared import DISK, SPHERE, SQUARE, TRIANGLE, ChiSquaredTest, cap, pool
from scipy import stats

DOMAINS = {"square": SQUARE, "sphere": SPHERE, "cap": cap(0.3), "disk": DISK, "triangle": TRIANGLE}


def uniform(points):
    return np.ones(len(points))


@pytest.mark.parametrize("domain", DOMAINS.values(), ids=DOMAINS)
def test_domains_map_there_and_back(domain):
    unit = np.random.default_rng(1).random((1000, 2))
    np.testing.assert_allclose(domain.to_unit(domain.from_unit(unit)), unit, atol=1e-9)


@pytest.mark.parametrize("domain", DOMAINS.values(), ids=DOMAINS)
def test_measures_of_domains_are_the_areas_of_their_maps(domain):
    unit = np.random.default_rng(2).random((1000, 2)) * 0.98 + 0.01
    step = 1e-6
    along = [
        (domain.from_unit(unit + np.eye(2)[i] * step) - domain.from_unit(unit - np.eye(2)[i] * step))
        / (2 * step)
        for i in (0, 1)
    ]
    gram = (along[0] ** 2).sum(1) * (along[1] ** 2).sum(1) - (along[0] * along[1]).sum(1) ** 2
    np.testing.assert_allclose(np.sqrt(gram), domain.measure(unit), rtol=1e-4)


def test_p_values_of_a_right_density_are_uniform():
    """Kolmogorov and Smirnov's test over 200 seeds; a correct test fails with probability 0.001."""
    p_values = [
        ChiSquaredTest(np.copy, uniform, SQUARE, samples=20_000, seed=seed).p_value for seed in range(200)
    ]
    assert stats.kstest(p_values, "uniform").pvalue > 0.001


@pytest.mark.parametrize("tilt", [0.02, -0.02])
def test_a_density_wrong_by_two_percent_fails(tilt):
    wrong = ChiSquaredTest(
        np.copy, lambda p: 1.0 + tilt * (2.0 * p[:, 0] - 1.0), SQUARE, samples=1_000_000, bins=(8, 8)
    )
    with pytest.raises(AssertionError, match="samples fell"):
        wrong.assert_passes()


def test_a_density_that_promises_too_little_fails():
    wrong = ChiSquaredTest(np.copy, lambda p: 0.99 * uniform(p), SQUARE, samples=100_000)
    assert wrong.p_value < 1e-6


def test_a_density_above_one_fails():
    with pytest.raises(AssertionError, match="integrates to"):
        ChiSquaredTest(np.copy, lambda p: 1.01 * uniform(p), SQUARE, samples=1_000).assert_passes()


def test_a_sample_where_the_density_is_zero_fails():
    def density(p):
        return np.where(p[:, 0] < 0.5, 2.0, 0.0)

    def sample(numbers):
        points = numbers * [0.5, 1.0]
        points[0] = [0.9, 0.5]
        return points

    assert ChiSquaredTest(sample, density, SQUARE).p_value == 0.0
    ChiSquaredTest(lambda numbers: numbers * [0.5, 1.0], density, SQUARE).assert_passes()


def test_rejected_samples_are_counted():
    def sample(numbers):
        return np.where(numbers[:, 2:] < 0.3, np.nan, numbers[:, :2])

    right, wrong = (
        ChiSquaredTest(
            sample, lambda p, share=share: share * uniform(p), SQUARE, dimensions=3, samples=200_000
        )
        for share in (0.7, 0.69)
    )
    right.assert_passes()
    assert wrong.p_value < 1e-6


def test_a_sample_outside_its_domain_fails():
    with pytest.raises(AssertionError, match="outside its domain"):
        ChiSquaredTest(lambda numbers: numbers + 0.1, uniform, SQUARE).assert_passes()


def test_pooled_bins_expect_five_and_lose_nothing():
    rng = np.random.default_rng(3)
    expected = np.sort(rng.exponential(3.0, 500))
    observed = rng.poisson(expected)
    pooled, counts = pool(expected, observed)
    assert pooled.min() >= 5.0
    assert pooled.sum() == pytest.approx(expected.sum())
    assert counts.sum() == observed.sum()
