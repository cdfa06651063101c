"""Renders one cell of the matrix in batches of independent iterations; runs in the child process."""

import math
import subprocess
import sys
import time
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from artist_py.film.accumulation import Film
from artist_py.samplers.memory import carries_colour
from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for
from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.stress.case import MERGES, Refusal
from artist_py.stress.own import small_scene
from artist_py.stress.toml import to_toml

BATCHES = 32
PILOT = 16  # iterations that say how many are needed
SAFETY = 4.0  # times as many as the pilot says, whose 16 values may be a quarter of the variance by chance
TIME_SHARE = 0.5  # of the seconds after which a cell counts as hung, to be spent at most
REGIONS = 2  # along each side of the image
NEGATIVE = 1e-5  # of the pixel's largest channel: rounding, not light
# From linear sRGB to XYZ: where a radiance is not negative neither is any of these, whatever RGB says.
TO_XYZ = np.array(
    [
        [0.4123908, 0.3575843, 0.1804808],
        [0.2126390, 0.7151687, 0.0721923],
        [0.0193308, 0.1191948, 0.9505322],
    ]
)


@dataclass
class Measurement:
    """What a cell gave; `means` (batches, regions) are radiances, the last region being the whole image."""

    means: np.ndarray = None
    picture: np.ndarray = None  # (h, w) mean radiance
    iterations: int = 0
    non_finite: int = 0
    negative: int = 0
    seconds: float = 0.0
    render_seconds: float = 0.0
    compile_seconds: float = 0.0
    warnings: tuple = ()
    message: str = ""  # what the renderer said instead of rendering
    code: int = 0


def measure(case, integrator, seed, folder, threads, started=lambda: None):
    """The `Measurement` of a cell; `started()` is called when its kernels are there."""
    begun = time.monotonic()
    for name, write, arguments in case.files:
        if not (folder / name).exists():
            write(folder / name, *arguments)
    if isinstance(case.expect, Refusal):
        return refused(scene_text(case, integrator, seed), folder, begun, case.seconds)
    compiled = compile_scene(graph_of(case, integrator, seed, folder), threads)
    result = Measurement(warnings=tuple(compiled.warnings))
    pilot = _run(compiled, PILOT, PILOT, threads, result, started, stream=1)
    started()
    affordable = PILOT * TIME_SHARE * case.seconds / max(result.render_seconds, 1e-9)
    wanted = _iterations(pilot[:, -1], case, case.precision_of(integrator), affordable)
    result.means = _run(compiled, wanted, BATCHES, threads, result, started)
    result.iterations, result.seconds = wanted, time.monotonic() - begun
    return result


def graph_of(case, integrator, seed, folder):
    """The scene of a cell, its tables or its file."""
    if isinstance(case.scene, Path):
        return small_scene(case.scene, integrator, seed_of(case, integrator, seed))
    return read_scene_text(scene_text(case, integrator, seed), str(folder / "scene.toml"))


def seed_of(case, integrator, seed):
    """The seed of a cell: that of the run, and its own."""
    return (zlib.crc32(f"{case.name}/{integrator}".encode()) + seed) % 2**31


def scene_text(case, integrator, seed):
    """The scene file of a cell."""
    render = {
        "wavelengths": "shared" if integrator in {*MERGES, "reference"} else "independent",
        **case.scene["render"],
        "integrator": integrator,
        "seed": seed_of(case, integrator, seed),
    }
    return to_toml({**case.scene, "render": render})


def refused(text, folder, begun, limit):
    """What `artist render` says about a scene, and its exit code."""
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    command = [
        sys.executable,
        "-m",
        "artist_py",
        "render",
        "scene.toml",
        "-q",
        "--iterations",
        "1",
        "-o",
        "x.exr",
    ]
    done = subprocess.run(  # noqa: S603 - our own command
        command, cwd=folder, capture_output=True, text=True, timeout=limit, check=False
    )
    seconds = time.monotonic() - begun
    return Measurement(message=(done.stdout + done.stderr).strip(), code=done.returncode, seconds=seconds)


def _iterations(means, case, precision, affordable):
    """How many iterations reach the precision, from means of single ones; a multiple of `BATCHES`.

    They may be fewer where time is short; then the verdict will be that the cell is too noisy.
    """
    mean, spread = abs(means.mean()), means.std(ddof=1)
    needed = SAFETY * (spread / (precision * mean)) ** 2 if mean > 0.0 else 0.0
    if not math.isfinite(needed):
        return BATCHES
    most = min(max(case.most, BATCHES), affordable)
    needed = min(max(needed, case.least, BATCHES), most)
    return BATCHES * math.ceil(needed / BATCHES)


def _run(compiled, iterations, batches, threads, result, started, stream=0):
    """Render; means of batches and regions. Faults are added to `result`."""
    x0, x1, y0, y1 = compiled.graph.film.crop or (
        0,
        compiled.graph.film.resolution[0],
        0,
        compiled.graph.film.resolution[1],
    )
    film = Film(y1 - y0, x1 - x0)
    white = float(TO_XYZ[1] @ compiled.spectra[:3].sum(axis=1, dtype=float))
    means, before = [], np.zeros(film.sums.shape)
    # A control variate may take more from single iterations than there is.
    is_light = not carries_colour(compiled, by_wavelength=False)
    with sampler_for(
        compiled, film, RenderSettings(iterations=iterations, threads=threads), Silence()
    ) as sampler:
        sampler.seed += stream
        result.compile_seconds += sampler.compile_kernels(Silence())
        started()
        begun = time.monotonic()
        for i in range(iterations):
            sampler.iterate(i)
            result.negative += count_negative(sampler.image) if is_light else 0
            if (i + 1) % (iterations // batches) == 0:
                luminance = (film.sums - before) @ TO_XYZ[1] / (white * (iterations // batches))
                means.append(region_means(luminance))
                before = film.sums.copy()
        result.render_seconds += time.monotonic() - begun
    result.non_finite += film.rejected_count
    result.picture = film.mean() @ TO_XYZ[1] / white
    return np.array(means)


def count_negative(image):
    """Pixels (h, w, 3) whose light is negative beyond rounding."""
    xyz = image.astype(float) @ TO_XYZ.T
    with np.errstate(invalid="ignore"):
        return int((xyz.min(axis=2) < -NEGATIVE * np.abs(image).max(axis=2)).sum())


def region_means(values):
    """Means over up to `REGIONS` x `REGIONS` parts of an image (h, w), and over all of it."""
    rows = np.array_split(values, min(REGIONS, values.shape[0]), axis=0)
    parts = [part for row in rows for part in np.array_split(row, min(REGIONS, values.shape[1]), axis=1)]
    return [*(part.mean() for part in parts), values.mean()]
