"""The backwards sampler: determinism, stores that grow, radii, light subpaths per pixel, memory."""

import math
from itertools import pairwise

import numpy as np
import pytest
from rendering import look, scene, shape, with_render

import artist_py
from artist_py.core.table import Table
from artist_py.errors import OptionError
from artist_py.film.accumulation import Film
from artist_py.integrators.pair import light_paths_of
from artist_py.samplers.backwards import BackwardsSampler, radius_of
from artist_py.samplers.memory import light_paths_within, memory_estimate
from artist_py.samplers.render_job import RenderSettings
from artist_py.samplers.wavelengths import shared_wavelengths
from artist_py.scene import tables
from artist_py.transport.splats import PROFILE_STEPS, choose_pixel
from artist_py.transport.vertices import CHUNK


def room(reflectance, lamp, emission, resolution, **render):
    """A box with a rectangle of light: all of them have the same kernels."""
    return scene(
        [
            shape("box", "white", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
            shape(
                "rectangle", corner=[-0.4, -0.4, 0.98], edges=[[0, lamp, 0], [lamp, 0, 0]], emission=emission
            ),
        ],
        materials={"white": {"type": "diffuse", "reflectance": reflectance}},
        camera=look([0, -0.9, 0], [0, 1, -0.2], 70),
        film={"resolution": resolution},
        render={"integrator": "vcm", "max_path_length": 6, **render},
    )


@pytest.fixture(scope="module")
def compiled():
    return room(0.7, 0.8, 8, [70, 45])


def rgb(compiled, threads, iterations=2):
    return artist_py.render(compiled, iterations=iterations, threads=threads).film.rgb


def test_images_do_not_depend_on_threads(compiled):
    one = rgb(compiled, 1)
    assert np.array_equal(one, rgb(compiled, 2))
    assert np.array_equal(one, rgb(compiled, 5))


def test_images_depend_on_the_seed(compiled):
    assert not np.array_equal(rgb(compiled, 2), rgb(with_render(compiled, seed=2), 2))


def test_stores_that_run_short_grow_and_lose_nothing(compiled):
    with sampler_of(compiled) as roomy, sampler_of(compiled) as tight:
        for name in ("light", "eye", "splats"):
            records = np.empty(2 * CHUNK, getattr(tight, name).records.dtype)
            setattr(tight, name, tight._pool_of(records))
        for sampler in (roomy, tight):
            sampler.iterate(0)
        assert len(tight.light.records) > 2 * CHUNK
        assert roomy.counts == tight.counts
        assert np.array_equal(roomy.film.sums, tight.film.sums)


def sampler_of(compiled, light_paths=1.0):
    width, height = compiled.graph.film.resolution
    return BackwardsSampler(compiled, Film(height, width), 2, light_paths)


def test_a_pixel_may_store_more_than_a_chunk():
    """64 light subpaths of a hundred edges each: every record is where its subpath has put it."""
    with sampler_of(room(1.0, 0.02, 8, [3, 1], max_path_length=101), 64.0) as sampler:
        sampler.iterate(0)
        paths, records = sampler.paths.array, sampler.light.records.array
        numbers = [
            np.arange(path["first_vertex"], path["first_vertex"] + path["n_vertices"]) for path in paths
        ]
        assert max(sum(map(len, numbers[64 * i : 64 * (i + 1)])) for i in range(3)) > CHUNK
        for index, rows in enumerate(numbers):
            assert (records["pixel"][rows] == index).all()
            assert np.array_equal(records["length"][rows], np.arange(1, len(rows) + 1))


def test_light_subpaths_that_are_black_at_their_wavelengths_are_not_traced():
    """A line that the wavelengths of these iterations miss, and one that they do not."""
    wavelengths = {"wavelength_range": [300, 780], "sampler": "independent"}
    line = {"spectrum": {"lines": [[301.5, 1.0]], "width": 1.0}}
    dark, lit = (room(0.7, 0.8, emission, [8, 8], **wavelengths) for emission in (line, 1.0))
    for iteration in range(4):
        nm = shared_wavelengths(dark.nodes, dark.graph.render.hero_count, dark.graph.render.seed, iteration)
        assert (np.abs(nm[0] - 301.5) > 0.5).all()
    for compiled, is_dark in ((dark, True), (lit, False)):
        with sampler_of(compiled) as sampler:
            for iteration in range(4):
                sampler.iterate(iteration)
            assert (sampler.counts["light_vertices"] == 0) is is_dark
            assert sampler.counts["eye_vertices"] > 0


@pytest.mark.parametrize("light_paths", [0.25, 0.5, 1.0, 1.7, 4.0])
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.99])
def test_every_light_subpath_belongs_to_one_pixel(light_paths, offset):
    method = type("Method", (), {"light_paths": light_paths, "offset": offset})
    ranges = [light_paths_of(method, index) for index in range(1000)]
    assert ranges[0][0] == 0
    assert all(before[1] == after[0] for before, after in pairwise(ranges))
    assert abs(ranges[-1][1] - 1000 * light_paths) <= 1


