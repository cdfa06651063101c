"""References: images whose own error is known, made of independent batches, and kept.

A reference is the mean of batches with seeds of their own and equally many iterations. The spread of the batches gives
the variance of the mean, stratification and correlation between pixels included, and so the reference's own error. A
cached reference grows by further batches when it is asked for with more time.
"""

import hashlib
import json
import math
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from artist_py.compare.metrics import relmse_of_variance, smape_of_variance
from artist_py.compare.z_test import Moments, student_tail, z_test
from artist_py.errors import OptionError, OutputError
from artist_py.evidence.entries import picture_hash, with_seed
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image
from artist_py.film.reading import read_image
from artist_py.jit import cache_root, source_digest
from artist_py.samplers.render_job import RenderSettings
from artist_py.samplers.snapshots import snapshots
from artist_py.scene.identity import settings

BATCHES = 16
FEWEST_BATCHES = 4
UNBIASED = ("pt", "bpt", "reference")
FALSE_ALARM = 1e-3  # that two integrators which agree are said not to
ATTRIBUTE = "artist:reference"
BLOCK = 8  # pixels


@dataclass
class Reference:
    """An image to measure errors against, and its own; a given one without variance has unknown errors (`None`)."""

    rgb: Any  # (h, w, 3) float64, linear RGB
    variance: Any  # of the mean, or None
    origin: dict = field(default_factory=dict)  # how it was made, for people and JSON
    relmse: float | None = None
    smape: float | None = None

    def __post_init__(self):
        if self.variance is not None:
            self.relmse = relmse_of_variance(self.variance, self.rgb)
            self.smape = smape_of_variance(self.variance, self.rgb)

    def summary(self):
        """Text, numbers and lists, for JSON."""
        return {**self.origin, "relmse": self.relmse, "smape": self.smape}


@dataclass
class Batches:
    """What one integrator has rendered for a reference."""

    integrator: str
    moments: Moments = field(default_factory=Moments)
    blocks: Moments = field(default_factory=Moments)  # of means over BLOCK x BLOCK pixels
    iterations: int = 0  # of one batch
    seconds: float = 0.0  # of all, wall

    def add(self, rgb):
        """Take the image of one more batch."""
        self.moments.add(rgb)
        self.blocks.add(block_means(rgb))


def block_means(image, size=BLOCK):
    """Means over blocks of `size` x `size` pixels; what is left at the right and below makes smaller blocks."""
    rows, columns = (np.arange(0, n, size) for n in image.shape[:2])
    sums = np.add.reduceat(np.add.reduceat(np.asarray(image, np.float64), rows, axis=0), columns, axis=1)
    ones = np.ones(image.shape[:2])
    return sums / np.add.reduceat(np.add.reduceat(ones, rows, axis=0), columns, axis=1)[..., None]


# --- rendering


def make_reference(compile_as, integrators, seconds, *, threads, is_fresh=False, observer=None, stop=None):
    """A `Reference` by one integrator, or by several that must agree, which share the time, wall seconds.

    `compile_as(integrator)` gives the compiled scene. What the cache holds counts, unless `is_fresh`. Raises
    OptionError where the integrators do not agree, and where `stop` came before there were enough batches.
    """
    made = []
    for integrator in integrators:
        compiled = compile_as(integrator)
        path = cached_path(compiled, integrator)
        batches = Batches(integrator) if is_fresh else load_batches(path, integrator)
        begun = batches.moments.count
        render_batches(compiled, batches, seconds / len(integrators), threads, observer, stop)
        if batches.moments.count > begun:
            save_batches(path, batches, compiled)
        if batches.moments.count < FEWEST_BATCHES:
            raise OptionError(
                f"the reference by {integrator} was interrupted before anything is known of its error"
            )
        made.append(batches)
    for other in made[1:]:
        check_agreement(made[0], other)
    return joined(made)


def render_batches(compiled, batches, seconds, threads, observer=None, stop=None):
    """Add batches until they have taken so many wall seconds in all; those of one reference are equally long."""
    limits = RenderSettings(threads=threads)
    while not (stop is not None and stop.is_set()):
        if batches.seconds >= seconds and batches.moments.count >= FEWEST_BATCHES:
            return
        marks, axis = (
            ([batches.iterations], "iterations") if batches.iterations else ([seconds / BATCHES], "wall")
        )
        seeded = with_seed(compiled, batch_seed(batches.integrator, batches.moments.count))
        for snapshot in snapshots(seeded, limits, marks, axis, observer, stop):
            batches.iterations = snapshot.iterations
            batches.add(snapshot.film.rgb)
            batches.seconds += snapshot.wall_seconds
            if observer:
                share = min(1.0, batches.seconds / seconds)
                observer.note(f"reference by {batches.integrator}: {share:.0%}, {_noise(batches)}")


def _noise(batches):
    moments = batches.moments
    if moments.count < FEWEST_BATCHES:
        return "its own error not known yet"
    return f"its own relMSE {relmse_of_variance(moments.variance, moments.mean):.3g}"


def batch_seed(integrator, batch):
    """A seed that no render has by accident."""
    digest = hashlib.sha256(f"reference {integrator} {batch}".encode()).digest()
    return int.from_bytes(digest[:8], "big") >> 1


