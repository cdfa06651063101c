"""Reconstruction filters: the tables draw what the formulas say."""

import numpy as np
import pytest
from scipy import integrate, stats

from artist_py.film.filters import FILTERS, evaluate_filter, filter_table

DEFAULT_RADIUS = {"box": 0.5, "tent": 1.0, "gaussian": 1.5, "blackman-harris": 1.5, "mitchell": 2.0}
NON_NEGATIVE = [name for name in FILTERS if name != "mitchell"]


def moment(name, radius, power):
    """Moment of the normalised filter, by quadrature; pixels^power."""

    def integrand(x, k):
        return float(evaluate_filter(name, radius, x)) * x**k

    def integral(k):
        return 2 * integrate.quad(integrand, 0, radius, args=(k,), points=[radius / 2], epsabs=1e-12)[0]

    return integral(power) / integral(0)


def draw(table, u):
    """Offsets for `u` in [0, 1), as a kernel draws them."""
    n = len(table.offset) - 1
    cell = np.minimum((u * n).astype(int), n - 1)
    return table.offset[cell] + (u * n - cell) * (table.offset[cell + 1] - table.offset[cell])


@pytest.mark.parametrize("radius_scale", [1.0, 1.7])
@pytest.mark.parametrize("name", FILTERS)
def test_moments_are_those_of_the_filter(name, radius_scale):
    """Estimates of 1, x, x^2 and x^4 with the table agree with quadrature of the formula."""
    radius = DEFAULT_RADIUS[name] * radius_scale
    table = filter_table(name, radius)
    first, end = table.offset[:-1], table.offset[1:]
    for power, tolerance in ((0, 1e-12), (1, 1e-12), (2, 3e-3), (4, 3e-2)):
        mean_power = (end ** (power + 1) - first ** (power + 1)) / ((power + 1) * (end - first))
        expected = 0.0 if power % 2 else moment(name, radius, power)
        assert np.mean(table.weight * mean_power) == pytest.approx(expected, rel=tolerance, abs=1e-12)


@pytest.mark.parametrize("name", FILTERS)
def test_cells_hold_the_integral_of_the_filter(name):
    """The integral of the filter over any eight cells, by quadrature, is the weight of those cells."""
    radius = DEFAULT_RADIUS[name]
    table = filter_table(name, radius)
    total = (
        2
        * integrate.quad(lambda x: float(evaluate_filter(name, radius, x)), 0, radius, points=[radius / 2])[0]
    )
    for first in (0, 40, 200, 508, 700, 1016):
        bounds = table.offset[first], table.offset[first + 8]
        part = integrate.quad(lambda x: float(evaluate_filter(name, radius, x)), *bounds)[0]
        assert part / total == pytest.approx(table.weight[first : first + 8].sum() / 1024, abs=2e-8)


@pytest.mark.parametrize("name", NON_NEGATIVE)
def test_drawn_offsets_follow_the_filter(name):
    """Kolmogorov-Smirnov against the distribution function by quadrature; fails by chance once in a thousand seeds."""
    radius = DEFAULT_RADIUS[name]
    x = np.linspace(-radius, radius, 4001)
    cdf = np.concatenate(([0.0], integrate.cumulative_trapezoid(evaluate_filter(name, radius, x), x)))
    table = filter_table(name, radius)
    offset = draw(table, np.random.default_rng(7).random(20_000))
    assert np.all(table.weight == 1)
    assert stats.kstest(offset, lambda at: np.interp(at, x, cdf / cdf[-1])).pvalue > 1e-3


def test_mitchell_carries_the_sign_of_its_lobes():
    """Negative beyond half the radius, positive within; the mean weight is 1 and its size is constant elsewhere."""
    table = filter_table("mitchell", 2.0)
    middle = np.abs(0.5 * (table.offset[1:] + table.offset[:-1]))
    size = table.weight.max()
    assert size > 1
    assert np.all(np.abs(table.weight) <= size * (1 + 1e-9))
    assert np.allclose(table.weight[middle < 0.98], size)
    assert np.all(table.weight[middle > 1.2] < 0)
    assert np.mean(table.weight) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("name", FILTERS)
def test_offsets_rise_from_edge_to_edge_symmetrically(name):
    """Every cell has a positive width, so that no pdf is infinite."""
    offset = filter_table(name, DEFAULT_RADIUS[name]).offset
    assert (offset[0], offset[-1]) == (-DEFAULT_RADIUS[name], DEFAULT_RADIUS[name])
    assert np.all(np.diff(offset) > 0)
    assert np.array_equal(offset, -offset[::-1])


def test_values_at_the_centre_and_beyond_the_edge():
    """Published values: Mitchell (B = C = 1/3) is 8/9 at its centre, 1/18 at one pixel; a window is 1 at its centre."""
    assert evaluate_filter("mitchell", 2.0, 0.0) == pytest.approx(8 / 9)
    assert evaluate_filter("mitchell", 2.0, 1.0) == pytest.approx(1 / 18)
    assert evaluate_filter("blackman-harris", 1.5, 0.0) == pytest.approx(1.0)
    for name in FILTERS:
        assert evaluate_filter(name, 1.0, 1.01) == 0
