"""Paths of different wavelengths merged, in a closed sphere: its wall emits 1, reflects a, and looks like 1 / (1 - a).

Merging is exact there for any radius, since the part of a sphere within a chord r of a point has the area pi r^2. Where
a is the same for all wavelengths so is merging photons of others. Fixed seeds; a correct program fails one comparison
by chance with probability 1e-4; there are 18.
"""

import math

import numpy as np
import pytest
from rendering import FALSE_ALARM, diffuse, look, render, scene, shape, with_render
from scipy import stats

TOLERANCE = 10.0  # nm
PRECISION = 0.006
SEEDS = range(1, 17)
SLOPE = 0.4 / 400  # of the coloured wall's reflectance, 1/nm
HEROES = 4
COLOURED = {"wavelengths": [380, 780], "values": [0.2, 0.6]}
# (reflectance, emission) of the wall. Most wavelengths are those of the line, if there is one.
WALLS = {
    "grey": (0.5, 1),
    "coloured": (COLOURED, 1),
    "lit by a line": (0.5, {"spectrum": {"lines": [[555.5, 100.0]]}}),
}


def room(wall, integrator):
    reflectance, emission = WALLS[wall]
    merging = {"radius": 0.1, "wavelength_tolerance": TOLERANCE}
    return scene(
        [shape("sphere", "wall", center=[0.2, 0, 0.1], radius=1.3, reverse=True, emission=emission)],
        materials={"wall": diffuse(reflectance)},
        camera=look([0, -0.5, 0], [0.3, 1, 0.2], 90),
        film={"resolution": [32, 32]},
        render={
            "integrator": integrator,
            "wavelengths": "rotate",
            "wavelength_range": [380, 780],
            "hero_count": HEROES,
            "max_path_length": 30,
            "merging": merging,
        },
    )


def exact(compiled, wall):
    """`(image, bias)` in linear RGB: with photons of the eye's wavelength, and how far those of others can lead."""
    sensor = compiled.spectra[:3].astype(float)
    if wall == "grey":
        return sensor.sum(axis=1) / 0.5, np.zeros(3)
    if wall == "coloured":
        reflectance = 0.2 + SLOPE * (np.arange(400) + 0.5)
        low, high = (1.0 / (1.0 - reflectance - sign * SLOPE * TOLERANCE) for sign in (-1, 1))
        return sensor @ (1.0 / (1.0 - reflectance)), 0.5 * np.abs(sensor) @ (high - low)
    line = np.where(np.arange(400) == 175, 100.0, 0.0)
    return sensor @ line / 0.5, np.abs(sensor @ (blurred(compiled.nodes, line) - line))


def blurred(nodes, spectrum, steps=50):
    """Mean over each wavelength's window (theory 2.8) of a spectrum in 1 nm bins from 380 nm on."""
    shares = np.linspace(0.0, 1.0, len(nodes))
    wavelength = 380.0 + (np.arange(len(spectrum) * steps) + 0.5) / steps
    share = np.interp(wavelength, nodes, shares)
    low = np.maximum(wavelength - TOLERANCE, np.interp(share - 0.5 / HEROES, shares, nodes))
    high = np.minimum(wavelength + TOLERANCE, np.interp(share + 0.5 / HEROES, shares, nodes))
    low, high = np.maximum(low, nodes[0]), np.minimum(high, nodes[-1])
    integral = np.concatenate([[0.0], np.cumsum(spectrum)])
    edges = 380.0 + np.arange(len(integral))
    mean = (np.interp(high, edges, integral) - np.interp(low, edges, integral)) / (high - low)
    return mean.reshape(len(spectrum), steps).mean(axis=1)


@pytest.mark.parametrize("wall", WALLS)
@pytest.mark.parametrize("integrator", [pytest.param("bpm", marks=pytest.mark.slow), "vcm"])
def test_closed_sphere(wall, integrator):
    compiled = room(wall, integrator)
    # Pixels share photons, and are not independent; renders of other seeds are.
    means = np.array(
        [render(with_render(compiled, seed=seed), 6).film.rgb.mean(axis=(0, 1)) for seed in SEEDS]
    )
    expected, bias = exact(compiled, wall)
    error = means.std(axis=0, ddof=1) / math.sqrt(len(SEEDS))
    assert np.all(error < PRECISION * np.abs(expected))
    allowed = stats.t.isf(0.5 * FALSE_ALARM, len(SEEDS) - 1) * error + bias
    assert np.all(np.abs(means.mean(axis=0) - expected) < allowed), means.mean(axis=0) / expected


def test_images_do_not_depend_on_threads():
    compiled = room("coloured", "vcm")
    one, three = (render(compiled, 2, threads=threads).film.rgb for threads in (1, 3))
    assert np.array_equal(one, three)
