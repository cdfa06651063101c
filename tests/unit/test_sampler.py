"""The image sampler: equal images whatever the threads, budgets, errors estimated, and nothing that is not finite.

Statistical tests have fixed seeds; a correct program fails one by chance with probability 1e-4; there are 9.
"""

import dataclasses
import math
import threading
from functools import cache

import numpy as np
import pytest
from rendering import FALSE_ALARM, ROUNDING, diffuse, look, render, scene, shape, with_render
from scipy import stats

from artist_py.core.spectra import spectrum_at
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum
from artist_py.film.accumulation import ERROR_OFFSET, Film, add_rows
from artist_py.samplers.stochastic import StochasticSampler
from artist_py.samplers.wavelengths import resolve_spectra, shared_wavelengths, van_der_corput
from artist_py.scene.tables import Spectra

SIZE = 70, 45  # no multiple of the tiles' 32


def room(seed=1, film=(), **settings):
    """A lamp, a ball and a wall that is not white; everything is seen to the edges of the image."""
    shapes = [
        shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
        shape("rectangle", "ball", corner=[-0.5, 0.4, -0.5], edges=[[0.6, 0, 0], [0, 0.2, 0.7]]),
        shape("rectangle", corner=[-0.3, -0.3, 0.99], edges=[[0, 0.6, 0], [0.6, 0, 0]], emission=5),
    ]
    return scene(
        shapes,
        materials={"wall": diffuse("ColorChecker orange"), "ball": diffuse(0.8)},
        camera=look([0, -0.95, 0], [0, 1, 0], 80),
        film={"resolution": SIZE, **dict(film)},
        render={"wavelength_range": [380, 780], "sampler": "sobol", "seed": seed, **settings},
    )


@pytest.fixture(scope="module")
def images():
    """(rgb, variance, spectral) of five iterations by number of threads."""
    compiled = room()
    results = [render(compiled, 5, threads=n, spectral=True, aovs=("variance",)) for n in (1, 2, 3)]
    return [(result.film.rgb, result.film.variance, result.film.spectral) for result in results]


# --- determinism --------------------------------------------------------------------------------------------------


def test_threads_do_not_matter(images):
    """Bit by bit, for the image, its variance and its spectra."""
    assert images[0][0].std() > 0
    for other in images[1:]:
        for mine, theirs in zip(images[0], other, strict=True):
            assert np.array_equal(mine, theirs)


@pytest.mark.parametrize("crop", [(0, 70, 0, 45), (13, 60, 7, 41), (69, 70, 44, 45)])
def test_a_crop_is_a_part_of_the_image(images, crop):
    """Bit by bit: pixels keep their random numbers."""
    x0, x1, y0, y1 = crop
    result = render(room(film={"crop": crop}), 5, spectral=True, aovs=("variance",))
    for whole, part in zip(
        images[0], (result.film.rgb, result.film.variance, result.film.spectral), strict=True
    ):
        assert np.array_equal(whole[y0:y1, x0:x1], part)


def test_seeds(images):
    """The same seed, the same image; another seed, another image everywhere that light is."""
    again = render(room(), 5).film.rgb
    other = render(room(seed=2), 5).film.rgb
    assert np.array_equal(images[0][0], again)
    lit = (again != 0) & (other != 0)
    assert lit.mean() > 0.9 and (again[lit] != other[lit]).mean() > 0.999


def test_iterations_do_not_depend_on_what_went_before(images):
    """In any order they make the same image, but for rounding."""
    compiled = room()
    film = Film(SIZE[1], SIZE[0])
    with StochasticSampler(compiled, film, 2) as sampler:
        for iteration in (4, 1, 0, 3, 2):
            assert sampler.iterate(iteration)
    assert np.allclose(film.mean(), images[0][0], rtol=1e-13, atol=1e-13)


def test_rays_are_counted():
    """Paths of one edge: one ray each, and no shadow ray."""
    statistics = render(room(max_path_length=1), 3).statistics
    assert statistics["paths"] == statistics["rays"] == 3 * 70 * 45
    assert statistics["shadow_rays"] == 0


# --- budgets ------------------------------------------------------------------------------------------------------


def test_time_ends_a_render():
    result = render(room(), iterations=None, time_seconds=0.3)
    assert 1 <= result.film.iterations < 10**6
    # What lies between phases, microseconds, is in none of them.
    assert 0.29 <= sum(result.statistics["phase_seconds"].values()) < 60
    assert not result.interrupted


ENOUGH = 0.02


def test_error_ends_a_render():
    """At the first even number of iterations whose estimate is low enough."""
    compiled = room()
    result = render(compiled, iterations=None, error=ENOUGH)
    n = result.film.iterations
    assert result.statistics["error_estimate"] <= ENOUGH
    assert n % 2 == 0 and n > 2
    assert render(compiled, n - 2).statistics["error_estimate"] > ENOUGH
    assert np.array_equal(render(compiled, n).film.rgb, result.film.rgb)


