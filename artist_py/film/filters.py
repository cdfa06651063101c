"""Reconstruction filters, sampled by importance: each path lands in one pixel, at an offset drawn from the filter.

All filters are separable, so each axis draws its own offset and the weights multiply. Ernst, Stamminger and Greiner
2006, "Filter importance sampling", says why: no pixel shares samples with its neighbour, so noise stays uncorrelated.
"""

import math
from typing import Any, NamedTuple

import numpy as np

TABLE_SIZE = 1024
FINE_CELLS = 1 << 18
# Harris 1978, table I: the four-term window with the lowest side lobes (-92 dB).
BLACKMAN_HARRIS = (0.35875, 0.48829, 0.14128, 0.01168)


class FilterTable(NamedTuple):
    """One axis of a filter f, in n cells of equal integral of |f|.

    For u in [0, 1), i = floor(n u): the offset is `offset[i]` to `offset[i + 1]`, linear in u; the weight is
    `weight[i]`. The pdf of the offset is then exactly 1 / (n (offset[i + 1] - offset[i])), pixel^-1.
    """

    offset: Any  # (n + 1,) float64, pixels from the pixel's centre
    weight: Any  # (n,) float64; exactly 1 throughout where f is nowhere negative


def evaluate_filter(name, radius, offset):
    """Value of the filter at `offset` pixels from its centre, not normalised; zero beyond `radius`."""
    x = np.abs(np.asarray(offset, dtype=float)) / radius
    return np.where(x <= 1, _PROFILES[name](x), 0.0)


def filter_table(name, radius, n=TABLE_SIZE):
    """FilterTable of one axis; `radius` in pixels, `n` even.

    Within a cell the sampled filter is constant, with the integral that f has there: weights are the integral of f
    over the cell divided by that of its pdf, 1 / n, so that estimates are unbiased for this step function whatever the
    sign of f. Mitchell has negative lobes: |f| is sampled, and the weight carries the sign and exceeds 1 in size, at
    the price of more variance (1.3 times, over both axes).
    """
    half = np.linspace(0.0, radius, FINE_CELLS + 1)
    density = evaluate_filter(name, radius, 0.5 * (half[1:] + half[:-1]))
    size = np.concatenate(([0.0], np.cumsum(np.abs(density))))
    right = np.interp(np.linspace(0.0, size[-1], n // 2 + 1), size, half)
    offsets = np.concatenate((-right[:0:-1], right))
    if density.min() >= 0:
        return FilterTable(offsets, np.ones(n))
    signed = np.concatenate(([0.0], np.cumsum(density)))
    weights = np.diff(np.interp(right, half, signed)) * (n // 2) / signed[-1]
    return FilterTable(offsets, np.concatenate((weights[::-1], weights)))


def _gaussian(x):
    # Standard deviation a third of the radius, lowered so that it ends at zero.
    return np.exp(-4.5 * x**2) - math.exp(-4.5)


def _blackman_harris(x):
    return sum(a * np.cos(k * math.pi * x) for k, a in enumerate(BLACKMAN_HARRIS))


def _mitchell(x):
    # Mitchell and Netravali 1988, eq. 8 with B = C = 1/3; there the radius is 2.
    x = 2 * x
    inner = (7 * x**3 - 12 * x**2 + 16 / 3) / 6
    outer = (-7 / 3 * x**3 + 12 * x**2 - 20 * x + 32 / 3) / 6
    return np.where(x < 1, inner, outer)


_PROFILES = {
    "box": np.ones_like,
    "tent": lambda x: 1 - x,
    "gaussian": _gaussian,
    "blackman-harris": _blackman_harris,
    "mitchell": _mitchell,
}
FILTERS = tuple(_PROFILES)
