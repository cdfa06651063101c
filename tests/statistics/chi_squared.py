"""One chi-squared test for every sampler: whether `sample` draws from the density that `density` states.

A *domain* maps the unit square onto what is sampled, and says how much measure a unit of the square stands for. The
square is cut into bins; the density is integrated over each by Gauss and Legendre's rule and compared with the counts.
What the sampler rejects has a bin of its own, so that a density which does not integrate to the share of accepted
samples fails as well.
"""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numba
import numpy as np
from scipy import stats

# Probability that a correct sampler fails, over all cases of one family together (Sidak's correction).
SIGNIFICANCE = 0.01
SAMPLES = 2_000 if numba.config.DISABLE_JIT else 200_000
LEAST_EXPECTED = 5.0


class Domain(NamedTuple):
    """Points of the domain are rows of arrays; `from_unit` and `to_unit` are inverse to each other."""

    from_unit: Callable  # (n, 2) in the unit square to (n, d)
    to_unit: Callable
    measure: Callable  # (n, 2) in the unit square to (n,): measure of the domain per unit of the square


def cap(one_minus_cos_max):
    """Directions around z, up to the given 1 - cos from it; solid angle."""

    def from_unit(unit):
        z = 1.0 - one_minus_cos_max * unit[:, 0]
        radius = np.sqrt(np.maximum(0.0, 1.0 - z * z))
        angle = 2.0 * np.pi * unit[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])

    def to_unit(w):
        # Near z, 1 - z has lost its digits.
        sin_squared = w[:, 0] ** 2 + w[:, 1] ** 2
        one_minus_z = np.where(w[:, 2] > 0.0, sin_squared / (1.0 + np.maximum(w[:, 2], 0.0)), 1.0 - w[:, 2])
        return np.column_stack([one_minus_z / one_minus_cos_max, turns(w)])

    return Domain(from_unit, to_unit, constant(2.0 * np.pi * one_minus_cos_max))


def constant(value):
    """The measure of an area-preserving map."""
    return lambda unit: np.full(len(unit), value)


def turns(points):
    """Azimuth of the points in full turns, [0, 1)."""
    return np.arctan2(points[:, 1], points[:, 0]) / (2.0 * np.pi) % 1.0


def disk_from_unit(unit):
    """Points (x, y) of the unit disk."""
    radius, angle = np.sqrt(unit[:, 0]), 2.0 * np.pi * unit[:, 1]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def triangle_from_unit(unit):
    """Weights (b1, b2) of two corners."""
    total = np.sqrt(unit[:, 0])
    return np.column_stack([total * (1.0 - unit[:, 1]), total * unit[:, 1]])


def triangle_to_unit(b):
    """The inverse of `triangle_from_unit`."""
    total = b[:, 0] + b[:, 1]
    return np.column_stack([total * total, b[:, 1] / total])


SQUARE = Domain(np.copy, np.copy, constant(1.0))  # area
SPHERE = cap(2.0)  # solid angle
DISK = Domain(disk_from_unit, lambda p: np.column_stack([(p * p).sum(1), turns(p)]), constant(np.pi))  # area
TRIANGLE = Domain(triangle_from_unit, triangle_to_unit, constant(0.5))  # area in the plane of (b1, b2)


