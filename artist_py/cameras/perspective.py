"""Perspective cameras: from a film point to a ray."""

import math

from ..core.frame import normalize
from ..core.vector import dot
from ..geometry.surface import largest, offset_position
from ..jit import function
from .lens import through_lens


@function
def filter_offset(offsets, weights, u):
    """`(offset from the pixel centre in pixels, weight)` of one axis of the reconstruction filter."""
    entries = offsets.shape[0] - 1
    scaled = u * entries
    index = min(int(scaled), entries - 1)
    fraction = scaled - index
    return offsets[index] * (1.0 - fraction) + offsets[index + 1] * fraction, _weight(weights, index)


@function
def _weight(weights, index):
    if weights is None:
        return 1.0
    return weights[index]


@function
def sample_film(pixel_filter, x, y, u, v):
    """Film point for pixel (x, y) and the sample's weight: importance sampling of the filter (Ernst et al. 2006)."""
    dx, weight_x = filter_offset(pixel_filter.offsets, pixel_filter.weights, u)
    dy, weight_y = filter_offset(pixel_filter.offsets, pixel_filter.weights, v)
    return x + 0.5 + dx, y + 0.5 + dy, weight_x * weight_y


@function
def camera_ray(camera, film_x, film_y, u, v):
    """`(point on the lens, origin, unit direction)` through a film point in pixels, row 0 on top.

    The ray begins just before the point on the lens, so that the eye may lie on a surface, or nearer to the scene where
    the camera is far from it.
    """
    direction = camera.corner + camera.right * film_x + camera.down * film_y
    lens_point, direction = through_lens(camera.lens, camera, direction, u, v)
    direction = normalize(direction)
    start = offset_position(lens_point, direction, largest(lens_point), direction)
    return lens_point, _start_at_sphere(camera.clip, start, direction), direction


@function
def _start_at_sphere(radius, origin, direction):
    """Where the ray enters the sphere around the scene: float32 could not tell its points apart from far away."""
    if radius is None:
        return origin
    along = dot(origin, direction)
    closest = origin - direction * along
    half_chord_squared = radius * radius - dot(closest, closest)
    if along > 0.0 or half_chord_squared <= 0.0:
        return origin
    return closest - direction * math.sqrt(half_chord_squared)
