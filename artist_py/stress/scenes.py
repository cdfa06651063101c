"""Scenes with closed forms, as the tables of a scene file, that stress cases are made of.

Light whose radiance is the same everywhere is the best judge: in a closed room whose walls emit 1 - a and reflect a the
radiance is 1 in every place and direction, whatever lossless things stand in it, by every path and every technique.
In an integrating sphere a lamp lights all of the wall alike.

Scenes are monochrome, and have unseen things aside, so that cases share their kernels.
"""

import math

WAVELENGTH = 550
MONOCHROME = [WAVELENGTH, WAVELENGTH + 1]
SIZE = 16  # pixels
EDGES = 60  # of the longest paths: 0.5^60 of the light is lost
LENGTHS = {"radius", "size", "aperture_radius", "focus_distance"}
POINTS = {"center", "corner", "base", "top", "apex", "position", "look_at", "min", "max"}


# --- tables -------------------------------------------------------------------------------------------------------


def shape(kind, material=None, **keys):
    """A shape's table."""
    return {"type": kind, **({"material": material} if material else {}), **keys}


def look(position, look_at, field_of_view=60.0, **more):
    """A pinhole camera's table; `up` is z unless that is nearly where it looks."""
    x, y, z = (b - a for a, b in zip(position, look_at, strict=True))
    up = [0, 1, 0] if math.hypot(x, y) < 1e-6 * abs(z) else [0, 0, 1]
    table = {"position": position, "look_at": look_at, "up": up, "field_of_view": field_of_view}
    return {"type": "pinhole", **table, **more}


MATERIALS = {
    "grey": {"type": "diffuse", "reflectance": 0.5},
    "white": {"type": "diffuse", "reflectance": 1.0},
    "mirror": {"type": "mirror", "reflectance": 1.0},
    "glass": {"type": "dielectric", "ior": 1.5},
    "dense": {"type": "dielectric", "ior": 1.8, "priority": 1},
    "pane": {"type": "thin-dielectric", "ior": 1.5},
    "lacquer": {"type": "phong", "reflectance": 0.2, "specular": 0.5, "exponent": 50},
    "clay": {"type": "oren-nayar", "reflectance": 0.5, "roughness": 30},
    "plastic": {"type": "plastic", "reflectance": 0.5},
    "gold": {"type": "conductor", "metal": "Au"},
    "air": {"type": "none"},
}


def _unseen(x, y, z):
    """Things of every kind in a white box around x, y, z, that give no light."""
    dark = {"spectrum": 0, "visible": False}
    balls = [
        shape("sphere", name, center=[x + 0.008 * (i - 5), y, z], radius=0.003)
        for i, name in enumerate(MATERIALS)
    ]
    lamps = [
        shape("rectangle", corner=[x, y + 0.01, z], edges=[[0.01, 0, 0], [0, 0.01, 0]], emission=dark),
        shape("sphere", center=[x, y - 0.02, z], radius=0.003, emission=dark),
        shape("disk", center=[x, y, z + 0.02], normal=[0, 0, 1], radius=0.003, emission=dark),
        shape("grooved-sphere", center=[x, y, z - 0.02], radius=0.005, segments=8, grooves=1, emission=dark),
    ]
    nested = [
        shape("sphere", "glass", center=[x + 0.03, y + 0.03, z], radius=0.006),
        shape("sphere", "dense", center=[x + 0.03, y + 0.03, z], radius=0.003),
    ]
    # Left open below, so that a lamp without power next to a wall is not a special case.
    box = shape("box", "white", center=[x, y, z], size=[0.1, 0.1, 0.1])
    return [*balls, *lamps, *nested, box]


def _dark_emitters(x, y, z):
    place = {"position": [x, y, z], "spectrum": 0}
    return [
        {"type": "point", **place},
        {"type": "spot", **place, "look_at": [x, y, z - 1], "angle": 10},
        {"type": "directional", "direction": [0, 0, -1], "spectrum": 0},
        {"type": "directional", "direction": [0, 0, -1], "spectrum": 0, "angle": 1, "visible": False},
        {"type": "environment", "spectrum": 0},
    ]


