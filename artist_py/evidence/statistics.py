"""What repeats say: medians with bands of known coverage, and slopes."""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import stats

CONFIDENCE = 0.95


class Interval(NamedTuple):
    """A median and what it may be; `coverage` is the probability that the true median is between `low` and `high`."""

    median: float
    low: float
    high: float
    coverage: float


def median_interval(values, confidence=CONFIDENCE):
    """`Interval` of independent values of one distribution, whatever it is.

    Between the k-th smallest and the k-th largest of n values lies the true median with probability
    1 - 2 P(B < k), B binomial (n, 1/2): the narrowest such interval that reaches `confidence`, else that of all
    values, which for n = 3 reaches 3/4. David and Nagaraja 2003, Order Statistics, section 7.1.
    """
    values = np.sort(np.asarray(values, float)).tolist()
    k, coverage = _rank(len(values), confidence)
    return Interval(float(np.median(values)), values[k - 1], values[-k], coverage)


@cache
def _rank(count, confidence):
    """`(k, coverage)` of `median_interval`."""
    for k in range((count + 1) // 2, 0, -1):
        coverage = 1.0 - 2.0 * float(stats.binom.cdf(k - 1, count, 0.5))
        if coverage >= confidence or k == 1:
            return k, max(0.0, coverage)
    raise ValueError("no values")


def log_slope(seconds, errors):
    """Exponent p of errors ~ seconds^p, by least squares of the logarithms; None for fewer than two places."""
    x, y = np.log(seconds), np.log(errors)
    if len(x) < 2 or np.ptp(x) == 0.0:
        return None
    return float(np.polynomial.polynomial.polyfit(x, y, 1)[1])


def slope_of(rows, axis, metric="relmse"):
    """`Interval` of the slopes of an entry's repeats, rows below the reference left out; None if there are none.

    Looks at one render are correlated, and so each repeat has its own slope; their spread says how sure it is. For
    relMSE the part of the reference is taken off first.
    """
    slopes = []
    for repeat in sorted({row.repeat for row in rows}):
        good = [row for row in rows if row.repeat == repeat and not row.is_below_reference]
        errors = [row.own_relmse if metric == "relmse" else row.smape for row in good]
        slope = log_slope([row.along(axis) for row in good], errors) if len(good) > 1 else None
        if slope is not None:
            slopes.append(slope)
    return median_interval(slopes) if slopes else None


def summary(convergence):
    """Per entry and mark, over repeats: a list of dicts, for tables and JSON."""
    return [
        _cell(entry.label, mark, [row for row in convergence.rows_of(entry.label) if row.mark == mark])
        for entry in convergence.entries
        for mark in sorted({row.mark for row in convergence.rows_of(entry.label)})
    ]


def _cell(label, mark, rows):
    def median(name):
        return float(np.median([getattr(row, name) for row in rows]))

    error, shape = median_interval([row.relmse for row in rows]), median_interval([row.smape for row in rows])
    own = [row.own_relmse for row in rows if row.own_relmse is not None]
    return {
        "entry": label,
        "mark": mark,
        "repeats": len(rows),
        "coverage": error.coverage,
        "wall_seconds": median("wall_seconds"),
        "cpu_seconds": median("cpu_seconds"),
        "iterations": median("iterations"),
        "relmse": error.median,
        "relmse_low": error.low,
        "relmse_high": error.high,
        "own_relmse": float(np.median(own)) if own else None,
        "smape": shape.median,
        "smape_low": shape.low,
        "smape_high": shape.high,
        "is_below_reference": any(row.is_below_reference for row in rows),
        "mean_ratio": _interval_of([row.mean_ratio for row in rows]),
        "rays": median("rays") + median("shadow_rays"),
        "peak_memory_bytes": max(row.peak_memory_bytes for row in rows),
        "render_memory_bytes": max(row.render_memory_bytes for row in rows),
    }


def _interval_of(values):
    """`[median, low, high]`; None where a value is not known."""
    return None if None in values else list(median_interval(values)[:3])


def slopes(convergence):
    """`{entry: {metric: Interval or None}}` along the convergence's axis."""
    return {
        entry.label: {
            metric: slope_of(convergence.rows_of(entry.label), convergence.axis, metric)
            for metric in ("relmse", "smape")
        }
        for entry in convergence.entries
    }


def clock_of(axis):
    """Name of the seconds that rates refer to."""
    return "cpu_seconds" if axis == "cpu" else "wall_seconds"


def speed_up(cells, label, base, axis="wall"):
    """How many times less time entry `label` needs than `base` for the same error, at their last common mark.

    The clock is that of `axis`, of the wall for iterations. Where errors fall as 1 / seconds, that is the ratio of
    error times seconds. None where one is below the reference or has no rows.
    """
    marks = {cell["mark"] for cell in cells if cell["entry"] == label}
    marks &= {cell["mark"] for cell in cells if cell["entry"] == base}
    if not marks:
        return None
    mine, theirs = (
        next(cell for cell in cells if cell["entry"] == name and cell["mark"] == max(marks))
        for name in (label, base)
    )
    if mine["is_below_reference"] or theirs["is_below_reference"]:
        return None
    costs = [cell["own_relmse"] * cell[clock_of(axis)] for cell in (theirs, mine)]
    return costs[0] / costs[1] if math.isfinite(costs[0]) and costs[1] > 0 else None
