"""Points on exact shapes: projection, normals against gradients, surface coordinates, bounds."""

import math

import numpy as np
import pytest
from quadric_cases import EPSILON, IDENTITY, all_kinds, off_surface, random_map, record

from artist_py.core.vector import Vec3, vec3
from artist_py.geometry.quadrics import quadric_bounds, quadric_normal, quadric_position, quadric_uv
from artist_py.scene.tables import CONE, CYLINDER, DISK, SPHERE


def surface_points(rng, kind, n):
    """Canonical points spread over the whole shape."""
    angle, s = rng.uniform(0.0, 2.0 * math.pi, n), rng.uniform(0.0, 1.0, n)
    radius = {SPHERE: np.sqrt(1.0 - (2.0 * s - 1.0) ** 2), DISK: s, CYLINDER: np.ones(n), CONE: 1.0 - s}[kind]
    z = {SPHERE: 2.0 * s - 1.0, DISK: np.zeros(n)}.get(kind, s)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1)


@all_kinds
def test_projected_points_lie_on_the_surface(kind):
    """From 1e-5 away a point comes back to the surface, to rounding of its coordinates, and moves by little more."""
    rng = np.random.default_rng(6)
    for _ in range(10):
        matrix = random_map(rng, 1.0, 1.0)
        quadric = record(kind, matrix)
        size = np.abs(matrix).sum(axis=1).max()
        for p in surface_points(rng, kind, 50):
            near = matrix[:, :3] @ (p + 1e-5 * rng.uniform(-1, 1, 3)) + matrix[:, 3]
            found = np.array(quadric_position(quadric, Vec3(near)))
            back = np.linalg.solve(matrix[:, :3], found - matrix[:, 3])
            # Two roundings of a coordinate, and the solver's own four, through a map of condition 4.
            assert off_surface(kind, back) < 24.0 * EPSILON * size
            assert np.abs(found - near).max() < 4e-5
            again = np.array(quadric_position(quadric, Vec3(found)))
            assert np.abs(again - found).max() <= 8.0 * EPSILON * size


@pytest.mark.parametrize(
    ("kind", "point", "expected"),
    [
        (DISK, (3, 4, 1), (0.6, 0.8, 0)),  # beyond the edge
        (DISK, (0, 0, 1), (0, 0, 0)),
        (CYLINDER, (3, 4, 2), (0.6, 0.8, 1)),
        (CYLINDER, (0, 0, -1), (1, 0, 0)),  # on the axis, where any direction will do
        (CONE, (0, 0, 3), (0, 0, 1)),  # above the apex
        (CONE, (3, 4, -9), (0.6, 0.8, 0)),
        (CONE, (0.75, 0, 0.75), (0.5, 0, 0.5)),
    ],
)
def test_projection_beyond_edges(kind, point, expected):
    """Points that have no foot of a perpendicular go to the edge."""
    assert np.allclose(np.array(quadric_position(record(kind, IDENTITY), vec3(*point))), expected, atol=1e-15)


def implicit(kind, p):
    """A function that vanishes on the canonical shape and grows outwards."""
    x, y, z = p
    return {SPHERE: x * x + y * y + z * z, DISK: z, CYLINDER: x * x + y * y, CONE: math.hypot(x, y) + z}[kind]


@all_kinds
def test_normals_are_gradients(kind):
    """The normal is the gradient of the implicit function over world space, by central differences; also mirrored."""
    rng = np.random.default_rng(7)
    signs = set()
    for _ in range(20):
        matrix = random_map(rng)
        signs.add(np.linalg.det(matrix[:, :3]) > 0)
        quadric = record(kind, matrix)
        for p in surface_points(rng, kind, 20)[:, :] * [1, 1, 0.9]:
            point = matrix[:, :3] @ p + matrix[:, 3]
            normal = np.array(quadric_normal(quadric, quadric_position(quadric, Vec3(point))))
            point = np.array(quadric_position(quadric, Vec3(point)))
            step = 1e-6
            ends = [
                np.linalg.solve(matrix[:, :3], point + s * e - matrix[:, 3])
                for e in np.eye(3)
                for s in (step, -step)
            ]
            values = [implicit(kind, end) for end in ends]
            gradient = np.subtract(values[0::2], values[1::2])
            assert np.allclose(normal, gradient / np.linalg.norm(gradient), atol=1e-6)
            assert np.linalg.norm(normal) == pytest.approx(1.0, abs=4 * EPSILON)
    assert signs == {True, False}


def test_normal_at_the_apex():
    """A cone's apex has the direction of its axis, and no NaN."""
    assert np.array(quadric_normal(record(CONE, IDENTITY), vec3(0, 0, 1))).tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("kind", "point", "expected"),
    [
        (SPHERE, (1, 0, 0), (0.0, 0.5)),
        (SPHERE, (0, 0, 1), (0.0, 1.0)),
        (SPHERE, (0, 0, -1), (0.0, 0.0)),
        (SPHERE, (0, -math.sqrt(0.5), math.sqrt(0.5)), (0.75, 0.75)),
        (DISK, (0, 0.5, 0), (0.25, 0.5)),
        (CYLINDER, (-1, 0, 0.25), (0.5, 0.25)),
        (CONE, (0, -0.25, 0.75), (0.75, 0.75)),
    ],
)
def test_uv(kind, point, expected):
    """Known surface coordinates, also under a map."""
    matrix = random_map(np.random.default_rng(8))
    assert np.allclose(quadric_uv(record(kind, IDENTITY), vec3(*point)), expected, atol=1e-15)
    world = matrix[:, :3] @ np.array(point) + matrix[:, 3]
    u, v = quadric_uv(record(kind, matrix), Vec3(world))
    assert 0.0 <= u <= 1.0
    assert 0.0 <= v <= 1.0
    assert v == pytest.approx(expected[1], abs=1e-7)
    if abs(expected[1] - 0.5) < 0.5:
        assert (u - expected[0] + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-12)


@all_kinds
def test_bounds_contain_and_touch(kind):
    """No point lies outside, and on each side some point comes as near as a dense grid lets it."""
    rng = np.random.default_rng(13)
    grid = (np.stack(np.meshgrid(np.arange(400), np.arange(401)), -1).reshape(-1, 2)) / 400.0
    angle, s = 2.0 * math.pi * grid[:, 0], grid[:, 1]
    radius = {SPHERE: np.sin(math.pi * s), DISK: s, CYLINDER: np.ones(len(s)), CONE: 1.0 - s}[kind]
    z = {SPHERE: -np.cos(math.pi * s), DISK: 0.0 * s}.get(kind, s)
    p = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1)
    for _ in range(10):
        matrix = random_map(rng)
        points = p @ matrix[:, :3].T + matrix[:, 3]
        lower, upper = (np.array(corner) for corner in quadric_bounds(record(kind, matrix)))
        assert (points.min(axis=0) >= lower - 1e-14).all()
        assert (points.max(axis=0) <= upper + 1e-14).all()
        assert np.abs(points.min(axis=0) - lower).max() < 2e-4
        assert np.abs(points.max(axis=0) - upper).max() < 2e-4
