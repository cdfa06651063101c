"""Rays against exact shapes: t against 60-digit arithmetic, from near, far, and along edges."""

import math
from decimal import Decimal, localcontext

import numba
import numpy as np
import pytest
from quadric_cases import EPSILON, IDENTITY, all_kinds, random_map, record

from artist_py.core.vector import Vec3, vec3
from artist_py.geometry.quadrics import intersect_quadric
from artist_py.jit import kernel
from artist_py.scene.tables import CONE, CYLINDER, DISK, SPHERE


def exact(array):
    return np.vectorize(lambda x: Decimal(float(x)), otypes=[object])(np.asarray(array))


def exact_first_hit(kind, matrix, origin, direction):
    """(t, |cos| of incidence, speed, canonical distance) of the first hit with t > 0, in 60 digits; or None."""
    with localcontext(prec=60):
        x, y, z, centre = exact(matrix).T
        cofactors = np.array([np.cross(y, z), np.cross(z, x), np.cross(x, y)])
        inverse = cofactors / (cofactors[0] @ x)
        o, d = inverse @ (exact(origin) - centre), inverse @ exact(direction)
        if kind == DISK:
            roots = [-o[2] / d[2]]
        else:
            # x² + y² + form z² + slope z = height
            form, slope, height = {SPHERE: (1, 0, 1), CYLINDER: (0, 0, 1), CONE: (-1, 2, 1)}[kind]
            weights = exact([1, 1, form])
            b = (weights * o) @ d + slope * d[2] / 2
            roots = real_roots((weights * d) @ d, b, (weights * o) @ o + slope * o[2] - height)
        for t in sorted(roots):
            p = o + d * t
            is_inside_edge = p[0] ** 2 + p[1] ** 2 <= 1 if kind == DISK else kind == SPHERE or 0 <= p[2] <= 1
            if t > 0 and is_inside_edge:
                normal = {SPHERE: p, DISK: exact([0, 0, 1]), CYLINDER: p * exact([1, 1, 0])}
                normal = normal.get(kind, np.array([p[0], p[1], 1 - p[2]]))
                speed, distance = (d @ d).sqrt(), (o @ o).sqrt()
                cosine = abs(normal @ d) / ((normal @ normal).sqrt() * speed)
                return float(t), float(cosine), float(speed), float(distance)
    return None


