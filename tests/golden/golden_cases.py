"""The golden images: which scenes are rendered, by which integrators, and how an image is compared with its golden one.

A golden image is the mean of `REPLICATES` renders of equal effort that differ in their seed alone, with the variance of
that mean. A test renders as many again, from other seeds. Both are means of equally many samples of one distribution,
if the renderer still computes what it did, so that their differences are symmetric whatever the noise is like: the
pixels' Z-test needs no normal distribution (`symmetric_tail`). The means of the whole image and of its blocks, of
nearly normal distribution, see errors that are too small for any pixel. These means are weighted with one over the
brightness that a pilot render found, as in relMSE: the edge of a lamp is not to drown everything else.
"""

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rendering import with_render

import artist_py
from artist_py import load_scene
from artist_py.compare.z_test import Moments, student_tail, symmetric_tail, z_test
from artist_py.evidence.reference import block_means
from artist_py.film.reading import read_image

ROOT = Path(__file__).parents[2]
IMAGES = Path(__file__).parent / "images"
SIZE, BLOCK = 64, 16
REPLICATES = 64
PILOT_REPLICATES = 16
GOLDEN_SEED, TEST_SEED, PILOT_SEED = 1_000_000, 1, 2_000_000
FLOOR = 0.1  # of the mean: brightness below which pixels get no more weight
# Of one run of all cases: one in two thousand, shared by the three tests of every case.
FALSE_ALARM = 5e-4


class Case(NamedTuple):
    """One golden image."""

    scene: str  # file in scenes/, without .toml
    integrator: str
    iterations: int  # of a replicate
    settings: tuple = ()  # (dotted key, value) beyond integrator and size
    is_slow: bool = False  # checked by `make slow` alone, since its kernels are much like those of others

    @property
    def name(self):
        """Of the file, and of the test."""
        return f"{self.scene}-{self.integrator}"


# Colour noise would hide small errors: most cases see one wavelength, and some the whole range.
ONE_WAVELENGTH = (("render.wavelength_range", [550, 551]),)
CASES = (
    Case("cornell_box", "pt", 8),
    Case("colorchecker", "pt", 4),
    Case("lights", "pt", 8),
    Case("prism", "pt", 32),
    Case("textures", "pt", 8),
    Case("fluorescent_spheres", "pt", 8),
    Case("instances", "pt", 4, ONE_WAVELENGTH, is_slow=True),
    Case("sun_sky", "pt", 8, ONE_WAVELENGTH, is_slow=True),
    Case("cornell_box", "lt", 4, ONE_WAVELENGTH),
    Case("spotlights", "lt", 4, ONE_WAVELENGTH),
    Case("sun_sky", "bpt", 8),
    Case("cornell_box", "bpt", 16, ONE_WAVELENGTH),
    Case("box_glossy", "bpt", 4, ONE_WAVELENGTH, is_slow=True),
    Case("depth_of_field", "bpt", 4, ONE_WAVELENGTH),
    Case("veach_room", "bpt", 4, ONE_WAVELENGTH),
    Case("fluorescent_room", "bpt", 8),
    Case("cascade", "bpt", 16),  # the kernels are those of fluorescent_room
    Case("box_spheres", "ppm", 4, ONE_WAVELENGTH),
    Case("small_light", "ppm", 4, ONE_WAVELENGTH, is_slow=True),
    Case("cornell_grooved", "bpm", 4, ONE_WAVELENGTH),
    Case("spotlights", "bpm", 4, ONE_WAVELENGTH),
    Case("glass_sphere", "vcm", 16),
    Case("black_light", "vcm", 8),
    Case("highlighters", "vcm", 8, is_slow=True),
    Case("ball_in_ball", "vcm", 4, ONE_WAVELENGTH, is_slow=True),
    Case("box_glossy", "vcm", 4, ONE_WAVELENGTH),
    Case("cone_caustic", "vcm", 4, ONE_WAVELENGTH, is_slow=True),
    Case("cornell_box", "vcm", 4, ONE_WAVELENGTH),
    Case("mirror_ceiling", "vcm", 4, ONE_WAVELENGTH, is_slow=True),
    Case("sds_pool", "vcm", 4, ONE_WAVELENGTH),
)


class Golden(NamedTuple):
    """Means and their variances: of pixels, and weighted ones of blocks and of the whole image; linear sRGB."""

    pixels: Moments  # (SIZE, SIZE, 3)
    blocks: Moments  # (SIZE / BLOCK, SIZE / BLOCK, 3)
    whole: Moments  # (3,)
    weights: np.ndarray  # (SIZE, SIZE, 3) of the pixels in the weighted means


