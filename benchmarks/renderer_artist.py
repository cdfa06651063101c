"""Renders a scene with this package, in a process of its own: `python -m benchmarks.renderer_artist SCENE`.

Every line of standard input, `{"iterations": n, "seed": s}`, asks for a render and is answered by a line of JSON;
`"threads"` may be added.
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
        print(json.dumps(answer(scene, **json.loads(line))), flush=True)


def answer(scene, iterations, seed=1, threads=1):
    """Render, and say how long it took."""
    scene.graph = with_seed(scene.graph, seed)
    wall, cpu = time.perf_counter(), time.process_time()
    result = artist_py.render(scene, iterations=iterations, threads=threads)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    counted = {name: result.statistics[name] for name in ("paths", "rays", "shadow_rays")}
    return {**counted, "cpu_seconds": cpu, "seconds": wall, "mean": result.film.rgb.mean((0, 1)).tolist()}


def with_seed(graph, seed):
    """The graph with another seed."""
    from dataclasses import replace

    return replace(graph, render=replace(graph.render, seed=seed))


if __name__ == "__main__":
    main()
