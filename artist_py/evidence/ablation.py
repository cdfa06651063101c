"""What a feature costs that a scene does not need: forced in, and measured against the same scene without it.

Each is forced in such that the picture stays the same: code for dispersion without a glass that disperses, a lens of
next to no aperture, surroundings of next to no light; and merging added to the techniques of bidirectional path
tracing. Renders with and without take turns of a fraction of a second, so that what else the machine does meets both.
"""

import dataclasses
import json
import os
import resource
import subprocess
import sys
import tempfile
from typing import NamedTuple

from artist_py.compare.metrics import relmse
from artist_py.errors import OptionError
from artist_py.evidence.entries import Entry
from artist_py.evidence.statistics import median_interval
from artist_py.samplers.render_job import RenderSettings, Silence
from artist_py.samplers.snapshots import snapshots
from artist_py.scene.compile import compile_scene
from artist_py.scene.emitter_types import EnvironmentEmitter
from artist_py.scene.graph import ThinLens
from artist_py.scene.reader import read_scene
from artist_py.scene.spectrum_types import Constant

ROUNDS = 10
APERTURE = 1e-7  # of the distance in focus
RADIANCE = 1e-12
FEATURES = ("dispersion", "lens", "environment", "merging")
COMPILE_SECONDS = 900


class Cost(NamedTuple):
    """A feature forced into a scene that does not need it; times are medians over rounds."""

    entry: str
    feature: str
    cpu_without: float  # CPU seconds per iteration
    cpu_with: float
    ratio: float
    ratio_low: float
    ratio_high: float
    coverage: float  # probability that the true median of the ratio is between these two
    compile_without: float | None  # CPU seconds from an empty cache; None if not measured
    compile_with: float | None
    difference: float  # relMSE between the two images of equally many iterations
    noise: float | None  # relMSE that two independent images would have, by their own estimates


def forced(graph, feature):
    """The graph with a feature that it does not have; None where it needs it anyway, or could not have it."""
    if feature == "lens" and not isinstance(graph.camera, ThinLens):
        return dataclasses.replace(graph, camera=_with_lens(graph.camera))
    if feature == "environment" and not any(isinstance(each, EnvironmentEmitter) for each in graph.emitters):
        surroundings = EnvironmentEmitter(spectrum=Constant(1.0), radiance=RADIANCE)
        return dataclasses.replace(graph, emitters=(*graph.emitters, surroundings))
    if feature == "merging" and graph.render.integrator == "bpt":
        # Methods that merge share their wavelengths; so that this is not what is measured, both do (`base_graph`).
        return _with_render(graph, integrator="vcm")
    return None


def base_graph(graph, feature):
    """What a feature is measured against."""
    return _with_render(graph, wavelengths="shared") if feature == "merging" else graph


def _with_render(graph, **changes):
    return dataclasses.replace(graph, render=dataclasses.replace(graph.render, **changes))


def _with_lens(camera):
    names = [field.name for field in dataclasses.fields(camera)]
    radius = APERTURE * sum(each**2 for each in camera.view()) ** 0.5
    return ThinLens(**{name: getattr(camera, name) for name in names}, aperture_radius=radius)


def compile_pair(scene, entry, overrides, feature, threads=None):
    """`(without, with)` of compiled scenes; None where the scene needs the feature anyway, or cannot have it."""
    settings = [*overrides, ("render.integrator", entry.integrator), *entry.settings]
    graph = base_graph(read_scene(scene, settings), feature)
    without = compile_scene(graph, threads)
    if feature == "dispersion":
        # No material says that it disperses, and so every path keeps its wavelengths; only the code is there.
        if without.scene.needs.dispersion:
            return None
        needs = without.scene.needs._replace(dispersion=True)
        return without, dataclasses.replace(without, scene=without.scene._replace(needs=needs))
    changed = forced(graph, feature)
    return None if changed is None else (without, compile_scene(changed, threads))


def ablate(
    scene, entries, overrides, *, seconds, threads=1, with_compile_times=True, observer=None, stop=None
):
    """`Cost` of each feature that can be forced into each entry, measured for so many seconds each; a list.

    Raises OptionError if there is none. An interrupted run returns what it has.
    """
    observer, costs = observer or Silence(), []
    for entry in entries:
        for feature in FEATURES:
            pair = compile_pair(scene, entry, overrides, feature, threads)
            if pair is None:
                observer.note(
                    f"{entry.label}: nothing to measure of {feature}, which it needs or cannot have"
                )
                continue
            measured = _measure(pair, seconds, threads, observer, stop)
            if measured is None:
                return costs
            compiles = (None, None)
            if with_compile_times:
                compiles = [_compile_seconds(scene, entry, overrides, feature, which) for which in (0, 1)]
            costs.append(_cost(entry.label, feature, measured, compiles))
            observer.note(_line(costs[-1]))
    if not costs:
        raise OptionError("--ablate: the scene needs all that could be forced into it")
    return costs


