"""Emitters without a surface over a white plane, against closed forms and quadrature; and all methods with each other.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4. All scenes have one of each kind of
emitter, those not meant without power, so that they share their kernels.
"""

import math

import numpy as np
import OpenImageIO as oiio
import pytest
from rendering import (
    MONOCHROME,
    assert_mean,
    assert_same,
    assert_uniform,
    compile_tables,
    diffuse,
    look,
    radiance,
    shape,
)

DARK = {
    "point": {"type": "point", "position": [0, 0, 1], "spectrum": 0},
    "spot": {"type": "spot", "position": [0, 0, 1], "look_at": [0, 0, 0], "angle": 10, "spectrum": 0},
    "directional": {"type": "directional", "direction": [0, 0, -1], "spectrum": 0},
    "sun": {"type": "directional", "direction": [0, 0, -1], "angle": 1, "spectrum": 0, "visible": False},
    "environment": {"type": "environment", "spectrum": 0},
}
PLANE = shape("rectangle", "white", corner=[-0.01, -0.01, 0], edges=[[0.02, 0, 0], [0, 0.02, 0]])
HIDDEN = {"spectrum": 2, "visible": False}
CEILING = shape("rectangle", corner=[-0.5, -0.5, 2], edges=[[0, 1, 0], [1, 0, 0]], emission=HIDDEN)
SPECK = shape(
    "rectangle", corner=[0, 0, -1], edges=[[0, 1e-3, 0], [1e-3, 0, 0]], emission={**HIDDEN, "spectrum": 0}
)
# Out of sight: quadrics, which the plane's scenes have in common with the room's.
UNSEEN = shape("sphere", "white", center=[0, 0, -0.9], radius=1e-3)
EYE = look([0, -1, 0.02], [0, 0, 0], 1e-4)


@pytest.fixture(scope="module")
def sky(tmp_path_factory):
    """A latitude-longitude image with dark, bright and narrow parts: `(path, texels)`."""
    texels = np.random.default_rng(5).random((6, 12)) ** 3
    texels[0, 3] = texels[2, 7] = 20.0
    texels[3:, :5] = 0.0
    path = str(tmp_path_factory.mktemp("images") / "sky.exr")
    pixels = np.repeat(texels[..., None], 3, axis=2).astype(np.float32)
    output = oiio.ImageOutput.create(path)
    assert output.open(path, oiio.ImageSpec(12, 6, 3, "float"))
    assert output.write_image(pixels)
    output.close()
    return path, texels


@pytest.fixture(scope="module")
def lit(sky):
    """A function from emitters, shapes and more to a compiled scene that has every kind of emitter."""
    dark = [*DARK.values(), {"type": "environment", "image": sky[0], "scale": 0}]

    def build(emitters, shapes=(PLANE,), camera=EYE, reflectance=1.0, panel=SPECK, **render):
        render = {"sampler": "independent", "wavelength_range": MONOCHROME, "max_path_length": 2, **render}
        table = {
            "film": {"resolution": [16, 16], "filter": "box"},
            "camera": {"type": "pinhole", **camera},
            "render": render,
            "materials": {"white": diffuse(reflectance)},
            "shapes": [*shapes, panel, UNSEEN],
            "emitters": [*emitters, *dark],
        }
        return compile_tables(table)

    return build


def irradiance_of(lit, emitter, expected, precision=2.5e-3, iterations=256):
    """The irradiance at the origin is `expected`; a white plane shows it divided by pi."""
    compiled = lit([emitter])
    assert_uniform(radiance(compiled, iterations), expected / math.pi, precision, rounding=2e-4)


# --- closed forms -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("position", [(0, 0, 1.5), (1, 0.5, 0.3)])
def test_point(lit, position):
    """I cos / d^2."""
    distance = math.hypot(*position)
    emitter = {"type": "point", "position": position, "spectrum": 1, "intensity": 3}
    irradiance_of(lit, emitter, 3 * position[2] / distance**3, iterations=4)


def test_point_power(lit):
    """W in all directions, from 300 to 780 nm: here P / (4 pi 480 nm) in every direction."""
    emitter = {"type": "point", "position": [0, 0, 2], "spectrum": 5, "power": 100}
    irradiance_of(lit, emitter, 100 / (4 * math.pi * 480) / 4, iterations=4)


