"""Renders a benchmark scene with LuxCore, in a process of its own: `python renderer_luxcore.py ENGINE`.

The first line of standard input is the scene (see luxcore_scene.py); every further line asks for a render,
`{"cpu_seconds": t, "seed": s, "image": path}`, and is answered by a line of JSON; the image, radiance of the green
channel, goes to an .npy file. Uses LuxCore and NumPy only.
"""

import json
import os
import sys
import time

import numpy as np

# LuxCore prints to the standard output, from its import on; the answers go where that was.
ANSWERS = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

import pyluxcore  # noqa: E402

POLL = 0.02  # seconds


def main():
    """Answer requests until standard input ends."""
    pyluxcore.Init(lambda _message: None)
    description = json.loads(sys.stdin.readline())
    scene = scene_of(description)
    print(json.dumps({"version": pyluxcore.Version()}), file=ANSWERS, flush=True)
    for line in sys.stdin:
        answer = render(scene, description, sys.argv[1], **json.loads(line))
        print(json.dumps(answer), file=ANSWERS, flush=True)


def scene_of(description):
    """LuxCore's scene."""
    scene = pyluxcore.Scene()
    for name, mesh in description["meshes"].items():
        normals = [tuple(n) for n in mesh["normals"]] if mesh["normals"] else None
        points, triangles = ([tuple(row) for row in mesh[key]] for key in ("points", "triangles"))
        scene.DefineMesh(name, points, triangles, normals, None, None, None)
    scene.Parse(properties(description["scene"]))
    return scene


def properties(values):
    """LuxCore's properties."""
    result = pyluxcore.Properties()
    for key, value in values.items():
        result.Set(pyluxcore.Property(key, value))
    return result


def render(scene, description, engine, cpu_seconds, seed, image):
    """Render until so many CPU seconds of this process are spent."""
    settings = {**description["config"], "renderengine.type": engine, "renderengine.seed": seed}
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings), scene))
    wall, cpu = time.perf_counter(), time.process_time()
    session.Start()
    while time.process_time() - cpu < cpu_seconds:
        time.sleep(POLL)
        session.UpdateStats()
    session.Stop()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    width, height = settings["film.width"], settings["film.height"]
    pixels = np.zeros((height, width, 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels)
    np.save(image, pixels[::-1, :, 1])
    samples = session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat()
    return {"paths": samples, "cpu_seconds": cpu, "seconds": wall, "mean": float(pixels[..., 1].mean())}


if __name__ == "__main__":
    main()
