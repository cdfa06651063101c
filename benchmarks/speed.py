"""Paths per CPU second, interleaved with Mitsuba 3 on the same scenes: A B C A B C ..., one processor."""

import os
import re
import statistics
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

from .measure import HERE, SCENES, Renderer, artist_renderer, median_and_spread, on_one_processor, save
from .mitsuba_scene import mitsuba_scene

NAMES = ("cornell_box", "glass_sphere")
# Mitsuba's variants, and whether Embree's intersections are watertight ("robust"), as ours always are.
VARIANTS = (("scalar_spectral", False), ("llvm_ad_spectral", False), ("llvm_ad_spectral", True))
OLDEST_LLVM = 17  # Dr.Jit starts with 15, but 15 and 16 abort on f32 minima with AVX-512


def run(options):
    """Measure and save; without Mitsuba only this package."""
    on_one_processor()
    python = options.mitsuba_python or sys.executable
    scenes = {name: measure_scene(name, python, options.repeats, options.iterations) for name in NAMES}
    save("speed", __doc__, iterations=options.iterations, repeats=options.repeats, scenes=scenes)


def measure_scene(name, python, repeats, iterations):
    """Figures of all renderers on one scene."""
    path = SCENES / f"{name}.toml"
    with ExitStack() as stack:
        renderers = {"artist": stack.enter_context(artist_renderer(path))}
        for variant, is_robust in VARIANTS:
            child = mitsuba_renderer(python, variant, path, is_robust)
            if child:
                label = f"mitsuba {variant}{' robust' if is_robust else ''}"
                renderers[label] = stack.enter_context(child)
        answers = interleave(renderers, repeats, iterations)
        versions = {label: renderer.version for label, renderer in renderers.items()}
    return {"renderers": summarise(answers, versions)}


def mitsuba_renderer(python, variant, path, is_robust):
    """A `Renderer` that runs Mitsuba, or `None` where that is not installed."""
    environment = {}
    if variant.startswith("llvm"):
        library = os.environ.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
        if library is None:
            print(f"{variant}: left out, no LLVM library of version {OLDEST_LLVM} or newer was found")
            return None
        environment["DRJIT_LIBLLVM_PATH"] = library
    if subprocess.run([python, "-c", "import mitsuba"], capture_output=True, check=False).returncode:  # noqa: S603
        print(
            f"{variant}: left out, {python} has no mitsuba: install the extra, or name another --mitsuba-python"
        )
        return None
    scene = {**mitsuba_scene(path), "embree_use_robust_intersections": is_robust}
    return Renderer([python, str(HERE / "renderer_mitsuba.py"), variant], scene, environment)


def newest_llvm():
    """Path of the newest LLVM library of the system, or `None`."""
    found = {}
    for path in Path("/usr/lib").glob("*/libLLVM*.so*"):
        if version := re.search(r"libLLVM(?:-|\.so\.)(\d+)", path.name):
            found[int(version[1])] = str(path)
    return found[max(found)] if found and max(found) >= OLDEST_LLVM else None


def interleave(renderers, repeats, iterations):
    """`{renderer: [answers]}`; the first round warms up and is not kept."""
    answers = {label: [] for label in renderers}
    for seed in range(repeats + 1):
        for label, renderer in renderers.items():
            answer = renderer.render(iterations=1 if seed == 0 else iterations, seed=seed)
            if seed:
                answers[label].append(answer)
                rate = answer["paths"] / answer["cpu_seconds"]
                print(f"  {label:32} {rate / 1e3:8.0f} thousand paths per CPU second", flush=True)
    return answers


def summarise(answers, versions):
    """Rates, ratios taken round by round, and mean radiances, which must agree if the work is the same."""
    rates = {
        label: [answer["paths"] / answer["cpu_seconds"] for answer in each] for label, each in answers.items()
    }
    ours = rates["artist"]
    result = {}
    for label, each in answers.items():
        means = [[answer["mean"][channel] for answer in each] for channel in range(3)]
        result[label] = {
            "version": versions[label],
            "paths_per_cpu_second": median_and_spread(rates[label]),
            "artist_over_this": median_and_spread([a / b for a, b in zip(ours, rates[label], strict=True)]),
            "mean_rgb": [statistics.fmean(channel) for channel in means],
            "mean_rgb_standard_error": [standard_error(channel) for channel in means],
            "cpu_seconds_over_wall": sum(a["cpu_seconds"] for a in each) / sum(a["seconds"] for a in each),
        }
    return result


def standard_error(values):
    """Of the mean of independent renders; `None` for a single one."""
    return statistics.stdev(values) / len(values) ** 0.5 if len(values) > 1 else None
