"""Materials at the ends of what they can be, and light that grazes."""

import math

from artist_py.stress.case import Case, Radiance, SameAs, Sane
from artist_py.stress.scenes import furnace, look, scene, shape

BELOW = (0.0, 0.0, -0.5)
FLOOR = {"corner": [-0.5, -0.5, 0], "edges": [[1, 0, 0], [0, 1, 0]]}


def seen_plate(degrees, field_of_view, **material):
    """A plate that fills the view, seen `degrees` from its normal, in a furnace with black walls that emit 1."""
    angle = math.radians(degrees)
    eye = [0, -0.4 * math.sin(angle), 0.4 * math.cos(angle)]
    return furnace(
        [shape("rectangle", "plate", **FLOOR)],
        look(eye, [0, 0, 0], field_of_view),
        albedo=0.0,
        materials={"plate": material},
        render={"max_path_length": 2},
    )


def grazing_light(radians):
    """Parallel light `radians` above a floor of reflectance 0.5, as bright as makes the radiance 1."""
    sun = {"type": "directional", "direction": [1, 0, -radians], "spectrum": 2 * math.pi / math.sin(radians)}
    return scene(
        [shape("rectangle", "grey", **FLOOR)], look([0, 0, 0.4], [0, 0, 0], 40), emitters=[sun], aside=BELOW
    )


def eye_level(height, material):
    """An eye `height` above a plate in a furnace, looking along it."""
    return furnace(
        [shape("rectangle", material, **FLOOR)], look([0, -0.4, height], [0, 1, height], 60), albedo=0.5
    )


BLIND = "its photons would have to fall into a beam of 1e-3 rad"
SPARSE = "one photon in a million falls on the floor"
BEAM = "no photon ever falls into the eye's narrow view"
ONE_SPOT = "all pixels see the same few photons, those of one spot"
SPOT = "what the eye sees of the floor is a spot of 1e-5"
BLACK = {"type": "diffuse", "reflectance": 0.0}
LOSSLESS = (
    shape("sphere", "pane", center=[-0.1, 0.6, 0.2], radius=0.2),
    shape("sphere", "mirror", center=[0.3, 0.5, -0.2], radius=0.2),
    shape("sphere", "glass", center=[-0.5, -0.2, 0.3], radius=0.2),
)
BALLS = (
    shape("sphere", "white", center=[-0.4, 0.2, -0.4], radius=0.3),
    shape("sphere", "odd", center=[-0.1, 0.5, 0.2], radius=0.2),
)
SLAB_BELOW = shape("box", "glass", min=[-0.5, -0.5, -0.3], max=[0.5, 0.5, 0.0])
PHONG = {"type": "phong", "reflectance": 0.0, "specular": 1.0}

CASES = (
    Case(
        "phong-1e6",
        "A lobe of 1e-3 rad, the sharpest there is, seen at 60 degrees.",
        seen_plate(60, 1e-3, **PHONG, exponent=1_000_000),
        Radiance(math.cos(math.radians(60))),
        left_out={"lt": BLIND, "ppm": BLIND, "bpm": BLIND},
    ),
    Case(
        "phong-1e4",
        "A lobe of 1e-2 rad.",
        seen_plate(60, 1e-3, **PHONG, exponent=10_000),
        Radiance(math.cos(math.radians(60))),
        left_out={"lt": BLIND, "ppm": BLIND, "bpm": BLIND},
    ),
    Case(
        "phong-0",
        "A lobe of all directions: k/pi along the normal, k cos in all.",
        seen_plate(0, 1e-3, **PHONG, exponent=0),
        Radiance(1),
        left_out={"lt": BEAM, "ppm": ONE_SPOT, "bpm": ONE_SPOT},
    ),
    Case(
        "oren-nayar-1e-6",
        "Facets that are flat to 1e-6 degrees: as diffuse.",
        seen_plate(45, 20, type="oren-nayar", reflectance=0.7, roughness=1e-6),
        Radiance(0.7),
        precision=0.03,
    ),
    Case(
        "oren-nayar-90",
        "The roughest facets there are; only their loss is not known in closed form.",
        furnace(BALLS, materials={"odd": {"type": "oren-nayar", "reflectance": 1.0, "roughness": 90}}),
        SameAs("pt"),
    ),
    Case(
        "reflectance-0",
        "Walls and things that reflect nothing.",
        furnace(
            [{**BALLS[0], "material": "odd"}],
            albedo=0.0,
            materials={"odd": BLACK},
            camera=look([0.3, -0.3, 0.1], [1, -1, 0]),
        ),
        Radiance(1),
    ),
    Case(
        "reflectance-1",
        "Walls that lose nothing: every reflection adds 1.",
        furnace(albedo=1.0, radiance=1.0, emission=1.0, render={"max_path_length": 12}),
        Radiance(12),
    ),
    Case(
        "lossless-things",
        "White, glass, panes, mirrors and plastic without colour together.",
        furnace(BALLS[:1] + LOSSLESS),
        Radiance(1),
    ),
    Case(
        "light-at-1e-6-rad",
        "Light that grazes the floor at 1e-6 rad.",
        grazing_light(1e-6),
        Radiance(1),
        left_out={"lt": SPARSE, "ppm": SPARSE, "bpm": SPARSE},
        rounding=1e-3,
        why="A direction of float32 has the angle to 1e-7 of 1, that is to 0.06 of 1e-6.",
    ),
    Case(
        "light-at-1e-3-rad",
        "Light that grazes the floor at 1e-3 rad.",
        grazing_light(1e-3),
        Radiance(1),
        left_out={"lt": SPARSE, "ppm": SPARSE, "bpm": SPARSE},
        rounding=1e-4,
        least=2048,  # light paths have 1e-3 of the weight, and few iterations see one that hits the floor
        why="Rounding as of light-at-1e-6-rad, where it is a thousand times as much.",
    ),
    *(
        Case(
            f"eye-at-1e-6-above-{material}",
            "An eye that looks along a surface.",
            eye_level(1e-6, material),
            Radiance(1),
            left_out={"lt": SPOT} if material == "white" else {},
            precision=0.03,
        )
        for material in ("white", "mirror", "pane")
    ),
    Case(
        "eye-on-surface",
        "An eye exactly on a white plate, looking along it and up.",
        eye_level(0.0, "white"),
        Radiance(1),
        precision=0.03,
    ),
    Case(
        "eye-on-glass",
        "An eye exactly on the surface of glass.",
        furnace([SLAB_BELOW], look([0, 0, 0], [0, 1, 0.2], 60), albedo=0.0, render={"max_path_length": 400}),
        Sane(),
        why="Whether it is inside, and sees n^2, is a matter of rounding.",
    ),
)
