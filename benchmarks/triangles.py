"""Cost against the number of triangles: loading and building, rate, and memory; each size in a process of its own."""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np

from .measure import on_one_processor, run_timed, save

SIZES = (10**2, 10**3, 10**4, 10**5, 300_000, 10**6, 10**7)
TARGET = {"triangles": 300_000, "load_and_build_seconds": 3.0}
ITERATIONS = 4

SCENE = """\
film.resolution = [256, 256]
camera = { type = "pinhole", position = [0, -4, 1], look_at = [0, 0, 0], field_of_view = 40 }
materials.grey = { type = "diffuse", reflectance = 0.7 }

[[shapes]]
type = "mesh"
file = "sphere.ply"
material = "grey"

[[shapes]]
type = "rectangle"
corner = [-3, -3, -1]
edges = [[6, 0, 0], [0, 6, 0]]
material = "grey"

[[shapes]]
type = "rectangle"
corner = [-1, -1, 3]
edges = [[0, 2, 0], [2, 0, 0]]
emission = 5
"""


def run(options):
    """Measure and save."""
    on_one_processor()
    sizes = [size for size in SIZES if not options.quick or size <= 10**6]
    save("triangles", __doc__, target=TARGET, sizes=[measure_size(size) for size in sizes])


def measure_size(target):
    """Figures of a bumpy sphere of about `target` triangles on a floor."""
    with tempfile.TemporaryDirectory() as directory:
        folder = Path(directory)
        vertices, faces = bumpy_sphere(target)
        write_ply(folder / "sphere.ply", vertices, faces)
        (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
        command = [
            sys.executable,
            "-m",
            "benchmarks.mesh_render",
            str(folder / "scene.toml"),
            str(ITERATIONS),
        ]
        _, memory = run_timed([*command, str(folder / "figures.json")])
        figures = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    figures = {"triangles": len(faces), **figures, "peak_bytes": memory}
    print(
        f"  {len(faces):9} triangles: load and build {figures['load_and_build_seconds']:6.2f} s, "
        f"{figures['cpu_ns_per_ray']:4.0f} ns per ray, {memory / 2**20:5.0f} MiB",
        flush=True,
    )
    return figures


def bumpy_sphere(target):
    """`(vertices, faces)` of a sphere of about `target` triangles whose radius varies by a tenth."""
    rows = max(round((target / 4) ** 0.5), 3)
    columns = 2 * rows
    theta, phi = np.meshgrid(
        np.pi * (np.arange(rows + 1) + 1e-3) / (rows + 2e-3),
        2 * np.pi * np.arange(columns) / columns,
        indexing="ij",
    )
    radius = 1.0 + 0.1 * np.sin(7 * theta) * np.sin(9 * phi)
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    faces = np.stack([a, a + columns, b, b, a + columns, b + columns], -1).reshape(-1, 3)
    return (directions * radius[..., None]).reshape(-1, 3).astype("<f4"), faces.astype("<i4")


def write_ply(path, vertices, faces):
    """Binary PLY."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    rows["count"], rows["corners"] = 3, faces
    path.write_bytes(header.encode() + vertices.tobytes() + rows.tobytes())
