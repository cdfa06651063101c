"""`artist render`: a scene to an image."""

import os
from functools import partial
from pathlib import Path

import click

from artist_py.cli.interrupt import INTERRUPTED, stop_signals
from artist_py.cli.options import AovNames, ByteSize, Duration, Integers, Number, Setting, display_options
from artist_py.cli.outputs import Outputs
from artist_py.cli.progress import Budget, duration_text, make_observer
from artist_py.cli.record import Record, exr_metadata

OVERRIDES = {
    "integrator": "render.integrator",
    "iterations": "render.iterations",
    "time": "render.time",
    "error": "render.error",
    "size": "film.resolution",
    "crop": "film.crop",
    "seed": "render.seed",
    "wavelengths": "render.wavelengths",
    "hero_count": "render.hero_count",
}
LIMITS = ("iterations", "time", "error")

OPTIONS = (
    click.Option(
        ["-o", "--output"],
        multiple=True,
        type=click.Path(),
        metavar="FILE",
        help="Image: .exr (linear, with metadata) or .png (tone-mapped); may be given for each. Statistics go to a "
        ".json beside it. Default: SCENE.exr in the current directory.",
    ),
    click.Option(["--integrator"], metavar="NAME", help="Method, such as pt (path tracing)."),
    click.Option(["--iterations"], type=click.IntRange(min=1), metavar="N", help="Paths per pixel."),
    click.Option(["--time"], type=Duration(), help="Time to render for, such as 30s, 2m or 1h30m."),
    click.Option(
        ["--error"], type=Number(min=0, min_open=True), metavar="X", help="Estimated relMSE at which to stop."
    ),
    click.Option(["--size"], type=Integers("WxH", "x", "640x480"), help="Size of the whole image, pixels."),
    click.Option(
        ["--crop"],
        type=Integers("x0,x1,y0,y1", ",", "100,200,0,50"),
        help="Part of the image: x0 <= x < x1, y0 <= y < y1; pixels from the top left.",
    ),
    click.Option(
        ["--threads"],
        type=click.IntRange(min=1),
        metavar="N",
        help="Threads; the image does not depend on them. Default: all processors.",
    ),
    click.Option(
        ["--seed"], type=click.IntRange(min=0), metavar="N", help="Seed: equal seeds give equal images."
    ),
    click.Option(
        ["--wavelengths"],
        type=click.Choice(["shared", "independent", "rotate"]),
        help="Whether paths share the wavelengths of their iteration, or draw their own (and merge, with rotate).",
    ),
    click.Option(["--hero-count"], type=click.Choice([1, 4, 8]), help="Wavelengths per path."),
    click.Option(["--spectral"], is_flag=True, help="Add spectral channels to the EXR, W m^-2 sr^-1 nm^-1."),
    click.Option(
        ["--aov", "aovs"],
        type=AovNames(),
        multiple=True,
        help="Channels to add to the EXR: any of normal, shading_normal, albedo, depth, position, material, variance.",
    ),
    click.Option(
        ["--techniques"],
        is_flag=True,
        help="Write what each technique brings, with and without its weight, to a directory OUTPUT.techniques: an EXR "
        "per path length, contact sheets, and merging (red) against connection (blue).",
    ),
    click.Option(
        ["--technique-length"],
        type=click.IntRange(min=1),
        metavar="N",
        help="With --techniques: longer paths share an image per kind of technique. Default: 8.",
    ),
    click.Option(
        ["--set", "settings"],
        type=Setting(),
        multiple=True,
        help="Override any key of the scene file, such as render.max_path_length=8.",
    ),
    click.Option(["--save-every"], type=Duration(), help="Write the image so far this often, such as 30s."),
    click.Option(["--max-memory"], type=ByteSize(), help="Memory to stay within, such as 4GiB."),
    click.Option(
        ["--timing-metadata"],
        is_flag=True,
        help="Add renderTimeSeconds to the EXR; equal renders are then no longer equal files.",
    ),
    click.Option(["-q", "--quiet"], is_flag=True, help="Print nothing but warnings and errors."),
)


