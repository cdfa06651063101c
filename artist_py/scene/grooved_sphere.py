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


def unrolled(mesh, segments):
    """The Mesh of `grooved_sphere` with texture coordinates, cut open where u is 0 and 1, and at the poles.

    u is the angle around the axis, of a full turn, and v the angle from the south pole, of half a turn.
    """
    n_vertices, rings = len(mesh.vertices), (len(mesh.vertices) - 2) // segments + 1
    columns, heights = np.arange(segments), np.arange(1, rings)
    faces, first, last = mesh.faces.copy(), mesh.faces[:segments], mesh.faces[-segments:]
    # The last faces around end in copies of the ring's first vertex, and every face at a pole has its own.
    ends = faces[segments:-segments].reshape(rings - 2, segments, 2, 3)[:, -1]
    for corners in (faces[segments - 1], faces[-1], ends):
        is_first = (corners > 0) & (corners < n_vertices - 1) & ((corners - 1) % segments == 0)
        corners[is_first] = n_vertices + (corners[is_first] - 1) // segments
    north = n_vertices + rings - 1 + columns
    faces[:segments, 0], faces[-segments:, 0] = north, north + segments
    copies = np.concatenate([1 + segments * (heights - 1), first[:, 0], last[:, 0]])
    sources = np.concatenate([np.arange(n_vertices), copies])
    u = np.concatenate(
        [[0], np.tile(columns, rings - 1), [0], np.full(rings - 1, segments), columns + 0.5, columns + 0.5]
    )
    from_north = np.concatenate(
        [[0], np.repeat(heights, segments), [rings], heights, 0 * columns, 0 * columns + rings]
    )
    uvs = np.stack([u / segments, 1 - from_north / rings], axis=1).astype(np.float32)
    return Mesh(mesh.vertices[sources], faces, mesh.normals[sources], uvs)


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
