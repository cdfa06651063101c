"""Error of the random numbers and of the wavelengths: what the defaults are chosen by.

relMSE is against a long render with another seed, averaged over seeds. Times CPU seconds it compares methods at equal
time, as long as the error falls like 1 / n.
"""

import numpy as np

import artist_py
from artist_py.compare.metrics import relmse
from artist_py.samplers import stochastic

from .measure import SCENES, on_one_processor, save

NAMES = ("cornell_box", "glass_sphere")
COUNTS = (16, 64, 256)
STRATIFIED_PAIRS = (0, 3, 6, 9, 12, 24, 48)
WAVELENGTHS = tuple((mode, count) for mode in ("independent", "shared") for count in (1, 4, 8))
SIZE = 128
REFERENCE_ITERATIONS, REFERENCE_SEED = 8192, 4711


def run(options):
    """Measure and save."""
    on_one_processor()
    scenes = {name: measure_scene(SCENES / f"{name}.toml", options) for name in NAMES}
    save("samplers", __doc__, size=SIZE, seeds=options.repeats, iterations=COUNTS, scenes=scenes)


def measure_scene(path, options):
    """Errors of all samplers on one scene."""
    reference_iterations = REFERENCE_ITERATIONS // (16 if options.quick else 1)
    reference, _ = render(path, reference_iterations, REFERENCE_SEED, {})
    result = {"reference_iterations": reference_iterations, "stratified_pairs": {}, "wavelengths": {}}
    for pairs in STRATIFIED_PAIRS:
        figures = errors(path, reference, options, {}, pairs)
        result["stratified_pairs"][str(pairs)] = show(f"{path.stem}, {pairs} stratified pairs", figures)
    for mode, count in WAVELENGTHS:
        overrides = {"render.wavelengths": mode, "render.hero_count": count}
        figures = errors(path, reference, options, overrides)
        result["wavelengths"][f"{mode} {count}"] = show(f"{path.stem}, {count} wavelengths, {mode}", figures)
    return result


def errors(path, reference, options, overrides, pairs=stochastic.STRATIFIED_PAIRS):
    """`{iterations: {"relmse", "cpu_seconds", "relmse_times_cpu_seconds"}}`."""
    result = {}
    for iterations in COUNTS:
        renders = [render(path, iterations, seed, overrides, pairs) for seed in range(1, options.repeats + 1)]
        error = float(np.mean([relmse(image, reference) for image, _ in renders]))
        seconds = float(np.median([seconds for _, seconds in renders]))
        result[str(iterations)] = {
            "relmse": error,
            "cpu_seconds": seconds,
            "relmse_times_cpu_seconds": error * seconds,
        }
    return result


def render(path, iterations, seed, overrides, pairs=stochastic.STRATIFIED_PAIRS):
    """`(image, CPU seconds)`."""
    sizes = {"film.resolution": [SIZE, SIZE], "render.seed": seed}
    scene = artist_py.load_scene(path, {**sizes, **overrides})
    usual, stochastic.STRATIFIED_PAIRS = stochastic.STRATIFIED_PAIRS, pairs
    try:
        result = artist_py.render(scene, iterations=iterations, threads=1)
    finally:
        stochastic.STRATIFIED_PAIRS = usual
    return result.film.rgb, result.statistics["cpu_seconds"]


def show(what, figures):
    """Print a line, and hand the figures on."""
    cells = "  ".join(
        f"{n}: {each['relmse']:.5f} in {each['cpu_seconds']:.2f} s" for n, each in figures.items()
    )
    print(f"  {what:40} {cells}", flush=True)
    return figures
