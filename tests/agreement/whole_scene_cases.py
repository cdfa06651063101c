"""Which scenes are compared, by which integrators, and why not by all."""

from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

SCENES = Path(__file__).resolve().parents[2] / "scenes"
OWN = Path(__file__).resolve().parent / "scenes"

# Reasons to leave an integrator out: its image is another one, on principle.
NO_DELTA_CAUSTICS = "next-event estimation cannot reach a point emitter by way of glass or metal"
NO_MIRRORED_VIEW = "light from a point emitter cannot be connected to a pinhole by way of glass or metal"
# Reasons to compare the whole image only: a few bright paths decide over the mean of a block, and unless one of them
# was met the block's variance is underestimated.
CAUSTICS = "finds caustics of a small lamp by rare hits"
THROUGH_GLASS = "finds what is seen through glass by rare hits of the lamp"
# Reason to leave an integrator out: not even the whole image can be told from noise.
HIDDEN_LAMP = "hits the lamp in the hood too rarely for the variance to be known"

NONE = MappingProxyType({})
ALL = frozenset({"pt", "lt", "ppm", "bpm", "vcm"})
MERGING_ALONE = frozenset({"ppm", "bpm"})  # vcm merges as they do, and they need the most light paths
ALWAYS_SLOW = frozenset(
    {"bpm"}
)  # it merges at all vertices, as vcm does, and weighs nothing else: closed forms show it


class Case(NamedTuple):
    """A scene file, overrides on top of it, and where tiny things are put.

    `left_out` and `on_the_whole` map integrators to the reasons why they are not compared, or only by the whole image.
    `slow` are the integrators that `make slow` compares: all, where other cases have the same materials and lamps.
    """

    file: Path
    overrides: dict = NONE
    place: tuple = (0.0, 0.0, 0.0)
    left_out: dict = NONE
    on_the_whole: dict = NONE
    slow: frozenset = frozenset()


CASES = {
    "diffuse boxes, measured spectra": Case(SCENES / "cornell_box.toml", slow=ALL),
    "mirror, glass, plastic": Case(
        SCENES / "cornell_smooth.toml", on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS}, slow=ALL
    ),
    "grooved metal, rough walls": Case(
        SCENES / "cornell_grooved.toml",
        on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS},
        slow=MERGING_ALONE,
    ),
    "caustic of a cone": Case(SCENES / "cone_caustic.toml", {"shapes.lamp.radius": 0.2}, slow=ALL),
    "dispersion": Case(
        SCENES / "glass_sphere.toml", {"shapes.lamp.radius": 0.25}, on_the_whole={"pt": CAUSTICS}
    ),
    "one-sided walls": Case(
        SCENES / "box_spheres.toml", on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS}, slow=ALL
    ),
    "Phong's lobe": Case(
        SCENES / "box_glossy.toml",
        on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS, "ppm": "few photons light a narrow lobe"},
        slow=MERGING_ALONE,
    ),
    "textures": Case(SCENES / "textures.toml", place=(0, 0, 1)),
    "sun and sky": Case(
        SCENES / "sun_sky.toml", {"emitters.sun.angle": 20, "shapes.ground.radius": 6}, (0, 0, 1)
    ),
    "spots and a point, direct light": Case(
        SCENES / "spotlights.toml", {"render.max_path_length": 2}, (0, 0, 2), slow=MERGING_ALONE
    ),
    "spots and a point, one reflection": Case(
        SCENES / "spotlights.toml",
        {"render.max_path_length": 3},
        (0, 0, 2),
        {"pt": NO_DELTA_CAUSTICS, "lt": NO_MIRRORED_VIEW},
        slow=MERGING_ALONE,
    ),
    "plastic in glass": Case(
        SCENES / "ball_in_ball.toml",
        {"shapes.lamp.radius": 0.7},
        (0, 0, 3),
        on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS},
    ),
    "mirror ceiling": Case(
        SCENES / "mirror_ceiling.toml",
        {"shapes.lamp.radius": 0.15, "camera.look_at": [0, 0, 0]},
        (0, 0, 2),
        {"pt": HIDDEN_LAMP},
        slow=ALL,
    ),
    "pool": Case(SCENES / "sds_pool.toml", {"emitters.sun.angle": 30}, (0, 0, 2), slow=ALL),
    "lamps that hide": Case(
        SCENES / "veach_room.toml",
        {},
        (0, 0, 2),
        on_the_whole={"pt": CAUSTICS, "lt": THROUGH_GLASS},
        slow=ALL,
    ),
    "pane, nothing, emitting mesh": Case(
        OWN / "pane_and_mesh_lamp.toml", {}, (0, 0, 0.3), slow=MERGING_ALONE
    ),
    "parallel light": Case(OWN / "parallel_light.toml", {}, (0, 0, 0.3), slow=MERGING_ALONE),
}