def test_whichever_limit_comes_first():
    assert render(room(), iterations=3, time_seconds=1000, error=1e-12).film.iterations == 3


class Stopping:
    """An observer that stops the render when it has heard of two iterations."""

    def __init__(self, stop):
        self.stop, self.seen = stop, []

    def progress(self, iteration, *rest):
        self.seen.append(iteration)
        self.stop.set()

    def __getattr__(self, name):
        return lambda *args: None


def test_stopping_leaves_a_whole_number_of_iterations():
    """The image is that of a render of as many iterations, bit by bit."""
    stop = threading.Event()
    result = render(room(), 10**6, stop=stop, observer=Stopping(stop))
    n = result.film.iterations
    assert result.interrupted and 1 <= n < 1000
    assert np.array_equal(result.film.rgb, render(room(), n).film.rgb)


def test_stopping_in_the_middle():
    """From another thread, at any time: what was begun and not finished is left out."""
    stop = threading.Event()
    timer = threading.Timer(0.4, stop.set)
    compiled = room(film={"resolution": [256, 256]})
    render(compiled, 1)
    timer.start()
    result = render(compiled, 10**6, stop=stop)
    assert result.interrupted
    assert np.array_equal(result.film.rgb, render(compiled, result.film.iterations).film.rgb)


def test_stopping_before_the_start():
    """There is an image, black where no tile was reached, and it says so."""
    warnings = []

    class Listening(Stopping):
        def warning(self, text):
            warnings.append(text)

    stop = threading.Event()
    stop.set()
    result = render(room(), 5, stop=stop, observer=Listening(stop))
    assert result.interrupted and result.film.iterations == 1
    assert np.isfinite(result.film.rgb).all()
    assert result.film.rgb.any() or "black" in warnings[0]


def test_the_variance_alone_takes_no_rays_of_its_own(monkeypatch):
    def refuse(*args):
        pytest.fail("first hits are traced, which nobody asked for")

    monkeypatch.setattr("artist_py.samplers.render_job.render_aovs", refuse)
    assert render(room(), 2, aovs=("variance",)).film.variance is not None


# --- estimates of the error ---------------------------------------------------------------------------------------

SEEDS = 64


def furnace(compiled, iterations):
    """A closed room of radiance 2 everywhere: estimated and true relMSE, mean and variance image."""
    truth = 2 * compiled.spectra[:3].sum(axis=1, dtype=float)
    result = render(compiled, iterations, aovs=("variance",))
    mean = result.film.rgb
    true = np.mean((mean - truth) ** 2 / (truth**2 + ERROR_OFFSET))
    return result.statistics["error_estimate"], true, mean, result.film.variance


@pytest.fixture(scope="module")
def runs():
    """`furnace` for 64 seeds, by sampler and number of iterations."""
    compiled = scene(
        [shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True, emission=1)],
        materials={"wall": diffuse(0.5)},
        film={"resolution": [8, 8]},
        render={"max_path_length": 40, "wavelength_range": [380, 780]},
    )

    @cache
    def runs_of(sampler, iterations):
        scenes = (with_render(compiled, sampler=sampler, seed=seed) for seed in range(SEEDS))
        return [furnace(each, iterations) for each in scenes]

    return runs_of


@pytest.mark.parametrize("how", [("sobol", 32), ("sobol", 33), ("independent", 32)], ids=str)
def test_error_estimate(runs, how):
    """Over 64 seeds the mean estimate is the mean relMSE, within 4 standard errors and 3 % for its denominator."""
    runs = runs(*how)
    estimates, truths = np.array([run[:2] for run in runs]).T
    excess = estimates - truths
    error = excess.std(ddof=1) / math.sqrt(SEEDS)
    assert error < 0.1 * truths.mean()
    assert abs(excess.mean()) < stats.t.isf(FALSE_ALARM / 2, SEEDS - 1) * error + 0.03 * truths.mean()


def test_variance_is_that_between_seeds(runs):
    """With independent numbers: the mean of the variance images is the variance of the mean images."""
    runs = runs("independent", 32)
    means, variances = np.array([run[2] for run in runs]), np.array([run[3] for run in runs])
    between = means.var(axis=0, ddof=1)
    ratio = between.mean(axis=(0, 1)) / variances.mean(axis=(0, 1, 2))
    # 64 pixels of 63 degrees of freedom each: 2.2 % for normal means, and half as much again for the estimate.
    assert np.abs(ratio - 1).max() < 4 * 0.033


def test_variance_overstates_that_of_stratified_paths(runs):
    runs = runs("sobol", 32)
    means, variances = np.array([run[2] for run in runs]), np.array([run[3] for run in runs])
    assert means.var(axis=0, ddof=1).mean() < 0.8 * variances.mean()


# --- what is not finite -------------------------------------------------------------------------------------------


