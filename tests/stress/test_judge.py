"""Verdicts on made-up measurements, and how often they are false. Fixed seeds."""

import numpy as np
import pytest
from scipy import stats

from artist_py.stress.case import Case, Radiance, Refusal, SameAs, Sane
from artist_py.stress.judge import FALSE_ALARM, chance_per_comparison, judge, quantile
from artist_py.stress.measure import BATCHES, Measurement, count_negative, region_means

CHANCE = 1e-6


def case(expect, **more):
    return Case("name", "shows", {}, expect, **more)


def measured(offset=0.0, spread=0.01, seed=1, **more):
    """Batches of five regions around 1 + `offset`."""
    noise = np.random.default_rng(seed).normal(0.0, spread, (BATCHES, 5))
    return Measurement(means=1.0 + offset + noise, **more)


def verdict(expect, found, reference=None, integrator="vcm", **more):
    return judge(case(expect, **more), integrator, found, reference, CHANCE)


def test_what_is_right():
    result = verdict(Radiance(1.0), measured())
    assert result.is_ok
    assert 0.0 < result.z < 4.0
    assert result.error == pytest.approx(0.01 / np.sqrt(BATCHES), rel=0.3)


@pytest.mark.parametrize("offset", [0.02, -0.02])
def test_what_is_two_per_cent_off(offset):
    """Eleven standard errors."""
    result = verdict(Radiance(1.0), measured(offset))
    assert result.status == "wrong"
    assert result.deviation == pytest.approx(offset, abs=0.005)


def test_a_fault_in_one_quarter():
    found = measured()
    found.means[:, 2] += 0.02
    assert verdict(Radiance(1.0), found).status == "wrong"


def test_noise_is_no_success():
    assert verdict(Radiance(1.0), measured(spread=0.2), precision=0.01).status == "too noisy"


def test_some_integrators_may_be_noisier():
    found = measured(spread=0.2)
    assert verdict(Radiance(1.0), found, noisier={"vcm": 0.1}).is_ok
    assert verdict(Radiance(1.0), found, noisier={"vcm": 0.1}, integrator="pt").status == "too noisy"


def test_a_stated_bias_is_that_of_one_integrator():
    expect = Radiance(1.0, bias={"ppm": 0.03})
    assert verdict(expect, measured(0.02), integrator="ppm").is_ok
    assert not verdict(expect, measured(0.02), integrator="bpm").is_ok


def test_without_noise_rounding_alone_is_allowed():
    exact = Measurement(means=np.full((BATCHES, 5), 1.0 + 0.9e-5))
    assert verdict(Radiance(1.0), exact).is_ok
    assert not verdict(Radiance(1.0), Measurement(means=exact.means + 0.2e-5)).is_ok


def test_black_is_black():
    assert verdict(Radiance(0.0), Measurement(means=np.zeros((BATCHES, 5)))).is_ok
    assert not verdict(Radiance(0.0), measured()).is_ok


def test_other_integrator():
    """Both errors count; what has nothing to be compared with is no success."""
    other = measured(seed=2)
    assert verdict(SameAs("pt"), measured(), other).is_ok
    assert verdict(SameAs("pt"), measured(0.03), other).status == "wrong"
    assert verdict(SameAs("pt"), measured(), None).status == "unknown"
    assert verdict(SameAs("pt"), measured(), None, integrator="pt").is_ok


@pytest.mark.parametrize(
    ("found", "status"),
    [
        (measured(non_finite=1), "not finite"),
        (measured(negative=1), "negative"),
        (Measurement(means=np.full((BATCHES, 5), np.nan)), "not finite"),
        (measured(), "ok"),
    ],
)
def test_what_no_image_may_have(found, status):
    assert verdict(Sane(), found).status == status
    assert verdict(Radiance(1.0), found).status == status


def test_a_warning_that_must_be_given():
    assert verdict(Sane(), measured(), warning="black").status == "no warning"
    assert verdict(Sane(), measured(warnings=("it will be black",)), warning="black").is_ok


@pytest.mark.parametrize(
    ("code", "message", "status"),
    [
        (2, "scene.toml: film: too large", "ok"),
        (0, "", "not refused"),
        (1, "too large", "not refused"),
        (2, "something else", "unclear"),
        (2, "Traceback (most recent call last): too large", "unclear"),
    ],
)
def test_refusals(code, message, status):
    assert verdict(Refusal("too large"), Measurement(code=code, message=message)).status == status


def test_false_alarms_are_as_rare_as_stated():
    """Of 40 000 comparisons of right values one in a hundred fails: within what that leaves to chance, 1e-4."""
    n, chance = 40_000, 0.01
    batches = np.random.default_rng(3).normal(size=(BATCHES, n))
    z = np.abs(batches.mean(axis=0)) / (batches.std(axis=0, ddof=1) / np.sqrt(BATCHES))
    failed = int((z > quantile(chance, BATCHES - 1)).sum())
    assert stats.binomtest(failed, n, chance).pvalue > 1e-4


def test_chance_of_a_run():
    """All comparisons of all cells together."""
    assert 1.0 - (1.0 - chance_per_comparison(500)) ** 2500 == pytest.approx(FALSE_ALARM)


def test_negative_light_and_colours_outside_of_srgb():
    """Green light of one wavelength has negative red; less than no light is something else."""
    green = np.array([[[-0.6, 1.0, -0.1]]])
    assert count_negative(green) == 0
    assert count_negative(-green) == 1
    assert count_negative(np.array([[[1e-3, -1e-2, 0.0]]])) == 1


@pytest.mark.parametrize(("shape", "count"), [((4, 4), 5), ((1, 1), 2), ((1, 6), 3), ((5, 3), 5)])
def test_regions(shape, count):
    means = region_means(np.arange(np.prod(shape), dtype=float).reshape(shape))
    assert len(means) == count
    assert means[-1] == pytest.approx((np.prod(shape) - 1) / 2)
