"""Rendering a compiled scene: budget, threads, film, snapshots; the image sampler does the iterations."""

import resource
import time
from dataclasses import dataclass

from ..film.accumulation import Film
from ..film.image import FilmImage
from ..film.techniques import LONGEST, TechniqueImages
from ..integrators.methods import METHODS
from .aovs import render_aovs
from .backwards import BackwardsSampler
from .memory import band_edges, crop_of, light_paths_within, memory_estimate
from .reference import ReferenceSampler
from .stochastic import StochasticSampler
from .techniques import TechniqueRecorder, techniques_of_render

PROGRESS_SECONDS = 0.5
LARGE_PIXELS = 1 << 17  # from here on memory matters more than the second that another process takes to start


@dataclass(frozen=True)
class RenderSettings:
    """When to stop and what to keep; limits that are `None` do not apply, at least one of the first three must."""

    iterations: int | None = None
    time_seconds: float | None = None
    error: float | None = None  # estimated relMSE
    threads: int = 1
    save_every_seconds: float | None = None
    spectral: bool = False
    aovs: tuple = ()
    max_memory_bytes: int | None = None
    techniques: bool = False  # keep an image per technique and path length
    technique_length: int = LONGEST  # longer paths share an image per kind of technique
    compile_apart: bool = False  # large images: compile in another process, whose memory is given back

    @property
    def first_hit_aovs(self):
        """The auxiliary outputs that tell of what paths meet first: all but the variance."""
        return tuple(name for name in self.aovs if name != "variance")


@dataclass(frozen=True)
class RenderResult:
    """The image and how it came about."""

    film: FilmImage
    statistics: dict
    interrupted: bool
    techniques: TechniqueImages | None = None


class Silence:
    """An observer that says nothing."""

    def __getattr__(self, name):
        return lambda *args, **kwargs: None


@dataclass
class _Run:
    """The state of one render."""

    compiled: object
    settings: RenderSettings
    observer: object
    stop: object
    begun: float = 0.0
    last_save: float = 0.0
    last_progress: float = -1.0


def render(compiled, settings, observer=None, stop=None):
    """Render until a limit is reached or `stop` (a threading.Event) is set; returns a `RenderResult`."""
    run = _Run(compiled, settings, observer or Silence(), stop)
    for text in compiled.warnings:
        run.observer.warning(text)
    film = film_of(compiled, settings)
    with sampler_for(compiled, film, settings, run.observer) as sampler:
        sampler.compiles_apart = settings.compile_apart and film.width * film.height >= LARGE_PIXELS
        compile_seconds = sampler.compile_kernels(run.observer)
        run.observer.started(_plan(compiled, settings))
        run.begun = run.last_save = time.monotonic()
        cpu_begun = time.process_time()
        interrupted = _iterate(run, sampler, film)
        seconds = time.monotonic() - run.begun
        cpu = time.process_time() - cpu_begun
        aovs = render_aovs(compiled, sampler, settings, run.observer) if settings.first_hit_aovs else {}
    image = film_image(compiled, settings, film, aovs)
    statistics = _statistics(run, sampler, film, compile_seconds, seconds, cpu)
    techniques = sampler.recorder and sampler.recorder.film.images(film.iterations)
    return RenderResult(image, statistics, interrupted, techniques)


def sampler_for(compiled, film, settings, observer):
    """The image sampler that drives the scene's integrator, within the memory that `settings` allows."""
    recorder = None
    light_paths = light_paths_within(compiled, settings, observer.warning)
    if settings.techniques:
        techniques = techniques_of_render(compiled, settings.technique_length)
        recorder = TechniqueRecorder(techniques, film.height, film.width)
    if compiled.graph.render.integrator == "reference":
        return ReferenceSampler(compiled, film, settings.threads)
    if compiled.graph.render.integrator in METHODS:
        return BackwardsSampler(compiled, film, settings.threads, light_paths, recorder)
    return StochasticSampler(compiled, film, settings.threads, recorder)