def test_non_finite_contributions_are_dropped_and_counted():
    """By the film alone: NaN and infinities of either sign, in any channel."""
    film = Film(3, 4, with_squares=True, n_bands=2)
    image = np.ones((3, 4, 3), np.float32)
    bands = np.ones((3, 4, 2), np.float32)
    image[0, 1, 0], image[1, 3, 1], image[2, 0, 2] = np.nan, np.inf, -np.inf
    places = np.zeros((10, 2), np.int64)
    count = add_rows(image, film.sums, film.odd_sums, film.squares, bands, film.band_sums, True, 0, 3, places)
    film.reject(count, places, (100, 200), 7)
    film.iterations = 1
    assert film.rejected_count == 3
    assert film.rejected == [(101, 200, 7), (103, 201, 7), (100, 202, 7)]
    kept = np.isfinite(image).all(axis=2)
    for sums in (film.sums, film.odd_sums, film.squares, film.band_sums):
        assert np.array_equal(sums, np.broadcast_to(kept[..., None], sums.shape))


def test_more_rejections_than_are_kept_are_still_counted():
    film = Film(2, 2)
    image, places = np.full((2, 2, 3), np.nan, np.float32), np.zeros((1, 2), np.int64)
    count = add_rows(image, film.sums, film.odd_sums, None, None, None, False, 0, 2, places)
    film.reject(count, places, (0, 0), 0)
    assert (film.rejected_count, film.rejected) == (4, [(0, 0, 0)])
    assert not film.sums.any()


def test_a_lamp_beyond_float32_does_not_end_a_render():
    """Its pixels are dropped, said and counted; the rest of the image is as without it."""
    lamps = [
        shape("rectangle", corner=[-2, 2, -2], edges=[[2, 0, 0], [0, 0, 4]], emission=1),
        shape(
            "rectangle",
            corner=[0, 2, -2],
            edges=[[2, 0, 0], [0, 0, 4]],
            emission={"spectrum": 1e30, "radiance": 1e30},
        ),
    ]
    compiled = scene(lamps, film={"resolution": [8, 4]})
    film = render(compiled, 6).film
    assert np.isfinite(film.rgb).all()
    assert film.rejected_count == 6 * 16
    assert {(x, y) for x, y, _ in film.rejected} == {(x, y) for x in range(4, 8) for y in range(4)}
    assert (film.rgb[:, :4, 1] > 0).all() and not film.rgb[:, 4:].any()


# --- wavelengths of an iteration ----------------------------------------------------------------------------------

NODES = 380 + 400 * np.linspace(0, 1, 1025) ** 1.5


def test_van_der_corput():
    assert [van_der_corput(i) for i in range(6)] == [0, 0.5, 0.25, 0.75, 0.125, 0.625]


@pytest.mark.parametrize("count", [1, 4, 8])
@pytest.mark.parametrize("parity", [0, 1])
def test_shared_wavelengths_are_stratified(count, parity):
    """Over 2^m iterations of a parity they fall into equal parts, one each; and they integrate well."""
    pairs = np.array([shared_wavelengths(NODES, count, 3, 2 * i + parity) for i in range(64)])
    wavelengths, weights = pairs[:, 0], pairs[:, 1]
    place = np.interp(wavelengths, NODES, np.linspace(0, 1, 1025)) * count * 64
    part = np.sort(np.floor(np.sort(place.ravel()) - place.min() % 1 + 1e-6))
    assert np.array_equal(part - part[0], np.arange(count * 64))
    assert np.mean((weights * np.sin(wavelengths / 30)).sum(axis=1)) == pytest.approx(
        -30 * (math.cos(780 / 30) - math.cos(380 / 30)), abs=4
    )


def test_shared_wavelengths_differ_between_seeds_and_parities():
    offsets = [shared_wavelengths(NODES, 4, seed, parity)[0, 0] for seed in range(20) for parity in (0, 1)]
    assert len(set(offsets)) == 40


def test_resolved_spectra_are_those_read_by_bin():
    """What a kernel reads of an iteration's table is what it would read of the full one; indices go linearly."""
    dense = np.random.default_rng(1).random((5, 400)).astype(np.float32)
    wavelengths = np.array([380.0, 500.25, 611.999, 779.99])
    resolved = resolve_spectra(dense, [3], 380, wavelengths)
    full = Spectra(None, Table(dense), 380.0)
    lanes = Spectrum(wavelengths)
    for row in (0, 1, 4):
        assert np.array_equal(
            np.asarray(spectrum_at(resolved, row, lanes)), np.asarray(spectrum_at(full, row, lanes))
        )
    centres = 380.5 + np.arange(400)
    assert np.allclose(
        np.asarray(spectrum_at(resolved, 3, lanes)), np.interp(wavelengths, centres, dense[3]), rtol=ROUNDING
    )


def test_results_are_records():
    """Statistics and film of a render are complete: no field is missing."""
    result = render(room(), 2)
    assert {
        "rays",
        "paths",
        "cache_hits",
        "cache_misses",
        "compile_seconds",
        "rejected_contributions",
    } <= set(result.statistics)
    assert dataclasses.is_dataclass(result.film)
