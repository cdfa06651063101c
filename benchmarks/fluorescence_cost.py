"""What fluorescence costs: time per iteration and peak memory, over the same scenes with white paint for every dye."""

import json
import statistics
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from artist_py.film.accumulation import Film
from artist_py.samplers.memory import memory_estimate
from artist_py.samplers.render_job import RenderSettings, Silence, render, sampler_for
from artist_py.scene.compile import compile_scene
from artist_py.scene.graph import Diffuse, Fluorescent
from artist_py.scene.reader import read_scene
from artist_py.scene.spectrum_types import Constant

from .measure import ROOT, median_and_spread, on_one_processor, save

SCENES = ("fluorescent_spheres", "fluorescent_room", "black_light", "cascade", "highlighters")
INTEGRATORS = ("pt", "bpt", "vcm")
WHITE = 0.76
SIZE, ITERATIONS = [128, 128], 4  # where time is measured
MEMORY_SIZE, MEMORY_ITERATIONS = [512, 512], 2
TARGETS = {"time": 1.6, "memory": 1.7}


def run(options):
    """Measure and save."""
    on_one_processor()
    scenes = {}
    for name in SCENES:
        for integrator in INTEGRATORS:
            figures = {
                "time": time_ratio(name, integrator, options.repeats),
                "memory": memory_ratio(name, integrator),
            }
            scenes[f"{name}, {integrator}"] = figures
            print(
                f"  {name}, {integrator}: {figures['time']['median']:.2f} times the time, "
                f"{figures['memory']['ratio']:.2f} times the memory, "
                f"{figures['memory']['stored_ratio']:.2f} times of what is stored",
                flush=True,
            )
    save("fluorescence_cost", __doc__, targets=TARGETS, size=SIZE, memory_size=MEMORY_SIZE, scenes=scenes)


def time_ratio(name, integrator, repeats):
    """CPU time of an iteration over that with white paint, rendered in turns."""
    ratios, seconds = [], {True: [], False: []}
    with ExitStack() as stack:
        samplers = {
            painted: _sampler(stack, scene(name, integrator, painted, SIZE)) for painted in (False, True)
        }
        for repeat in range(repeats):
            for painted, sampler in samplers.items():
                seconds[painted].append(_seconds(sampler, repeat * ITERATIONS))
            ratios.append(seconds[False][-1] / seconds[True][-1])
    per_iteration = {what: statistics.median(each) / ITERATIONS for what, each in seconds.items()}
    return {
        **median_and_spread(ratios),
        "seconds": per_iteration[False],
        "seconds_white": per_iteration[True],
    }


def _seconds(sampler, first):
    begun = time.process_time()
    for iteration in range(first, first + ITERATIONS):
        sampler.iterate(iteration)
    return time.process_time() - begun


def _sampler(stack, compiled):
    """A sampler that has its kernels and has grown its pools."""
    film = Film(*SIZE)
    sampler = stack.enter_context(sampler_for(compiled, film, RenderSettings(threads=1), Silence()))
    sampler.compile_kernels(Silence())
    sampler.iterate(0)
    return sampler


def scene(name, integrator, painted, size):
    """A scene, compiled; `painted`: white paint for every material that fluoresces, all else the same."""
    path = ROOT / "scenes" / f"{name}.toml"
    overrides = {"render.integrator": integrator, "film.resolution": size}
    graph = read_scene(path, overrides)
    if not painted:
        return compile_scene(graph)
    materials = {
        key: Diffuse(reflectance=Constant(WHITE)) if isinstance(material, Fluorescent) else material
        for key, material in graph.materials.items()
    }
    return compile_scene(replace(graph, materials=materials))


def memory_ratio(name, integrator):
    """Peak memory of a process that renders the scene over that of one with white paint; and so of what is stored."""
    peaks, stored = {}, {}
    for painted in (False, True):
        request = json.dumps([name, integrator, painted])
        command = [sys.executable, "-m", "benchmarks.fluorescence_cost", request]
        for _ in range(2):  # the first fills the cache of kernels
            done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)  # noqa: S603
        peaks[painted] = int(done.stdout)
        compiled = scene(name, integrator, painted, MEMORY_SIZE)
        stored[painted] = sum(memory_estimate(compiled, RenderSettings(threads=1)).values())
    return {
        "ratio": peaks[False] / peaks[True],
        "bytes": peaks[False],
        "bytes_white": peaks[True],
        "stored_ratio": stored[False] / stored[True],
    }


def render_once(name, integrator, painted):
    """Render in this process, and print its peak memory in bytes.

    As Linux counts it: what the system reports of a child's may be the parent's, from before the child was itself.
    """
    settings = RenderSettings(iterations=MEMORY_ITERATIONS, threads=2, compile_apart=True)
    render(scene(name, integrator, painted, MEMORY_SIZE), settings)
    status = Path("/proc/self/status").read_text(encoding="ascii")
    print(int(status.split("VmHWM:")[1].split()[0]) * 1024)


if __name__ == "__main__":
    render_once(*json.loads(sys.argv[1]))
