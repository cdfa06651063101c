"""The rooms of test_fluorescent_rooms.py by paths whose wavelengths shift, against linear algebra on bins of 1 nm.

Merging within a tolerance blurs what is reflected elastically, and in these rooms exactly so: by merges on spheres
nothing else is lost (theory 3.10), so that photon mapping has an expectation for each tolerance, which is compared with
here, and which becomes the solution on bins as the tolerance shrinks. Fixed seeds; a correct program fails one
comparison by chance with probability 1e-4.
"""

import math

import numpy as np
import pytest
from fluorescence import INNER, OUTER, SHARE, Surfaces, colours, on_bins, room
from rendering import FALSE_ALARM, render, with_render
from scipy import stats
from test_fluorescent_rooms import glass_room

from artist_py.samplers.wavelengths import tolerance_of

ROUNDING = 2e-5  # relative; long paths carry float32
SEEDS = range(1, 25)
PARTS = 16  # of a bin, over which wavelengths of eye paths are taken to be spread


def assert_colour(values, expected, precision):
    """Independent values (n, 3) have the mean `expected` (3,), known to a `precision` of its largest channel."""
    size = np.abs(expected).max()
    error = values.std(axis=0, ddof=1) / math.sqrt(len(values))
    assert (error < precision * size).all(), error / size
    limit = stats.t.isf(FALSE_ALARM / 6, len(values) - 1) * error + ROUNDING * size
    deviation = values.mean(axis=0) - expected
    assert (np.abs(deviation) < limit).all(), (deviation / size, error / size)


# --- path tracing -------------------------------------------------------------------------------------------------


def assert_path_tracing(precision, iterations, seen=OUTER, **settings):
    compiled = room(seen, integrator="pt", wavelengths="independent", **settings)
    pixels = render(compiled, iterations).film.rgb.reshape(-1, 3)
    expected = colours(on_bins(compiled), compiled.graph.render.max_path_length)[seen]
    assert_colour(pixels.astype(float), expected, precision)


@pytest.mark.parametrize("seen", [INNER, OUTER])
def test_path_tracing(seen):
    assert_path_tracing(1.5e-3, 400, seen)


@pytest.mark.parametrize("edges", [1, 2, 3])
def test_limited_length(edges):
    """No fluorescent event, one, and two at different surfaces."""
    assert_path_tracing(1.5e-3, 400, max_path_length=edges)


def test_roulette_from_the_start():
    assert_path_tracing(2e-3, 400, roulette_length=0)


@pytest.mark.slow
def test_one_wavelength():
    assert_path_tracing(4e-3, 400, hero_count=1)


@pytest.mark.slow
def test_dispersion():
    """A dispersive surface keeps one wavelength, which then shifts alone."""
    compiled = glass_room(integrator="pt", wavelengths="independent")
    pixels = render(compiled, 400).film.rgb.reshape(-1, 3)
    surfaces = on_bins(compiled)
    light = np.linalg.solve(np.eye(surfaces.emission.shape[1]) - surfaces.scatter[0], surfaces.emission[0])
    assert_colour(pixels.astype(float), surfaces.response @ light, 8e-3)


# --- photon mapping -----------------------------------------------------------------------------------------------


def blur(bins, tolerance):
    """What an eye path in a bin is told of a spectrum: its mean within the tolerance (bins, bins)."""
    wavelengths = (np.arange(bins * PARTS) + 0.5) / PARTS
    low, high = np.maximum(wavelengths - tolerance, 0.0), np.minimum(wavelengths + tolerance, bins)
    start = np.arange(bins)
    overlap = np.minimum(high[:, None], start + 1) - np.maximum(low[:, None], start)
    weights = np.maximum(overlap, 0.0) / (high - low)[:, None]
    return weights.reshape(bins, PARTS, bins).mean(axis=1)


def seen_by_photons(surfaces, seen, edges, tolerance):
    """RGB of one of the two spheres by photon mapping: merges blur what it reflects, and light is what it is."""
    light, part = surfaces.emission.copy(), surfaces.emission
    for _ in range(edges - 2):
        part = np.einsum("soi,si->so", surfaces.scatter, around(part))
        light = light + part
    elastic = np.diag(surfaces.elastic[seen]) @ blur(light.shape[1], tolerance)
    glow = surfaces.scatter[seen] - np.diag(surfaces.elastic[seen])
    radiance = surfaces.emission[seen] + (elastic + glow) @ around(light)[seen]
    return surfaces.response @ radiance


def around(light):
    """What arrives at either sphere of the light that both give off."""
    return np.array([light[OUTER], SHARE * light[INNER] + (1.0 - SHARE) * light[OUTER]])


class WithElastic:
    """`Surfaces` of a scene, and the elastic part of its diagonals: dyes have nothing there."""

    def __init__(self, surfaces: Surfaces):
        self.emission, self.scatter, self.response = surfaces
        self.elastic = np.diagonal(self.scatter, axis1=1, axis2=2)


def photon_room(seen, **settings):
    merging = {"radius": 0.05, "alpha": 1, "light_paths": 4, **settings.pop("merging")}
    return room(seen, integrator="ppm", wavelengths="rotate", hero_count=1, **settings, merging=merging)


def assert_photon_mapping(precision, iterations, seen, **settings):
    compiled = photon_room(seen, **settings)
    # Pixels share photons, and are not independent; renders of other seeds are.
    means = [
        render(with_render(compiled, seed=seed), iterations).film.rgb.mean(axis=(0, 1)) for seed in SEEDS
    ]
    surfaces, graph = WithElastic(on_bins(compiled)), compiled.graph.render
    expected = [
        seen_by_photons(surfaces, seen, graph.max_path_length, tolerance_of(graph.merging, i))
        for i in range(iterations)
    ]
    assert_colour(np.array(means, float), np.mean(expected, axis=0), precision)


@pytest.mark.parametrize("seen", [INNER, OUTER])
def test_photon_mapping(seen):
    """The usual tolerance, which shrinks."""
    merging = {"wavelength_tolerance": 50, "tolerance_exponent": 0.25}
    assert_photon_mapping(8e-3, 8, seen, merging=merging)


def test_photons_of_two_edges():
    """Light of lamps alone, on dyes."""
    merging = {"wavelength_tolerance": 30}
    assert_photon_mapping(8e-3, 8, OUTER, merging=merging, max_path_length=2)


def test_what_the_tolerance_blurs_vanishes():
    """What the tests above expect becomes the solution on bins, at most with the first power of the tolerance."""
    compiled = photon_room(OUTER, merging={"wavelength_tolerance": 50, "tolerance_exponent": 0.25})
    surfaces, edges = on_bins(compiled), compiled.graph.render.max_path_length
    exact = colours(surfaces, edges)[OUTER]

    def bias(tolerance):
        found = seen_by_photons(WithElastic(surfaces), OUTER, edges, tolerance)
        return np.abs(found - exact).max() / exact.max()

    assert 1e-3 < bias(50.0) < 0.1
    assert bias(25.0) < 0.6 * bias(50.0) and bias(5.0) < 0.15 * bias(50.0) and bias(0.5) < 1e-4
