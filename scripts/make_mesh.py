"""Makes the mesh of scenes/mesh.toml: a rope tied into a trefoil knot, of 384 000 triangles.

python scripts/make_mesh.py

writes scenes/generated/knot.ply, a binary PLY file with normals. Fewer or more triangles: --along and --around.
"""

import argparse
from pathlib import Path

import numpy as np

OUTPUT = Path(__file__).resolve().parent.parent / "scenes" / "generated" / "knot.ply"
RING, COIL = 1.0, 0.42  # the knot lies on a torus with these radii
WINDINGS, TURNS = 2, 3  # around the axis of the torus and around its tube: a trefoil
ROPE, STRANDS, RELIEF, TWISTS = 0.21, 5, 0.13, 36  # radius, number of strands, their depth in radii, twists
FIBRES, FIBRE_RELIEF = 60, 0.006  # fine lines along the strands


def main():
    """Write the mesh that the command line asks for."""
    parser = argparse.ArgumentParser(description="Makes the mesh of scenes/mesh.toml.")
    parser.add_argument("--along", type=int, default=1600, help="points along the rope (default: 1600)")
    parser.add_argument("--around", type=int, default=120, help="points around the rope (default: 120)")
    parser.add_argument(
        "-o", "--output", type=Path, default=OUTPUT, help="PLY file (default: scenes/generated/knot.ply)"
    )
    arguments = parser.parse_args()
    if min(arguments.along, arguments.around) < 3:
        parser.error("a mesh needs 3 points or more in each direction")
    vertices, normals, faces = knot(arguments.along, arguments.around)
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    write_ply(arguments.output, vertices, normals, faces)
    print(f"{arguments.output}: {len(faces)} triangles")


def knot(along, around):
    """Vertices and unit normals, float64 (n, 3), and faces, int32 (m, 3), counter-clockwise seen from outside."""
    t = 2 * np.pi * np.arange(along)[:, None] / along
    phi = 2 * np.pi * np.arange(around)[None, :] / around
    vertices = surface(t, phi)
    step = 1e-5  # central differences: the error is of second order, and far below what float32 resolves
    d_t = surface(t + step, phi) - surface(t - step, phi)
    d_phi = surface(t, phi + step) - surface(t, phi - step)
    normals = np.cross(d_phi, d_t)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return vertices.reshape(-1, 3), normals.reshape(-1, 3), grid_faces(along, around)


def surface(t, phi):
    """Points of the rope, shape of `t` and `phi` together with a last axis x, y, z; both run from 0 to 2 pi."""
    centre, tangent, normal = knot_line(t)
    strand = STRANDS * phi + TWISTS * t
    relief = RELIEF * np.sqrt(np.cos(strand / 2) ** 2 + 0.02)  # 0.02 rounds the grooves between the strands
    fibres = FIBRE_RELIEF * np.cos(FIBRES * phi - strand)
    radius = ROPE * (1 + relief + fibres)
    side = np.cross(tangent, normal)
    return centre + vector(radius) * (vector(np.cos(phi)) * normal + vector(np.sin(phi)) * side)


def knot_line(t):
    """Points of the knot's centre line, its unit tangents, and the unit normals of the torus there."""
    cos_w, sin_w, cos_t, sin_t = (
        np.cos(WINDINGS * t),
        np.sin(WINDINGS * t),
        np.cos(TURNS * t),
        np.sin(TURNS * t),
    )
    normal = vector(cos_t * cos_w, cos_t * sin_w, sin_t)
    centre = RING * vector(cos_w, sin_w, 0 * t) + COIL * normal
    ahead_along_ring = WINDINGS * (RING + COIL * cos_t)
    ahead_along_coil = TURNS * COIL
    tangent = vector(ahead_along_ring) * vector(-sin_w, cos_w, 0 * t)
    tangent = tangent + ahead_along_coil * vector(-sin_t * cos_w, -sin_t * sin_w, cos_t)
    return centre, tangent / np.linalg.norm(tangent, axis=-1, keepdims=True), normal


def vector(*components):
    """Arrays as components along a new last axis."""
    return np.stack(components, axis=-1)


def grid_faces(along, around):
    """Two triangles for each cell of a grid that closes on itself both ways; int32 (2 along around, 3)."""
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    here, ahead = i * around, (i + 1) % along * around
    beside = (j + 1) % around
    a, b, c, d = here + j, ahead + j, ahead + beside, here + beside
    return np.stack([a, d, c, a, c, b], axis=-1).reshape(-1, 3).astype(np.int32)


def write_ply(path, vertices, normals, faces):
    """A binary PLY file of float32 vertices and normals."""
    header = f"""ply
format binary_little_endian 1.0
element vertex {len(vertices)}
property float x
property float y
property float z
property float nx
property float ny
property float nz
element face {len(faces)}
property list uchar int vertex_indices
end_header
"""
    rows = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    points = np.concatenate([vertices, normals], axis=1).astype("<f4")
    path.write_bytes(header.encode() + points.tobytes() + rows.tobytes())


if __name__ == "__main__":
    main()
