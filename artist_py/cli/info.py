"""`artist info`: what a scene holds, what it needs, and what is left out."""

import json
import sys

import click

from artist_py.cli.options import Setting


@click.command()
@click.argument("scene", type=click.Path())
@click.option("--set", "settings", type=Setting(), multiple=True, help="Override any key of the scene file.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(scene, settings, as_json):
    """Say what a scene holds and needs.

    Prints what is in SCENE, what that needs and why, what is left out, and the settings that count.
    """
    from artist_py.samplers.memory import memory_estimate
    from artist_py.samplers.render_job import RenderSettings
    from artist_py.scene.compile import compile_scene
    from artist_py.scene.describe import describe
    from artist_py.scene.reader import read_scene

    compiled = compile_scene(read_scene(scene, settings))
    sections = describe(compiled, memory_estimate(compiled, RenderSettings()))
    if as_json:
        click.echo(
            json.dumps({title: dict(rows) for title, rows in sections.items()}, indent=2, ensure_ascii=False)
        )
    elif sys.stdout.isatty():
        _print_tables(sections)
    else:
        _print_lines(sections)


def _print_tables(sections):
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console()
    for title, rows in sections.items():
        table = Table(title=title, title_justify="left", title_style="bold", show_header=False)
        for name, value in rows:
            table.add_row(Text(str(name)), Text(str(value)))
        console.print(table)


def _print_lines(sections):
    for title, rows in sections.items():
        click.echo(f"{title}:")
        for name, value in rows:
            click.echo(f"  {name}: {value}")
