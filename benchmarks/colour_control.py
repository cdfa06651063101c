"""How much of the chance in wavelengths the control of colour takes out of fluorescent scenes, by path tracing.

With it (as ever), and without: images by wavelength do without it. What differs from seed to seed in the mean of an
image is nearly all due to wavelengths, which all its paths share; what does in its pixels is due to paths as well.
"""

import numpy as np

from .fluorescence_cost import SCENES
from .measure import ROOT, on_one_processor, save

SIZE, SEEDS, ITERATIONS = [48, 48], 24, (4, 16, 64)


def run(options):
    """Measure and save."""
    on_one_processor()
    seeds, iterations = (4, ITERATIONS[:1]) if options.quick else (SEEDS, ITERATIONS)
    scenes = {}
    for name in SCENES:
        scenes[name] = figures = measure(name, seeds, iterations)
        print(f"  {name}: {figures}", flush=True)
    save("colour_control", __doc__, size=SIZE, seeds=seeds, iterations=iterations, scenes=scenes)


def measure(name, seeds, iterations):
    """Of images with and without control, relative standard deviations of their means and of their pixels."""
    found = {}
    for label, by_wavelength in (("with", False), ("without", True)):
        images = np.array(
            [snapshot_images(name, 1 + seed, iterations, by_wavelength) for seed in range(seeds)]
        )
        found[label] = {"mean": _spread(images.mean(axis=(2, 3))), "pixel": _spread(images)}
    return found


def snapshot_images(name, seed, iterations, by_wavelength):
    """The image after each number of iterations, (n, h, w, 3)."""
    import artist_py
    from artist_py.samplers.render_job import RenderSettings, Silence, film_of, sampler_for

    overrides = {"render.integrator": "pt", "render.seed": seed, "film.resolution": SIZE}
    compiled = artist_py.load_scene(ROOT / "scenes" / f"{name}.toml", overrides)
    settings = RenderSettings(threads=1, spectral=by_wavelength)
    film, images = film_of(compiled, settings), []
    with sampler_for(compiled, film, settings, Silence()) as sampler:
        sampler.compile_kernels(Silence())
        for iteration in range(max(iterations)):
            sampler.iterate(iteration)
            if film.iterations in iterations:
                images.append(film.sums / film.iterations)
    return np.array(images)


def _spread(values):
    """Root of the variance over seeds (axis 0) over that of the mean square, per number of iterations (axis 1)."""
    axes = tuple(range(1, values.ndim - 1))
    variance = values.var(axis=0, ddof=1).mean(axis=axes)
    return np.sqrt(variance / (values.mean(axis=0) ** 2).mean(axis=axes)).tolist()