def _measure(pair, seconds, threads, observer, stop):
    """Per round the CPU seconds per iteration, without and with, and the last snapshots; None if interrupted."""
    settings = RenderSettings(threads=threads)
    [first] = list(snapshots(pair[0], settings, [seconds / ROUNDS / 2], "wall", observer, stop)) or [None]
    if first is None:
        return None
    step = first.iterations + first.iterations % 2
    marks = [step * (i + 1) for i in range(ROUNDS)]
    # Their first iterations load what the processor has not seen yet: that round does not count.
    renders = [
        snapshots(each, settings, [step, *(m + step for m in marks)], "iterations", observer, stop)
        for each in pair
    ]
    rounds, before = [], None
    for looks in zip(*renders, strict=False):
        spent = [look.cpu_seconds for look in looks]
        if before is not None:
            rounds.append([(now - then) / step for now, then in zip(spent, before, strict=True)])
        before, last = spent, looks
    return (rounds, last) if len(rounds) == ROUNDS else None


def _cost(label, feature, measured, compiles):
    rounds, (without, with_) = measured
    ratio = median_interval([b / a for a, b in rounds])
    noise = [look.noise for look in (without, with_)]
    return Cost(
        label,
        feature,
        median_interval([a for a, _ in rounds]).median,
        median_interval([b for _, b in rounds]).median,
        *ratio,
        *compiles,
        relmse(with_.film.rgb, without.film.rgb),
        None if None in noise else sum(noise),
    )


def _line(cost):
    return f"{cost.entry}, {cost.feature} forced in: {cost.ratio:.3f} times the CPU time per iteration"


# --- compile times


CHILD = "import sys; from artist_py.evidence.ablation import print_compile_seconds as run; run(sys.argv[1])"


def _compile_seconds(scene, entry, overrides, feature, which):
    """CPU seconds to compile all kernels with an empty cache, in a process of its own."""
    task = json.dumps([str(scene), list(entry), [list(each) for each in overrides], feature, which])
    with tempfile.TemporaryDirectory(prefix="artist-compile-") as cache:
        environment = {**os.environ, "ARTIST_CACHE_DIR": cache}
        done = subprocess.run(  # noqa: S603 - our own script
            [sys.executable, "-c", CHILD, task],
            capture_output=True, text=True, env=environment, timeout=COMPILE_SECONDS, check=False,
        )  # fmt: skip
    if done.returncode != 0:
        raise OptionError(f"--ablate: compiling ended with {done.returncode}: {done.stderr.strip()[-500:]}")
    return float(done.stdout.split()[-1])


def print_compile_seconds(task):
    """Compile what `task` says, and print the CPU seconds that took; the cache is that of the environment."""
    scene, (label, integrator, settings), overrides, feature, which = json.loads(task)
    entry = Entry(label, integrator, tuple(tuple(each) for each in settings))
    compiled = compile_pair(scene, entry, [tuple(each) for each in overrides], feature, 1)[which]
    before = _cpu_seconds()
    [look] = snapshots(compiled, RenderSettings(threads=1), [1], "iterations")
    print(_cpu_seconds() - before - look.cpu_seconds)  # noqa: T201 - for the parent


def _cpu_seconds():
    """Of this process and of its children, in which kernels of large renders are compiled."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


# --- words


def ablation_table(costs):
    """`(header, lines)` of texts."""
    header = ["", "forced in", "ms CPU/iteration without", "with", "ratio", "compile CPU s without", "with",
              "images differ by relMSE"]  # fmt: skip
    lines = [
        [
            cost.entry,
            cost.feature,
            f"{1e3 * cost.cpu_without:.1f}",
            f"{1e3 * cost.cpu_with:.1f}",
            f"{cost.ratio:.3f} ({cost.ratio_low:.3f} to {cost.ratio_high:.3f})",
            "" if cost.compile_without is None else f"{cost.compile_without:.1f}",
            "" if cost.compile_with is None else f"{cost.compile_with:.1f}",
            f"{cost.difference:.2g}" + ("" if cost.noise is None else f" (noise {cost.noise:.2g})"),
        ]
        for cost in costs
    ]
    return header, lines
