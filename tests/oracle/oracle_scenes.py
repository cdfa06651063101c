"""Scenes of the oracle tests: each has what makes densities differ from the plain case."""

from pathlib import Path

from rendering import diffuse, look, scene, shape

import artist_py

CORNELL = Path(__file__).parents[2] / "scenes" / "cornell_box.toml"
WHITE, GREY = diffuse(0.8), diffuse(0.3)
MATERIALS = {
    "white": WHITE,
    "grey": GREY,
    "rough": {"type": "oren-nayar", "reflectance": 0.7, "roughness": 30},
    "gloss": {"type": "phong", "reflectance": 0.3, "specular": 0.5, "exponent": 20},
    "needle": {"type": "phong", "reflectance": 0.3, "specular": 0.6, "exponent": 80000},
    "plastic": {"type": "plastic", "reflectance": 0.6},
    "mirror": {"type": "mirror", "reflectance": 0.9},
    "gold": {"type": "conductor", "metal": "Au"},
    "glass": {"type": "dielectric", "ior": 1.5},
    "flint": {"type": "dielectric", "ior": "N-SF11"},
    "water": {"type": "dielectric", "ior": 1.33, "priority": -1},
    "pane": {"type": "thin-dielectric", "ior": 1.5},
    "nothing": {"type": "none"},
}
SMALL = {"resolution": [8, 8]}
LENGTH = 7


def cornell():
    """The Cornell box."""
    overrides = {
        "film.resolution": [8, 8],
        "render.max_path_length": LENGTH,
        "render.wavelength_range": [600, 601],
    }
    return artist_py.load_scene(str(CORNELL), overrides)


def room(*shapes, camera=None, length=LENGTH):
    """Shapes in a closed box of 4 x 4 x 4 around the origin."""
    walls = shape("box", "white", center=[0, 0, 0], size=[4, 4, 4])
    used = {each["material"] for each in shapes if "material" in each} | {"white"}
    return scene(
        [walls, *shapes],
        materials={name: MATERIALS[name] for name in sorted(used)},
        camera=camera or look([0, -1.9, 0], [0, 0, 0], 80.0),
        film=SMALL,
        render={"max_path_length": length, "hero_count": 1},
    )


def mixed(camera=None):
    """Mirror, metal, glass and a pane among rough quadrics; lights: a sphere, a two-sided disk and a cylinder."""
    return room(
        shape("sphere", "mirror", center=[-0.9, 0.3, -0.8], radius=0.6),
        shape("sphere", "glass", center=[0.6, -0.2, -0.7], radius=0.7),
        shape("sphere", "grey", center=[0.6, -0.2, -0.7], radius=0.3),
        shape("cone", "gold", base=[0, 1, -2], apex=[0, 1, -0.6], radius=0.7),
        shape("rectangle", "pane", corner=[-1.9, -0.9, -1.9], edges=[[1.5, 0.2, 0], [0, 0, 2.2]]),
        shape("cylinder", "rough", base=[1.5, 1.2, -2], top=[1.4, 1, 0.2], radius=0.3),
        shape("sphere", center=[0.4, 0.5, 0.9], radius=0.4, emission=2),
        shape(
            "disk", "rough", center=[-1, -0.5, 1.2], normal=[0.2, 0, -1], radius=0.5,
            emission={"spectrum": 3, "sides": "both"},
        ),
        shape("cylinder", base=[-1.5, 1.4, 0.3], top=[-0.5, 1.4, 0.4], radius=0.2, emission=1.5),
        camera=camera,
    )  # fmt: skip


def nested():
    """A glass ball with a diffuse and a light inside, standing in water; a surface that is not there."""
    return room(
        shape("box", "water", center=[0, 0.4, -1], size=[3, 2, 1.6]),
        shape("sphere", "glass", center=[-0.5, 0.3, -0.6], radius=0.7),
        shape("sphere", "grey", center=[-0.6, 0.3, -0.6], radius=0.25),
        shape("sphere", "nothing", center=[0.9, 0.1, -0.2], radius=0.6),
        shape("sphere", center=[-0.3, 0.5, -0.3], radius=0.1, emission=9),
        shape("rectangle", corner=[-0.5, -0.5, 1.9], edges=[[0, 1, 0], [1, 0, 0]], emission=5),
    )


def coated():
    """Lobes beside lobes: plastic, whose coat is a delta, and Phong's; a mirror and glass among them."""
    return room(
        shape("rectangle", "plastic", corner=[-1.9, -1.9, -1.5], edges=[[3.8, 0, 0], [0, 3.8, 0]]),
        shape("sphere", "plastic", center=[0.8, 0.4, -0.9], radius=0.6),
        shape("sphere", "gloss", center=[-0.8, 0.3, -0.9], radius=0.6),
        shape("rectangle", "gloss", corner=[-1.9, 1.8, -1.5], edges=[[3.8, 0, 0], [0, 0, 3]]),
        shape("sphere", "mirror", center=[0, 1.2, -1.1], radius=0.4),
        shape("sphere", "glass", center=[0, -0.5, -1.1], radius=0.4),
        shape("sphere", center=[0.4, 0.5, 0.9], radius=0.4, emission=2),
    )


def sharp():
    """Lobes too narrow to be merged at, beside ones that are not."""
    return room(
        shape("rectangle", "needle", corner=[-1.9, -1.9, -1.5], edges=[[3.8, 0, 0], [0, 3.8, 0]]),
        shape("sphere", "gloss", center=[0.8, 0.4, -0.9], radius=0.6),
        shape("sphere", "needle", center=[-0.8, 0.3, -0.9], radius=0.6),
        shape("sphere", "mirror", center=[0, 1.2, -1.1], radius=0.4),
        shape("sphere", center=[0.4, 0.5, 0.9], radius=0.4, emission=2),
    )


