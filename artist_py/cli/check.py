"""`artist check`: whether scenes can be rendered, without rendering them."""

import click

from artist_py.errors import SceneError

BAD_SCENE = 2


@click.command()
@click.argument("scenes", metavar="SCENE...", nargs=-1, required=True, type=click.Path())
def command(scenes):
    """Say what is wrong with scenes.

    Reads each SCENE with its meshes and spectra, and prints all that is wrong with it, and what to be warned of. The
    exit code is 2 if anything is wrong.
    """
    problems = [problem for scene in scenes for problem in _problems(scene)]
    for problem in problems:
        click.echo(str(problem))
    return BAD_SCENE if problems else 0


def _problems(scene):
    from artist_py.scene.compile import validate
    from artist_py.scene.reader import read_scene

    try:
        warnings = validate(read_scene(scene))
    except SceneError as error:
        return error.problems
    for text in warnings:
        click.echo(f"{scene}: warning: {text}")
    click.echo(f"{scene}: ok")
    return ()
