"""Loads, builds and renders: `python -m benchmarks.mesh_render SCENE ITERATIONS FILE.json` writes the figures."""

import json
import sys
import time
from pathlib import Path

import artist_py


def main(scene, iterations, path):
    """Seconds to load and build, rate, and time per ray."""
    begun = time.perf_counter()
    compiled = artist_py.load_scene(scene)
    loaded = time.perf_counter() - begun
    statistics = artist_py.render(compiled, iterations=int(iterations), threads=1).statistics
    rays = statistics["rays"] + statistics["shadow_rays"]
    figures = {
        "load_and_build_seconds": loaded,
        "paths_per_cpu_second": statistics["paths"] / statistics["cpu_seconds"],
        "cpu_ns_per_ray": 1e9 * statistics["cpu_seconds"] / rays,
    }
    Path(path).write_text(json.dumps(figures), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