class ChiSquaredTest:
    """A sampler against its density.

    `sample` takes uniform numbers of shape (n, dimensions) and returns points of the domain, rows of NaN where it
    rejects. `density` takes points and returns densities in the domain's measure. `order` is that of the rule
    that integrates a bin along each axis.
    """

    def __init__(
        self, sample, density, domain=SPHERE, *, dimensions=2, bins=(20, 40), samples=SAMPLES, seed=1, order=4
    ):
        self.sample, self.density, self.domain = sample, density, domain
        self.dimensions, self.bins, self.samples, self.seed, self.order = (
            dimensions,
            bins,
            samples,
            seed,
            order,
        )

    @cached_property
    def observed(self):
        """How many samples fell into each bin, and at the end how many were rejected."""
        numbers = np.random.default_rng(self.seed).random((self.samples, self.dimensions))
        points = np.asarray(self.sample(numbers))
        accepted = np.isfinite(points).all(axis=1)
        unit = self.domain.to_unit(points[accepted])
        assert np.all((unit > -1e-9) & (unit < 1.0 + 1e-9)), "a sample lies outside its domain"
        index = np.minimum((np.clip(unit, 0.0, 1.0) * self.bins).astype(int), np.subtract(self.bins, 1))
        counts = np.bincount(np.ravel_multi_index(index.T, self.bins), minlength=np.prod(self.bins))
        return np.append(counts, np.count_nonzero(~accepted))

    @cached_property
    def expected(self):
        """How many samples the density promises for each bin, and at the end how many rejections."""
        nodes, weights = np.polynomial.legendre.leggauss(self.order)
        axes = [((np.arange(count)[:, None] + 0.5 + 0.5 * nodes) / count).ravel() for count in self.bins]
        unit = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
        values = np.asarray(self.density(self.domain.from_unit(unit))) * self.domain.measure(unit)
        assert np.all(np.isfinite(values) & (values >= 0.0)), "a density is negative or not finite"
        cells = values.reshape(self.bins[0], self.order, self.bins[1], self.order)
        shares = np.einsum("iajb,a,b->ij", cells, weights / 2.0, weights / 2.0).ravel() / np.prod(self.bins)
        assert shares.sum() < 1.0 + 1e-3, f"the density integrates to {shares.sum():.4f}"
        return self.samples * np.append(shares, max(0.0, 1.0 - shares.sum()))

    @property
    def p_value(self):
        """Probability of deviations as large as these if the density is right."""
        of_bins, of_rejection = self.p_value_of_bins, self.p_value_of_rejection
        return of_bins if of_rejection is None else 1.0 - (1.0 - min(of_bins, of_rejection)) ** 2

    @cached_property
    def p_value_of_bins(self):
        """The chi-squared test; bins are pooled until each expects at least 5."""
        order = np.argsort(self.expected, kind="stable")
        expected, observed = self.expected[order], self.observed[order]
        # Bins that the density rules out cannot be pooled: one sample there is one too many.
        possible = expected > 1e-6
        if observed[~possible].any():
            return 0.0
        expected, observed = pool(expected[possible], observed[possible])
        if len(expected) == 1:
            return 1.0
        deviation = ((observed - expected) ** 2 / expected).sum()
        return stats.chi2.sf(deviation, len(expected) - 1)

    @cached_property
    def p_value_of_rejection(self):
        """The binomial test of how many samples were rejected, in which many bins would drown; None if none can be."""
        share = self.expected[-1] / self.samples
        if share < 1e-6 and self.observed[-1] == 0:
            return None
        return stats.binomtest(int(self.observed[-1]), self.samples, share).pvalue

    def assert_passes(self, cases=1):
        """Fail if the deviations are significant; `cases` is how many such tests are made together."""
        threshold = 1.0 - (1.0 - SIGNIFICANCE) ** (1.0 / cases)
        sigma = (self.observed - self.expected) / np.sqrt(np.maximum(self.expected, 1.0))
        worst = int(np.argmax(np.abs(sigma)))
        assert self.p_value > threshold, (
            f"p = {self.p_value:.3g} < {threshold:.3g}; worst in bin {worst} of {self.bins}, where"
            f" {self.observed[worst]} samples fell and {self.expected[worst]:.1f} were expected"
        )


def pool(expected, observed):
    """Join neighbours of the sorted bins until each expects `LEAST_EXPECTED`; what remains joins the last."""
    starts, total = [0], 0.0
    for i, value in enumerate(expected):
        if total >= LEAST_EXPECTED:
            starts.append(i)
            total = 0.0
        total += value
    if total < LEAST_EXPECTED and len(starts) > 1:
        starts.pop()
    return np.add.reduceat(expected, starts), np.add.reduceat(observed, starts)
