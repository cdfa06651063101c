"""Write scenes/meshes/pool_water.ply: a block of water with waves on top, closed, with normals at the corners.

The waves are a sum of sines that go in all directions, with random phases; short ones are flatter (amplitude
proportional to the square of their length). Run from anywhere: `python scripts/make_pool.py`.
"""

from pathlib import Path

import numpy as np

TARGET = Path(__file__).parent.parent / "scenes" / "meshes" / "pool_water.ply"
HALF_WIDTH, HALF_LENGTH = 1.55, 2.05  # m; the basin of scenes/sds_pool.toml is 5 cm smaller all around
BOTTOM = -1.6  # m
COLUMNS, ROWS = 72, 96  # squares
WAVES = 14
LONGEST, SHORTEST = 1.3, 0.42  # m
STEEPNESS = 0.1  # rms of the slope
SEED = 3


def waves():
    """Wave vectors (n, 2), 1/m, amplitudes (n,), m, and phases (n,)."""
    rng = np.random.default_rng(SEED)
    length = np.geomspace(LONGEST, SHORTEST, WAVES)
    turn = 2 * np.pi * (np.arange(WAVES) * 0.382 + 0.1 * rng.random(WAVES))
    vectors = (2 * np.pi / length)[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    amplitudes = length**2
    slope = np.sqrt(0.5 * ((amplitudes * 2 * np.pi / length) ** 2).sum())
    return vectors, amplitudes * STEEPNESS / slope, rng.random(WAVES) * 2 * np.pi


def surface():
    """Corners of the top (rows + 1, columns + 1, 3), m, and its unit normals."""
    x, y = np.meshgrid(
        np.linspace(-HALF_WIDTH, HALF_WIDTH, COLUMNS + 1), np.linspace(-HALF_LENGTH, HALF_LENGTH, ROWS + 1)
    )
    vectors, amplitudes, phases = waves()
    angle = x[..., None] * vectors[:, 0] + y[..., None] * vectors[:, 1] + phases
    height = (amplitudes * np.sin(angle)).sum(axis=-1)
    slope = ((amplitudes * np.cos(angle))[..., None] * vectors).sum(axis=-2)
    normals = np.concatenate([-slope, np.ones_like(x)[..., None]], axis=-1)
    return np.stack([x, y, height], axis=-1), normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def rim():
    """Indices of the top's outer corners, counter-clockwise as seen from above."""
    index = np.arange((ROWS + 1) * (COLUMNS + 1)).reshape(ROWS + 1, COLUMNS + 1)
    return np.concatenate([index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]])


def block():
    """Vertices (n, 6) as position and normal, and triangles (m, 3), of the closed block."""
    positions, normals = surface()
    top = np.concatenate([positions.reshape(-1, 3), normals.reshape(-1, 3)], axis=1)
    index = np.arange(len(top)).reshape(ROWS + 1, COLUMNS + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = [np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)]
    outer = rim()
    position, following = top[outer, :3], np.roll(top[outer, :3], -1, axis=0)
    outward = np.cross(following - position, [0, 0, 1])
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    vertices = [top]
    # Each strip of the sides has corners of its own, so that the edges stay sharp.
    low, low_following = ((each * [1, 1, 0] + [0, 0, BOTTOM]) for each in (position, following))
    strips = np.stack([position, low, low_following, following], axis=1)
    vertices.append(
        np.concatenate([strips, np.broadcast_to(outward[:, None], strips.shape)], axis=2).reshape(-1, 6)
    )
    first = len(top) + 4 * np.arange(len(outer))[:, None]
    faces += [first + np.array(corners) for corners in ([0, 1, 2], [0, 2, 3])]
    x, y = [-1, 1, 1, -1], [-1, -1, 1, 1]
    floor = np.column_stack([HALF_WIDTH * np.array(x), HALF_LENGTH * np.array(y), np.full(4, BOTTOM)])
    start = len(top) + 4 * len(outer)
    vertices.append(np.concatenate([floor, np.tile([0.0, 0.0, -1.0], (4, 1))], axis=1))
    faces.append(start + np.array([[0, 2, 1], [0, 3, 2]]))
    return np.concatenate(vertices).astype("<f4"), np.concatenate(faces)


def main():
    """Write the mesh."""
    vertices, faces = block()
    names = ("x", "y", "z", "nx", "ny", "nz")
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    head += [f"property float {name}" for name in names]
    head += [f"element face {len(faces)}", "property list uchar uint vertex_indices", "end_header\n"]
    rows = np.zeros(len(faces), [("count", "u1"), ("corners", "<u4", 3)])
    rows["count"], rows["corners"] = 3, faces
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_bytes("\n".join(head).encode("ascii") + vertices.tobytes() + rows.tobytes())
    print(f"{TARGET}: {len(faces)} triangles")


if __name__ == "__main__":
    main()
