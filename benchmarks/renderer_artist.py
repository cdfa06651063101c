"""Renders a scene with this package, in a process of its own: `python -m benchmarks.renderer_artist SCENE`.

Every line of standard input, `{"iterations": n, "seed": s}`, asks for a render and is answered by a line of JSON;
`"threads"` may be added. `{"cpu_seconds": t, "seed": s, "image": path}` asks for one that takes so long; its radiance
at one wavelength goes to an .npy file.
"""

import json
import sys
import time

import artist_py


def main():
    """Answer requests until standard input ends."""
    scene = artist_py.load_scene(sys.argv[1], json.loads(sys.argv[2]) if len(sys.argv) > 2 else {})
    print(json.dumps({"version": artist_py.__version__}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        print(json.dumps((timed if "image" in request else answer)(scene, **request)), flush=True)


def answer(scene, iterations, seed=1, threads=1):
    """Render, and say how long it took."""
    scene.graph = with_seed(scene.graph, seed)
    wall, cpu = time.perf_counter(), time.process_time()
    result = artist_py.render(scene, iterations=iterations, threads=threads)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    counted = {name: result.statistics[name] for name in ("paths", "rays", "shadow_rays")}
    return {**counted, "cpu_seconds": cpu, "seconds": wall, "mean": result.film.rgb.mean((0, 1)).tolist()}


def timed(scene, cpu_seconds, seed, image):
    """Render on one thread for so many CPU seconds; the image in the unit of the scene's radiance."""
    import numpy as np

    from artist_py.film.accumulation import Film
    from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for

    scene.graph = with_seed(scene.graph, seed)
    film = Film(*scene.graph.film.resolution)
    with sampler_for(scene, film, RenderSettings(threads=1), Silence()) as sampler:
        sampler.compile_kernels(Silence())
        wall, cpu = time.perf_counter(), time.process_time()
        while time.process_time() - cpu < cpu_seconds:
            sampler.iterate(film.iterations)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    radiance = film.mean()[..., 1] / scene.spectra[1].sum(dtype=float)
    np.save(image, radiance)
    paths = film.iterations * film.width * film.height
    return {"paths": paths, "cpu_seconds": cpu, "seconds": wall, "mean": float(radiance.mean())}


def with_seed(graph, seed):
    """The graph with another seed."""
    from dataclasses import replace

    return replace(graph, render=replace(graph.render, seed=seed))


if __name__ == "__main__":
    main()