@click.command(params=[click.Argument(["scene"], type=click.Path()), *OPTIONS])
@display_options
def command(**options):  # click's way to pass options, by the names they have above
    """Render a scene to an image.

    Options override the file. The render ends after --iterations, after --time, or at --error: give one of them. In
    the file, render.time and render.error replace render.iterations.

    The image is written under its final name when the render is done, at --save-every, and on Ctrl-C or SIGTERM.
    """
    outputs = _outputs(options)
    graph = _read(options)
    budget = _budget(graph.render, options)
    return _render(graph, budget, outputs, options)


def _outputs(options):
    from artist_py.film.tonemap import ToneMapping

    paths = options["output"] or [f"{Path(options['scene']).stem}.exr"]
    mapping = ToneMapping(exposure=options["exposure"], bits=options["bits"])
    outputs = Outputs(paths, mapping, options["techniques"])
    if options["technique_length"] and not options["techniques"]:
        raise click.UsageError("--technique-length needs --techniques")
    for name, option in (
        ("aovs", "--aov"),
        ("spectral", "--spectral"),
        ("timing_metadata", "--timing-metadata"),
    ):
        if options[name] and not outputs.has_exr:
            raise click.UsageError(f"{option} needs an --output that ends in .exr")
    outputs.check()
    return outputs


def _read(options):
    from artist_py.scene.reader import read_scene

    given = [f"--{name}" for name in LIMITS if options[name] is not None]
    if len(given) > 1:
        raise click.UsageError(f"{' and '.join(given)} exclude each other: a render ends at one of them")
    overrides = [(key, options[name]) for name, key in OVERRIDES.items() if options[name] is not None]
    return read_scene(options["scene"], [*overrides, *options["settings"]])


def _budget(render, options):
    """What was asked for on the command line, else in the file; there, time or error replace iterations."""
    if any(options[name] is not None for name in LIMITS):
        return Budget(*(options[name] for name in LIMITS))
    has_other = render.time is not None or render.error is not None
    return Budget(None if has_other else render.iterations, render.time, render.error)


def _render(graph, budget, outputs, options):
    from artist_py.film.techniques import LONGEST
    from artist_py.samplers.render_job import RenderSettings, render
    from artist_py.scene.compile import compile_scene

    threads = options["threads"] or _processors()
    settings = RenderSettings(
        **budget._asdict(),
        threads=threads,
        save_every_seconds=options["save_every"],
        spectral=options["spectral"],
        aovs=tuple(dict.fromkeys(name for names in options["aovs"] for name in names)),
        max_memory_bytes=options["max_memory"],
        techniques=options["techniques"],
        technique_length=options["technique_length"] or LONGEST,
        compile_apart=True,
    )
    record = Record(options["scene"], exr_metadata(graph, budget), outputs)
    save = partial(record.write, statistics={}, complete=False)
    observer = make_observer(budget, save, quiet=options["quiet"])
    compiled = compile_scene(graph, threads)
    with stop_signals() as stop:
        try:
            result = render(compiled, settings, observer, stop=stop)
        finally:
            observer.close()
        seconds = float(sum(result.statistics["phase_seconds"].values()))
        if options["timing_metadata"]:
            record.metadata["renderTimeSeconds"] = seconds
        return _finish(result, seconds, record, observer)


def _finish(result, seconds, record, observer):
    film = result.film
    if film.iterations == 0:
        observer.warning("interrupted before the first iteration was done: nothing was written")
        return INTERRUPTED
    record.write(film, result.statistics, complete=not result.interrupted, techniques=result.techniques)
    n_rejected = max(film.rejected_count, len(film.rejected))
    if n_rejected:
        observer.warning(f"{n_rejected} contributions were not finite and were dropped; the .json says where")
    observer.note(f"{film.iterations} iterations in {duration_text(seconds)}; wrote {record.outputs}")
    return INTERRUPTED if result.interrupted else 0


def _processors():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