def make_golden(case):
    """A new `Golden` of a case."""
    pilot = Moments()
    for image in replicates(case, PILOT_SEED, PILOT_REPLICATES):
        pilot.add(image)
    brightness = np.maximum(pilot.mean, 0.0) + FLOOR * pilot.mean.mean(axis=(0, 1)).max()
    return measure(case, GOLDEN_SEED, (1.0 / brightness).astype(np.float16).astype(float))


def measure(case, first_seed, weights):
    """The `Golden` of a case's replicates from a seed on, with given weights."""
    result = Golden(Moments(), Moments(), Moments(), weights)
    for image in replicates(case, first_seed, REPLICATES):
        weighted = weights * image
        result.pixels.add(image)
        result.blocks.add(block_means(weighted, BLOCK))
        result.whole.add(weighted.mean(axis=(0, 1)))
    return result


def replicates(case, first_seed, count):
    """Images (SIZE, SIZE, 3) of a case from seeds `first_seed`, `first_seed` + 1, ..."""
    overrides = {"film.resolution": [SIZE, SIZE], "render.integrator": case.integrator, **dict(case.settings)}
    if case.integrator in ("ppm", "bpm", "vcm"):
        overrides["render.wavelengths"] = "shared"
    compiled = load_scene(ROOT / "scenes" / f"{case.scene}.toml", overrides)
    for seed in range(first_seed, first_seed + count):
        film = artist_py.render(with_render(compiled, seed=seed), iterations=case.iterations, threads=1).film
        assert film.rejected_count == 0
        yield film.rgb


def comparisons(image, golden):
    """`{what: ZTest}` of a case's `Golden` against the golden one."""
    share = FALSE_ALARM / (3 * len(CASES))
    tails = {
        "pixels": symmetric_tail(REPLICATES),
        "blocks": student_tail(2 * (REPLICATES - 1)),
        "whole": student_tail(2 * (REPLICATES - 1)),
    }
    return {
        what: z_test(a.mean, a.variance, b.mean, b.variance, false_alarm=share, tail=tail)
        for (what, tail), a, b in zip(tails.items(), image[:3], golden[:3], strict=True)
    }


# --- files ----------------------------------------------------------------------------------------------------------


def write_golden(case, golden):
    """Write an EXR: mean in R, G, B; its standard error; the weights as half floats; larger parts in the header.

    Errors are floats: a half float would be 0 for those of nearly black pixels.
    """
    import OpenImageIO as oiio

    channels = ("R", "G", "B", *(f"{layer}.{channel}" for layer in ("error", "weight") for channel in "RGB"))
    spec = oiio.ImageSpec(SIZE, SIZE, len(channels), "float")
    spec.channelnames, spec.channelformats = channels, ("float",) * 6 + ("half",) * 3
    spec.attribute("compression", "zip")
    spec.attribute("DateTime", "1970:01:01 00:00:00")
    spec.attribute("replicates", golden.pixels.count)
    spec.attribute("iterations", case.iterations)
    for name in ("blocks", "whole"):
        moments = getattr(golden, name)
        spec.attribute(name, json.dumps([moments.mean.tolist(), moments.variance.tolist()]))
    errors = np.sqrt(golden.pixels.variance)
    pixels = np.concatenate([golden.pixels.mean, errors, golden.weights], axis=2)
    IMAGES.mkdir(exist_ok=True)
    output = oiio.ImageOutput.create("golden.exr")
    if not output.open(str(IMAGES / f"{case.name}.exr"), spec) or not output.write_image(
        pixels.astype(np.float32)
    ):
        raise OSError(output.geterror())
    output.close()


def read_golden(case):
    """The `Golden` that is stored for a case."""
    stored = read_image(IMAGES / f"{case.name}.exr")
    count = int(stored.metadata["replicates"])
    assert (count, stored.metadata["iterations"]) == (REPLICATES, case.iterations), "run `make golden`"
    parts = [json.loads(stored.metadata[name]) for name in ("blocks", "whole")]
    pixels = Moments(stored.rgb, stored.layer("error").astype(float) ** 2, count)
    blocks, whole = (Moments(mean, variance, count) for mean, variance in parts)
    return Golden(pixels, blocks, whole, stored.layer("weight").astype(float))
