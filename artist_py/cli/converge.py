"""`artist converge`: error against time."""

import os

import click

from artist_py.cli.interrupt import INTERRUPTED, stop_signals
from artist_py.cli.options import Duration, Exposure, Integers, Setting
from artist_py.cli.progress import Budget, LineObserver, Observer, duration_text
from artist_py.errors import OptionError

DEFAULT_TIMES = "1,2,5,10,20,40"
REFERENCE_FACTOR = 10  # times the longest time


class Times(click.ParamType):
    """Times with commas between them, such as 1,2,5 or 30s,2m."""

    name = "times"

    def convert(self, value, param, ctx):
        """Increasing tuple of seconds."""
        if isinstance(value, tuple):
            return value
        return tuple(sorted({Duration().convert(part, param, ctx) for part in value.split(",")}))


class Talk(LineObserver):
    """Prints what happens, and not that each render begins."""

    def started(self, plan):
        """Nothing: the first look at it comes soon."""


OPTIONS = (
    click.Option(
        ["--integrators"],
        default="pt,bpt,vcm",
        metavar="LIST",
        help="What is compared, with commas between: NAME or NAME:KEY=VALUE:KEY=VALUE..., where a KEY without a dot is "
        "one of [render], such as pt:wavelengths=shared:hero_count=8 or vcm:render.merging.alpha=0.9.",
    ),
    click.Option(["--times"], type=Times(), default=DEFAULT_TIMES, help="Seconds at which to measure."),
    click.Option(
        ["--axis"],
        type=click.Choice(["wall", "cpu"]),
        default="wall",
        help="Whose seconds: of the clock on the wall, or of all processors together, for a machine that has other "
        "work. Both are recorded.",
    ),
    click.Option(
        ["--repeat"],
        type=click.IntRange(min=1),
        default=3,
        metavar="N",
        help="Renders of each, with other seeds.",
    ),
    click.Option(
        ["--reference"],
        type=click.Path(),
        metavar="REF.exr",
        help="Image to measure against, from any program.",
    ),
    click.Option(
        ["--make-reference"],
        type=Duration(),
        help=f"Time to spend on a reference, cached one included. Default: {REFERENCE_FACTOR} times the longest time.",
    ),
    click.Option(
        ["--reference-integrator"],
        default="bpt",
        metavar="LIST",
        help="What makes the reference: pt or bpt, which have no bias, or with a comma between them both, which then "
        "must agree. Where light is out of reach of both, vcm, whose bias vanishes.",
    ),
    click.Option(["--fresh"], is_flag=True, help="Make the reference anew, whatever is cached."),
    click.Option(
        ["--set", "settings"],
        type=Setting(),
        multiple=True,
        help="Override any key of the scene file, for all.",
    ),
    click.Option(["--size"], type=Integers("WxH", "x", "640x480"), help="Size of the whole image, pixels."),
    click.Option(
        ["--threads"], type=click.IntRange(min=1), metavar="N", help="Threads. Default: all processors."
    ),
    click.Option(
        ["--exposure"], type=Exposure(), default=0.0, help="Exposure of the page's images, or auto."
    ),
    click.Option(
        ["--ablate"],
        is_flag=True,
        help="Instead, measure what it would cost to have what SCENE does not need: dispersion, a lens, surroundings "
        "that emit, merging. Each is forced in so that the picture stays the same, for the longest of --times, and "
        "compiled from an empty cache. Writes ablation.csv and ablation.json.",
    ),
    click.Option(["--skip-compile-times"], is_flag=True, help="With --ablate: leave out what takes long."),
    click.Option(
        ["-o", "--output"], type=click.Path(), required=True, metavar="OUTDIR", help="Folder of results."
    ),
    click.Option(["-q", "--quiet"], is_flag=True, help="Print nothing but the table, warnings and errors."),
)


