"""The camera seen from the scene: where light from a point arrives on the film, and with which density."""

import math
from typing import NamedTuple

from ..core.vector import Vec3, dot
from ..jit import function
from .lens import sample_aperture


class SensorPoint(NamedTuple):
    """A connection to the camera; `pdf_solid_angle` is 0 where the film does not see it.

    `pdf_solid_angle` is the density of camera rays into the direction of the point, sr^-1, over the whole window of
    pixels (theory 1.22), `importance` the value of one pixel per radiance and projected solid angle, sr^-1 (1.23).
    """

    position: Vec3  # on the lens
    towards: Vec3  # from the point to the lens, not unit
    film_x: float  # pixels
    film_y: float
    pdf_solid_angle: float
    importance: float


@function
def connect_to_lens(camera, n_pixels, point, u, v):
    """The `SensorPoint` of `point`; (u, v) choose the point on the lens. `n_pixels` is the number of eye subpaths."""
    lens_point = _lens_point(camera.lens, camera, u, v)
    towards = lens_point - point
    depth = -dot(towards, camera.forward)
    if depth <= 0.0:
        return SensorPoint(lens_point, towards, 0.0, 0.0, 0.0, 0.0)
    film = _film_direction(camera.lens, camera, lens_point, towards * (-1.0 / depth))
    x, y = film_position(camera, film)
    cos_theta = depth / math.sqrt(dot(towards, towards))
    pixel_area = math.sqrt(dot(camera.right, camera.right) * dot(camera.down, camera.down))
    density = 1.0 / (pixel_area * cos_theta * cos_theta * cos_theta)
    return SensorPoint(lens_point, towards, x, y, density / n_pixels, density)


@function
def film_position(camera, direction):
    """Pixel coordinates of a direction that has length 1 along the optical axis."""
    offset = direction - camera.corner
    x = dot(offset, camera.right) / dot(camera.right, camera.right)
    return x, dot(offset, camera.down) / dot(camera.down, camera.down)


@function
def pdf_camera_direction(camera, n_pixels, direction):
    """Density of camera rays into a unit direction, sr^-1, over the whole window (1.22)."""
    cos_theta = dot(direction, camera.forward)
    pixel_area = math.sqrt(dot(camera.right, camera.right) * dot(camera.down, camera.down))
    return 1.0 / (n_pixels * pixel_area * cos_theta * cos_theta * cos_theta)


@function
def _lens_point(lens, camera, u, v):
    if lens is None:
        return camera.position
    x, y = sample_aperture(lens, u, v)
    right = camera.right * (lens.radius * x / math.sqrt(dot(camera.right, camera.right)))
    down = camera.down * (lens.radius * y / math.sqrt(dot(camera.down, camera.down)))
    return camera.position + right + down


@function
def _film_direction(lens, camera, lens_point, direction):
    """Direction through the lens centre of the film point that a ray leaving `lens_point` in `direction` belongs to."""
    if lens is None:
        return direction
    return direction + (lens_point - camera.position) * (1.0 / lens.focus_distance)