@pytest.mark.parametrize(("off_axis", "share"), [(5, 1.0), (15, None), (25, 0.0)])
def test_spot(lit, off_axis, share):
    """Bright within 10 degrees, dark beyond 20, a smooth step of the cosine between."""
    if share is None:
        low, high = (math.cos(math.radians(angle)) for angle in (20, 10))
        t = (math.cos(math.radians(off_axis)) - low) / (high - low)
        share = t * t * (3 - 2 * t)
    aside = 2 * math.tan(math.radians(off_axis))
    emitter = {"type": "spot", "position": [0, 0, 2], "look_at": [aside, 0, 0], "angle": 20, "falloff": 10}
    compiled = lit([{**emitter, "spectrum": 4}])
    assert np.allclose(radiance(compiled, 2).mean, share / math.pi, rtol=1e-4, atol=0)


def test_spot_power(lit):
    """A hard cone of 60 degrees has pi steradians."""
    emitter = {
        "type": "spot",
        "position": [0, 0, 2],
        "look_at": [0, 0, 0],
        "angle": 60,
        "spectrum": 1,
        "power": 100,
    }
    irradiance_of(lit, emitter, 100 / (math.pi * 480) / 4, iterations=4)


@pytest.mark.parametrize("angle", [0, 1, 40])
def test_sun(lit, angle):
    """Irradiance is across the light: the horizontal one is its cosine, whatever the size of the disk."""
    emitter = {
        "type": "directional",
        "direction": [1, 0.5, -2],
        "spectrum": 1,
        "irradiance": 5,
        "angle": angle,
    }
    irradiance_of(lit, emitter, 5 * 2 / math.sqrt(5.25))


def test_illuminance(lit):
    """A flat spectrum of 1 has 683.002 lm/W times the integral of ybar."""
    emitter = {"type": "directional", "direction": [0, 0, -1], "spectrum": 7, "illuminance": 2 * 72983.4866}
    irradiance_of(lit, emitter, 2.0, iterations=4)


@pytest.mark.parametrize("integrator", ["pt", "bpt", pytest.param("vcm", marks=pytest.mark.slow)])
def test_constant_environment_is_a_furnace(lit, integrator):
    """Whatever is white and convex cannot be seen."""
    ball = shape("sphere", "white", center=[0, 0, 0.2], radius=0.5)
    sky = {"type": "environment", "spectrum": 1, "luminance": 72983.4866}
    compiled = lit([sky], [ball], look([0, -2, 0.2], [0, 0, 0.2], 40), integrator=integrator)
    assert_mean(radiance(compiled, 64), 1.0, 2e-3)


def environment_irradiance(texels, turned, steps=720):
    """At the origin, by the midpoint rule over the upper hemisphere of a bilinear image turned around z."""
    z = (np.arange(steps) + 0.5) / steps
    azimuth = (np.arange(4 * steps) + 0.5) / (4 * steps) * 2 * np.pi
    angle = azimuth[None] + turned  # clockwise from y; turning the image counter-clockwise moves it back
    height, width = texels.shape
    x = (angle / (2 * np.pi) + 0.5) % 1.0 * width - 0.5
    y = np.arccos(z)[:, None] / np.pi * height - 0.5
    left, above = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = x - left, y - above
    rows = np.clip([above, above + 1], 0, height - 1)
    columns = np.array([left, left + 1]) % width
    upper = texels[rows[0], columns[0]] * (1 - fx) + texels[rows[0], columns[1]] * fx
    lower = texels[rows[1], columns[0]] * (1 - fx) + texels[rows[1], columns[1]] * fx
    values = upper * (1 - fy) + lower * fy
    return float((values * z[:, None]).mean() * 2 * np.pi)


@pytest.mark.parametrize("turned", [0, 70])
def test_environment_image(lit, sky, turned):
    emitter = {
        "type": "environment",
        "image": sky[0],
        "scale": 0.5,
        "transform": [{"rotate": [0, 0, 1, turned]}],
    }
    # The image is grey: its spectrum is that of D65 with the luminance of E, seen at one wavelength.
    compiled = lit([emitter])
    row = compiled.scene.emitters.records.array[compiled.scene.emitters.background]
    grey = sum(float(compiled.spectra[row[name], 0]) for name in ("spectrum", "green", "blue"))
    expected = 0.5 * grey * environment_irradiance(sky[1], math.radians(turned))
    assert_uniform(radiance(compiled, 512), expected / math.pi, 4e-3, rounding=1e-3)