@pytest.mark.parametrize("light_paths", [0.01, 0.25, 1.0, 1.7, 3.5])
def test_every_pixel_has_its_share_of_light_subpaths(light_paths):
    """On average over the offsets of iterations, which fill [0, 1) evenly; or some pixels would never be connected."""
    offsets = (np.arange(400) + 0.5) / 400
    methods = [type("Method", (), {"light_paths": light_paths, "offset": offset}) for offset in offsets]
    for index in range(7):
        ranges = [light_paths_of(method, index) for method in methods]
        assert np.mean([end - first for first, end in ranges]) == pytest.approx(light_paths, abs=1e-9)
    assert np.mean([light_paths_of(method, 255)[1] for method in methods]) == pytest.approx(256 * light_paths)


def test_radii_follow_knaus_and_zwicker():
    squared = 0.04
    for n in range(1, 50):
        assert radius_of(0.2, 0.75, n - 1) ** 2 == pytest.approx(squared, rel=1e-12)
        squared *= (n + 0.75) / (n + 1)
    assert radius_of(0.2, 1.0, 1000) == pytest.approx(0.2, rel=1e-12)


def test_radii_of_the_approximation():
    assert radius_of(0.2, 0.75, 15, "smallvcm") == pytest.approx(0.2 * 16 ** (-0.125), rel=1e-12)


@pytest.mark.parametrize("width", [1.0, 3.0])
def test_splats_are_spread_as_the_filter_says(width):
    """The mean weight that each pixel gets, over the numbers that choose it, is the filter's value there."""
    half = round(0.5 * width * PROFILE_STEPS)
    offsets = np.arange(-half, half + 1) / PROFILE_STEPS
    profile = np.ones_like(offsets) if width == 1.0 else 1.5 - np.abs(offsets)
    profile /= np.trapezoid(profile, offsets)
    table = tables.Filter(None, None, Table(profile))
    x, count = 7.3, 20_000
    found = np.zeros(16)
    for u in (np.arange(count) + 0.5) / count:
        pixel = choose_pixel(table, x, 5.5, u, (0, 16, 5, 6))
        if pixel.index >= 0:
            found[pixel.index] += pixel.weight / count
    expected = np.interp(x - np.arange(16) - 0.5, offsets, profile, 0.0, 0.0)
    along_y = np.interp(0.0, offsets, profile)
    assert found == pytest.approx(expected * along_y, abs=2e-3)


def test_memory_is_bounded_by_fewer_light_paths(compiled):
    said = []
    needed = sum(memory_estimate(compiled, RenderSettings()).values())
    settings = RenderSettings(max_memory_bytes=int(0.8 * needed))
    light_paths = light_paths_within(compiled, settings, said.append)
    assert 0.0 < light_paths < 1.0
    assert "light paths per pixel instead of 1" in said[0]
    assert light_paths_within(compiled, RenderSettings(max_memory_bytes=2 * needed), said.append) == 1.0
    with pytest.raises(OptionError, match="--max-memory"):
        light_paths_within(compiled, RenderSettings(max_memory_bytes=1000), said.append)


def test_fewer_light_paths_change_the_noise_only(compiled):
    """The mean of many iterations, with 0.5 and 2 light subpaths per pixel; fails by chance with probability 1e-4."""
    images = []
    for light_paths in (0.5, 2.0):
        film = Film(45, 70, with_squares=True)
        sampler = BackwardsSampler(with_render(compiled, seed=int(4 * light_paths)), film, 2, light_paths)
        with sampler:
            for iteration in range(24):
                sampler.iterate(iteration)
        images.append((film.mean().sum(), film.variance().sum()))
    (a, variance_a), (b, variance_b) = images
    assert math.sqrt(variance_a) < 0.02 * a
    assert abs(a - b) < 3.9 * math.sqrt(variance_a + variance_b)
