"""Renders a benchmark scene with Mitsuba 3, in a process of its own: `python renderer_mitsuba.py VARIANT`.

The first line of standard input is the scene (see mitsuba_scene.py); every further line asks for a render,
`{"iterations": n, "seed": s}`, and is answered by a line of JSON. Uses Mitsuba and NumPy only.
"""

import json
import sys
import time

import mitsuba as mi


def main():
    """Answer requests until standard input ends."""
    mi.set_variant(sys.argv[1])
    import drjit as dr
    import numpy as np

    dr.set_thread_count(0 if sys.argv[1].startswith("llvm") else 1)  # only Dr.Jit can do with its main thread
    scene = mi.load_dict(with_transforms(json.loads(sys.stdin.readline())))
    print(json.dumps({"version": mi.__version__}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        wall, cpu = time.perf_counter(), time.process_time()
        image = np.array(mi.render(scene, spp=request["iterations"], seed=request["seed"]))
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        paths = image.shape[0] * image.shape[1] * request["iterations"]
        answer = {"paths": paths, "cpu_seconds": cpu, "seconds": wall, "mean": image.mean((0, 1)).tolist()}
        print(json.dumps(answer), flush=True)


def with_transforms(value):
    """The dictionary with its 4x4 matrices as Mitsuba's transforms."""
    if not isinstance(value, dict):
        return value
    if "matrix" in value:
        return mi.ScalarTransform4f(value["matrix"])
    return {key: with_transforms(each) for key, each in value.items()}


if __name__ == "__main__":
    main()
