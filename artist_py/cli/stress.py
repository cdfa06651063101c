"""`artist stress`: extreme scenes with all integrators, and whether each came out right."""

import sys
import time

import click

from artist_py.cli.interrupt import INTERRUPTED
from artist_py.errors import OptionError, OutputError

STYLES = {"ok": "green", "too noisy": "yellow"}  # whatever else is wrong is red
WRONG = 1
FILE_WIDTH = 220  # columns of the table where the output is no terminal


@click.command()
@click.argument("scenes", metavar="[SCENE]...", nargs=-1, type=click.Path())
@click.option("--quick", "extent", flag_value="quick", default=True, help="What takes minutes; the default.")
@click.option(
    "--full", "extent", flag_value="full", help="All cases: also 1e7 triangles, and 1e5 points of light."
)
@click.option(
    "--only",
    multiple=True,
    metavar="NAME",
    help="Only the case NAME, or those with NAME in their names; may be repeated.",
)
@click.option(
    "--integrator", "integrators", multiple=True, metavar="NAME", help="Only this one; may be repeated."
)
@click.option(
    "-o", "--output", type=click.Path(), metavar="FILE.html", help="Write the report as an HTML page."
)
@click.option("--seed", type=click.IntRange(min=0), default=1, help="Another seed is an independent run.")
@click.option("--threads", type=click.IntRange(min=1), default=1, help="Images are small: one is fastest.")
@click.option(
    "--list", "only_list", is_flag=True, help="Print the cases and what they show, and run nothing."
)
def command(scenes, extent, only, integrators, output, seed, threads, only_list):
    """Render extreme scenes, or each SCENE, with all integrators.

    Tiny lamps, huge scales, odd glass, degenerate triangles and the like: each must give the right picture or a
    clear message. Images are compared with closed forms, or with another integrator, by Z-tests: a correct program
    fails a run by chance with probability 0.001. The exit code is 1 if anything is wrong. Ctrl-C ends the run and
    reports what has been rendered.

    A SCENE of your own is rendered in 16 pixels and compared with vcm: what an integrator cannot find in it, and what
    it is too noisy for, is reported as such.
    """
    if output and not output.endswith(".html"):
        raise OptionError(f"--output: {output}: expected a name that ends in .html")
    cases = _chosen(scenes, extent, only)
    _check_integrators(integrators)
    if only_list:
        for case in cases:
            click.echo(f"{case.name}: {case.shows} Expected: {case.expect}.")
        return 0
    return _run(cases, integrators, output, seed, threads)


def _chosen(scenes, extent, only):
    from artist_py.stress.cases import CASES
    from artist_py.stress.own import own_case

    own = [own_case(scene) for scene in scenes]
    if own and not only:
        return own
    chosen = set()
    for name in only:
        # A whole name is itself alone, though it may be part of others.
        found = [case.name for case in CASES if name == case.name] or [
            c.name for c in CASES if name in c.name
        ]
        if not found:
            raise OptionError(f"--only: no case has {name} in its name; --list --full shows all")
        chosen.update(found)
    if only:
        return own + [case for case in CASES if case.name in chosen]
    return [case for case in CASES if case.quick or extent == "full"]


def _check_integrators(integrators):
    from artist_py.stress.case import INTEGRATORS

    for name in integrators:
        if name not in INTEGRATORS:
            raise OptionError(
                f"--integrator: unknown integrator {name}, expected one of {', '.join(INTEGRATORS)}"
            )


def _run(cases, integrators, output, seed, threads):
    from artist_py.stress.matrix import Matrix
    from artist_py.stress.runner import run_cells

    begun = time.monotonic()
    matrix = Matrix(cases, integrators or None)
    code = None
    try:
        for cell in run_cells(cases, seed, threads, integrators or None):
            matrix.add(cell)
            click.echo(f"{cell.case.name}, {cell.integrator}: {_in_words(matrix, cell)}", err=True)
    except KeyboardInterrupt:
        code = INTERRUPTED
    seconds = time.monotonic() - begun
    _print(matrix, seconds)
    if output:
        _write(matrix, seconds, output)
    return code or (0 if matrix.is_ok else WRONG)


def _in_words(matrix, cell):
    verdict = matrix.verdict(cell)
    _, text = matrix.text(cell.case, cell.integrator)
    return text if verdict.is_ok else f"{text}: {verdict.text}"


def _print(matrix, seconds):
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(width=None if sys.stdout.isatty() else FILE_WIDTH, highlight=False)
    table = Table("case", "expected", *matrix.integrators)
    for case in matrix.cases:
        cells = [matrix.text(case, name) for name in matrix.integrators]
        table.add_row(
            Text(case.name), Text(str(case.expect)), *(Text(t, STYLES.get(s, "red")) for s, t in cells)
        )
    console.print(table)
    for case in matrix.cases:
        if not case.integrators:
            click.echo(f"{case.name}: left out: {next(iter(case.left_out.values()))}")
    for case, name, verdict in matrix.faults():
        click.echo(f"{case.name}, {name}: {verdict.status}: {verdict.text}")
    click.echo(f"{matrix.summary} ({seconds:.0f} s)")


def _write(matrix, seconds, output):
    from artist_py.stress.report import page

    try:
        with open(output, "w", encoding="utf-8") as file:
            file.write(page(matrix, seconds))
    except OSError as error:
        raise OutputError(f"{output}: {error.strerror}") from None
