"""Renders a scene with this package, in a process of its own: `python -m benchmarks.renderer_artist SCENE`.

Every line of standard input, `{"iterations": n, "seed": s}`, asks for a render and is answered by a line of JSON;
`"threads"` may be added. `{"cpu_seconds": t, "seed": s, "image": path}` asks for one that takes so long; its radiance
at one wavelength goes to an .npy file.
"""

import json
import sys
import time

import artist_py
from artist_py.evidence.entries import with_seed


def main():
    """Answer requests until standard input ends."""
    scene = artist_py.load_scene(sys.argv[1], json.loads(sys.argv[2]) if len(sys.argv) > 2 else {})
    print(json.dumps({"version": artist_py.__version__}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        print(json.dumps((timed if "image" in request else answer)(scene, **request)), flush=True)


def answer(scene, iterations, seed=1, threads=1):
    """Render, and say how long it took."""
    scene = with_seed(scene, seed)
    wall, cpu = time.perf_counter(), time.process_time()
    result = artist_py.render(scene, iterations=iterations, threads=threads)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    counted = {name: result.statistics[name] for name in ("paths", "rays", "shadow_rays")}
    return {**counted, "cpu_seconds": cpu, "seconds": wall, "mean": result.film.rgb.mean((0, 1)).tolist()}


def timed(scene, cpu_seconds, seed, image):
    """Render on one thread for so many CPU seconds; the image in the unit of the scene's radiance."""
    import numpy as np

    from artist_py.samplers.render_job import RenderSettings
    from artist_py.samplers.snapshots import snapshots

    (result,) = snapshots(with_seed(scene, seed), RenderSettings(threads=1), [cpu_seconds], "cpu")
    radiance = result.film.rgb[..., 1] / scene.spectra[1].sum(dtype=float)
    np.save(image, radiance)
    paths, seconds = result.iterations * radiance.size, result.wall_seconds
    return {
        "paths": paths,
        "cpu_seconds": result.cpu_seconds,
        "seconds": seconds,
        "mean": float(radiance.mean()),
    }


if __name__ == "__main__":
    main()
