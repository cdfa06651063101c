"""The reference integrator as a renderer: its images are those of the kernels, in every mode."""

import math

import numpy as np
import pytest
from oracle_scenes import CORNELL, LIGHTS, MATERIALS
from rendering import FALSE_ALARM, GREEN, MONOCHROME, assert_equals, look, radiance, scene, shape, with_render
from scipy import stats

import artist_py
from artist_py.film.accumulation import Film
from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for

ITERATIONS = 1500  # of the kernels
PRECISION = 0.25  # relative, of a quarter of the image
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


def quarters(compiled, iterations):
    """Means of the image's quarters in every iteration, (iterations, 2, 2).

    Pixels of an iteration share photons and are not independent, iterations are.
    """
    film, found = Film(8, 8), []
    settings = RenderSettings(iterations=iterations, threads=1)
    with sampler_for(compiled, film, settings, Silence()) as sampler:
        sampler.compile_kernels(Silence())
        for i in range(iterations):
            before = film.sums.copy()
            sampler.iterate(i)
            found.append((film.sums - before)[..., GREEN].reshape(2, 4, 2, 4).mean(axis=(1, 3)))
    return np.array(found)


@pytest.mark.parametrize(
    ("mode", "other"), [("vcm", "vcm"), ("bdpt", "bpt"), pytest.param("bdpm", "bpm", marks=pytest.mark.slow)]
)
def test_same_image_as_the_kernels(mode, other):
    """Merges have the same radius and so the same bias."""
    found = quarters(cornell("reference", **{"render.reference.mode": mode}), 20)
    assert_agree(found, quarters(cornell(other), 400))


def assert_agree(found, expected):
    """Means over iterations are the same in every quarter, by Welch's test."""
    error = np.sqrt(found.var(axis=0, ddof=1) / len(found) + expected.var(axis=0, ddof=1) / len(expected))
    assert np.all(error < PRECISION * expected.mean(axis=0))
    p = stats.ttest_ind(found, expected, equal_var=False).pvalue
    assert p.min() > FALSE_ALARM / p.size


def corner(shapes, emitters=(), lanes=1):
    """A floor and a rough wall, under an open sky."""
    used = {each["material"] for each in shapes if "material" in each} | {"white", "rough"}
    return scene(
        [
            shape("rectangle", "white", corner=[-2, -2, -1], edges=[[4, 0, 0], [0, 4, 0]]),
            shape("rectangle", "rough", corner=[-2, 1.5, -1], edges=[[4, 0, 0], [0, 0, 2]]),
            *shapes,
        ],
        emitters=emitters,
        materials={name: MATERIALS[name] for name in sorted(used)},
        camera=look([0, -3, 0.5], [0, 0.5, -0.8], 30.0),
        film={"resolution": [8, 8]},
        render={
            "integrator": "reference", "max_path_length": 4, "hero_count": lanes, "merging": {"radius": 0.05},
            "wavelength_range": MONOCHROME if lanes == 1 else [400, 700], "wavelengths": "shared",
        },
    )  # fmt: skip


def test_emitters_without_a_surface():
    """A point, a spot, directional light, a sun and a sky at once: the path tracer sees the same."""
    compiled = corner([], LIGHTS)
    expected = quarters(with_render(compiled, integrator="pt", roulette_length=9, seed=2), 600)
    assert_agree(quarters(compiled, 16), expected)


def test_dispersion_at_several_wavelengths():
    """A ball of flint before the wall; what it refracts goes on with one of four wavelengths."""
    lamp = shape("sphere", center=[0.2, -0.6, 0.6], radius=0.5, emission=3)
    compiled = corner([shape("sphere", "flint", center=[0, 0.4, -0.7], radius=0.6), lamp], (), 4)
    expected = quarters(with_render(compiled, integrator="pt", seed=2), 1200)
    assert_agree(quarters(compiled, 24), expected)


@pytest.fixture(scope="module")
def images():
    """`Image` of the Cornell box by the kernels."""
    return {"bpt": radiance(cornell("bpt"), ITERATIONS)}


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