def test_environment_image_lies_as_documented(lit, tmp_path):
    """Up is row 0, the middle is along y, right is to the right; a turn by the transform follows the right hand."""
    texels = np.zeros((8, 16, 3), np.float32)
    texels[3:5, 7:9] = 1.0  # ahead along y
    texels[3:5, 11:13] = 2.0  # a quarter to the right: along x
    texels[0] = 3.0  # up
    path = str(tmp_path / "marks.exr")
    output = oiio.ImageOutput.create(path)
    assert output.open(path, oiio.ImageSpec(16, 8, 3, "float"))
    assert output.write_image(texels)
    output.close()

    def seen(direction, transform=()):
        emitter = {"type": "environment", "image": path, "transform": list(transform)}
        compiled = lit([emitter], [PLANE], look([0, 0, 1], np.add([0, 0, 1], direction), 1e-3))
        row = compiled.scene.emitters.records.array[compiled.scene.emitters.background]
        grey = sum(float(compiled.spectra[row[name], 0]) for name in ("spectrum", "green", "blue"))
        return radiance(compiled, 2).mean.mean() / grey

    up = math.sqrt(0.5)
    assert seen([0, 1, 0]) == pytest.approx(1.0, abs=1e-3)
    assert seen([1, 0, 0]) == pytest.approx(2.0, abs=1e-3)
    assert seen([-1, 0, 0]) == seen([0, -1, 0]) == 0.0
    assert seen([0, 0, 1]) == pytest.approx(3.0, abs=1e-3)
    assert seen([0, 1, 0], [{"rotate": [0, 0, 1, 90]}]) == pytest.approx(2.0, abs=1e-3)
    assert seen([0, up, -up], [{"rotate": [1, 0, 0, -45]}]) == pytest.approx(1.0, abs=1e-3)


def test_what_is_not_visible_lights_but_is_not_seen(lit):
    sky = {"type": "environment", "spectrum": 1, "visible": False}
    compiled = lit([sky], [PLANE], look([0, 0, 1], [0, 0, 2], 60), panel=CEILING)
    assert radiance(compiled, 2).mean.max() == 0.0  # neither the sky nor the ceiling
    irradiance_of(lit, sky, math.pi)


# --- methods ------------------------------------------------------------------------------------------------------

ROOM = [
    shape("rectangle", "white", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]]),
    shape("sphere", "white", center=[0.3, 0.2, 0.4], radius=0.3),
]
VIEW = look([0, -3, 2], [0, 0, 0.2], 35)
LIGHTS = {
    "point": {"type": "point", "position": [-0.5, 0.3, 1.5], "spectrum": 2},
    "spot": {
        "type": "spot",
        "position": [-0.5, 0.3, 1.5],
        "look_at": [0.2, 0, 0],
        "angle": 40,
        "falloff": 15,
        "spectrum": 4,
    },
    "directional": {"type": "directional", "direction": [0.3, 0.2, -1], "spectrum": 1},
    "sun": {"type": "directional", "direction": [0.3, 0.2, -1], "spectrum": 1, "angle": 20},
    "environment": {"type": "environment", "spectrum": 0.5},
}


@pytest.fixture(scope="module")
def by_path_tracing(lit, sky):
    lights = lights_of(sky)
    return {name: radiance(room(lit, lights[name], "pt"), 768) for name in lights}


def lights_of(sky):
    image = {"type": "environment", "image": sky[0], "transform": [{"rotate": [0, 0, 1, 30]}]}
    lights = {name: [emitter] for name, emitter in LIGHTS.items()}
    return {**lights, "image": [image], "all": [*LIGHTS.values(), image]}


def room(lit, emitters, integrator):
    panel = CEILING if len(emitters) > 1 else {**CEILING, "emission": {**HIDDEN, "spectrum": 0}}
    settings = {"max_path_length": 4, "integrator": integrator, "seed": 7 if integrator == "pt" else 8}
    return lit(emitters, ROOM, VIEW, 0.6, panel, **settings)


def pairs():
    """Every kind of light by every method.

    Bidirectional path tracing has the techniques of the others but merging, which whole scenes with lights of all
    these kinds compare; so the others are slow.
    """
    pairs = [(integrator, name) for integrator in ("bpt", "lt", "vcm") for name in (*LIGHTS, "image", "all")]
    return [pytest.param(*pair, marks=() if pair[0] == "bpt" else pytest.mark.slow) for pair in pairs]


@pytest.mark.parametrize(("integrator", "name"), pairs())
def test_methods_agree(lit, sky, by_path_tracing, name, integrator):
    """Path tracing finds all that there is: every method does."""
    image = radiance(room(lit, lights_of(sky)[name], integrator), 768)
    assert_same(image, by_path_tracing[name], 1.2e-2)
