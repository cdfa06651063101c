"""Traces recorded rays again, and nothing else; in turns with the render that they are from.

`python -m benchmarks.replay SCENE ITERATIONS FILE.npy REPEATS` prints a line of JSON.
"""

import json
import sys
import time

import numpy as np

import artist_py
from artist_py.core.vector import vec3
from artist_py.geometry.embree import SEEN, closest_hit, is_occluded
from artist_py.jit import kernel

# RTCRay of Embree 4.
ray_dtype = np.dtype(
    [
        ("origin", "f4", 3),
        ("t_near", "f4"),
        ("direction", "f4", 3),
        ("time", "f4"),
        ("t_far", "f4"),
        ("mask", "u4"),  # SEEN: closest hit, else occlusion
        ("id", "u4"),
        ("flags", "u4"),
    ],
    align=True,
)


@kernel
def trace_again(embree, rays):
    """Number of rays that hit something."""
    hits = 0
    for i in range(rays.shape[0]):
        ray = rays[i]
        origin = vec3(ray.origin[0], ray.origin[1], ray.origin[2])
        direction = vec3(ray.direction[0], ray.direction[1], ray.direction[2])
        if ray.mask == SEEN:
            hits += closest_hit(embree, origin, direction, ray.t_far).t < ray.t_far
        else:
            hits += is_occluded(embree, origin, direction, ray.t_far)
    return hits


def main(scene, iterations, path, repeats):
    """CPU seconds of render and replay, in turns."""
    compiled = artist_py.load_scene(scene)
    rays = np.load(path)
    address = compiled.embree.address
    trace_again(address, rays[:100])
    artist_py.render(compiled, iterations=1, threads=1)
    renders, replays = [], []
    for _ in range(int(repeats)):
        # What a render does once, such as compiling and converting the film, is not part of tracing paths.
        renders.append(
            artist_py.render(compiled, iterations=int(iterations), threads=1).statistics["cpu_seconds"]
        )
        begun = time.process_time()
        trace_again(address, rays)
        replays.append(time.process_time() - begun)
    counts = {"rays": len(rays), "closest_hits": int((rays["mask"] == SEEN).sum())}
    print(json.dumps({**counts, "render_cpu_seconds": renders, "embree_cpu_seconds": replays}))


if __name__ == "__main__":
    main(*sys.argv[1:])
