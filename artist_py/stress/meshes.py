"""Meshes for stress cases, written as binary PLY."""

import math

import numpy as np

FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def write_ply(path, vertices, faces):
    """Write vertices (n, 3) and triangles (m, 3)."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), FACE)
    rows["count"], rows["corners"] = 3, np.reshape(faces, (-1, 3))
    with open(path, "wb") as file:
        file.write(header.encode())
        file.write(np.ascontiguousarray(vertices, "<f4").tobytes())
        file.write(rows.tobytes())


def sphere_mesh(colatitudes, n_around, radius=1.0, center=(0.0, 0.0, 0.0)):
    """Vertices and faces, normals outwards, of a sphere cut at `colatitudes` (0 and pi excluded)."""
    azimuths = np.arange(n_around) * (2.0 * math.pi / n_around)
    sines, cosines = np.sin(colatitudes)[:, None], np.cos(colatitudes)[:, None]
    rings = np.stack(
        [
            sines * np.cos(azimuths),
            sines * np.sin(azimuths),
            np.broadcast_to(cosines, (len(colatitudes), n_around)),
        ],
        axis=2,
    )
    vertices = np.concatenate([rings.reshape(-1, 3), [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    return vertices * radius + np.asarray(center), _sphere_faces(len(colatitudes), n_around)


def _sphere_faces(n_rings, n_around):
    here = np.arange(n_around)
    there = (here + 1) % n_around
    start = (np.arange(n_rings - 1) * n_around)[:, None]
    a, b, c, d = (start + each for each in (here, there, n_around + here, n_around + there))
    sides = np.concatenate([np.stack([a, c, b], axis=2), np.stack([b, c, d], axis=2)]).reshape(-1, 3)
    north, south = n_rings * n_around, n_rings * n_around + 1
    last = (n_rings - 1) * n_around
    top = np.stack([np.full(n_around, north), here, there], axis=1)
    bottom = np.stack([last + here, np.full(n_around, south), last + there], axis=1)
    return np.concatenate([sides, top, bottom])


def write_graded_sphere(path, n_rings, n_around, smallest):
    """A sphere whose triangles get smaller towards the north pole: to `smallest` times the area of the largest."""
    # Areas go with the square of the distance from the pole, as rings of equal shape do.
    graded = np.geomspace(math.sqrt(smallest), 1.0, n_rings - n_rings // 10)
    rest = np.linspace(1.0, math.pi, n_rings // 10 + 2)[1:-1]
    write_ply(path, *sphere_mesh(np.concatenate([graded, rest]), n_around))


def write_sphere(path, n_rings, n_around, radius):
    """A sphere of about 2 `n_rings` x `n_around` triangles."""
    colatitudes = np.linspace(0.0, math.pi, n_rings + 2)[1:-1]
    write_ply(path, *sphere_mesh(colatitudes, n_around, radius))


def write_rubble(path, seed, kinds):
    """Triangles strewn over a ball of radius 0.5, of each of `kinds` some."""
    rng = np.random.default_rng(seed)
    corners = np.concatenate([RUBBLE[kind](rng) for kind in kinds])
    write_ply(path, corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _plain(rng, count=40, size=0.1):
    """Triangles (count, 3, 3) of about `size`."""
    places = rng.uniform(-0.35, 0.35, (count, 1, 3))
    return places + rng.normal(0.0, size, (count, 3, 3))


def _duplicates(rng):
    """Each four times, once with its corners in reverse, so that it looks to the other side."""
    once = _plain(rng, 10)
    return np.concatenate([once, once, np.roll(once, 1, axis=1), once[:, ::-1]])


def _coplanar(rng):
    """Overlapping ones in one plane."""
    flat = _plain(rng, 20)
    flat[..., 2] = 0.0625
    return flat


def _slivers(rng):
    """A millionth of a length across to ten times that: an aspect of 1e7."""
    ends = _plain(rng, 40, 0.3)
    ends[:, 2] = 0.5 * (ends[:, 0] + ends[:, 1]) + rng.normal(0.0, 3e-8, (40, 3))
    return ends


def _degenerate(rng):
    """Points, lines, and corners that coincide."""
    some = _plain(rng, 30)
    some[:10, 1] = some[:10, 0]
    some[10:20, 1:] = some[10:20, :1]
    some[20:, 2] = 2.0 * some[20:, 1] - some[20:, 0]
    return some


RUBBLE = {
    "plain": _plain,
    "duplicates": _duplicates,
    "coplanar": _coplanar,
    "slivers": _slivers,
    "degenerate": _degenerate,
}
