"""Whatever is done to a good scene, reading it gives a graph or a SceneError, never anything else."""

import copy
import json

from hypothesis import example, given, settings
from hypothesis import strategies as st

from artist_py.errors import SceneError
from artist_py.scene import graph
from artist_py.scene.identity import settings as effective_settings
from artist_py.scene.reader import read_scene_text
from artist_py.scene.transforms import matrix

PLACE = {"transform": [{"translate": [1, 2, 3]}, {"rotate": [0, 0, 1, 30]}, {"scale": [1, 2, 3]}]}
SPECTRA = [
    0.5,
    "D65",
    {"rgb": [0.1, 0.2, 0.3], "scale": 0.5},
    {"blackbody": 5000},
    {"gaussian": [550, 20], "peak": 0.5},
    {"lines": [[546.1, 1], [577, 2]], "width": 0.5},
    {"wavelengths": [400, 500, 600], "values": [0.1, 0.2, 0.3]},
    {"file": "green.csv", "column": 2},
    {"illuminant": "A"},
]
GOOD = {
    "film": {
        "resolution": [64, 32],
        "crop": [0, 8, 0, 8],
        "filter": "tent",
        "filter_radius": 1,
        "white_luminance": 100,
    },
    "camera": {
        "type": "thin-lens",
        "position": [0, -4, 0.2],
        "look_at": [0, 0, 0],
        "up": [0, 0, 1],
        "field_of_view": 30,
        "aperture_radius": 0.1,
        "focus_distance": 4,
        "blades": 6,
    },
    "render": {
        "integrator": "pt",
        "iterations": 4,
        "time": 10,
        "seed": 3,
        "wavelength_range": [380, 780],
        "merging": {"radius": 0.01, "alpha": 0.7},
    },
    "spectra": {f"s{i}": value for i, value in enumerate(SPECTRA)} | {"again": "s3"},
    "materials": {
        "white": {"type": "diffuse", "reflectance": {"rgb": [0.1, 0.2, 0.3]}},
        "matte": {"type": "oren-nayar", "reflectance": "s2", "roughness": 30, "two_sided": False},
        "gloss": {"type": "phong", "reflectance": 0.2, "specular": {"rgb": [0.7, 0.6, 0.5]}, "exponent": 90},
        "coated": {"type": "plastic", "reflectance": "s2", "ior": 1.6},
        "tiles": {"type": "diffuse", "reflectance": {"checkerboard": [0.2, "s2"], "repeat": [3, 4.5]}},
        "photo": {
            "type": "mirror",
            "reflectance": {"image": "a.png", "scale": 0.5, "repeat": [2, 1], "interpolation": "nearest"},
        },
        "gold": {"type": "conductor", "metal": "Au"},
        "metal": {"type": "conductor", "eta": 0.2, "k": {"wavelengths": [400, 700], "values": [3, 4]}},
        "glass": {"type": "dielectric", "ior": {"sellmeier": [[1.03, 0.006], [0.23, 0.02]]}, "priority": 2},
        "water": {"type": "dielectric", "ior": {"cauchy": [1.32, 0.003]}},
        "pane": {"type": "thin-dielectric", "ior": "N-BK7"},
        "air": {"type": "none"},
    },
    "objects": {
        "lamp": {
            "shapes": [{"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1, "emission": 1}]
        }
    },
    "shapes": [
        {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass", "name": "ball"} | PLACE,
        {"type": "rectangle", "corner": [0, 0, 0], "edges": [[1, 0, 0], [0, 1, 0]], "material": "white"},
        {"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], "material": "matte", "reverse": True},
        {
            "type": "cylinder",
            "base": [0, 0, 0],
            "top": [0, 0, 1],
            "radius": 1,
            "caps": False,
            "material": "gold",
        },
        {"type": "cone", "base": [0, 0, 0], "apex": [0, 0, 1], "radius": 1, "material": "metal"},
        {
            "type": "grooved-sphere",
            "center": [0, 0, 0],
            "radius": 1,
            "depth": 0.1,
            "grooves": 4,
            "material": "pane",
        },
        {"type": "mesh", "file": "a.ply", "smooth": True, "material": "air"},
        {
            "type": "disk",
            "center": [0, 0, 3],
            "normal": [0, 0, -1],
            "radius": 1,
            "emission": {"spectrum": "D65", "luminance": 5000, "sides": "both"},
        },
    ],
    "instances": [
        {"object": "lamp", "material": "white", "name": "left", "transform": [{"scale": 2}]},
        {"object": "lamp", "transform": [{"look_at": {"from": [1, 1, 1], "to": [0, 0, 0], "up": [0, 0, 1]}}]},
        {
            "object": "lamp",
            "transform": [{"matrix": [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]}],
        },
    ],
}


class Literal(str):
    """TOML that stands as it is."""

    __slots__ = ()


def toml(value):
    """A value as TOML; tables are inline."""
    if isinstance(value, Literal):
        return str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str | bool):
        return json.dumps(value)
    return str(value)


def document(tables):
    """A scene file."""
    return "".join(f"{json.dumps(key)} = {toml(value)}\n" for key, value in tables.items())


def places_of(value, path=()):
    """The paths of all values in a tree."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield (*path, key)
        yield from places_of(item, (*path, key))


NUMBERS = [
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e400",
    "-1e400",
    "1e308",
    "-1e308",
    "1e-320",
    "-0.0",
    "0",
    "1",
    "-1",
    "2.5",
]
NUMBERS += [
    "0x" + "f" * 400,
    "9" * 4000,
    "-9223372036854775809",
    "1e18",
    "1e19",
    "0.1",
    "3",
    "1979-05-27",
    "07:32:00",
]
WORDS = [
    "",
    "white",
    "lamp",
    "ball",
    "s2",
    "again",
    "D65",
    "N-BK7",
    "sphere",
    "box",
    "diffuse",
    "é\u0000",
    "x" * 300,
]
KEYS = sorted(
    {name for cls in graph.TYPE_NAMES for name in cls.__dataclass_fields__} | {"rgb", "file", "spectrum", ""}
)

leaves = st.one_of(
    st.sampled_from(NUMBERS).map(Literal),
    st.sampled_from(WORDS),
    st.booleans(),
    st.integers(-(10**9), 10**9),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=8),
)
values = st.one_of(
    leaves,
    st.recursive(
        leaves,
        lambda item: st.lists(item, max_size=4) | st.dictionaries(st.sampled_from(KEYS), item, max_size=3),
    ),
    st.builds(lambda: [0.5] * 3000),
    st.builds(lambda: [[1, 2] for _ in range(1000)]),
    st.builds(lambda: {f"k{i}": i for i in range(500)}),
)


def parent_of(tables, path):
    """What holds the value of a path."""
    for key in path[:-1]:
        tables = tables[key]
    return tables


def mutate(tables, data):
    """Change, delete, rename, copy or add one value somewhere."""
    path = data.draw(st.sampled_from(list(places_of(tables))))
    parent, key = parent_of(tables, path), path[-1]
    action = data.draw(st.sampled_from(["change", "change", "change", "delete", "rename", "copy", "add"]))
    if action == "change":
        parent[key] = data.draw(values)
    elif action == "delete":
        del parent[key]
    elif action == "copy":
        other = data.draw(st.sampled_from(list(places_of(tables))))
        parent[key] = copy.deepcopy(parent_of(tables, other)[other[-1]])
    elif isinstance(parent, dict):
        name = data.draw(st.sampled_from(KEYS) | st.text(max_size=6))
        parent[name] = parent.pop(key) if action == "rename" else data.draw(values)
    else:
        parent.append(data.draw(values))


def check_problems(problems):
    """Each is one line that can be read."""
    assert problems
    for problem in problems:
        assert "\n" not in str(problem)
        assert len(problem.message) < 1500


def check(text, overrides=()):
    """Read, and use what was read; a SceneError must have problems, each in one line."""
    try:
        scene = read_scene_text(text, overrides=overrides)
    except SceneError as error:
        check_problems(error.problems)
        return None
    json.dumps(effective_settings(scene), allow_nan=False)
    for item in (*scene.shapes, *scene.instances):
        assert abs(matrix(item.transform)[3, 3]) == 1.0
    return scene


def test_the_good_scene_is_good():
    scene = check(document(GOOD))
    assert scene is not None
    assert len(scene.shapes) == 8


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_changed_scenes(data):
    tables = copy.deepcopy(GOOD)
    for _ in range(data.draw(st.integers(1, 4))):
        mutate(tables, data)
    check(document(tables))


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(sorted(".".join(map(str, path)) for path in places_of(GOOD))), values)
def test_overrides(key, value):
    check(document(GOOD), {key: toml(value)})
    check(document(GOOD), {key: value})
    check(document(GOOD | {"film": 3, "shapes": [4]}), {key: value})


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=20), st.text(max_size=20))
@example("a = 1\nb", "1")
@example("", "")
@example("render.seed", "1\nx = 2")
@example("render.seed", "[" * 3000)
def test_overrides_of_any_text(key, value):
    check(document(GOOD), {key: value})


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_changed_characters(data):
    text = document(GOOD)
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 40)))
    new = data.draw(st.text(max_size=6) | st.text("[]{}\"'=,.#\\\n \t1ex_", max_size=6))
    check(text[:start] + new + text[end:])


@settings(max_examples=100, deadline=None)
@given(st.text())
@example("[" * 10_000)
@example("a." * 10_000 + "b = 1")
@example("x = " + "[" * 300 + "]" * 300)
@example("x = " + "{a = " * 300 + "1" + "}" * 300)
@example("[[shapes]]\n" * 1000)
@example("\ufeff[film]")
def test_any_text(text):
    check(text)
