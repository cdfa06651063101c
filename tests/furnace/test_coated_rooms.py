"""Rooms of fluorescent paint under a clear coat, by every integrator.

In a sphere a straight line meets the wall at the same angle at both ends, and so does light that the coat mirrors. The
wall has the radiance L(mu) in the direction of cosine mu, the same everywhere: with F(mu) for the coat's reflectance,
T = 1 - F, T_m the mean of T, K what becomes of light between entering and leaving the coat, and <.> the mean over 2 mu
dmu,

    L = E + F L + (T / T_m) K <T L>,

a vector over wavelengths at each mu, by one more edge of the paths with each time that the right side is put to itself.
With all paths L = E / T + K (I - K)^-1 E / T_m. Given its wavelengths an iteration has that expectation, as in
test_fluorescent_rooms.py. Fixed seeds; a correct program fails one comparison by chance with probability 1e-4.
"""

import numpy as np
import pytest
from fluorescence import (
    CASCADE,
    LAMP,
    RANGE,
    assert_deviations_vanish,
    iteration_colours,
    iteration_images,
    on_bins,
    on_sets,
)
from rendering import look, scene, shape
from scipy import stats
from test_shifting_wavelengths import blur

from artist_py.core.fresnel import fresnel_dielectric
from artist_py.samplers.wavelengths import tolerance_of
from artist_py.scene.optics import diffuse_transmittance

FALSE_ALARM = 1e-4
IOR = 1.5
PAINT = {**CASCADE, "coat_ior": IOR}
FLINT = {"type": "dielectric", "ior": {"cauchy": [1.6, 0.02]}}
EDGES = 6
ITERATIONS = 32
EYE = 0.7  # from the centre of the room, whose radius is 1
SIZE, VIEW = 24, 60.0  # pixels, degrees
# Standard errors that the images must have, relative: light subpaths alone are noisier here.
PRECISION = {"pt": 1.5e-3, "bpt": 1.5e-3, "vcm": 1.5e-3, "lt": 3e-3, "bpm": 5e-3, "ppm": 5e-3}
SLOW = ("lt", "bpt", "bpm", "ppm")  # parts of vcm, compiled anew


def painted_room(integrator, **render):
    """A sphere of coated paint that emits light all over, seen from within."""
    return scene(
        [shape("sphere", "paint", center=[0, 0, 0], radius=1, reverse=True, emission=LAMP)],
        materials={"paint": PAINT},
        camera=look([0, -EYE, 0], [0, 1, 0], VIEW),
        film={"resolution": [SIZE, SIZE]},
        render={
            "integrator": integrator,
            "wavelength_range": RANGE,
            "max_path_length": EDGES,
            "merging": {"radius": 0.02, "alpha": 1, "light_paths": 4},
            **render,
        },
    )


# --- what it should look like -------------------------------------------------------------------------------------


def reflected(cosines):
    """F."""
    return np.array([fresnel_dielectric(mu, IOR)[0] for mu in cosines])


