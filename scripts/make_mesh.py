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
    torus_normal = np.stack(
        [
            np.cos(TURNS * t) * np.cos(WINDINGS * t),
            np.cos(TURNS * t) * np.sin(WINDINGS * t),
            np.sin(TURNS * t),
        ],
        axis=-1,
    )
    ring = np.stack([np.cos(WINDINGS * t), np.sin(WINDINGS * t), np.zeros_like(t)], axis=-1)
    centre = RING * ring + COIL * torus_normal
    # The derivative of the centre: a tangent of the torus, hence perpendicular to its normal.
    ring_ahead = np.stack([-np.sin(WINDINGS * t), np.cos(WINDINGS * t), np.zeros_like(t)], axis=-1)
    tube_ahead = np.stack(
        [
            -np.sin(TURNS * t) * np.cos(WINDINGS * t),
            -np.sin(TURNS * t) * np.sin(WINDINGS * t),
            np.cos(TURNS * t),
        ],
        axis=-1,
    )
    tangent = WINDINGS * (RING + COIL * np.cos(TURNS * t))[..., None] * ring_ahead + TURNS * COIL * tube_ahead
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    side = np.cross(tangent, torus_normal)
    angle = STRANDS * phi + TWISTS * t
    radius = ROPE * (
        1 + RELIEF * np.sqrt(np.cos(angle / 2) ** 2 + 0.02) + FIBRE_RELIEF * np.cos(FIBRES * phi - angle)
    )
    return centre + radius[..., None] * (
        np.cos(phi)[..., None] * torus_normal + np.sin(phi)[..., None] * side
    )


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
