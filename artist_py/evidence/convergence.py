"""Error against time: every entry rendered a few times, with other seeds, and looked at on the way."""

import os
import platform
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from artist_py.compare.metrics import relmse, smape
from artist_py.errors import OptionError
from artist_py.evidence.entries import compile_entry, picture_of, with_seed
from artist_py.evidence.reference import is_below, own_error
from artist_py.samplers.render_job import RenderSettings, Silence
from artist_py.samplers.snapshots import snapshots
from artist_py.version import __version__

VERSION = 1  # of the JSON file's layout


class Row(NamedTuple):
    """One look at one render."""

    entry: str
    repeat: int
    seed: int
    mark: float  # what `axis` was to reach
    wall_seconds: float
    cpu_seconds: float
    iterations: int
    paths: int
    rays: int
    shadow_rays: int
    peak_memory_bytes: int  # of the process
    render_memory_bytes: int  # of that, what the render took
    relmse: float
    own_relmse: float | None  # without what the reference adds; None where nothing is left
    smape: float
    noise: float | None  # relMSE by the film's own estimate, without reference
    is_below_reference: bool
    rejected: int
    mean_ratio: float | None = (
        None  # mean of the image over that of the reference: less than 1 where light is missed
    )

    def along(self, axis):
        """Its place on the axis of the plots."""
        return {"wall": self.wall_seconds, "cpu": self.cpu_seconds, "iterations": self.iterations}[axis]


@dataclass
class Convergence:
    """All that was measured of a scene."""

    scene: str
    entries: list  # of `Entry`
    axis: str
    marks: list
    reference: Any  # `Reference`
    about: dict  # of scene and machine, for JSON
    rows: list = field(default_factory=list)
    compile_seconds: dict = field(default_factory=dict)  # entry -> seconds to have its kernels
    images: dict = field(default_factory=dict)  # (entry, mark) -> rgb of the first repeat, float32
    is_interrupted: bool = False

    def rows_of(self, label):
        """Rows of an entry."""
        return [row for row in self.rows if row.entry == label]


def compile_entries(scene, entries, overrides, threads):
    """`{label: CompiledScene}`; OptionError unless all show the same picture, which one reference then serves."""
    compiled = {entry.label: compile_entry(scene, entry, overrides, threads) for entry in entries}
    first, *others = compiled.items()
    expected = picture_of(first[1])
    for label, each in others:
        found = picture_of(each)
        different = [key for key in expected if found[key] != expected[key]]
        if different:
            raise OptionError(
                f"--integrators: {label!r} and {first[0]!r} render other pictures ({', '.join(different)} differs), "
                "which one reference cannot judge"
            )
    return compiled


def converge(
    scene,
    entries,
    reference,
    *,
    compiled,
    marks,
    axis="wall",
    repeats=3,
    threads=1,
    observer=None,
    stop=None,
):
    """Render every entry `repeats` times to the last mark and measure at each; a `Convergence`.

    `compiled` maps labels to compiled scenes (`compile_entries`). Entries take turns, so that what else the machine
    does meets all of them; the seed of repeat i is `render.seed` + i.
    """
    observer = observer or Silence()
    run = Convergence(str(scene), list(entries), axis, sorted(marks), reference, about(compiled, threads))
    for entry in entries:
        for text in compiled[entry.label].warnings:
            observer.warning(f"{entry.label}: {text}")
    for repeat in range(repeats):
        for entry in entries:
            for row in _rows(run, compiled[entry.label], entry, repeat, threads, observer, stop):
                observer.note(_line(row, repeats, axis))
            if stop is not None and stop.is_set():
                run.is_interrupted = True
                return run
    return run


def _rows(run, compiled, entry, repeat, threads, observer, stop):
    """Render an entry once; yields what it adds to `run`."""
    seed = compiled.graph.render.seed + repeat
    settings = RenderSettings(threads=threads)
    for snapshot in snapshots(with_seed(compiled, seed), settings, run.marks, run.axis, observer, stop):
        run.compile_seconds.setdefault(entry.label, snapshot.compile_seconds)
        row = _row(snapshot, entry.label, repeat, seed, run.reference)
        run.rows.append(row)
        if repeat == 0:
            run.images[entry.label, snapshot.mark] = snapshot.film.rgb.astype(np.float32)
        yield row


def _row(snapshot, label, repeat, seed, reference):
    rgb = snapshot.film.rgb
    error = relmse(rgb, reference.rgb)
    own = own_error(error, reference)
    return Row(
        entry=label,
        repeat=repeat,
        seed=seed,
        mark=snapshot.mark,
        wall_seconds=snapshot.wall_seconds,
        cpu_seconds=snapshot.cpu_seconds,
        iterations=snapshot.iterations,
        paths=snapshot.iterations * rgb.shape[0] * rgb.shape[1],
        rays=snapshot.rays,
        shadow_rays=snapshot.shadow_rays,
        peak_memory_bytes=snapshot.peak_memory_bytes,
        render_memory_bytes=snapshot.render_memory_bytes,
        relmse=error,
        own_relmse=own if own == own else None,  # noqa: PLR0124 - NaN
        smape=smape(rgb, reference.rgb),
        noise=snapshot.noise,
        is_below_reference=is_below(error, reference),
        rejected=snapshot.film.rejected_count,
        mean_ratio=float(np.mean(rgb)) / mean if (mean := float(np.mean(reference.rgb))) > 0 else None,
    )


def _line(row, repeats, axis):
    below = ", below what the reference can tell" if row.is_below_reference else ""
    seconds = f"{row.cpu_seconds:.3g} CPU s" if axis == "cpu" else f"{row.wall_seconds:.3g} s"
    return (
        f"{row.entry}, repeat {row.repeat + 1} of {repeats}: {seconds}, {row.iterations} iterations, "
        f"relMSE {row.relmse:.3g}, sMAPE {row.smape:.3g}{below}"
    )


def about(compiled, threads):
    """Scene and machine, for JSON."""
    first = next(iter(compiled.values()))
    film = first.graph.film
    x0, x1, y0, y1 = film.crop or (0, film.resolution[0], 0, film.resolution[1])
    return {
        "picture": picture_of(first),
        "width": x1 - x0,
        "height": y1 - y0,
        "threads": threads,
        "software": f"artist {__version__}",
        "processor": _processor(),
        "processors": os.cpu_count(),
        "python": platform.python_version(),
    }


def _processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as stream:
            return next(line.partition(":")[2].strip() for line in stream if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()
