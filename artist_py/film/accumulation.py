"""The film: sums over iterations in float64, and the one place where non-finite contributions are rejected.

A film is a sum and the set of iterations in it. Even and odd iterations are independent randomisations
(core/rng.py), so their two means estimate the error of the image with the gain of stratification included.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from ..jit import function, kernel

REJECTED_KEPT = 1000  # places reported; all are counted
ERROR_OFFSET = 0.001  # in relMSE, as Sriwasansak et al. 2018


@kernel
def add_rows(image, sums, odd_sums, squares, bands, band_sums, is_odd, first, end, rejected):
    """Add rows [first, end) of one iteration's image to the film; `rejected` (n, 2) receives (row, column).

    Returns the number of non-finite pixels, which are left out. Optional sums are `None`.
    """
    count = 0
    for row in range(first, end):
        for column in range(image.shape[1]):
            # A comparison, and not isfinite of the sum: that is x - x == 0, which reassociation makes true of NaN.
            if abs(image[row, column, 0] + image[row, column, 1] + image[row, column, 2]) < math.inf:
                _add_pixel(image, sums, odd_sums, is_odd, row, column)
                _add_squares(squares, image, row, column)
                _add_bands(band_sums, bands, row, column)
            else:
                if count < rejected.shape[0]:
                    rejected[count, 0], rejected[count, 1] = row, column
                count += 1
    return count


@function
def _add_pixel(image, sums, odd_sums, is_odd, row, column):
    for channel in range(3):
        sums[row, column, channel] += image[row, column, channel]
        if is_odd:
            odd_sums[row, column, channel] += image[row, column, channel]


@function
def _add_squares(squares, image, row, column):
    if squares is None:
        return
    for channel in range(3):
        value = float(image[row, column, channel])
        squares[row, column, channel] += value * value


@function
def _add_bands(band_sums, bands, row, column):
    if band_sums is None:
        return
    for band in range(bands.shape[2]):
        band_sums[row, column, band] += bands[row, column, band]


@dataclass
class Film:
    """Sums of linear RGB over `iterations`; see `add_rows`."""

    height: int
    width: int
    with_squares: bool = False
    n_bands: int = 0
    iterations: int = 0
    rejected_count: int = 0
    rejected: list = field(default_factory=list)  # (x, y, iteration)

    def __post_init__(self):
        shape = (self.height, self.width, 3)
        self.sums, self.odd_sums = np.zeros(shape), np.zeros(shape, np.float32)
        self.squares = np.zeros(shape) if self.with_squares else None
        self.band_sums = np.zeros((self.height, self.width, self.n_bands)) if self.n_bands else None

    def mean(self):
        """Mean image, (h, w, 3) float64, linear RGB."""
        return self.sums / max(self.iterations, 1)

    def variance(self):
        """Variance of the mean, (h, w, 3), from the spread of single paths; `None` without `with_squares`.

        It takes paths as independent, and so overstates the variance where they are stratified.
        """
        if self.squares is None:
            return None
        n = max(self.iterations, 1)
        spread = np.maximum(self.squares / n - self.mean() ** 2, 0.0)
        return spread / max(n - 1, 1)

    def spectral(self):
        """Mean spectral image (h, w, n_bands), or `None`."""
        return None if self.band_sums is None else self.band_sums / max(self.iterations, 1)

    def error_estimate(self):
        """Estimated relMSE of the mean against the truth; `None` before two iterations.

        The means a, b of odd and even iterations are independent: E[(a - b)^2] = var a + var b, and the variance of
        the weighted mean follows from n_odd and n_even.
        """
        n, n_odd = self.iterations, self.iterations // 2
        if n_odd == 0:
            return None
        mean = self.mean()
        odd = self.odd_sums / n_odd
        even = (self.sums - self.odd_sums) / (n - n_odd)
        variance = (odd - even) ** 2 * (n_odd * (n - n_odd) / n**2)
        return float(np.mean(variance / (mean**2 + ERROR_OFFSET)))

    def reject(self, count, places, offset, iteration):
        """Note `count` dropped contributions of `iteration`; `offset` (x0, y0) makes places those of the full image."""
        self.rejected_count += count
        for row, column in places[: min(count, len(places))]:
            if len(self.rejected) < REJECTED_KEPT:
                self.rejected.append((int(column) + offset[0], int(row) + offset[1], iteration))
