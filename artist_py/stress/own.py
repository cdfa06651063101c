"""Scenes of the user as stress cases: rendered small by every integrator, which must agree."""

from pathlib import Path

from artist_py.scene.reader import read_scene
from artist_py.stress.case import Case, SameAs
from artist_py.stress.scenes import SIZE

# The most robust one first: the others are compared with it.
INTEGRATORS = ("vcm", "pt", "lt", "bpt", "ppm", "bpm")
MANY = 64  # light paths per pixel where nothing but photons brings light
MERGES_ALONE = dict.fromkeys(("ppm", "bpm"), 0.02)
BLURRED = 5e-3
MERGING_BLURS = (
    "Merging blurs light and misses photons beyond edges: half a per cent is allowed for where it is one of many "
    "techniques, and two more where it is alone."
)


def own_case(path):
    """The `Case` of a scene file; raises SceneError if it cannot be read."""
    read_scene(path)
    return Case(
        str(path),
        "A scene of your own, in few pixels.",
        Path(path).resolve(),
        SameAs("vcm", bias=MERGES_ALONE),
        integrators=INTEGRATORS,
        precision=0.02,
        rounding=BLURRED,
        why=MERGING_BLURS,
    )


def small_scene(path, integrator, seed):
    """The scene of a file as a cell renders it: of the same shape, with `SIZE` pixels along its longer side."""
    width, height = read_scene(path).film.resolution
    pixels = [max(1, round(SIZE * side / max(width, height))) for side in (width, height)]
    changes = {
        "film.resolution": pixels,
        "film.crop": [0, pixels[0], 0, pixels[1]],
        "render.integrator": integrator,
        "render.seed": seed,
    }
    if integrator in MERGES_ALONE:  # the few light paths of so few pixels would hardly ever meet
        changes["render.merging.light_paths"] = MANY
    return read_scene(path, changes)
