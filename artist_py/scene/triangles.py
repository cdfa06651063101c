"""Triangles that share vertices, and their normals."""

from typing import NamedTuple

import numpy as np

FLATNESS = 1e-12  # a triangle has no area where that is below this share of its longest edge squared


class Mesh(NamedTuple):
    """Triangles, counter-clockwise seen from the front."""

    vertices: np.ndarray  # float64 (n, 3)
    faces: np.ndarray  # uint32 (m, 3), into vertices
    normals: np.ndarray | None = None  # float32 (n, 3), unit
    uvs: np.ndarray | None = None  # float32 (n, 2)
    warnings: tuple[str, ...] = ()


def smooth_normals(vertices, faces):
    """Unit vertex normals, float32 (n, 3): the means of the faces' normals, weighted by the angle of their corner.

    Vertices in the same place count as one. (0, 0, 1) where no face gives a direction.
    Thuermer and Wuethrich 1998, Computing vertex normals from polygonal facets.
    """
    places, place_of = np.unique(vertices + 0.0, axis=0, return_inverse=True)
    corners = place_of.reshape(-1)[faces]
    crosses, sizes = face_crosses(vertices, faces)
    units = crosses / np.maximum(sizes, np.finfo(float).tiny)[:, None]
    sums, some = np.zeros_like(places), np.zeros_like(places)
    for corner in range(3):
        before, here, after = (vertices[faces[:, (corner + i) % 3]] for i in (2, 0, 1))
        cosine, sine = np.sum((after - here) * (before - here), axis=1), sizes
        weighted = units * np.arctan2(sine, cosine)[:, None]
        for axis in range(3):
            sums[:, axis] += np.bincount(corners[:, corner], weighted[:, axis], len(places))
        some[corners[:, corner]] = units
    # Faces back to back cancel; any one of them is as good as the other.
    lengths = np.linalg.norm(sums, axis=1)
    sums[lengths < 1e-9] = some[lengths < 1e-9]
    sums[np.linalg.norm(sums, axis=1) == 0] = 0, 0, 1
    return (sums / np.linalg.norm(sums, axis=1, keepdims=True)).astype(np.float32)[place_of.reshape(-1)]


def with_flat_normals(mesh):
    """The mesh with three vertices of its own per face, and the face's normal at each."""
    corners = mesh.faces.ravel()
    crosses, sizes = face_crosses(mesh.vertices, mesh.faces)
    normals = np.repeat(crosses / np.maximum(sizes, np.finfo(float).tiny)[:, None], 3, axis=0)
    faces = np.arange(len(corners)).reshape(-1, 3)
    return Mesh(mesh.vertices[corners], faces, normals, None if mesh.uvs is None else mesh.uvs[corners])


def face_crosses(vertices, faces):
    """Edge 0 x edge 1 of each face and its length, which is twice the area; float64 (m, 3) and (m,)."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        crosses = np.cross(b - a, c - a)
        return crosses, np.linalg.norm(crosses, axis=1)


def is_flat(vertices, faces):
    """Whether each face has, to rounding, no area; bool (m,)."""
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return ~(face_crosses(vertices, faces)[1] > FLATNESS * longest**2)