@click.command(params=[click.Argument(["scene"], type=click.Path()), *OPTIONS])
def command(**options):  # click's way to pass options, by the names they have above
    """Measure error against time.

    Renders SCENE by each integrator, looks at the image on the way, and compares it with a reference. Measuring takes
    no time of the render. Writes convergence.csv, convergence.json, reference.exr, images/ and, with the extra
    `report`, plot.png, plot.svg and index.html, a page that shows everything.

    References are kept in the cache, by scene, size, path length and wavelengths, with the variance of their own noise.
    Errors that are as small as the reference's own are marked.
    """
    from artist_py.evidence.entries import parse_entries
    from artist_py.evidence.files import prepare_folder

    if options["reference"] and options["make_reference"]:
        raise click.UsageError("--reference and --make-reference exclude each other")
    entries = parse_entries(options["integrators"])
    folder = prepare_folder(options["output"])
    budget = Budget(None, None, None)
    observer = (Observer if options["quiet"] else Talk)(budget, save=lambda _film: None)
    with stop_signals() as stop:
        if options["ablate"]:
            return _ablate(options, entries, folder, observer, stop)
        try:
            run = _run(options, entries, folder, observer, stop)
        except OptionError as error:
            if not stop.is_set():
                raise
            observer.warning(str(error))
            return INTERRUPTED
    _report(folder, run, options, observer)
    return INTERRUPTED if run.is_interrupted else 0


def _run(options, entries, folder, observer, stop):
    from artist_py.evidence.convergence import compile_entries, converge
    from artist_py.evidence.entries import Entry, compile_entry
    from artist_py.evidence.reference import make_reference, read_reference, write_reference

    threads, overrides = _threads(options), _overrides(options)
    compiled = compile_entries(options["scene"], entries, overrides, threads)
    first = compiled[entries[0].label]

    def compile_as(integrator):
        return compile_entry(options["scene"], Entry(integrator, integrator, ()), overrides, threads)

    if options["reference"]:
        reference = read_reference(options["reference"], first)
    else:
        seconds = options["make_reference"] or REFERENCE_FACTOR * max(options["times"])
        names = [name.strip() for name in options["reference_integrator"].split(",")]
        _announce(observer, options, entries, seconds)
        reference = make_reference(
            compile_as,
            names,
            seconds,
            threads=threads,
            is_fresh=options["fresh"],
            observer=observer,
            stop=stop,
        )
        write_reference(
            folder / "reference.exr", reference.rgb, reference.variance, reference.summary(), first
        )
    return converge(
        options["scene"],
        entries,
        reference,
        compiled=compiled,
        marks=options["times"],
        axis=options["axis"],
        repeats=options["repeat"],
        threads=threads,
        observer=observer,
        stop=stop,
    )


def _ablate(options, entries, folder, observer, stop):
    from artist_py.cli.tables import print_table
    from artist_py.evidence.ablation import ablate, ablation_table
    from artist_py.evidence.convergence import about, compile_entries
    from artist_py.evidence.files import write_ablation

    threads, overrides = _threads(options), _overrides(options)
    compiled = compile_entries(options["scene"], entries, overrides, threads)
    costs = ablate(
        options["scene"],
        entries,
        overrides,
        seconds=max(options["times"]),
        threads=threads,
        with_compile_times=not options["skip_compile_times"],
        observer=observer,
        stop=stop,
    )
    if costs:
        write_ablation(folder, options["scene"], about(compiled, threads), costs)
        print_table(*ablation_table(costs), left=2)
    return INTERRUPTED if stop.is_set() else 0


def _threads(options):
    return options["threads"] or len(os.sched_getaffinity(0))


def _overrides(options):
    size = [("film.resolution", options["size"])] if options["size"] else []
    return [*options["settings"], *size]


def _announce(observer, options, entries, seconds):
    renders = len(entries) * options["repeat"] * max(options["times"])
    observer.note(
        f"{duration_text(renders)} of rendering, and up to {duration_text(seconds)} for the reference"
    )


def _report(folder, run, options, observer):
    from artist_py.evidence.files import write_csv, write_images, write_json

    write_csv(folder / "convergence.csv", run)
    write_json(folder / "convergence.json", run)
    write_images(folder, run)
    if not run.rows:
        observer.warning("interrupted before the first look: there is nothing to plot")
        return
    _print_table(run)
    try:
        _draw(folder, run, options, observer)
    except OptionError as error:  # what is measured is safe; a library is absent
        observer.warning(str(error))
    observer.note(f"wrote {folder}")


def _draw(folder, run, options, observer):
    from artist_py.evidence.page import write_page
    from artist_py.evidence.plots import write_plots

    write_plots(folder, run)
    for text in write_page(folder / "index.html", run, options["exposure"]):
        observer.warning(text)


def _print_table(run):
    from artist_py.cli.tables import print_table
    from artist_py.evidence.tables import convergence_table
    from artist_py.evidence.words import band_text, notes

    print_table(*convergence_table(run))
    for note in notes(run):
        click.echo(note)
    click.echo(band_text(run))
