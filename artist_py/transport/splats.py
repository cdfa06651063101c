"""The light image: contributions to any pixel, kept per light subpath and added up in a fixed order."""

import math
from typing import NamedTuple

import numpy as np

from ..core.vector import lane
from ..jit import function

PROFILE_STEPS = 256  # samples of the filter per pixel


def splat_dtype(lanes, with_technique=False):
    """Layout of a splat of `lanes` wavelengths or channels; `with_technique` adds what images of techniques need."""
    technique = [("technique", "i4"), ("length", "i4"), ("weight", "f4")] if with_technique else []
    return np.dtype([("pixel", "i4"), ("value", "f4", lanes), *technique], align=True)


class ChosenPixel(NamedTuple):
    """A pixel under whose filter a film point lies; `index` is row-major in the window, negative for none."""

    index: int
    weight: float


@function
def choose_pixel(pixel_filter, film_x, film_y, u, crop):
    """One of the pixels whose filter covers a film point, drawn by the filter's value; the weight makes up for that.

    Every pixel's filter integrates to 1, so that the expectation is the filtered light image.
    """
    x0, x1, y0, y1 = crop
    column, weight_x, u = _choose(pixel_filter.profile, film_x, u)
    row, weight_y, u = _choose(pixel_filter.profile, film_y, u)
    if column < x0 or column >= x1 or row < y0 or row >= y1:
        return ChosenPixel(-1, 0.0)
    return ChosenPixel((row - y0) * (x1 - x0) + column - x0, weight_x * weight_y)


@function
def _choose(profile, x, u):
    """`(pixel, weight, remaining number)` along one axis."""
    reach = (profile.shape[0] - 1) / (2.0 * PROFILE_STEPS)
    first, last = math.ceil(x - 0.5 - reach), math.floor(x - 0.5 + reach)
    total = 0.0
    for pixel in range(first, last + 1):
        total += abs(_value(profile, x - pixel - 0.5))
    target, chosen, value = u * total, first, 0.0
    for pixel in range(first, last + 1):
        f = _value(profile, x - pixel - 0.5)
        if f != 0.0 and target >= 0.0:
            chosen, value = pixel, f
            u = min(target / abs(f), 1.0 - 2.0**-53)
            target -= abs(f)
    return chosen, math.copysign(total, value), u


@function
def _value(profile, offset):
    """The filter at `offset` pixels from its centre, linear between samples."""
    position = (offset * PROFILE_STEPS) + 0.5 * (profile.shape[0] - 1)
    index = math.floor(position)
    if index < 0 or index >= profile.shape[0] - 1:
        return 0.0
    fraction = position - index
    return profile[index] * (1.0 - fraction) + profile[index + 1] * fraction


@function
def store_splat(tables, pool, thread, record, pixel, value, technique, length, weight):
    """Append a splat to those of the light subpath `record`; room has been made sure of.

    Its technique, the number of edges of its path and its MIS weight are kept for the `TechniqueTables`, if there are
    any.
    """
    row = pool.ends[thread, 0]
    pool.ends[thread, 0] = row + 1
    splat = pool.records[row]
    splat.pixel = pixel
    for i in range(len(splat.value)):
        splat.value[i] = lane(value, i)
    _store_technique(tables, splat, technique, length, weight)
    record.n_splats += 1


@function
def _store_technique(tables, splat, technique, length, weight):
    if tables is None:
        return
    splat.technique = technique
    splat.length = length
    splat.weight = weight
