"""`artist compare`: several runs of `artist converge` side by side."""

import click


@click.command()
@click.argument("runs", metavar="RUN.json...", nargs=-1, required=True, type=click.Path())
@click.option("--metric", type=click.Choice(["relmse", "smape"]), default="relmse", help="Which error.")
@click.option("-o", "--output", type=click.Path(), metavar="FILE.csv", help="Write the table as CSV, too.")
def command(runs, metric, output):
    """Put runs of converge side by side.

    Prints the errors of all RUNs, by scene, entry and time, and the last run against the first: the ratio of the errors
    without what the references add, the range that the repeats leave for it, and the ratio of iterations per second.
    Errors below the reference's own have a *.
    """
    from artist_py.cli.tables import print_table
    from artist_py.evidence.joining import join, joined_table, read_runs, warnings

    found, notes = read_runs(runs)
    for text in (*notes, *warnings(found)):
        click.echo(f"warning: {text}", err=True)
    header, lines = joined_table(found, join(found, metric), metric)
    if output:
        _write(output, header, lines)
    print_table(header, lines, left=2)


def _write(path, header, lines):
    import csv

    from artist_py.film.replacing import replacing

    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream).writerows([header, *lines])
