"""Scenes of `scenes/`, small, with one of everything that a scene may hold, compared iteration by iteration.

What is compiled depends on what a scene holds. Tiny things of every kind, the lamps of them dark, stand in all scenes
here, so that these share their kernels, one set per integrator and kind of camera. All integrators see the same things.

Pixels of an iteration share photons and wavelengths, and are not independent; iterations are. So two integrators are
compared by paired t-tests over iterations, block by block and on the whole, against bidirectional path tracing, the
least noisy one without bias. Merging has a bias that falls with its radius, at least as fast as the radius itself:
it is rendered with two radii, and what they differ by says how large the bias may be.

All comparisons together fail by chance with probability FALSE_ALARM (Sidak). Power: the bound of a comparison is about
7 standard errors; on the whole these are at most PRECISION, and around 0.3 %, of the image.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from rendering import shape
from scipy import stats
from whole_scene_cases import ALWAYS_SLOW, CASES, SCENES

import artist_py
from artist_py.film.accumulation import Film
from artist_py.samplers.render_job import RenderSettings, Silence, sampler_for
from artist_py.stress.toml import to_toml

SIZE, BLOCK, ITERATIONS = 64, 8, 32
RADII = {"ppm": 0.01, "bpm": 0.01, "vcm": 0.004}  # in the scene's; the larger of two
FALSE_ALARM = 1e-3
PRECISION = 0.03
TINY = 1e-3

MATERIALS = {
    "every_diffuse": {"type": "diffuse", "reflectance": {"checkerboard": [0.2, 0.7]}, "two_sided": False},
    "every_matte": {"type": "oren-nayar", "reflectance": {"image": str(SCENES / "textures" / "tile.png")}},
    "every_phong": {"type": "phong"},
    "every_plastic": {"type": "plastic"},
    "every_mirror": {"type": "mirror"},
    "every_metal": {"type": "conductor", "metal": "Au"},
    "every_glass": {"type": "dielectric", "ior": "SF10", "priority": -1},
    "every_pane": {"type": "thin-dielectric"},
    "every_nothing": {"type": "none"},
}
MESH = {"file": str(SCENES / "meshes" / "prism.obj"), "transform": [{"scale": TINY}]}


def every_shape():
    """Tiny shapes about the origin: of every material, of every kind, and dark lamps of every kind."""
    center = {"center": [0, 0, 0]}
    balls = [
        shape("sphere", material, **center, radius=TINY * (1 + 0.1 * i))
        for i, material in enumerate(MATERIALS)
    ]
    dark = {"spectrum": 0, "visible": False}
    square = {"corner": [0, 0, 0], "edges": [[TINY, 0, 0], [0, TINY, 0]]}
    rings = {"grooves": 2, "segments": 8, "radius": TINY}
    return [
        *balls,
        shape("sphere", "every_glass", **center, radius=0.9 * TINY),
        shape("grooved-sphere", "every_matte", **center, **rings),
        shape("mesh", **MESH, emission=dark),
        shape("rectangle", **square, emission=dark),
        shape("sphere", **center, radius=TINY, emission=dark),
        shape("disk", **center, normal=[0, 0, 1], radius=TINY, emission=dark),
    ]


def every_emitter():
    """Dark emitters of every kind without a surface."""
    place = {"position": [0, 0, 0], "spectrum": 0}
    return [
        {"type": "point", **place},
        {"type": "spot", **place, "look_at": [0, 0, 1], "angle": 10},
        {"type": "directional", "direction": [0, 0, -1], "spectrum": 0},
        {"type": "directional", "direction": [0, 0, -1], "spectrum": 0, "angle": 1},
        {"type": "environment", "spectrum": 0},
        {"type": "environment", "image": str(SCENES / "images" / "sky.exr"), "scale": 0},
    ]


def moved(item, offset):
    """The shape with a step of translation at the end of its transform."""
    return {**item, "transform": [*item.get("transform", []), {"translate": offset}]}


def with_everything(file, place, folder):
    """A scene file in `folder` that includes `file`, and has one of everything at `place`."""
    ball = shape("sphere", "every_matte", center=[0, 0, 0], radius=TINY)
    tables = {
        "include": [str(file)],
        "materials": MATERIALS,
        "shapes": [moved(each, place) for each in every_shape()],
        "emitters": every_emitter(),
        "objects": {"every": {"shapes": [ball]}},
        "instances": [{"object": "every", "transform": [{"translate": place}]}],
    }
    path = Path(folder) / file.name
    path.write_text(to_toml(tables), encoding="utf-8")
    return path


def blocks(compiled, iterations):
    """Means of the image's blocks in every iteration: float64 (iterations, blocks, blocks, 3), linear RGB."""
    film, found, count = Film(SIZE, SIZE), [], SIZE // BLOCK
    with sampler_for(compiled, film, RenderSettings(threads=2), Silence()) as sampler:
        sampler.compile_kernels(Silence())
        for i in range(iterations):
            before = film.sums.copy()
            sampler.iterate(i)
            found.append((film.sums - before).reshape(count, BLOCK, count, BLOCK, 3).mean(axis=(1, 3)))
    assert film.rejected_count == 0
    return np.array(found)


