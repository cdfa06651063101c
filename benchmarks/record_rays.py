"""Writes every ray of a render to a file: `python -m benchmarks.record_rays SCENE ITERATIONS FILE.npy`.

Kernels find Embree's queries by name (geometry/embree.py). In this process, and before any kernel is loaded, the names
are given to functions that note the ray and pass it on; the renderer itself knows nothing of it.
"""

import ctypes
import sys

import numpy as np
from llvmlite import binding

import artist_py
from artist_py.geometry import embree

from .replay import ray_dtype

QUERY = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)


def recorder(name, rays):
    """A C function for Embree's query `name` that also appends the ray, as Embree gets it, to `rays`."""
    query = getattr(embree.rtc, name)

    def record(scene, ray, arguments):
        rays.append(ctypes.string_at(ray, embree.RAY_BYTES))
        query(scene, ray, arguments)

    return QUERY(record)


def main(scene, iterations, path):
    """Render, and save the rays as an array of `ray_dtype`."""
    rays = []
    recorders = {name: recorder(name, rays) for name in ("rtcIntersect1", "rtcOccluded1")}
    for name, function in recorders.items():
        binding.add_symbol(f"artist_{name}", ctypes.cast(function, ctypes.c_void_p).value)
    result = artist_py.render(artist_py.load_scene(scene), iterations=int(iterations), threads=1)
    counted = result.statistics["rays"] + result.statistics["shadow_rays"]
    if counted != len(rays):
        raise SystemExit(f"{len(rays)} rays were recorded, but the render says that it traced {counted}")
    np.save(path, np.frombuffer(b"".join(rays), ray_dtype))


if __name__ == "__main__":
    main(*sys.argv[1:])