def scene(shapes, camera, *, materials=(), emitters=(), film=(), render=(), aside=(1.2, 0.0, 0.0)):
    """The tables of a scene with these shapes; the unseen things are at `aside`, or nowhere if that is None."""
    unseen = _unseen(*aside) if aside else []
    dark = _dark_emitters(*aside) if aside else []
    return {
        "film": {"resolution": [SIZE, SIZE], "filter": "box", **dict(film)},
        "camera": camera,
        "render": {
            "sampler": "independent",
            "wavelength_range": MONOCHROME,
            "max_path_length": EDGES,
            "merging": {"radius": 0.05, "light_paths": 4},
            **dict(render),
        },
        "materials": {**MATERIALS, **dict(materials)},
        "shapes": [*shapes, *unseen],
        "emitters": [*emitters, *dark],
    }


# --- rooms --------------------------------------------------------------------------------------------------------

# Photons around a point of a sphere lie on a cap whose area is exactly pi r^2 for the chord r: merging has no bias.
VIEW = look([0.3, -0.3, 0.1], [-0.1, 0.6, 0.2])


def furnace(things=(), camera=VIEW, albedo=0.5, radiance=1.0, emission=None, **more):
    """A sphere of radius 1 that emits 1 - albedo and reflects albedo: radiance 1 everywhere in it, or as given."""
    emission = radiance * (1 - albedo) if emission is None else emission
    wall = shape("sphere", "wall", center=[0, 0, 0], radius=1, reverse=True, emission=emission)
    return _with_wall([wall, *things], camera, albedo, more)


def box_furnace(things=(), camera=VIEW, albedo=0.5, **more):
    """The same, a box of two units: its corners are where rays leak and photons are missing."""
    wall = shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True, emission=1 - albedo)
    return _with_wall([wall, *things], camera, albedo, more)


def integrating_sphere(lamp, albedo=0.5, camera=None, **more):
    """A sphere of radius 1 around `lamp`, shapes or emitters in its middle; the camera sees the wall alone."""
    wall = shape("sphere", "wall", center=[0, 0, 0], radius=1, reverse=True)
    camera = camera or look([0.3, -0.3, 0.1], [0.9, -0.9, 0.3], 90)
    emitters = [each for each in lamp if each["type"] == "point"]
    shapes = [each for each in lamp if each["type"] != "point"]
    return _with_wall([wall, *shapes], camera, albedo, {"emitters": emitters, **more})


def wall_radiance(lamp_radiance, lamp_radius, albedo=0.5):
    """Radiance of the wall of an integrating sphere of radius 1 around a black sphere that emits.

    The share F = r^2 of what leaves the wall hits the lamp, and F pi L is the irradiance that the lamp gives: the
    radiosity B = a (F pi L + (1 - F) B).
    """
    share = lamp_radius**2
    return albedo * share * lamp_radiance / (1 - albedo * (1 - share))


def _with_wall(shapes, camera, albedo, more):
    materials = {"wall": {"type": "diffuse", "reflectance": albedo}, **dict(more.pop("materials", ()))}
    return scene(shapes, camera, materials=materials, **more)


def moved(tables, scale=1.0, offset=(0.0, 0.0, 0.0)):
    """The same scene in other units, and in another place."""

    def place(key, value):
        if isinstance(value, dict):
            return {name: place(name, item) for name, item in value.items()}
        if key in POINTS:
            return [scale * x + o for x, o in zip(value, offset, strict=True)]
        if key == "edges":
            return [[scale * x for x in edge] for edge in value]
        if key in LENGTHS:
            return [scale * x for x in value] if isinstance(value, list) else scale * value
        return value

    def all_of(items):
        return [{key: place(key, value) for key, value in item.items()} for item in items]

    camera = {key: place(key, value) for key, value in tables["camera"].items()}
    return {**tables, "camera": camera, **{name: all_of(tables[name]) for name in ("shapes", "emitters")}}
