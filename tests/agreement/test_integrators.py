"""Every integrator converges to the picture of the path tracer, on scenes that hold all materials, shapes and cameras.

The images are compared in blocks of pixels by Z-tests with the variance of both. Of the blocks of all comparisons one
may fail by chance with probability 1e-3 (Sidak); the power is stated by `PRECISION`: an image that is wrong by more
than a few per cent in its mean is caught. Methods that merge are biased by their radius, which is small here.
"""

import numpy as np
import pytest
from rendering import look, scene, shape
from scipy import stats

import artist_py

SIZE, BLOCK, ITERATIONS = 24, 6, 256
# Whole scenes compare all methods on all materials, through a pinhole and with shared wavelengths. What they lack is
# here: wavelengths of each path's own where glass disperses, and a lens that light hits, with all techniques.
FAST = {("specular", "bpt"), ("smooth", "vcm")}
PRECISION = 0.01  # standard error of the image's mean that each image has to reach, relative
METHODS = ("lt", "bpt", "ppm", "bpm", "vcm")
FALSE_ALARM = 1e-3
COMPARISONS = (3 * len(METHODS) + 2) * (SIZE // BLOCK) ** 2


ROOM = [
    shape("box", "white", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
    shape("rectangle", corner=[-0.4, -0.4, 0.98], edges=[[0, 0.8, 0], [0.8, 0, 0]], emission=8),
]
MATERIALS = {
    "white": {"type": "diffuse", "reflectance": 0.6},
    "matte": {"type": "oren-nayar", "reflectance": 0.5, "roughness": 30},
    "glass": {"type": "dielectric", "ior": "SF10"},
    "water": {"type": "dielectric", "ior": 1.33},
    "mirror": {"type": "mirror", "reflectance": 0.9},
    "gold": {"type": "conductor", "metal": "Au"},
    "pane": {"type": "thin-dielectric"},
}
SCENES = {
    "diffuse": {
        "shapes": [*ROOM, shape("box", "matte", center=[0.2, 0.1, -0.7], size=[0.6, 0.6, 0.6])],
        "camera": look([0, -0.9, 0], [0, 1, -0.2], 70),
    },
    "specular": {
        "shapes": [
            *ROOM,
            shape("sphere", "glass", center=[-0.4, 0.2, -0.5], radius=0.4),
            shape("sphere", "water", center=[-0.4, 0.2, -0.5], radius=0.2),
            shape("cone", "gold", base=[0.5, 0.2, -1], apex=[0.5, 0.2, -0.2], radius=0.3),
            shape("cylinder", "matte", base=[0.1, 0.7, -1], top=[0.1, 0.7, -0.3], radius=0.2),
            shape("rectangle", "pane", corner=[-0.2, -0.3, -1], edges=[[0.9, 0, 0], [0, 0, 0.8]]),
            shape("sphere", center=[0.6, -0.2, 0.3], radius=0.15, emission=10),
        ],
        "camera": look([0, -0.95, 0], [0, 1, -0.4], 75),
    },
    "smooth": {
        "shapes": [
            *ROOM,
            shape("grooved-sphere", "matte", center=[0, 0.2, -0.4], radius=0.5, segments=32, grooves=3),
            shape("disk", "mirror", center=[0.7, 0.6, 0], normal=[-1, -1, 0], radius=0.4),
        ],
        "camera": {
            **look([0, -0.9, 0.3], [0, 1, -0.6], 70),
            "type": "thin-lens",
            "aperture_radius": 0.3,  # large enough for light to hit it
            "focus_distance": 1.0,
            "blades": 5,
        },
    },
}


def compiled_scene(name, integrator, **more):
    film = {"resolution": [SIZE, SIZE], "filter": "mitchell" if name == "diffuse" else "blackman-harris"}
    wavelengths = "shared" if integrator in ("ppm", "bpm", "vcm") else "independent"
    # Seeds of their own: equal ones would give equal eye subpaths.
    seed = 1 + METHODS.index(integrator) if integrator != "pt" else 99
    render = {"integrator": integrator, "wavelengths": wavelengths, "seed": seed, "max_path_length": 7}
    # Merging alone needs more photons and a larger radius to be precise; their bias is still far below the error.
    merging = {"radius": 0.01, "light_paths": 8} if integrator in ("ppm", "bpm") else {"radius": 0.002}
    render |= {"wavelength_range": [380, 780], "merging": merging} | more
    return scene(materials=MATERIALS, film=film, render=render, **SCENES[name])


def image(name, integrator, **more):
    compiled = compiled_scene(name, integrator, **more)
    result = artist_py.render(compiled, iterations=ITERATIONS, threads=2, aovs=("variance",)).film
    assert result.rejected_count == 0
    return result


def blocks(values):
    count = SIZE // BLOCK
    return values.reshape(count, BLOCK, count, BLOCK, 3).sum(axis=(1, 3))


@pytest.fixture(scope="module")
def path_traced():
    cache = {}

    def get(name):
        if name not in cache:
            cache[name] = image(name, "pt")
        return cache[name]

    return get


def pairs():
    """Every scene by every method."""
    pairs = [(name, integrator) for name in SCENES for integrator in METHODS]
    return [pytest.param(*pair, marks=() if pair in FAST else pytest.mark.slow) for pair in pairs]


@pytest.mark.parametrize(("name", "integrator"), pairs())
def test_agrees_with_path_tracing(name, integrator, path_traced):
    assert_agree(
        path_traced(name), image(name, integrator), PRECISION * (2 if integrator in ("ppm", "bpm") else 1)
    )


@pytest.mark.slow
def test_rotated_wavelengths_agree(path_traced):
    """Over 10 nm to either side the spectra of gold and of flint glass are straight lines, to 1e-3."""
    merging = {"radius": 0.002, "wavelength_tolerance": 10}
    found = image("specular", "vcm", wavelengths="rotate", merging=merging, seed=50)
    assert_agree(path_traced("specular"), found, PRECISION)


def test_crowded_merges_agree(path_traced):
    """With weights that know the density of photons; and images do not depend on threads."""
    merging = {"radius": 0.002, "correlation": "vcm+"}
    assert_agree(path_traced("specular"), image("specular", "vcm", merging=merging, seed=51), PRECISION)
    compiled = compiled_scene("specular", "vcm", merging=merging | {"radius": 0.02})
    one, three = (artist_py.render(compiled, iterations=2, threads=threads).film.rgb for threads in (1, 3))
    assert np.array_equal(one, three)


def assert_agree(expected, found, precision):
    """Two images within their noise, which is below `precision` of the mean of the second."""
    variance = expected.variance + found.variance
    error = np.sqrt(found.variance.sum(axis=(0, 1))) / found.rgb.sum(axis=(0, 1))
    assert np.all(error < precision), error
    z = np.abs(blocks(found.rgb - expected.rgb)) / np.sqrt(blocks(variance))
    # The channels of one block follow each other: they count as one comparison of their largest deviation each.
    allowed = stats.norm.isf(0.5 * (1.0 - (1.0 - FALSE_ALARM) ** (1.0 / (3 * COMPARISONS))))
    assert z.max() < allowed, f"{z.max():.2f} standard errors, allowed {allowed:.2f}"
