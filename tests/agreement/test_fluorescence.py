"""All integrators agree on the fluorescent scenes of scenes/, iteration by iteration.

With the same seed all of them have the same wavelengths in an iteration, so that the noise of colours drops out of the
differences of their images. A t-test over iterations for each of 16 parts of the image and each channel; a correct
program fails one comparison by chance with probability 1e-4.
"""

from pathlib import Path

import numpy as np
import pytest
from fluorescence import iteration_images
from scipy import stats

import artist_py

SCENES = Path(__file__).resolve().parents[2] / "scenes"
NAMES = ["fluorescent_spheres", "fluorescent_room", "black_light", "cascade", "highlighters"]
FALSE_ALARM = 1e-4
ITERATIONS = 48
OWN_ITERATIONS = 1024
KERNEL_BIAS = 5e-3  # relative to the image's mean: merges blur edges, more so on images as small as these


def parts(name, integrator, iterations=ITERATIONS, wavelengths="shared"):
    """Means over 4 x 4 parts of the image of each iteration, (iterations, 16, 3)."""
    scene = artist_py.load_scene(
        SCENES / f"{name}.toml",
        {"film.resolution": [64, 64], "render.integrator": integrator, "render.wavelengths": wavelengths},
    )
    images = iteration_images(scene, iterations)
    return images.reshape(iterations, 4, 16, 4, 16, 3).mean(axis=(2, 4)).reshape(iterations, 16, 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("integrator", ["pt", "lt", "bpm", "vcm"])
def test_integrators_agree(name, integrator):
    """With bidirectional path tracing, which finds caustics and has no bias."""
    images = [parts(name, each) for each in ("bpt", integrator)]
    difference = images[1] - images[0]
    mean, error = difference.mean(axis=0), difference.std(axis=0, ddof=1) / np.sqrt(ITERATIONS)
    size = images[0].mean()
    limit = stats.t.ppf(1.0 - FALSE_ALARM / (2 * mean.size), ITERATIONS - 1) * error
    if integrator in ("bpm", "vcm"):
        limit = limit + KERNEL_BIAS * size
    assert (np.abs(mean) < limit).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_wavelengths_of_each_path(name):
    """Path tracing with sets of wavelengths, and with wavelengths that shift: here colours are noisy."""
    images = [parts(name, "pt", OWN_ITERATIONS, each) for each in ("shared", "independent")]
    difference = images[1].mean(axis=0) - images[0].mean(axis=0)
    # Not less than the error of the means, since iterations are spread more evenly than chance would have them.
    error = np.sqrt(sum(image.var(axis=0, ddof=1) for image in images) / OWN_ITERATIONS)
    assert np.median(error) < 0.08 * images[0].mean()
    limit = stats.t.ppf(1.0 - FALSE_ALARM / (2 * difference.size), OWN_ITERATIONS - 1) * error
    assert (np.abs(difference) < limit).all()
