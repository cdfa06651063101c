"""Says which cells of the matrix are right: Z-tests over independent batches, with a stated chance of a false alarm.

A cell compares the mean of the image and those of its quarters, each with the standard error of its batches. Of all
comparisons of a run, one fails a correct program by chance with probability `FALSE_ALARM` (Sidak). A cell whose
standard error is larger than the case asks for is no success: noise cannot hide a fault.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

from artist_py.stress.case import Radiance, Refusal, Sane

FALSE_ALARM = 1e-3
COMPARISONS = 5  # of a cell: four regions and the whole


@dataclass(frozen=True)
class Verdict:
    """`status` is "ok" or what is wrong; `z` the largest deviation in standard errors, where there is one."""

    status: str
    text: str = ""
    z: float | None = None
    deviation: float | None = None  # of the mean, relative to what is expected
    error: float | None = None  # the standard error of that

    @property
    def is_ok(self):
        return self.status == "ok"


def chance_per_comparison(n_cells):
    """What one comparison of a run of so many cells may fail by."""
    return -math.expm1(math.log1p(-FALSE_ALARM) / (COMPARISONS * max(n_cells, 1)))


def judge(case, integrator, found, reference, chance):
    """The `Verdict` of a cell's `Measurement`; `reference` is that of what `SameAs` names, or `None`."""
    if isinstance(case.expect, Refusal):
        return _judge_refusal(case.expect, found)
    fault = _fault(case, found)
    if fault or isinstance(case.expect, Sane):
        return fault or Verdict("ok")
    expected = _expected(case, integrator, found, reference)
    if expected is None:
        return Verdict("unknown", f"{case.expect.integrator}, which it is compared with, has no image")
    return _judge_means(case, integrator, mean_and_error(found.means), expected, chance, len(found.means) - 1)


def _judge_refusal(expect, found):
    if found.code != expect.code:
        return Verdict(
            "not refused", f"exit code {found.code} instead of {expect.code}: {found.message[-400:]}"
        )
    if expect.text not in found.message or "Traceback" in found.message:
        return Verdict("unclear", f'expected "{expect.text}", found "{found.message[-400:]}"')
    return Verdict("ok", found.message)


def _fault(case, found):
    """What no image may have, or `None`."""
    if found.non_finite:
        return Verdict("not finite", f"{found.non_finite} contributions were not finite and were dropped")
    if not np.isfinite(found.means).all():
        return Verdict("not finite", "the film holds values that are not finite")
    if found.negative:
        return Verdict("negative", f"{found.negative} pixels of single iterations were negative")
    if case.warning and not any(case.warning in text for text in found.warnings):
        return Verdict("no warning", f'expected the warning "{case.warning}", found {list(found.warnings)}')
    return None


def _expected(case, integrator, found, reference):
    """Expected means of the regions and the standard errors of these, or `None` where there are none."""
    n_regions = found.means.shape[1]
    if isinstance(case.expect, Radiance):
        return np.full(n_regions, float(case.expect.value)), np.zeros(n_regions)
    if integrator == case.expect.integrator:
        return mean_and_error(found.means)
    return None if reference is None or reference.means is None else mean_and_error(reference.means)


def _judge_means(case, integrator, found, expected, chance, freedom):
    size = abs(float(expected[0][-1])) or 1.0
    error = np.hypot(found[1], expected[1])
    allowed = size * (case.rounding + case.expect.bias.get(integrator, 0.0))
    beyond = np.maximum(np.abs(found[0] - expected[0]) - allowed, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        z = float(np.where(beyond > 0.0, beyond / error, 0.0).max())
    figures = {
        "z": z,
        "deviation": float(found[0][-1] - expected[0][-1]) / size,
        "error": float(error[-1]) / size,
    }
    if z > quantile(chance, freedom):
        what = f"{found[0][-1]:.6g} instead of {expected[0][-1]:.6g}; one part is {z:.1f} standard errors off"
        return Verdict("wrong", what, **figures)
    precision = case.precision_of(integrator)
    if found[1][-1] > precision * size:
        what = f"standard error {found[1][-1] / size:.2g}, wanted is {precision:.2g} at most"
        return Verdict("too noisy", what, **figures)
    return Verdict("ok", **figures)


def mean_and_error(means):
    """Means over batches (batches, regions), and their standard errors."""
    return means.mean(axis=0), means.std(axis=0, ddof=1) / math.sqrt(len(means))


def quantile(chance, freedom):
    """How many standard errors a mean may be off, to either side; Student's t."""
    return float(stats.t.isf(0.5 * chance, freedom))
