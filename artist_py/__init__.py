"""`artist`: a spectral batch renderer in Python.

The public API, for notebooks and scripts; the command line is a thin layer over it::

    import artist_py

    scene = artist_py.load_scene("scenes/cornell_box.toml", {"render.iterations": 16})
    film = artist_py.render(scene).film
    film.rgb  # (height, width, 3) float64, linear sRGB

Nothing heavy is imported before it is needed.
"""

from artist_py.version import __version__

__all__ = ["__version__", "load_scene", "render"]


def load_scene(path, overrides=()):
    """The compiled scene of a file; `overrides` maps dotted keys to values, as `--set` does. Raises `SceneError`."""
    from artist_py.scene.compile import compile_scene
    from artist_py.scene.reader import read_scene

    return compile_scene(read_scene(path, overrides))


def render(scene, *, observer=None, stop=None, **settings):
    """Render a scene from `load_scene`; a `RenderResult` with `film`, `statistics` and `interrupted`.

    `settings` are the fields of `RenderSettings`: iterations, time_seconds, error (estimated relMSE), threads,
    spectral, aovs, ...; without a limit those of the scene file hold. `stop` is a threading.Event that ends the
    render early.
    """
    import os

    from artist_py.samplers.render_job import RenderSettings
    from artist_py.samplers.render_job import render as run

    if not any(settings.get(name) for name in ("iterations", "time_seconds", "error")):
        settings["iterations"] = scene.graph.render.iterations
    settings.setdefault("threads", len(os.sched_getaffinity(0)))
    return run(scene, RenderSettings(**settings), observer, stop)
