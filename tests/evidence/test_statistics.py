"""Medians with their bands, and slopes. Fixed seeds; a frequency is off by 5 standard errors with probability 6e-7."""

import math

import numpy as np
import pytest

from artist_py.evidence.convergence import Convergence, Row
from artist_py.evidence.entries import Entry
from artist_py.evidence.reference import Reference
from artist_py.evidence.statistics import log_slope, median_interval, slope_of, speed_up, summary

TRIALS = 4000


def row(entry="pt", repeat=0, mark=1.0, relmse=0.1, own=None, wall=None, below=False):
    """A row with an error, and something in the other fields."""
    wall = mark if wall is None else wall
    own = relmse if own is None else own
    return Row(entry, repeat, repeat, mark, wall, 2 * wall, 10, 1000, 50, 30, 10**8, 10**7, relmse, own, relmse**0.5,
               None, below, 0)  # fmt: skip


def convergence(rows, *names):
    """A `Convergence` of these rows."""
    entries = [Entry(name, name, ()) for name in names or ("pt",)]
    return Convergence("room.toml", entries, "wall", [1.0, 2.0], Reference(None, None), {}, rows)


class TestMedians:
    """Bands."""

    @pytest.mark.parametrize(("count", "coverage"), [(2, 0.5), (3, 0.75), (6, 0.96875)])
    def test_all_values(self, count, coverage):
        """Few values: from the least to the largest, with the coverage that has."""
        values = np.arange(count, dtype=float)
        assert median_interval(values[::-1]) == (np.median(values), 0.0, count - 1.0, coverage)

    def test_one_value(self):
        """Covers nothing."""
        assert median_interval([3.0]) == (3.0, 3.0, 3.0, 0.0)

    @pytest.mark.parametrize("count", [3, 9, 20])
    def test_coverage(self, count):
        """As often as it says, for a skewed distribution, and at least 95 % from 6 values on."""
        samples = np.random.default_rng(1).exponential(size=(TRIALS, count))
        intervals = [median_interval(each) for each in samples]
        covered = np.mean([low <= math.log(2) <= high for _, low, high, _ in intervals])
        expected = intervals[0].coverage
        assert covered == pytest.approx(expected, abs=5 * math.sqrt(expected * (1 - expected) / TRIALS))
        assert expected >= 0.95 or count < 6


class TestSlopes:
    """Errors that fall as a power of time."""

    def test_power_law(self):
        """Exactly; and nothing from one place."""
        seconds = np.array([1.0, 2.0, 5.0, 10.0])
        assert log_slope(seconds, 3 * seconds**-0.7) == pytest.approx(-0.7)
        assert log_slope([1.0], [1.0]) is None

    def test_what_the_reference_adds_is_taken_off(self):
        """With a reference of relMSE 0.01, and rows below it left out."""
        rows = [row(mark=t, relmse=0.1 / t + 0.01, own=0.1 / t, below=t > 9) for t in (1, 2, 5, 10, 20)]
        assert slope_of(rows, "wall").median == pytest.approx(-1.0)
        assert slope_of(rows[:1], "wall") is None

    def test_repeats(self):
        """The middle one of their slopes, and their range."""
        rows = [row(repeat=i, mark=t, relmse=t**-p) for i, p in enumerate((0.5, 1.0, 0.8)) for t in (1, 2, 4)]
        found = slope_of(rows, "cpu")
        assert (found.median, found.low, found.high) == pytest.approx((-0.8, -1.0, -0.5))
        assert slope_of(rows, "wall", "smape").median == pytest.approx(-0.4)


class TestSummary:
    """A line per entry and mark."""

    def test_medians(self):
        """Over repeats; a mark that one row is below the reference at is marked."""
        rows = [row(repeat=i, mark=m, relmse=e / m, below=m == 2 and i == 1) for i, e in enumerate((0.1, 0.3, 0.2))
                for m in (1, 2)]  # fmt: skip
        first, second = summary(convergence(rows))
        assert (first["relmse"], first["relmse_low"], first["relmse_high"]) == (0.2, 0.1, 0.3)
        assert first["coverage"] == 0.75
        assert first["rays"] == 80
        assert first["mean_ratio"] is None
        assert (first["is_below_reference"], second["is_below_reference"]) == (False, True)

    def test_speed_up(self):
        """Half the error in half the time again: four times."""
        rows = [row("pt", mark=2, relmse=0.2), row("bpt", mark=2, relmse=0.1, wall=1.0), row("bpt", mark=4)]
        cells = summary(convergence(rows, "pt", "bpt"))
        assert speed_up(cells, "bpt", "pt") == pytest.approx(4.0)
        assert speed_up(cells, "pt", "bpt") == pytest.approx(0.25)
        assert speed_up(cells, "pt", "vcm") is None
        below = summary(convergence([row("pt", below=True), row("bpt")], "pt", "bpt"))
        assert speed_up(below, "bpt", "pt") is None
