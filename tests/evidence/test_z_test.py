"""The Z-test: how often it cries wolf, what it finds, and what it is not fooled by.

Fixed seeds; each test of a frequency fails a right program with probability below 1e-4 (5 standard errors or a bound).
"""

import math

import numpy as np
import pytest

from artist_py.compare.z_test import (
    Moments,
    normal_tail,
    sidak,
    student_tail,
    symmetric_tail,
    z_test,
    z_values,
)

SHAPE = 8, 8, 3
TRIALS = 1000
ALARM = 0.05


def alarm_rate(draw, tail, seed=1):
    """Share of pairs of images of equal expectation that fail; `draw(rng)` gives mean and variance of an image."""
    rng = np.random.default_rng(seed)
    failed = [
        not z_test(*draw(rng), *draw(rng), false_alarm=ALARM, tail=tail, rounding=0.0).is_same
        for _ in range(TRIALS)
    ]
    return float(np.mean(failed))


def of_samples(samples):
    """Mean and variance of the mean over the first axis."""
    return samples.mean(axis=0), samples.var(axis=0, ddof=1) / len(samples)


class TestFalseAlarms:
    """Images of equal expectation."""

    error = 5 * math.sqrt(ALARM * (1 - ALARM) / TRIALS)

    def test_normal(self):
        """Exactly as often as stated."""
        rate = alarm_rate(lambda rng: (rng.standard_normal(SHAPE), np.ones(SHAPE)), normal_tail)
        assert rate == pytest.approx(ALARM, abs=self.error)

    def test_correlated(self):
        """Not more often when pixels share their noise (Sidak 1967)."""

        def draw(rng):
            common = rng.standard_normal((1, 1, 1))
            return 0.8 * common + 0.6 * rng.standard_normal(SHAPE), np.ones(SHAPE)

        assert 0.0 < alarm_rate(draw, normal_tail) <= ALARM + self.error

    def test_few_samples(self):
        """Eight samples need Student's tail; the normal one alarms several times too often."""

        def draw(rng):
            return of_samples(rng.standard_normal((8, *SHAPE)))

        assert alarm_rate(draw, student_tail(14)) == pytest.approx(ALARM, abs=self.error)
        assert alarm_rate(draw, normal_tail) > 4 * ALARM

    @pytest.mark.parametrize(
        "sample",
        [
            lambda rng, shape: rng.random(shape) < 0.02,  # rare hits: many pixels see none
            lambda rng, shape: np.exp(2.0 * rng.standard_normal(shape)),
            lambda rng, shape: rng.pareto(0.8, shape),  # no mean at all
        ],
        ids=["rare", "lognormal", "pareto"],
    )
    def test_fireflies(self, sample):
        """Equally many samples of one distribution, however skewed, alarm no more often than stated."""

        def draw(rng):
            return of_samples(sample(rng, (64, *SHAPE)).astype(float))

        assert alarm_rate(draw, symmetric_tail(64)) <= ALARM

    def test_bound_holds_for_signs(self):
        """2 exp(-t^2 / 2) bounds sums of random signs, exactly: the binomial distribution."""
        n = 30
        for heads in range(16, 31):
            probability = 2 * sum(math.comb(n, k) for k in range(heads, n + 1)) / 2**n
            t = (2 * heads - n) / math.sqrt(n)
            z = t * math.sqrt((n - 1) / (n - t * t)) if t * t < n else math.inf
            assert probability <= symmetric_tail(n)(z) * (1 + 1e-9)


class TestDetection:
    """Images that differ."""

    def test_one_pixel(self):
        """A value that is 8 standard errors off is found, and where."""
        rng = np.random.default_rng(2)
        a, b, variance = rng.standard_normal(SHAPE), rng.standard_normal(SHAPE), np.ones(SHAPE)
        a[3, 5, 1] = b[3, 5, 1] - 8 * math.sqrt(2)
        test = z_test(a, variance, b, variance)
        assert not test.is_same
        assert test.worst == (3, 5, 1)
        assert test.z[3, 5, 1] == pytest.approx(-8)
        assert test.p == pytest.approx(SHAPE[0] * SHAPE[1] * SHAPE[2] * 1.244e-15, rel=1e-2)

    def test_skewed_samples_can_differ(self):
        """The distribution-free tail is not blind: 64 samples, 6 standard errors."""
        assert sidak(float(symmetric_tail(64)(8.0)), 192) < 1e-3
        assert symmetric_tail(10**6)(6.0) == pytest.approx(2 * math.exp(-18), rel=1e-3)

    def test_without_noise(self):
        """Equal is equal, rounding is forgiven, and more is not."""
        value, none = np.full(SHAPE, 0.5), np.zeros(SHAPE)
        assert z_test(value, none, value, none).p == 1.0
        assert z_test(value, none, value * (1 + 1e-6), none).is_same
        assert not z_test(value, none, value * 1.001, none).is_same
        assert np.isinf(z_values(1.0, 0.0, 2.0, 0.0, rounding=0.0))

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (lambda a: a[:4], "one shape"),
            (lambda a: np.where(np.arange(8)[:, None, None] == 1, np.nan, a), "finite"),
            (lambda a: a - 2.0, "variances >= 0"),
        ],
    )
    def test_bad_input(self, change, message):
        """Nothing is compared that cannot be."""
        one = np.ones(SHAPE)
        with pytest.raises(ValueError, match=message):
            z_test(one, change(one), one, one)


class TestMoments:
    """Means over images."""

    def test_against_numpy(self):
        """Mean and variance of the mean, with digits kept on a large offset; also when taken up again."""
        images = 1e6 + np.random.default_rng(3).random((9, 4, 5, 3))
        moments = Moments()
        for image in images[:5]:
            moments.add(image)
        moments = Moments(moments.mean, moments.variance, moments.count)
        for image in images[5:]:
            moments.add(image)
        np.testing.assert_allclose(moments.mean, images.mean(axis=0), rtol=1e-14)
        np.testing.assert_allclose(moments.variance, images.var(axis=0, ddof=1) / 9, rtol=1e-8)

    def test_one_image(self):
        """Nothing is known of its error."""
        moments = Moments()
        moments.add(np.ones(SHAPE))
        assert np.isinf(moments.variance).all()
