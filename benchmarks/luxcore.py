"""Bidirectional methods beside LuxCore's: samples per CPU second, and relMSE after equal CPU time, in turns.

Both render the glass sphere in the Cornell box in grey, at one wavelength. The error needs no reference: it is the
variance over independent renders of a pixel, relative to their mean as in relMSE; bias is not in it. The means tell
whether the same is computed. LuxCore has no spheres and gets 20480 triangles.
"""

import statistics
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from artist_py.compare.metrics import relmse_of_variance

from .luxcore_scene import luxcore_scene
from .measure import HERE, SCENES, Renderer, artist_renderer, median_and_spread, on_one_processor, save

SCENE = SCENES / "glass_sphere.toml"
WAVELENGTH, SIZE, MAX_PATH_LENGTH = 550, 128, 10
CPU_SECONDS, QUICK_CPU_SECONDS = 20, 2
# Ours, and LuxCore's engine that does the same.
PAIRS = {"vcm": "BIDIRVMCPU", "bpt": "BIDIRCPU", "pt": "PATHCPU"}


def run(options):
    """Measure and save; nothing where there is no LuxCore."""
    if subprocess.run(
        [sys.executable, "-c", "import pyluxcore"], capture_output=True, check=False
    ).returncode:
        print("left out, pyluxcore is missing: install the extra `bench`")
        return
    on_one_processor()
    seconds = QUICK_CPU_SECONDS if options.quick else CPU_SECONDS
    pairs = {name: compare(name, engine, options.repeats, seconds) for name, engine in PAIRS.items()}
    save("luxcore", __doc__, cpu_seconds=seconds, repeats=options.repeats, size=SIZE, pairs=pairs)


def compare(integrator, engine, repeats, seconds):
    """Figures of one of our integrators and one of LuxCore's engines, rendering in turns."""
    answers = {integrator: [], engine: []}
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        renderers = {integrator: _artist(integrator), engine: _luxcore(engine)}
        for each in renderers.values():
            stack.enter_context(each)
        for seed in range(1, repeats + 1):
            for name, renderer in renderers.items():
                image = str(folder / f"{name}_{seed}.npy")
                answer = renderer.render(cpu_seconds=seconds, seed=seed, image=image)
                answers[name].append({**answer, "image": np.load(image)})
                rate = answer["paths"] / answer["cpu_seconds"]
                print(f"  {name:12} {rate / 1e3:8.1f} thousand samples per CPU second", flush=True)
        versions = {name: renderer.version for name, renderer in renderers.items()}
    figures = {name: {"version": versions[name], **summarise(each)} for name, each in answers.items()}
    rates = [[each["paths"] / each["cpu_seconds"] for each in answers[name]] for name in (integrator, engine)]
    return {
        "renderers": figures,
        "rate_ratio": median_and_spread([ours / theirs for ours, theirs in zip(*rates, strict=True)]),
        "error_ratio": figures[engine]["relmse"] / figures[integrator]["relmse"],
    }


def _artist(integrator):
    overrides = {
        "film.resolution": [SIZE, SIZE],
        "render.integrator": integrator,
        "render.max_path_length": MAX_PATH_LENGTH,
        "render.wavelength_range": [WAVELENGTH, WAVELENGTH + 1],
    }
    return artist_renderer(SCENE, overrides)


def _luxcore(engine):
    scene = luxcore_scene(SCENE, WAVELENGTH, SIZE, MAX_PATH_LENGTH)
    return Renderer([sys.executable, str(HERE / "renderer_luxcore.py"), engine], scene)


def summarise(answers):
    """Rate, relMSE and mean radiance of the renders of one renderer."""
    images = np.array([each["image"] for each in answers], float)
    variance, mean = images.var(axis=0, ddof=1), images.mean(axis=0)
    return {
        "samples_per_cpu_second": median_and_spread([a["paths"] / a["cpu_seconds"] for a in answers]),
        "cpu_seconds": statistics.fmean(each["cpu_seconds"] for each in answers),
        "relmse": relmse_of_variance(variance, mean),
        "mean_radiance": float(mean.mean()),
    }
