"""Any numbers of samples of each technique give the same picture: weights make up for them, and for what is left out.

Means of the image's quarters in single iterations are compared with path tracing by Welch's t-test; a correct program
fails one comparison by chance with probability 1e-4. Merges have a radius whose bias is far below the error.
"""

import numpy as np
import pytest
from rendering import FALSE_ALARM, GREEN, look, render, scene, shape
from scipy import stats

from artist_py.film.accumulation import Film
from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for

SIZE, ITERATIONS = 16, 300
PRECISION = 0.03  # of a quarter's mean, relative
CASES = {
    "every number": ("vcm", {"next_event": 3, "connections": 0.4, "light_image": 0.3, "merging": 0.25}, 1.0),
    "of many light paths": ("vcm", {"connections": 1.5, "light_image": 0.9, "merging": 0.4, "next_event": 2}, 4.0),
    "hits and connections": ("bpt", {"next_event": 0, "connections": 0.5, "light_image": 0}, 0.7),
    "hits alone": ("bpt", {"next_event": 0, "connections": 0, "light_image": 0}, 1.0),
    "no connections": ("vcm", {"connections": 0, "light_image": 0, "merging": 0.5}, 1.0),
    "part of the light image": ("lt", {"light_image": 0.4}, 1.0),
}  # fmt: skip
FAST = {"every number", "of many light paths", "hits alone"}  # with few kernels


def box(integrator, samples=None, light_paths=1.0, **reference):
    """A closed box of grey walls, lit from above."""
    return scene(
        [
            shape("box", "white", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
            shape("rectangle", corner=[-0.6, -0.6, 0.98], edges=[[0, 1.2, 0], [1.2, 0, 0]], emission=4),
        ],
        materials={"white": {"type": "diffuse", "reflectance": 0.6}},
        camera=look([0, -0.9, 0], [0, 1, -0.4], 70),
        film={"resolution": [SIZE, SIZE]},
        render={
            "integrator": integrator, "max_path_length": 5, "seed": 1 + len(integrator),
            "samples": samples or {}, "merging": {"radius": 0.02, "alpha": 1.0, "light_paths": light_paths},
            "reference": reference,
        },
    )  # fmt: skip


def quarters(compiled, iterations):
    """Means of the image's quarters in every iteration, (iterations, 2, 2)."""
    film, found = Film(SIZE, SIZE), []
    settings = RenderSettings(iterations=iterations, threads=2)
    with sampler_for(compiled, film, settings, Silence()) as sampler:
        sampler.compile_kernels(Silence())
        for i in range(iterations):
            before = film.sums.copy()
            sampler.iterate(i)
            half = SIZE // 2
            found.append((film.sums - before)[..., GREEN].reshape(2, half, 2, half).mean(axis=(1, 3)))
    return np.array(found)


@pytest.fixture(scope="module")
def path_traced():
    return quarters(box("pt"), 2 * ITERATIONS)


def assert_agrees(found, expected, precision):
    error = np.sqrt(found.var(axis=0, ddof=1) / len(found) + expected.var(axis=0, ddof=1) / len(expected))
    assert np.all(error < precision * expected.mean(axis=0)), error / expected.mean(axis=0)
    p = stats.ttest_ind(found, expected, equal_var=False).pvalue
    assert p.min() > FALSE_ALARM / p.size, found.mean(axis=0) / expected.mean(axis=0)


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=() if case in FAST else pytest.mark.slow) for case in CASES]
)
def test_any_numbers(case, path_traced):
    integrator, samples, light_paths = CASES[case]
    assert_agrees(quarters(box(integrator, samples, light_paths), ITERATIONS), path_traced, PRECISION)


@pytest.mark.parametrize(
    "samples",
    [
        pytest.param(
            {"next_event": 2, "connections": 2.5, "light_image": 0.5, "merging": 0.5}, marks=pytest.mark.slow
        ),
        {"next_event": 0, "connections": 0.3, "light_image": 0},
    ],
)
def test_reference(samples, path_traced):
    """The brute-force integrator takes the same numbers, and more connections than there are light paths per pixel."""
    found = quarters(box("reference", samples, light_samples=60), 12)
    assert_agrees(found, path_traced, 0.2)


def test_more_shadow_rays_are_cast():
    """The numbers are those of the rays that are traced."""
    rays = {}
    for count in (0, 2, 8):
        samples = {"next_event": count, "connections": 0, "light_image": 0}
        rays[count] = render(box("bpt", samples), 4).statistics["shadow_rays"]
    assert rays[0] == 0 < rays[2]
    assert 3.9 * rays[2] < rays[8] < 4.1 * rays[2]
