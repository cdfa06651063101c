"""Whether two noisy images have the same expectation, pixel by pixel, with a stated probability of a false alarm.

Each value is compared by z = (a - b) / sqrt(var a + var b). The smallest of the n p-values is corrected for having been
chosen: p = 1 - (1 - p_min)^n. Sidak 1967 showed that for normal values with any correlation between them, such as
neighbouring pixels that share photons, this is at least the true probability.

How likely a large z is by chance is a `tail`: a function from |z| to the two-sided probability. The means of few or of
strongly skewed samples are not normal, and millions of values look far into the tail; take the tail that holds.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy import special, stats

ROUNDING = 1e-5  # relative deviation that is no fault: images are float32, and long paths lose digits


class ZTest(NamedTuple):
    """What the comparison found."""

    z: np.ndarray  # of the inputs' shape, signed: a - b in standard errors
    p: float  # probability that images of equal expectation have a |z| this large anywhere
    worst: tuple  # index of the largest |z|
    is_same: bool  # p >= the false alarm probability


def normal_tail(z):
    """For values that are normal: means of many samples, none of which dominates."""
    return 2.0 * stats.norm.sf(z)


def student_tail(degrees):
    """Tail for normal values whose variances were estimated with so many degrees of freedom in all."""
    return lambda z: 2.0 * stats.t.sf(z, degrees)


def symmetric_tail(samples):
    """Tail for a and b that are means of equally many samples of the same distribution, however skewed.

    Their differences are symmetric, and of n symmetric numbers, however wild, |sum| / sqrt(sum of squares) exceeds t
    with a probability of at most 2 exp(-t^2 / 2) (Efron 1969). z is that with the mean taken out of the squares:
    t^2 = n z^2 / (n - 1 + z^2), as far as samples of a and b, paired at random, do not happen to be correlated.
    """

    def tail(z):
        square = np.minimum(np.square(np.asarray(z, np.float64)), 1e300)
        with np.errstate(under="ignore"):
            return np.minimum(1.0, 2.0 * np.exp(-0.5 * samples * square / (samples - 1.0 + square)))

    return tail


def z_values(mean_a, variance_a, mean_b, variance_b, rounding=ROUNDING):
    """(a - b) / sqrt(var a + var b) of each value; `variance_*` are those of the means. Infinite without noise."""
    a, b = np.asarray(mean_a, np.float64), np.asarray(mean_b, np.float64)
    variance = np.asarray(variance_a, np.float64) + np.asarray(variance_b, np.float64)
    slack = (rounding * np.maximum(np.abs(a), np.abs(b))) ** 2
    difference = a - b
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        z = difference / np.sqrt(variance + slack)
    return np.where(difference == 0.0, 0.0, z)


def sidak(p, count):
    """Probability that the smallest of `count` independent p-values is at most `p`."""
    return float(-special.expm1(count * special.log1p(-p))) if p < 1.0 else 1.0


def z_test(mean_a, variance_a, mean_b, variance_b, *, false_alarm=1e-3, tail=normal_tail, rounding=ROUNDING):
    """Whether two images may have the same expectation; a `ZTest`.

    Images of equal expectation fail with a probability of at most `false_alarm`, for the whole image and as far as
    `tail` and the variances hold; those of the film overstate where samples are stratified, which is on the safe side.
    Raises ValueError for shapes that differ and for what is not finite.
    """
    arrays = [np.asarray(each, np.float64) for each in (mean_a, variance_a, mean_b, variance_b)]
    if len({array.shape for array in arrays}) > 1:
        raise ValueError(f"expected arrays of one shape, found {[array.shape for array in arrays]}")
    if not all(np.isfinite(array).all() for array in arrays):
        raise ValueError("expected finite means and variances")
    if min(arrays[1].min(), arrays[3].min()) < 0.0:
        raise ValueError("expected variances >= 0")
    z = z_values(*arrays, rounding)
    worst = np.unravel_index(np.argmax(np.abs(z)), z.shape)
    p = sidak(float(tail(abs(z[worst]))), z.size)
    return ZTest(z, p, tuple(int(i) for i in worst), p >= false_alarm)


class Moments:
    """Mean and variance of independent images, one at a time: their spread shows their noise, however they were made.

    Welford's sums as by Chan, Golub and LeVeque 1983. Replicates of equal effort (same iterations, other seeds) need no
    assumption about stratification or about correlation between pixels.
    """

    def __init__(self, mean=0.0, variance_of_mean=0.0, count=0):
        """Nothing yet, or what was kept of `count` images."""
        self.count, self._mean = count, np.asarray(mean, np.float64)
        self._squares = np.asarray(variance_of_mean, np.float64) * (count * max(count - 1, 0))

    def add(self, image):
        """Take one more image."""
        image = np.asarray(image, np.float64)
        self.count += 1
        step = image - self._mean
        self._mean = self._mean + step / self.count
        self._squares = self._squares + step * (image - self._mean)

    @property
    def mean(self):
        """Mean of the images."""
        return self._mean

    @property
    def variance(self):
        """Variance of that mean; infinite for fewer than two images."""
        if self.count < 2:
            return np.full(np.shape(self._mean), math.inf)
        return self._squares / (self.count * (self.count - 1))
