"""`artist warm`: compile kernels before they are needed."""

from pathlib import Path

import click

from artist_py.cli.progress import Budget, make_observer

TYPICAL_SCENE = Path(__file__).with_name("typical.toml")
SIZE = 16  # pixels, to the side
OVERRIDES = (
    ("film.resolution", [SIZE, SIZE]),
    ("film.crop", [0, SIZE, 0, SIZE]),
    ("render.iterations", 1),
)


@click.command()
@click.argument("scenes", metavar="[SCENE]...", nargs=-1, type=click.Path())
def command(scenes):
    """Compile what scenes need.

    Fills the cache that later renders use with what each SCENE needs; without SCENE, for diffuse walls, an area
    light and dispersive glass.
    """
    for scene in scenes or (TYPICAL_SCENE,):
        _warm(scene)


def _warm(scene):
    from artist_py.samplers.render_job import RenderSettings, render
    from artist_py.scene.compile import compile_scene
    from artist_py.scene.reader import read_scene

    budget = Budget(iterations=1, time_seconds=None, error=None)
    observer = make_observer(budget, save=lambda _film: None)
    settings = RenderSettings(
        **budget._asdict(),
        threads=1,
        save_every_seconds=None,
        spectral=False,
        aovs=(),
        max_memory_bytes=None,
    )
    observer.note(f"warming for {scene}")
    try:
        render(compile_scene(read_scene(scene, OVERRIDES)), settings, observer)
    finally:
        observer.close()
