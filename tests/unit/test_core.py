"""Frames, affine maps, warps, alias tables, wavelengths and counters: exact where they can be.

Directions and points are random with fixed seeds; nothing here is a statistical test.
"""

import math
import threading

import numba
import numpy as np
import pytest

from artist_py.core import warp
from artist_py.core.affine import load_vec3, transform_direction, transform_normal, transform_point
from artist_py.core.alias_table import build_alias_table, sample_alias
from artist_py.core.atomic import fetch_and_add
from artist_py.core.frame import frame_around, length, normalize, reflect, to_local, to_world
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3, cross, dot, lane, vec3
from artist_py.core.wavelengths import sample_wavelengths
from artist_py.jit import kernel

LAST = 1.0 - 2.0**-32  # the largest random number
AXES = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (0.6, 0.8, 0.0), (0.6, 0.8, -0.0)]


def directions(count, seed=1):
    """Unit vectors, those along the axes and next to them first."""
    rng = np.random.default_rng(seed)
    near = np.array(AXES, float) + rng.normal(scale=1e-9, size=(len(AXES), 3))
    vectors = np.concatenate([np.array(AXES, float), near, rng.normal(size=(count, 3))])
    return [Vec3(v / np.linalg.norm(v)) for v in vectors]


# --- frames -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("normal", directions(40), ids=str)
def test_frames_are_orthonormal_and_right_handed(normal):
    axes = np.array(frame_around(normal), dtype=float)
    assert np.allclose(axes @ axes.T, np.eye(3), atol=4e-16)
    assert np.allclose(np.cross(axes[0], axes[1]), axes[2], atol=4e-16)
    assert np.array_equal(axes[2], normal.values)


def test_local_and_world_are_inverse():
    for normal, w in zip(directions(40), directions(40, seed=2), strict=True):
        frame = frame_around(normal)
        local = to_local(frame, w)
        assert local.z == pytest.approx(dot(w, normal), abs=1e-15)
        assert np.allclose(to_world(frame, local).values, w.values, atol=1e-15)


def test_reflection_keeps_the_angle():
    for w in directions(10):
        mirrored = reflect(w)
        assert mirrored.z == w.z
        assert np.array_equal((w + mirrored).values, [0, 0, 2 * w.z])


def test_length_and_normalize():
    v = vec3(3.0, -4.0, 12.0)
    assert length(v) == 13.0
    assert np.allclose(normalize(v).values, np.array([3, -4, 12]) / 13, rtol=1e-15)
    assert np.allclose(normalize(v * 1e-150).values, np.array([3, -4, 12]) / 13, rtol=1e-15)


# --- affine maps --------------------------------------------------------------------------------------------------


