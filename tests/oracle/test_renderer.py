"""The reference integrator as a renderer: its images are those of the kernels, in every mode."""

import math

import numpy as np
import pytest
from oracle_scenes import CORNELL
from rendering import MONOCHROME, Image, assert_equals, assert_same, radiance

import artist_py

ITERATIONS = 1500  # of the kernels
# A corner of the Cornell box without the lamp, whose hard edge would be noise only.
VIEW = {
    "film.resolution": [8, 8],
    "film.filter": "box",
    "camera.position": [0, -0.3, 0.95],
    "camera.look_at": [0.2, -0.6, -1],
    "render.max_path_length": 4,
    "render.sampler": "independent",
    "render.wavelength_range": MONOCHROME,
    "render.merging.radius": 0.2,
    "render.merging.alpha": 1.0,
}


def cornell(integrator, **overrides):
    return artist_py.load_scene(str(CORNELL), {**VIEW, "render.integrator": integrator, **overrides})


def reference(iterations, **overrides):
    """`Image` of the Cornell box by the reference integrator."""
    return radiance(cornell("reference", **overrides), iterations, threads=1)


@pytest.fixture(scope="module")
def images():
    """`Image` of the Cornell box by the kernels."""
    return {name: radiance(cornell(name), ITERATIONS) for name in ("bpt", "bpm", "vcm")}


def quarters(image):
    """The image as 2 x 2 pixels: averages that are nearly Gaussian."""
    mean = image.mean.reshape(2, 4, 2, 4).mean(axis=(1, 3))
    return Image(mean, image.variance.reshape(2, 4, 2, 4).sum(axis=(1, 3)) / 16**2)


@pytest.mark.parametrize(("mode", "other"), [("vcm", "vcm"), ("bdpt", "bpt"), ("bdpm", "bpm")])
def test_same_image_as_the_kernels(images, mode, other):
    """Merges have the same radius and so the same bias; and the kernels, which take more samples, know the variance."""
    n = 16
    expected = images[other]
    image = reference(n, **{"render.reference.mode": mode})
    assert_same(
        quarters(image._replace(variance=expected.variance * (ITERATIONS / n))), quarters(expected), 0.05
    )


@pytest.mark.parametrize(("light_samples", "eye_samples"), [(0, 2), (20, 2), (200, 1)])
def test_any_number_of_samples(images, light_samples, eye_samples):
    """Weights make up for the numbers of subpaths; without light subpaths it is path tracing."""
    settings = {
        "render.reference.mode": "bdpt",
        "render.reference.light_samples": light_samples,
        "render.reference.eye_samples": eye_samples,
        "render.heuristic": "power",
    }
    image, expected = reference(12, **settings), images["bpt"]
    error = math.sqrt(image.variance.sum() + expected.variance.sum()) / image.mean.size
    assert_equals(image.mean.mean(), error, expected.mean.mean(), 0.06)


def test_shortest_paths():
    """Paths of 1 and 2 edges and those of 3 and more are all paths: with the same random numbers, to the digit."""
    short = reference(2, **{"render.max_path_length": 2})
    long = reference(2, **{"render.reference.min_path_length": 3})
    total = reference(2)
    assert long.mean.mean() > 0.0
    assert short.mean.mean() > 0.0
    np.testing.assert_allclose(short.mean + long.mean, total.mean, rtol=1e-5, atol=1e-7)
