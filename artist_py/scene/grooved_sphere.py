"""The grooved sphere: a unit sphere with rings cut into it like the grooves of a screw without pitch."""

import numpy as np

from artist_py.scene.triangles import Mesh

RINGS_PER_GROOVE = 16


def grooved_sphere(segments, depth, grooves):
    """The Mesh of the surface r = 1 - depth (1 - cos(2 grooves t)) / 2, t the angle from +z, with exact normals.

    The grooves are circles of latitude, `grooves` of them between the poles, where r = 1 and the surface is
    smooth. There are `segments` faces around the axis, and half as many from pole to pole, at least 16 per groove.
    """
    rings = max(segments // 2, RINGS_PER_GROOVE * grooves)
    polar = np.pi * np.arange(1, rings) / rings
    azimuth = 2 * np.pi * np.arange(segments) / segments
    around = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    radius = 1 - depth * (1 - np.cos(2 * grooves * polar)) / 2
    slope = -depth * grooves * np.sin(2 * grooves * polar)  # dr / dt
    # The normal of a surface of revolution is r e_r - r' e_t.
    sine, cosine = np.sin(polar), np.cos(polar)
    across = _turned(radius * sine - slope * cosine, radius * cosine + slope * sine, around)
    vertices = _with_poles(_turned(radius * sine, radius * cosine, around))
    normals = _with_poles(across / np.linalg.norm(across, axis=1, keepdims=True))
    return Mesh(vertices, _faces(rings, segments), normals.astype(np.float32))


def _turned(outward, upward, around):
    """Points of a profile (outward, upward), turned to each direction around; float64 (rings x segments, 3)."""
    points = np.empty((len(outward), len(around), 3))
    points[..., :2] = outward[:, None, None] * around
    points[..., 2] = upward[:, None]
    return points.reshape(-1, 3)


def _with_poles(points):
    return np.concatenate([[[0, 0, 1.0]], points, [[0, 0, -1.0]]])


def _faces(rings, segments):
    """Triangles between the rings, and fans around the poles; uint32 (n, 3)."""
    here = np.arange(segments)
    after = (here + 1) % segments
    last = 1 + (rings - 2) * segments
    south = last + segments
    top = np.stack([np.zeros_like(here), 1 + here, 1 + after], axis=1)
    bottom = np.stack([np.full_like(here, south), last + after, last + here], axis=1)
    upper = 1 + segments * np.arange(rings - 2)[:, None]
    a, b, c, d = upper + here, upper + segments + here, upper + segments + after, upper + after
    sides = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=2)
    return np.concatenate([top, sides.reshape(-1, 3), bottom]).astype(np.uint32)