def test_affine_maps():
    """Against numpy; normals stay perpendicular to what was in the surface."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        matrix = rng.normal(size=(3, 4))
        inverse = np.linalg.inv(np.vstack([matrix, [0, 0, 0, 1]]))[:3]
        p, q = rng.normal(size=(2, 3))
        assert np.allclose(transform_point(matrix, Vec3(p)).values, matrix @ [*p, 1])
        assert np.allclose(transform_direction(matrix, Vec3(p)).values, matrix[:, :3] @ p)
        normal = transform_normal(inverse, cross(Vec3(p), Vec3(q)))
        for tangent in (p, q):
            assert abs(dot(normal, transform_direction(matrix, Vec3(tangent)))) < 1e-9
    assert load_vec3(np.array([1, 2, 3], np.float32)).values.tolist() == [1, 2, 3]


# --- warps (their densities are tested in tests/statistics) -------------------------------------------------------

CORNERS = [(u, v) for u in (0.0, 0.5, 2.0**-32, LAST) for v in (0.0, 0.5, 2.0**-32, LAST)]


@kernel
def warp_all(u, v, out):
    out[0], out[1] = warp.square_to_disk(u, v)
    w = warp.square_to_cosine_hemisphere(u, v)
    out[2], out[3], out[4] = w.x, w.y, w.z
    w = warp.square_to_sphere(u, v)
    out[5], out[6], out[7] = w.x, w.y, w.z
    out[8], out[9] = warp.square_to_triangle(u, v)
    w = warp.square_to_cone(u, v, 1e-12)
    out[10], out[11], out[12] = w.x, w.y, w.z


@pytest.mark.parametrize(("u", "v"), CORNERS)
def test_warps_reach_no_further_than_their_domain(u, v):
    """In kernels and in plain Python, also at the ends of the range."""
    out = np.empty(13)
    warp_all(u, v, Table(out))
    assert np.isfinite(out).all()
    assert math.hypot(out[0], out[1]) <= 1 + 1e-15
    assert out[4] >= 0.0
    assert np.linalg.norm(out[2:5]) == pytest.approx(1, abs=1e-8)  # on the rim the root of a rounding error
    assert np.linalg.norm(out[5:8]) == pytest.approx(1, abs=1e-15)
    assert out[8] >= 0 and out[9] >= 0 and out[8] + out[9] <= 1
    assert 1 - 1e-12 <= out[12] <= 1
    plain = [*warp.square_to_disk(u, v), *warp.square_to_cosine_hemisphere(u, v).values]
    plain += [*warp.square_to_sphere(u, v).values, *warp.square_to_triangle(u, v)]
    plain += [*warp.square_to_cone(u, v, 1e-12).values]
    assert np.allclose(plain, out, atol=1e-8)


@pytest.mark.parametrize(
    ("function", "area"),
    [
        (warp.square_to_disk, math.pi),
        (warp.square_to_triangle, 0.5),
        (lambda u, v: warp.square_to_cosine_hemisphere(u, v).values[:2], math.pi),
        (lambda u, v: warp.square_to_sphere(u, v).values, 4 * math.pi),
        (lambda u, v: warp.square_to_cone(u, v, 0.3).values, 2 * math.pi * 0.3),
    ],
    ids=["disk", "triangle", "cosine hemisphere, projected", "sphere", "cone"],
)
def test_warps_keep_area(function, area):
    """The Jacobian by central differences is the same everywhere off the creases."""
    step = 1e-6
    for u, v in np.random.default_rng(6).uniform(0.01, 0.99, (60, 2)):
        if min(abs(u - v), abs(u + v - 1)) < 1e-4:
            continue
        du, dv = (
            (np.array(function(u + a, v + b)) - np.array(function(u - a, v - b))) / (2 * step)
            for a, b in ((step, 0), (0, step))
        )
        gram = np.array([[du @ du, du @ dv], [du @ dv, dv @ dv]])
        assert math.sqrt(np.linalg.det(gram)) == pytest.approx(area, rel=1e-5)


def test_cosine_and_sine_of_an_octant():
    x = np.linspace(-math.pi / 4, math.pi / 4, 10_001)
    cosine, sine = warp.cos_sin_octant(x)
    assert np.abs(cosine - np.cos(x)).max() < 1e-11
    assert np.abs(sine - np.sin(x)).max() < 1e-11


# --- alias tables -------------------------------------------------------------------------------------------------

WEIGHTS = {
    "one": [3.0],
    "equal": [2.0] * 7,
    "with zeros": [0, 1, 0, 2, 0, 0],
    "ten orders": 10.0 ** np.random.default_rng(7).uniform(-5, 5, 10_000),
    "huge and tiny": [1e300, 1e-300, 1e290],
    "many": np.random.default_rng(8).random(1000) ** 4,
}


@pytest.mark.parametrize("weights", WEIGHTS.values(), ids=WEIGHTS)
def test_alias_table_is_exact(weights):
    """What each index gets of all cells of the table is its probability, to rounding; zero gets nothing at all."""
    weights = np.array(weights, float)
    table, probabilities = build_alias_table(weights)
    n = len(weights)
    assert np.allclose(probabilities, weights / weights.sum(), rtol=1e-15)
    assert table["probability"].min() >= 0 and table["probability"].max() <= 1
    share = table["probability"].copy()
    np.add.at(share, table["alias"], 1 - table["probability"])
    assert np.allclose(share / n, probabilities, rtol=1e-12, atol=4e-16)
    assert (share[weights == 0] == 0).all()


@kernel
def choose_all(table, numbers, out):
    for i in range(numbers.shape[0]):
        out[i] = sample_alias(table, numbers[i])


def test_choosing_by_alias_table():
    """A fine grid of numbers chooses each index as often as it is probable, to one point of the grid per cell."""
    weights = np.array([0.5, 0.0, 3.0, 1.0, 0.1])
    table, probabilities = build_alias_table(weights)
    points = 10_000 if numba.config.DISABLE_JIT else 1_000_000
    grid = (np.arange(points) + 0.5) / points
    chosen = np.empty(len(grid), np.int64)
    choose_all(Table(table), Table(grid), Table(chosen))
    counts = np.bincount(chosen, minlength=5)
    assert np.abs(counts - probabilities * len(grid)).max() <= 5
    assert counts[1] == 0
    rows = Table(table)
    assert [sample_alias(rows, u) for u in grid[::1000]] == chosen[::1000].tolist()
    assert sample_alias(rows, LAST) in (2, 3, 4) and sample_alias(rows, 0.0) in (0, 2)


# --- wavelengths --------------------------------------------------------------------------------------------------


@kernel
def wavelengths_of_all(nodes, zero, numbers, wavelengths_out, weights_out):
    for i in range(numbers.shape[0]):
        wavelengths, weights = sample_wavelengths(nodes, zero, numbers[i])
        for k in range(wavelengths_out.shape[1]):
            wavelengths_out[i, k], weights_out[i, k] = lane(wavelengths, k), lane(weights, k)


def _nodes(kind):
    rng = np.random.default_rng(9)
    if kind == "uniform":
        return np.linspace(380.0, 780.0, 11)
    if kind == "one bin":
        return np.array([550.0, 551.0])
    widths = rng.exponential(size=1024) ** 6 + 1e-6  # over many orders of magnitude
    return 300.0 + 480.0 * np.concatenate([[0.0], np.cumsum(widths) / widths.sum()])


@pytest.mark.parametrize("count", [1, 4, 8])
@pytest.mark.parametrize("kind", ["uniform", "one bin", "arbitrary"])
def test_wavelengths_integrate_without_bias(kind, count):
    """The weighted sum over lanes, averaged over u, is the integral, for any nodes; weights are float32."""
    nodes = _nodes(kind)
    cells = 64 * (len(nodes) - 1)
    numbers = (np.arange(cells) + 0.5) / cells
    wavelengths, weights = np.empty((2, cells, count), np.float32)
    zero = Spectrum(np.zeros(count))
    wavelengths_of_all(Table(nodes), zero, Table(numbers), Table(wavelengths), Table(weights))
    plain = sample_wavelengths(nodes, zero, numbers[7])
    assert np.array_equal(np.asarray(plain[0]), wavelengths[7])
    assert np.allclose(np.asarray(plain[1]), weights[7], rtol=1e-6)
    wavelengths, weights = wavelengths.astype(float), weights.astype(float)
    first, last = nodes[0], nodes[-1]
    assert weights.sum(axis=1).mean() == pytest.approx(last - first, rel=1e-6)
    integral = (weights * wavelengths**2).sum(axis=1).mean()
    assert integral == pytest.approx((last**3 - first**3) / 3, rel=1e-5)
    assert wavelengths.min() >= np.float32(first) and wavelengths.max() <= np.float32(last)
    assert (np.diff(wavelengths, axis=1) >= 0).all()


# --- counters -----------------------------------------------------------------------------------------------------


@kernel
def take_all(counters, taken, end):
    count = 0
    while True:
        index = fetch_and_add(counters, 1, 1)
        if index >= end:
            return count
        taken[index] += 1
        count += 1


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="plain Python does not count in one step")
def test_counters_shared_by_threads_lose_nothing():
    """Every number is taken once, by one of four threads."""
    counters, taken = np.zeros(3, np.int64), np.zeros(200_000, np.int64)
    tables = Table(counters), Table(taken)
    take_all(*tables, 0)
    counters[:] = 0
    threads = [threading.Thread(target=take_all, args=(*tables, len(taken))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (taken == 1).all()
    assert counters.tolist() == [0, len(taken) + 4, 0]


def test_counters_in_plain_python():
    counters = Table(np.array([5, 7]))
    assert fetch_and_add(counters, 1, 3) == 7
    assert counters.array.tolist() == [5, 10]
