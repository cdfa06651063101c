"""Scenes written in tests as Python values, rendered small, and compared with what they should be.

Most scenes are *monochrome*: their wavelengths fill one bin of 1 nm, where the sensor is constant, so that an image is
a radiance without any noise of colour. Comparisons allow for the measured standard error and nothing else but
rounding; each states how precise it has to be, so that noise cannot hide a fault.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from scipy import stats

import artist_py
from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.stress.toml import to_toml

FALSE_ALARM = 1e-4  # probability that one comparison fails by chance
ROUNDING = 1e-5  # relative; long paths carry float32
WAVELENGTH = 550
MONOCHROME = [WAVELENGTH, WAVELENGTH + 1]
GREEN = 1


# --- scenes -------------------------------------------------------------------------------------------------------


def compile_tables(table):
    """A `CompiledScene` of the tables of a scene file."""
    return compile_scene(read_scene_text(to_toml(table)))


def scene(shapes=(), *, emitters=(), materials=(), objects=(), instances=(), camera=None, film=(), render=()):
    """A `CompiledScene`. Absent settings are those of these tests, not those of the renderer.

    `shapes` is a list of tables as in a scene file, `objects` maps names to such lists; `materials` maps names to
    tables.
    """
    table = {
        "film": {"resolution": [16, 16], "filter": "box", **dict(film)},
        "camera": {"type": "pinhole", **(camera or look([0, 0, 0], [0, 1, 0]))},
        "render": {"sampler": "independent", "wavelength_range": MONOCHROME, **dict(render)},
        "materials": dict(materials),
        "objects": {name: {"shapes": items} for name, items in dict(objects).items()},
        "shapes": list(shapes),
        "instances": list(instances),
        "emitters": list(emitters),
    }
    return compile_tables(table)


def with_render(compiled, **settings):
    """The same compiled scene with other settings of rendering, such as the seed, that its tables do not depend on."""
    render = dataclasses.replace(compiled.graph.render, **settings)
    return dataclasses.replace(compiled, graph=dataclasses.replace(compiled.graph, render=render))


def look(position, look_at, field_of_view=45.0, **more):
    """A pinhole camera; `up` is z unless that is where it looks."""
    view = np.subtract(look_at, position)
    is_upright = math.hypot(view[0], view[1]) < 1e-6 * abs(view[2])
    up = [0, 1, 0] if is_upright else [0, 0, 1]
    return {"position": position, "look_at": look_at, "up": up, "field_of_view": field_of_view, **more}


def shape(kind, material=None, **keys):
    """A shape's table."""
    return {"type": kind, **({"material": material} if material else {}), **keys}


def diffuse(reflectance):
    """A diffuse material's table."""
    return {"type": "diffuse", "reflectance": reflectance}


# --- images -------------------------------------------------------------------------------------------------------


class Image(NamedTuple):
    """A mean image and the variance of that mean, of the same shape."""

    mean: np.ndarray
    variance: np.ndarray


def render(compiled, iterations=16, **settings):
    """The `RenderResult`, on one thread: tests run side by side, and small images take longer on two."""
    return artist_py.render(compiled, **{"iterations": iterations, "threads": 1, **settings})


def radiance(compiled, iterations=16, **settings):
    """`Image` (h, w) of a monochrome scene, W m^-2 sr^-1 nm^-1."""
    film = render(compiled, iterations, aovs=("variance",), **settings).film
    assert film.rejected == ()
    response = compiled.spectra[GREEN].sum(dtype=float)
    return Image(film.rgb[..., GREEN] / response, film.variance[..., GREEN] / response**2)


# --- comparisons --------------------------------------------------------------------------------------------------


def assert_equals(mean, error, expected, precision, samples=math.inf, rounding=ROUNDING):
    """`mean` is `expected` as far as its standard `error`, which has to be below `precision`, relative, can tell.

    `samples` is how many values the error was estimated from, where these are few; `rounding` is the relative deviation
    that would not be a fault.
    """
    assert error <= precision * abs(expected), f"too noisy: {error / expected:.2g}, expected {precision:.2g}"
    allowed = stats.t.isf(0.5 * FALSE_ALARM, samples - 1) * error + rounding * abs(expected)
    assert abs(mean - expected) <= allowed, (
        f"{mean:.7g} instead of {expected:.7g}: off by {mean / expected - 1:.2g}, error {error / expected:.2g}"
    )


def assert_sample_mean(values, expected, precision, rounding=ROUNDING):
    """Independent samples of one distribution have the mean `expected`."""
    values = np.ravel(values)
    error = values.std(ddof=1) / math.sqrt(values.size)
    assert_equals(values.mean(), error, expected, precision, values.size, rounding)


def assert_uniform(image, expected, precision, rounding=ROUNDING):
    """Every pixel has the expectation `expected`: their mean and spread tell how near it is."""
    assert_sample_mean(image.mean, expected, precision, rounding)


def assert_mean(image, expected, precision):
    """The mean over the image is `expected`, by the pixels' own variances."""
    assert_equals(image.mean.mean(), math.sqrt(image.variance.sum()) / image.mean.size, expected, precision)


def assert_same(image, other, precision):
    """Two independent images have the same expectation everywhere: chi-squared over pixels, and their means."""
    difference, variance = image.mean - other.mean, image.variance + other.variance
    error = math.sqrt(variance.sum()) / variance.size
    middle = 0.5 * (image.mean + other.mean).mean()
    assert_equals(middle + difference.mean(), error, middle, precision)
    z_squared = difference**2 / np.maximum(variance, (ROUNDING * middle) ** 2)
    p = stats.chi2.sf(z_squared.sum(), z_squared.size)
    assert p > FALSE_ALARM, f"p = {p:.2g}; worst {math.sqrt(z_squared.max()):.1f} sigma"
