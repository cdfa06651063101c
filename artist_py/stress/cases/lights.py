"""Lamps: tiny, all around, many, bright, dim, on surfaces; and paths of a thousand edges."""

import math

from artist_py.stress.case import Case, Radiance, Sane
from artist_py.stress.meshes import write_graded_sphere
from artist_py.stress.scenes import (
    box_furnace,
    furnace,
    integrating_sphere,
    look,
    scene,
    shape,
    wall_radiance,
)


def ball_lamp(radius):
    """A sphere that makes the wall of an integrating sphere have radiance 1."""
    return shape("sphere", center=[0, 0, 0], radius=radius, emission=1 / wall_radiance(1, radius))


def point_lamps(count, decades=10):
    """Points within 0.001 of the middle, their powers spread over `decades`: the wall has radiance 1.

    Each has a twin opposite of it, so that the irradiance of the wall differs from that of one point by 1e-6.
    """
    intensities = [10 ** (-decades * i / (count // 2 - 1)) for i in range(count // 2)]
    scale = math.pi / (2 * sum(intensities))  # a / (1 - a) E / pi = 1, E the sum of all intensities
    lamps = []
    for i, intensity in enumerate(intensities):
        azimuth, z = 2.39996 * i, 2 * (i + 0.5) / len(intensities) - 1  # a Fibonacci sphere
        r = math.sqrt(1 - z * z)
        for sign in (1e-3, -1e-3):
            position = [sign * r * math.cos(azimuth), sign * r * math.sin(azimuth), sign * z]
            lamps.append({"type": "point", "position": position, "spectrum": scale * intensity})
    return lamps


def on_floor(height, **lamp):
    """A point `height` above the floor of a grey box."""
    walls = shape("box", "grey", min=[-1, -1, -1], max=[1, 1, 1], reverse=True)
    lamps = [{"type": "point", "position": [0.1, 0.2, height - 1], "spectrum": 1, **lamp}]
    return scene([walls], look([0, -0.9, 0], [0, 1, 0.3]), emitters=lamps, render={"max_path_length": 5})


MESH_WALL = shape("mesh", "grey", file="wall.ply", smooth=False, emission={"spectrum": 0.5, "sides": "both"})
LONG = {"max_path_length": 1000, "roulette_length": 10**6}
LONG_VALUE = (1 - 0.999**1000) * 1.0

CASES = (
    Case(
        "furnace",
        "Light from everywhere: all techniques at work, and none may count twice.",
        furnace(),
        Radiance(1),
    ),
    Case(
        "furnace-reference",
        "The same, up to six edges, by brute force in plain Python.",
        furnace(aside=None, film={"resolution": [3, 3]}, render={"max_path_length": 6}),
        Radiance(1 - 0.5**6),
        integrators=("reference",),
        precision=0.03,
        most=64,
    ),
    Case(
        "furnace-box",
        "The same with flat walls: edges, where rays leak.",
        box_furnace(render={"merging": {"radius": 0.005, "light_paths": 16}}),
        Radiance(1, bias={"ppm": 0.005, "bpm": 0.005}),
        why="Merging alone misses the photons that lie beyond an edge: within a radius r of the edges of walls of size "
        "2 it loses 0.21 of its light, 0.42 r in all.",
    ),
    Case(
        "lamp-1e-6",
        "A lamp whose radius is 1e-6 of the scene's: found by none but those who aim.",
        integrating_sphere([ball_lamp(1e-6)]),
        Radiance(1),
    ),
    Case(
        "lamp-0.1",
        "A lamp of a tenth of the scene's size.",
        integrating_sphere([ball_lamp(0.1)]),
        Radiance(1),
    ),
    Case(
        "points-1e3",
        "A thousand lamps, with powers over ten orders of magnitude.",
        integrating_sphere(point_lamps(1000)),
        Radiance(1),
    ),
    Case(
        "points-1e5",
        "A hundred thousand lamps, with powers over ten orders of magnitude.",
        integrating_sphere(point_lamps(100_000)),
        Radiance(1),
        quick=False,
        seconds=900.0,
    ),
    Case(
        "triangles-lit-1e5",
        "A wall of 1e5 lamps, triangles whose areas, and so whose powers, span ten orders of magnitude.",
        scene([MESH_WALL], look([0.3, -0.3, 0.1], [-0.1, 0.6, 0.2])),
        Radiance(1),
        files=(("wall.ply", write_graded_sphere, (500, 100, 1e-10)),),
    ),
    Case(
        "radiance-1e30",
        "Lamps as bright as numbers of 32 bits get.",
        furnace(radiance=1e30),
        Radiance(1e30),
    ),
    Case("radiance-1e-30", "Lamps as dim as they get.", furnace(radiance=1e-30), Radiance(1e-30)),
    Case(
        "path-length-1000",
        "A thousand reflections of 0.999: weights of long paths, and stores that grow.",
        furnace(albedo=0.999, film={"resolution": [2, 2]}, render=LONG),
        Radiance(LONG_VALUE),
        integrators=("pt", "lt", "ppm", "bpm"),
        precision=0.03,
        least=256,
        rounding=1e-4,
        why="A thousand times the rounding of the albedo to float32.",
    ),
    Case(
        "path-length-1000-connected",
        "The same with half a million connections for each pair of subpaths.",
        furnace(albedo=0.999, film={"resolution": [1, 1]}, render=LONG),
        Radiance(LONG_VALUE),
        integrators=("bpt", "vcm"),
        rounding=1e-4,
        why="As of path-length-1000.",
        quick=False,
        seconds=900.0,
    ),
    Case(
        "point-near-floor",
        "A point 1e-6 above the floor: inverse squares of nothing.",
        on_floor(1e-6),
        Sane(),
        why="Half of the light falls on a spot of some 1e-6, whose glow is as good as another point: no path "
        "from the eye finds it, and light paths do.",
    ),
    Case(
        "point-on-floor",
        "A point exactly on the floor.",
        on_floor(0.0),
        Sane(),
        why="Which side of the floor the point is on is a matter of rounding.",
    ),
)