def check_agreement(a, b):
    """Raise OptionError unless the batches of two integrators may have the same expectation, in pixels and blocks.

    Their variances differ, and so the test has the degrees of freedom of the smaller number of batches, which is on the
    safe side of Welch's.
    """
    tail = student_tail(min(a.moments.count, b.moments.count) - 1)
    for name, mine, theirs in (("pixel", a.moments, b.moments), ("block", a.blocks, b.blocks)):
        if min(mine.count, theirs.count) < 2:
            continue  # blocks are not kept in the cache
        test = z_test(
            mine.mean, mine.variance, theirs.mean, theirs.variance, false_alarm=FALSE_ALARM / 2, tail=tail
        )
        if not test.is_same:
            y, x, _ = (int(i) * (BLOCK if name == "block" else 1) for i in test.worst)
            raise OptionError(
                f"the references by {a.integrator} and {b.integrator} do not agree: p = {test.p:.2g}, worst at x {x}, "
                f"y {y}, {test.z[test.worst]:+.1f} standard errors; one of them does not find all the light"
            )


def joined(made):
    """The `Reference` of all batches, weighted by the inverse of each integrator's mean variance."""
    variances = [batches.moments.variance for batches in made]
    weights = np.array([1.0 / max(float(variance.mean()), 1e-300) for variance in variances])
    weights /= weights.sum()
    rgb = sum(weight * batches.moments.mean for weight, batches in zip(weights, made, strict=True))
    variance = sum(weight**2 * each for weight, each in zip(weights, variances, strict=True))
    origin = {
        "integrators": [batches.integrator for batches in made],
        "is_unbiased": all(batches.integrator in UNBIASED for batches in made),
        "batches": [batches.moments.count for batches in made],
        "iterations": [batches.moments.count * batches.iterations for batches in made],
        "seconds": sum(batches.seconds for batches in made),
    }
    return Reference(rgb, variance, origin)


# --- files


def cached_path(compiled, integrator):
    """Where the reference of a picture by an integrator is kept; one with bias has its settings in the name, too."""
    key = picture_hash(compiled)
    if integrator not in UNBIASED:
        key = hashlib.sha256(f"{key} {settings(compiled.graph)['render']['merging']}".encode()).hexdigest()
    return cache_root() / "references" / f"{key[:32]}-{integrator}.exr"


def save_batches(path, batches, compiled):
    """Keep batches in the cache."""
    path.parent.mkdir(parents=True, exist_ok=True)
    about = {
        "integrator": batches.integrator,
        "batches": batches.moments.count,
        "iterations": batches.iterations,
        "seconds": batches.seconds,
        "sources": source_digest(),
    }
    write_reference(path, batches.moments.mean, batches.moments.variance, about, compiled)


def load_batches(path, integrator):
    """Batches from the cache; none if there are none, or if they were made by other kernels, which may differ."""
    if not path.exists():
        return Batches(integrator)
    os.utime(path.parent)  # what is used is not forgotten (jit.forget_old_caches)
    stored = read_image(path)
    about = json.loads(stored.metadata[ATTRIBUTE])
    if about["sources"] != source_digest():
        return Batches(integrator)
    moments = Moments(stored.rgb.astype(float), stored.layer("variance").astype(float), about["batches"])
    return Batches(integrator, moments, Moments(), about["iterations"], about["seconds"])


def write_reference(path, rgb, variance, about, compiled):
    """Write an image with its variance; `about` says how it was made. OutputError."""
    if not np.isfinite(variance).all():
        raise OutputError(f"{path}: a reference needs two batches")
    graph = compiled.graph
    film = FilmImage(
        rgb=rgb,
        iterations=int(np.sum(about["batches"]) * np.max(about["iterations"])),
        resolution=tuple(graph.film.resolution),
        crop=graph.film.crop,
        variance=variance,
    )
    metadata = {ATTRIBUTE: json.dumps(about), "artist:pictureHash": picture_hash(compiled)}
    write_image(path, film, metadata)


def read_reference(path, compiled):
    """The `Reference` in an EXR, with its error if it has a layer of variance; OptionError if it is another picture."""
    stored = read_image(path)
    if stored.rgb is None:
        raise OptionError(f"{path}: has no channels R, G and B")
    x0, y0, full_width, full_height = stored.window
    height, width = stored.rgb.shape[:2]
    film = compiled.graph.film
    crop = film.crop or (0, film.resolution[0], 0, film.resolution[1])
    if (x0, x0 + width, y0, y0 + height) != tuple(crop) or (full_width, full_height) != tuple(
        film.resolution
    ):
        raise OptionError(
            f"{path}: shows {width} x {height} pixels from {x0}, {y0} of {full_width} x {full_height}, and the scene "
            f"{crop[1] - crop[0]} x {crop[3] - crop[2]} from {crop[0]}, {crop[2]} of "
            f"{film.resolution[0]} x {film.resolution[1]}"
        )
    known = stored.metadata.get("artist:pictureHash")
    if known is not None and known != picture_hash(compiled):
        raise OptionError(f"{path}: is a reference of another scene, path length or range of wavelengths")
    variance = stored.layer("variance").astype(float)
    origin = {"file": Path(path).name, **json.loads(stored.metadata.get(ATTRIBUTE, "{}"))}
    if not np.isfinite(stored.rgb).all() or not np.isfinite(variance).all():
        raise OptionError(f"{path}: has pixels that are not finite")
    return Reference(stored.rgb.astype(float), variance if variance.size else None, origin)


def is_below(relmse, reference):
    """Whether an image of this relMSE is nearer to the truth than the reference itself, as far as one can tell.

    The relMSE against a noisy reference expects the sum of both errors.
    """
    return reference.relmse is not None and relmse < 2.0 * reference.relmse


def own_error(relmse, reference):
    """The image's own relMSE: without what the reference adds; NaN where nothing is left."""
    own = relmse - (reference.relmse or 0.0)
    return own if own > 0.0 else math.nan