class Renders:
    """Images of the cases by integrators, each made once; see `whole_scene_cases`."""

    def __init__(self, folder):
        self.folder, self.cache = folder, {}

    def image(self, name, integrator, radius=None):
        """`blocks` of a case. `radius` is that of merges, in the scene's; it does not shrink."""
        key = name, integrator, radius
        if key not in self.cache:
            case = CASES[name]
            # Equal seeds give equal wavelengths and eye paths: differences are then much smaller than images' noise.
            settings = {
                "render.integrator": integrator,
                "render.wavelengths": "shared",
                "render.sampler": "independent",
                "film.resolution": [SIZE, SIZE],
                **case.overrides,
            }
            if radius is not None:
                light_paths = 1 if integrator == "vcm" else 4
                settings["render.merging"] = {"radius": radius, "alpha": 1, "light_paths": light_paths}
            path = with_everything(case.file, case.place, self.folder)
            self.cache[key] = blocks(artist_py.load_scene(path, settings), ITERATIONS)
        return self.cache[key]


def unbiased(renders, name, integrator):
    """What an unbiased integrator and bidirectional path tracing differ by, per iteration, and 0."""
    found = renders.image(name, integrator)
    return found - renders.image(name, "bpt"), np.zeros_like(found)


def merging(renders, name, integrator):
    """As `unbiased` for the smaller of two merge radii, and what the two differ by."""
    radius = RADII[integrator]
    large, small = (renders.image(name, integrator, r) for r in (radius, 0.5 * radius))
    return small - renders.image(name, "bpt"), large - small


def smallest_t(deviation, slope, scale):
    """Student's t of the mean over iterations of deviation - w slope for the w in [0, 1] that explains most, absolute.

    A bias that falls as fast as the radius, or faster, as r^p, is at half the radius 1 / (2^p - 1) of what both radii
    differ by. `scale` is of the size of the image; what rounding makes is below a part of 100 000.
    """
    t = []
    for w in np.linspace(0, 1, 11):
        rest = deviation - w * slope
        error = rest.std(axis=0, ddof=1) / math.sqrt(len(rest))
        t.append(np.abs(rest.mean(axis=0)) / np.maximum(error, 1e-5 * scale))
    return np.min(t, axis=0)


def allowed_t():
    """Student's bound for all comparisons of all cases together (Sidak)."""
    n_blocks = (SIZE // BLOCK) ** 2 + 1
    comparisons = len(CASES) * 5 * 3 * n_blocks
    return stats.t.isf(0.5 * (1 - (1 - FALSE_ALARM) ** (1 / comparisons)), ITERATIONS - 1)


def assert_agrees(renders, name, integrator):
    """Block by block, unless the table says otherwise, and on the whole, where the error has to be below PRECISION."""
    deviation, slope = (merging if integrator in RADII else unbiased)(renders, name, integrator)
    scale = renders.image(name, "bpt").mean()
    whole = [each.mean(axis=(1, 2)) for each in (deviation, slope)]
    error = whole[0].mean(axis=-1).std(ddof=1) / math.sqrt(ITERATIONS)
    assert error < PRECISION * scale, f"too noisy: {error / scale:.2g}"
    t = smallest_t(*whole, scale).max()
    assert t < allowed_t(), f"on the whole {t:.1f}, off by {whole[0].mean() / scale:.2%}"
    if integrator not in CASES[name].on_the_whole:
        t = smallest_t(deviation, slope, scale)
        assert t.max() < allowed_t(), f"block {np.unravel_index(t.argmax(), t.shape)}: {t.max():.1f}"


def names_for(integrator):
    """Parameters: the cases that an integrator is compared in."""
    return [
        pytest.param(name, marks=pytest.mark.slow if integrator in case.slow | ALWAYS_SLOW else ())
        for name, case in CASES.items()
        if integrator not in case.left_out
    ]
