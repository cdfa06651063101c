"""Exact shapes, maps and rays that the tests of quadrics share."""

import math

import numpy as np
import pytest

from artist_py.geometry.quadric_records import quadric_records
from artist_py.scene.tables import CONE, CYLINDER, DISK, SPHERE

KINDS = (SPHERE, DISK, CYLINDER, CONE)
EPSILON = 2.0**-52
IDENTITY = np.eye(3, 4)
all_kinds = pytest.mark.parametrize("kind", KINDS, ids=["sphere", "disk", "cylinder", "cone"])


def record(kind, object_to_world):
    """The record of one shape; `object_to_world` is (3, 4)."""
    return quadric_records([kind], [object_to_world]).view(np.recarray)[0]


def random_map(rng, size=1.0, offset=1.0):
    """A skewed, sometimes mirrored map with stretches in [1/4, 1] x `size`, and its centre about `offset` away."""
    left, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    right, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    stretches = size * rng.uniform(0.25, 1.0, 3) * rng.choice([-1.0, 1.0], 3)
    return np.column_stack([left @ np.diag(stretches) @ right, offset * rng.normal(size=3)])


def random_maps(rng, n, size, spread):
    """Skewed maps of about `size`, centred within `spread` of the origin."""
    rotations, _ = np.linalg.qr(rng.normal(size=(n, 3, 3)))
    shears = np.eye(3) + np.triu(rng.uniform(-0.5, 0.5, (n, 3, 3)), 1)
    linear = rotations @ shears * (size * rng.uniform(0.3, 1.0, (n, 1, 3)))
    return np.concatenate([linear, rng.uniform(-spread, spread, (n, 3, 1))], axis=2)


def random_rays(rng, n):
    """Origins and directions that are exact in float32."""
    origins = rng.uniform(-1.5, 1.5, (n, 3)).astype(np.float32).astype(float)
    return origins, (rng.normal(size=(n, 3)) * 0.7 - origins).astype(np.float32).astype(float)


def off_surface(kind, p):
    """How far the canonical point p is from the canonical shape, edges included."""
    radius = math.hypot(p[0], p[1])
    if kind == SPHERE:
        return abs(math.hypot(radius, p[2]) - 1.0)
    if kind == DISK:
        return abs(p[2]) + max(radius - 1.0, 0.0)
    beyond = max(-p[2], 0.0) + max(p[2] - 1.0, 0.0)
    return abs(radius - (1.0 if kind == CYLINDER else 1.0 - p[2])) + beyond