def smooth():
    """Coarse balls with interpolated normals: geometric and shading normals differ by up to 20 degrees."""
    grooved = {"depth": 0.1, "grooves": 3, "segments": 10}
    return room(
        shape("grooved-sphere", "rough", center=[-0.8, 0.2, -0.5], radius=0.8, **grooved),
        shape("grooved-sphere", "glass", center=[0.9, 0.1, -0.6], radius=0.7, **grooved),
        shape("grooved-sphere", "mirror", center=[0.6, 1.0, 0.9], radius=0.6, **grooved),
        shape("rectangle", corner=[-0.8, -0.5, 1.9], edges=[[0, 1, 0], [1, 0, 0]], emission=5),
    )


def far():
    """A camera so far away that its rays start on a sphere around the scene."""
    floor = shape("rectangle", "white", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]])
    ball = shape("sphere", "grey", center=[0.3, 0, 0.4], radius=0.4)
    lamp = shape("sphere", center=[-0.5, 0, 0.8], radius=0.2, emission=3)
    return scene(
        [floor, ball, lamp],
        materials={"white": WHITE, "grey": GREY},
        camera=look([0, -90, 90], [0, 0, 0], 1.0),
        film=SMALL,
        render={"max_path_length": 4, "hero_count": 1},
    )


LIGHTS = [
    {"type": "point", "position": [-0.8, -0.6, 1.2], "spectrum": 2},
    {"type": "spot", "position": [0.9, -0.4, 1.5], "look_at": [0.3, 0.2, -1], "angle": 50, "spectrum": 9},
    {"type": "directional", "direction": [0.3, 0.5, -1], "spectrum": 1},
    {"type": "directional", "direction": [-0.4, 0.2, -1], "spectrum": 2, "angle": 40},
    {"type": "environment", "spectrum": 0.5},
]


def lights():
    """Emitters without a surface, and a sphere that emits, over a floor with a mirror, glass and a rough wall."""
    shapes = [
        shape("rectangle", "white", corner=[-2, -2, -1], edges=[[4, 0, 0], [0, 4, 0]]),
        shape("rectangle", "rough", corner=[-2, 1.5, -1], edges=[[4, 0, 0], [0, 0, 2]]),
        shape("sphere", "mirror", center=[-0.7, 0.3, -0.5], radius=0.5),
        shape("sphere", "glass", center=[0.6, 0.1, -0.5], radius=0.5),
        shape("sphere", center=[0, 0.9, 0.2], radius=0.2, emission=3),
    ]
    return open_scene(shapes, LIGHTS, 1)


def lights_on_lens():
    """Emitters without a surface above a large lens that looks down; of one edge, only hits find paths to them."""
    shapes = [
        shape("rectangle", "white", corner=[-2, -2, -1], edges=[[4, 0, 0], [0, 4, 0]]),
        shape("rectangle", "mirror", corner=[-1, -1, -0.9], edges=[[1, 0, 0], [0, 2, 0]]),
    ]
    camera = look([0, 0, 0], [0, 0, -1], 140.0, type="thin-lens", aperture_radius=1.0, focus_distance=2.0)
    return open_scene(shapes, LIGHTS, 1, camera)


def dispersive():
    """Prism glass and dispersive glass in a pane of glass, by four wavelengths at once."""
    shapes = [
        shape("rectangle", "white", corner=[-2, -2, -1], edges=[[4, 0, 0], [0, 4, 0]]),
        shape("rectangle", "rough", corner=[-2, 1.5, -1], edges=[[4, 0, 0], [0, 0, 2]]),
        shape("sphere", "flint", center=[-0.6, 0.1, -0.4], radius=0.6),
        shape("sphere", "glass", center=[0.7, 0.1, -0.4], radius=0.6),
        shape("sphere", "flint", center=[0.7, 0.1, -0.4], radius=0.4),
        shape("sphere", center=[0, 0.2, 1.0], radius=0.4, emission=3),
    ]
    return open_scene(shapes, (), 4)


def open_scene(shapes, emitters, lanes, camera=None):
    """A scene without walls."""
    used = {each["material"] for each in shapes if "material" in each}
    return scene(
        shapes,
        emitters=emitters,
        materials={name: MATERIALS[name] for name in sorted(used)},
        camera=camera or look([0, -3, 0.5], [0, 0, -0.3], 60.0),
        film=SMALL,
        render={"max_path_length": LENGTH, "hero_count": lanes, "wavelength_range": [400, 700]},
    )


def through_lens():
    """The mixed scene through a thin lens."""
    camera = look([0, -1.9, 0], [0, 0, 0], 80.0, type="thin-lens", aperture_radius=0.1, focus_distance=2.0)
    return mixed(camera)


def wide_lens():
    """Mirrors and more in front of a large lens that light paths hit, a pentagon."""
    camera = look(
        [0, -1.3, 0], [0, 0, 0], 140.0, type="thin-lens", aperture_radius=1.8, focus_distance=3.0, blades=5
    )
    return mixed(camera)


SCENES = {
    "cornell": cornell,
    "mixed": mixed,
    "lens": through_lens,
    "wide lens": wide_lens,
    "nested": nested,
    "coated": coated,
    "sharp": sharp,
    "smooth": smooth,
    "far": far,
    "lights": lights,
    "lights on lens": lights_on_lens,
    "dispersive": dispersive,
}