def _iterate(run, sampler, film):
    """Add iterations to the film until it is good enough; returns whether it was interrupted."""
    error = None
    while not _is_done(run, film, error):
        if not sampler.iterate(film.iterations, run.stop):
            if film.iterations == 0:
                sampler.add_to_film(0)
                run.observer.warning("interrupted in the first iteration: the tiles not reached are black")
            return True
        if run.stop is not None and run.stop.is_set():
            return True
        error = _report(run, film, error)
    return False


def _is_done(run, film, error):
    settings = run.settings
    if settings.iterations is not None and film.iterations >= settings.iterations:
        return True
    if film.iterations == 0:
        return False
    if settings.time_seconds is not None and time.monotonic() - run.begun >= settings.time_seconds:
        return True
    return settings.error is not None and error is not None and error <= settings.error


def _report(run, film, error):
    """Tell the observer how far it is, now and then; returns the newest error estimate."""
    now = time.monotonic()
    seconds = now - run.begun
    is_due = now - run.last_progress >= PROGRESS_SECONDS
    # Only with as many odd as even iterations, so that looking more often does not stop the render on a lucky value.
    if (is_due or run.settings.error is not None) and film.iterations % 2 == 0:
        error = film.error_estimate()
    if is_due:
        run.last_progress = now
        paths = film.iterations * film.height * film.width
        run.observer.progress(
            film.iterations, run.settings.iterations, seconds, paths, paths / max(seconds, 1e-9), error
        )
    every = run.settings.save_every_seconds
    if every is not None and now - run.last_save >= every:
        run.observer.snapshot(film_image(run.compiled, run.settings, film, {}))
        run.last_save = time.monotonic()
    return error


def film_of(compiled, settings):
    """An empty film with what `settings` asks to keep."""
    x0, x1, y0, y1 = crop_of(compiled.graph)
    bands = len(band_edges(compiled)) - 1 if settings.spectral else 0
    return Film(y1 - y0, x1 - x0, "variance" in settings.aovs, bands)


def _plan(compiled, settings):
    x0, x1, y0, y1 = crop_of(compiled.graph)
    render = compiled.graph.render
    return {
        "integrator": render.integrator,
        "pixels": f"{x1 - x0} x {y1 - y0}",
        "threads": settings.threads,
        "memory": f"{sum(memory_estimate(compiled, settings).values()) / 2**20:.0f} MiB",
    }


def film_image(compiled, settings, film, aovs):
    """The film as the outputs take it."""
    graph = compiled.graph
    edges = band_edges(compiled)
    return FilmImage(
        rgb=film.mean(),
        iterations=film.iterations,
        resolution=tuple(graph.film.resolution),
        crop=crop_of(graph),
        variance=film.variance(),
        spectral=film.spectral(),
        band_centres=0.5 * (edges[1:] + edges[:-1]) if settings.spectral else None,
        aovs=aovs,
        rejected=tuple(film.rejected),
        rejected_count=film.rejected_count,
        world_to_camera=compiled.matrices[0],
        world_to_ndc=compiled.matrices[1],
    )


def _statistics(run, sampler, film, compile_seconds, seconds, cpu):
    rays, shadow_rays = sampler.rays
    paths = film.iterations * film.height * film.width
    return {
        "scene_seconds": run.compiled.seconds,
        "compile_seconds": compile_seconds,
        "cache_hits": sampler.cache_hits,
        "cache_misses": sampler.cache_misses,
        "phase_seconds": sampler.phases,
        **sampler.counts,
        "cpu_seconds": cpu,
        "threads": run.settings.threads,
        "paths": paths,
        "paths_per_second": paths / max(seconds, 1e-9),
        "rays": rays,
        "shadow_rays": shadow_rays,
        "rays_per_second": (rays + shadow_rays) / max(seconds, 1e-9),
        "peak_memory_bytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
        "rejected_contributions": film.rejected_count,
        "error_estimate": film.error_estimate(),
    }