def real_roots(a, b, c):
    discriminant = b * b - a * c
    if discriminant < 0:
        return []
    return [(-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a]


def random_rays(rng, matrix, n, distance):
    """Rays of any length that start `distance` sizes away, or inside for 0, and pass through or beside the shape."""
    targets = rng.uniform(-1.3, 1.3, (n, 3))
    away = rng.normal(size=(n, 3))
    away *= distance / np.linalg.norm(away, axis=1, keepdims=True)
    starts = targets + away if distance else rng.uniform(-0.5, 0.5, (n, 3))
    directions = (targets - starts) * 10.0 ** rng.uniform(-3, 3, (n, 1))
    return starts @ matrix[:, :3].T + matrix[:, 3], directions @ matrix[:, :3].T


@kernel
def intersect_all(quadrics, origins, directions, t_near, t_far, found):
    for i in range(len(origins)):
        o, d = origins[i], directions[i]
        found[i] = intersect_quadric(
            quadrics[0], vec3(o[0], o[1], o[2]), vec3(d[0], d[1], d[2]), t_near, t_far
        )


def compiled_hits(quadric, origins, directions, t_near=0.0, t_far=math.inf):
    origins, directions = (
        np.array(np.broadcast_to(each, (len(directions), 3)), float) for each in (origins, directions)
    )
    found = np.empty(len(origins))
    intersect_all(
        np.array([quadric], quadric.dtype).view(np.recarray),
        origins,
        directions,
        float(t_near),
        float(t_far),
        found,
    )
    return found


@all_kinds
@pytest.mark.parametrize(
    ("size", "offset", "distance"),
    [(1.0, 1.0, 0.0), (1.0, 1.0, 3.0), (1.0, 0.0, 1e4), (1e-5, 1.0, 3.0), (1e-5, 1.0, 1e5), (1e4, 1e4, 1e4)],
)
def test_hits_are_those_of_exact_arithmetic(kind, size, offset, distance):
    """t is right to rounding, amplified by the distance in sizes and by grazing; hits and misses agree.

    A ray would be doubtful within 1e-9 of an edge or of grazing: chance of one among all 7200 below 1e-4.
    """
    rng = np.random.default_rng([kind, int(offset), int(distance), int(1 / size)])
    hits = 0
    for _ in range(5):
        matrix = random_map(rng, size, offset)
        origins, directions = random_rays(rng, matrix, 60, distance)
        quadric = record(kind, matrix)
        compiled = compiled_hits(quadric, origins, directions)
        for origin, direction, t in zip(origins, directions, compiled, strict=True):
            plain = intersect_quadric(quadric, Vec3(origin), Vec3(direction), 0.0, math.inf)
            hits += check_hit(kind, matrix, origin, direction, t, plain)
    assert hits > 50


def check_hit(kind, matrix, origin, direction, *found):
    reference = exact_first_hit(kind, matrix, origin, direction)
    if reference is None:
        assert all(t == math.inf for t in found)
        return False
    t_exact, cosine, speed, distance = reference
    # Stretches differ by up to 4, which the rounding of the canonical ray is multiplied with.
    error = 16.0 * EPSILON * (1.0 + distance)
    for t in found:
        assert abs(t - t_exact) * speed <= error / max(cosine, math.sqrt(error))
    return True


@pytest.mark.parametrize(("distance", "gap"), [(1.0, 1e-13), (1e4, 1e-10), (1e7, 1e-7)])
def test_grazing_rays_are_told_apart(distance, gap):
    """A ray that passes the unit sphere or cylinder within `gap` of touching it hits or misses as it should."""
    for kind, z in ((SPHERE, 0.0), (CYLINDER, 0.5)):
        quadric = record(kind, IDENTITY)
        for angle in np.linspace(0.1, 6.0, 20):
            aside = np.array([-math.sin(angle), math.cos(angle), 0.0])
            direction = np.array([math.cos(angle), math.sin(angle), 0.0])
            origin = [aside * (1.0 + side) - distance * direction + [0, 0, z] for side in (-gap, gap)]
            found = compiled_hits(quadric, origin, [direction] * 2)
            assert abs(found[0] - distance) < 1.1 * math.sqrt(2.0 * gap) + 4.0 * EPSILON * distance
            assert found[1] == math.inf


AXIS, SLANT = (0.0, 0.0, 1.0), (1.0, 0.0, -1.0)


@pytest.mark.parametrize(
    ("kind", "origin", "direction", "expected"),
    [
        (SPHERE, (0, 0, -3), AXIS, 2.0),
        (SPHERE, (0, 0, 0), AXIS, 1.0),
        (SPHERE, (0, 0, 3), AXIS, math.inf),
        (DISK, (0.5, 0, -2), AXIS, 2.0),
        (DISK, (0.5, 0, 2), (0.0, 0.0, -4.0), 0.5),
        (DISK, (-3, 0, 0), (1.0, 0.0, 0.0), math.inf),  # within the plane
        (DISK, (-3, 0, 1), (1.0, 0.0, 0.0), math.inf),  # parallel to it
        (CYLINDER, (0.5, 0, -2), AXIS, math.inf),  # parallel to the axis, inside
        (CYLINDER, (2, 0, -2), AXIS, math.inf),
        (CYLINDER, (1, 0, -2), AXIS, math.inf),  # along the surface
        (CYLINDER, (0, 0, 0.5), (0.0, 2.0, 0.0), 0.5),
        (CYLINDER, (-3, 0, 1.5), (1.0, 0.0, 0.0), math.inf),  # above
        (CYLINDER, (0, 0, -0.5), (1.0, 0.0, 1.0), 1.0),  # through the open bottom
        (CONE, (0.5, 0, -2), AXIS, 2.5),
        (CONE, (0, 0, -2), AXIS, 3.0),  # through the apex
        (CONE, (0.25, 0, 3), (0.0, 0.0, -1.0), 2.25),
        (CONE, (-0.5, 0, 1.25), SLANT, 0.375),  # parallel to the generator opposite: one root
        (CONE, (0, 0, 3), (1.0, 0.0, 0.0), math.inf),
        (CONE, (2, 0, 1.5), (-1.0, 0.0, 0.0), math.inf),  # the other nappe
    ],
)
def test_special_rays(kind, origin, direction, expected):
    """Rays that make coefficients of the quadratic vanish."""
    quadric = record(kind, IDENTITY)
    assert compiled_hits(quadric, origin, [direction])[0] == pytest.approx(expected, rel=1e-15)
    found = intersect_quadric(quadric, vec3(*origin), vec3(*direction), 0.0, math.inf)
    assert found == pytest.approx(expected, rel=1e-15)


def test_range_is_open():
    """Hits outside (t_near, t_far) do not count, and the far one is found where the near one does not."""
    quadric = record(SPHERE, IDENTITY)
    ranges = [(0.0, 5.0, 2.0), (2.0, 5.0, 4.0), (2.5, 5.0, 4.0), (2.5, 4.0, math.inf), (0.0, 2.0, math.inf)]
    for t_near, t_far, expected in ranges:
        assert compiled_hits(quadric, (0, 0, -3), [AXIS], t_near, t_far)[0] == expected
        assert intersect_quadric(quadric, vec3(0, 0, -3), vec3(0, 0, 1), t_near, t_far) == expected


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="kernels divide by zero, plain Python does not")
def test_a_direction_of_no_length_misses():
    """Such a ray is a miss, not a NaN."""
    assert compiled_hits(record(SPHERE, IDENTITY), (0, 0, 0), [(0, 0, 0)])[0] == math.inf


@pytest.mark.parametrize("kind", [CYLINDER, CONE], ids=["cylinder", "cone"])
def test_no_ray_slips_between_a_shape_and_its_cap(kind):
    """From inside, rays towards the rim, the apex and the base meet the shell or a cap."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        matrix = random_map(rng, 1.0, 3.0)
        caps = [matrix, matrix + np.outer(matrix[:, 2], [0, 0, 0, 1])] if kind == CYLINDER else [matrix]
        shapes = [record(kind, matrix), *(record(DISK, cap) for cap in caps)]
        angle = rng.uniform(0.0, 2.0 * math.pi, 500)
        height = rng.integers(0, 2, 500)
        radius = 1.0 if kind == CYLINDER else 1.0 - height
        rim = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], 1)
        start = rng.uniform(0.1, 0.3, (500, 3))
        origins = start @ matrix[:, :3].T + matrix[:, 3]
        directions = rim @ matrix[:, :3].T + matrix[:, 3] - origins
        first = np.min([compiled_hits(shape, origins, directions) for shape in shapes], axis=0)
        assert np.abs(first - 1.0).max() < 1e-9
