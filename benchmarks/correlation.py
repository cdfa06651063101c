"""Noise at equal time of vcm with and without weights that know of shared photons (`merging.correlation`), in turns."""

import math
import statistics
import time

import artist_py
from artist_py.film.accumulation import Film
from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for

from .measure import ROOT, on_one_processor, save

SCENES = ("box_spheres", "cone_caustic")
CORRELATIONS = ("none", "vcm+")
RADII = (0.003, 0.01)  # of the scene: the larger, the more photons a merge shares with its neighbours
SIZE, ITERATIONS = 256, 16


def run(options):
    """Measure and save."""
    on_one_processor()
    size = 64 if options.quick else SIZE
    scenes = {}
    for name in SCENES:
        for radius in RADII:
            figures = compare(name, radius, size, options.repeats)
            scenes[f"{name}, radius {radius}"] = figures
            print(f"  {name}, radius {radius}: noise x time {figures['none_over_vcm+']:.3f} times with none")
    save("correlation", __doc__, size=size, iterations=ITERATIONS, repeats=options.repeats, scenes=scenes)


def compare(name, radius, size, repeats):
    """Figures of both kinds of weights on a scene, renders in turns with a seed of their own each."""
    found = {correlation: [] for correlation in CORRELATIONS}
    for repeat in range(repeats):
        for correlation in CORRELATIONS:
            found[correlation].append(measure(name, correlation, radius, size, repeat + 1))
    figures = {
        correlation: {
            "cpu_seconds": statistics.median(seconds for seconds, _ in each),
            "relmse": statistics.mean(error for _, error in each),
            "relmse_spread": statistics.stdev(error for _, error in each),
        }
        for correlation, each in found.items()
    }
    none, plus = ([seconds * error for seconds, error in found[each]] for each in CORRELATIONS)
    figures["none_over_vcm+"] = statistics.mean(none) / statistics.mean(plus)
    figures["standard_error"] = figures["none_over_vcm+"] * math.sqrt(
        sum(statistics.variance(each) / statistics.mean(each) ** 2 / repeats for each in (none, plus))
    )
    return figures


def measure(name, correlation, radius, size, seed):
    """`(CPU seconds, relMSE)` of one render; the error is that of noise, from its odd and even iterations."""
    compiled = artist_py.load_scene(
        ROOT / "scenes" / f"{name}.toml",
        {
            "render.integrator": "vcm",
            "render.seed": seed,
            "render.merging.correlation": correlation,
            "render.merging.radius": radius,
            "film.resolution": [size, size],
        },
    )
    film = Film(size, size)
    with sampler_for(compiled, film, RenderSettings(threads=1), Silence()) as sampler:
        sampler.compile_kernels(Silence())
        begun = time.process_time()
        for iteration in range(ITERATIONS):
            sampler.iterate(iteration)
        seconds = time.process_time() - begun
    return seconds, film.error_estimate()