def quadrature(n=48):
    """Cosines and weights of the mean over 2 mu dmu: Gauss and Legendre's in the root of mu, where F has its bend."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    roots = 0.5 + 0.5 * nodes
    return roots**2, 2.0 * weights * roots**3


def seen_cosines(steps=4):
    """Cosines at which the wall is seen, of `steps` x `steps` points in each pixel."""
    width = np.tan(np.radians(0.5 * VIEW))
    x = (np.arange(SIZE * steps) + 0.5) / (SIZE * steps) * 2.0 - 1.0
    squared = width**2 * (x[:, None] ** 2 + x[None, :] ** 2)
    sine = EYE * np.sqrt(squared / (1.0 + squared))  # the ray's distance from the centre
    return np.sqrt(1.0 - sine**2).ravel()


def below_coat(surfaces):
    """K (lanes, lanes): reflection deepened by the coat, and the matrix of the dyes as it was tabulated."""
    rho = np.diag(surfaces.scatter[0])  # no set leads to itself
    leaving = diffuse_transmittance(IOR) / IOR**2
    return surfaces.scatter[0] + np.diag(rho * leaving / (1.0 - rho * (1.0 - leaving)) - rho)


def radiance(surfaces, seen, edges, seen_below=None):
    """L (cosines, lanes) at the cosines `seen` by paths of up to so many edges.

    `seen_below` is K where the path that is seen first gets below the coat, if it is another there.
    """
    cosines, weights = quadrature()
    f_seen, f = reflected(seen)[:, None], reflected(cosines)[:, None]
    below, mean = below_coat(surfaces), diffuse_transmittance(IOR)
    seen_below = below if seen_below is None else seen_below
    emission = surfaces.emission[0]
    part_seen, part = (
        np.broadcast_to(emission, (len(seen), len(emission))),
        np.tile(emission, (len(cosines), 1)),
    )
    total = part_seen.copy()
    for _ in range(edges - 1):
        arriving = weights @ ((1.0 - f) * part) / mean
        part_seen = f_seen * part_seen + (1.0 - f_seen) * (seen_below @ arriving)
        part = f * part + (1.0 - f) * (below @ arriving)
        total += part_seen
    return total


def room_colour(compiled, iteration):
    """RGB of the image of `painted_room` at the wavelengths of an iteration (3,)."""
    return image_colour(compiled, on_sets(compiled, iteration))


def image_colour(compiled, surfaces, seen_below=None):
    """RGB of the image of `painted_room` at the wavelengths of `surfaces` (3,)."""
    seen, count = np.unique(np.round(seen_cosines(), 9), return_counts=True)
    light = radiance(surfaces, seen, compiled.graph.render.max_path_length, seen_below)
    return surfaces.response @ np.average(light, axis=0, weights=count)


def test_all_paths_bring_the_closed_form():
    surfaces, seen = on_sets(painted_room("pt"), 0), np.array([1.0, 0.7, 0.2])
    emission, below = surfaces.emission[0], below_coat(surfaces)
    inside = below @ np.linalg.solve(np.eye(len(below)) - below, emission)
    expected = emission / (1.0 - reflected(seen))[:, None] + inside / diffuse_transmittance(IOR)
    np.testing.assert_allclose(radiance(surfaces, seen, 400), expected, rtol=1e-6)


# --- renders ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "integrator", [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in PRECISION]
)
def test_iterations_have_the_expectation_of_their_wavelengths(integrator):
    compiled = painted_room(integrator)
    expected = np.array([room_colour(compiled, i) for i in range(ITERATIONS)])
    assert_deviations_vanish(iteration_colours(compiled, ITERATIONS), expected, PRECISION[integrator])


@pytest.mark.parametrize("edges", [1, 2, 3])
def test_limited_length(edges):
    """Emission alone; what the coat mirrors and one fluorescent event; two of them."""
    compiled = painted_room("pt", max_path_length=edges)
    expected = np.array([room_colour(compiled, i) for i in range(ITERATIONS)])
    assert_deviations_vanish(iteration_colours(compiled, ITERATIONS), expected, PRECISION["pt"])


# --- wavelengths that shift ---------------------------------------------------------------------------------------


def assert_shifting_agrees(compiled, expected, precision, iterations):
    """Images of iterations, whose paths have wavelengths of their own, have the expectations (iterations, 3)."""
    assert_deviations_vanish(
        iteration_colours(compiled, iterations), np.broadcast_to(expected, (iterations, 3)), precision
    )


@pytest.mark.parametrize(
    ("heroes", "precision"), [(4, 1.5e-3), pytest.param(1, 4e-3, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("edges", [2, EDGES])
def test_path_tracing_by_shifting_wavelengths(edges, heroes, precision):
    """What the coat mirrors leaves at the wavelengths it came with, what has been below it at others."""
    compiled = painted_room("pt", wavelengths="independent", hero_count=heroes, max_path_length=edges)
    assert_shifting_agrees(compiled, image_colour(compiled, on_bins(compiled)), precision, 400)


@pytest.mark.slow
@pytest.mark.parametrize("edges", [2, EDGES])
def test_photon_mapping_by_shifting_wavelengths(edges):
    """A merge within a tolerance blurs what the base reflects where it is seen, and nothing else."""
    merging = {"radius": 0.02, "alpha": 1, "light_paths": 4, "wavelength_tolerance": 50}
    compiled = painted_room("ppm", wavelengths="rotate", hero_count=1, max_path_length=edges, merging=merging)
    surfaces, tolerance = on_bins(compiled), tolerance_of(compiled.graph.render.merging, 0)
    below = below_coat(surfaces)
    elastic = np.diag(below)
    seen_below = below - np.diag(elastic) + elastic[:, None] * blur(len(below), tolerance)
    assert_shifting_agrees(compiled, image_colour(compiled, surfaces, seen_below), 8e-3, 400)


# --- several materials --------------------------------------------------------------------------------------------


def still_life(integrator, *more, **render):
    """Two coated balls, of a dark dye and of two dyes, in a coated room with a small lamp; and `more` shapes."""
    dark = {"type": "fluorescent", "absorption": {"gaussian": [420, 40], "peak": 0.95}, "coat_ior": 1.8}
    dark["emission"] = {"gaussian": [540, 25]}
    return scene(
        [
            shape("sphere", "wall", center=[0, 0, 0], radius=2, reverse=True),
            shape("sphere", "dark", center=[-0.6, 0.5, -0.4], radius=0.45),
            shape("sphere", "paint", center=[0.6, 0.6, 0.1], radius=0.5),
            shape("sphere", center=[0, 0.2, 1.2], radius=0.25, emission=LAMP),
            *more,
        ],
        materials={"dark": dark, "paint": PAINT, "wall": {**PAINT, "coat_ior": 1.3}, "flint": FLINT},
        camera=look([0, -1.6, 0.2], [0, 1, 0], 50),
        film={"resolution": [64, 64]},
        render={
            "integrator": integrator,
            "wavelength_range": RANGE,
            "max_path_length": 5,
            "merging": {"radius": 0.01, "light_paths": 1},
            **render,
        },
    )


def parts(compiled, iterations=ITERATIONS):
    """Means over 4 x 4 parts of the image of each iteration, (iterations, 16, 3)."""
    images = iteration_images(compiled, iterations)
    return images.reshape(iterations, 4, 16, 4, 16, 3).mean(axis=(2, 4)).reshape(iterations, 16, 3)


def assert_same_parts(found, expected, kernel_bias, precision):
    """Two renders with the same wavelengths in each iteration agree: t-tests of the parts of the image."""
    difference, size = found - expected, expected.mean()
    mean, error = difference.mean(axis=0), difference.std(axis=0, ddof=1) / np.sqrt(ITERATIONS)
    assert np.median(error) < precision * size
    limit = stats.t.ppf(1.0 - FALSE_ALARM / (2 * mean.size), ITERATIONS - 1) * error + kernel_bias * size
    assert (np.abs(mean) < limit).all()


@pytest.fixture(scope="module")
def path_traced():
    return parts(still_life("pt"))


@pytest.mark.parametrize(
    ("integrator", "kernel_bias"), [pytest.param("bpt", 0.0, marks=pytest.mark.slow), ("vcm", 5e-3)]
)
def test_integrators_agree(integrator, kernel_bias, path_traced):
    """With path tracing."""
    assert_same_parts(parts(still_life(integrator)), path_traced, kernel_bias, 0.01)


@pytest.mark.slow
def test_integrators_agree_through_glass():
    """A path that has lost its wavelengths but one to a prism keeps it where the coat mirrors (theory 3.7)."""
    ball = shape("sphere", "flint", center=[0.1, -0.3, -0.1], radius=0.4)
    images = [parts(still_life(integrator, ball)) for integrator in ("pt", "bpt")]
    assert_same_parts(images[1], images[0], 0.0, 0.02)


@pytest.mark.slow
def test_shifting_wavelengths_agree():
    """Path tracing by wavelengths of each path: no noise of colours is shared, and more iterations are needed."""
    iterations = 1024
    shared = parts(still_life("pt"), iterations)
    shifting = parts(still_life("pt", wavelengths="independent"), iterations)
    size = shared.mean()
    difference = shifting.mean(axis=0) - shared.mean(axis=0)
    error = np.sqrt((shared.var(axis=0, ddof=1) + shifting.var(axis=0, ddof=1)) / iterations)
    assert np.median(error) < 0.05 * size
    limit = stats.t.ppf(1.0 - FALSE_ALARM / (2 * difference.size), iterations - 1) * error
    assert (np.abs(difference) < limit).all()
