"""The command `artist` with a sampler and a compiler of scenes that do next to nothing.

As a script it runs the command line, for tests that need a process of their own. The image of a fake render is its
iteration count; FAKE_SECONDS is how long an iteration takes, FAKE_ERROR the name of an exception to raise.
"""

import builtins
import os
import sys
import time
import types
from dataclasses import asdict, dataclass

import numpy as np

from artist_py.errors import Problem, SceneError
from artist_py.film.image import FilmImage


@dataclass(frozen=True)
class RenderSettings:
    """As the sampler's."""

    iterations: int | None = None
    time_seconds: float | None = None
    error: float | None = None
    threads: int = 1
    save_every_seconds: float | None = None
    spectral: bool = False
    aovs: tuple = ()
    max_memory_bytes: int | None = None
    techniques: bool = False
    technique_length: int = 8
    compile_apart: bool = False


def compile_scene(graph, threads=None):
    """The graph will do."""
    return types.SimpleNamespace(graph=graph, threads=threads)


def validate(graph):
    """Find fault with scenes of seed 666, as loading a mesh might, and warn of seed 13."""
    if graph.render.seed == 666:
        raise SceneError([Problem("a mesh is missing", "mesh.ply"), Problem("so is another", "other.ply")])
    return ["it will be black"] if graph.render.seed == 13 else []


def describe(compiled, memory):
    """A little about it."""
    width, height = compiled.graph.film.resolution
    return {
        "film": [("resolution", f"{width} x {height}"), ("filter", compiled.graph.film.filter)],
        "memory": memory,
    }


def memory_estimate(_compiled, _settings):
    """A bit."""
    return [("film", "1 MiB")]


def film_of(compiled, settings, iterations):
    """An image of which every value is the number of iterations."""
    film = compiled.graph.film
    x0, x1, y0, y1 = film.crop or (0, film.resolution[0], 0, film.resolution[1])
    shape = (y1 - y0, x1 - x0)
    return FilmImage(
        rgb=np.full((*shape, 3), float(iterations)),
        iterations=iterations,
        resolution=film.resolution,
        crop=film.crop,
        spectral=np.ones((*shape, 1)) if settings.spectral else None,
        band_centres=[550.0] if settings.spectral else None,
        aovs={name: np.ones((*shape, 1), np.float32) for name in settings.aovs},
        rejected=((1, 2, 0),) if compiled.graph.render.seed == 13 else (),
        rejected_count=2000 if compiled.graph.render.seed == 13 else 0,
    )


def render(compiled, settings, observer, stop=None):
    """Count to the number of iterations, or three."""
    if "FAKE_ERROR" in os.environ:
        raise getattr(builtins, os.environ["FAKE_ERROR"])("said so")
    observer.warning("this is a fake")
    observer.compiling("a fake", 3)
    observer.compiled(3.1)
    observer.started({"threads": settings.threads})
    done, n_iterations = 0, settings.iterations or 3
    while done < n_iterations and not (stop and stop.is_set()):
        time.sleep(float(os.environ.get("FAKE_SECONDS", "0")))
        done += 1
        observer.progress(done, settings.iterations, 0.5 * done, 100 * done, 2e6, 0.1 / done)
        if settings.save_every_seconds is not None:
            observer.snapshot(film_of(compiled, settings, done))
    statistics = {
        "phase_seconds": {"first": 3, "second": 1.5},
        "settings": asdict(settings),
        "compile_threads": compiled.threads,
    }
    interrupted = stop is not None and stop.is_set()
    return types.SimpleNamespace(
        film=film_of(compiled, settings, done),
        statistics=statistics,
        interrupted=interrupted,
        techniques=None,
    )


def modules():
    """Modules in place of those that do the work."""
    names = "render_job", "memory", "compile", "describe"
    job, memory, compiler, words = (types.ModuleType(name) for name in names)
    job.RenderSettings, job.render, memory.memory_estimate = RenderSettings, render, memory_estimate
    compiler.compile_scene, compiler.validate = compile_scene, validate
    words.describe = describe
    return {
        "artist_py.samplers.render_job": job,
        "artist_py.samplers.memory": memory,
        "artist_py.scene.compile": compiler,
        "artist_py.scene.describe": words,
    }


if __name__ == "__main__":
    sys.modules.update(modules())
    from artist_py.cli.main import main

    sys.exit(main())
