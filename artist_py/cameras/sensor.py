"""The camera seen from the scene: where light from a point arrives on the film, and with which density."""

import math
from typing import NamedTuple

from ..core.vector import Vec3, dot
from ..jit import function
from .lens import aperture_area, is_in_aperture, sample_aperture


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
    lens_area: float  # times the cosine at the lens, render-space units^2: the reciprocal of the density; 0: a pinhole


@function
def connect_to_lens(camera, n_pixels, point, u, v):
    """The `SensorPoint` of `point`; (u, v) choose the point on the lens. `n_pixels` is the number of eye subpaths."""
    lens_point = _lens_point(camera.lens, camera, u, v)
    towards = lens_point - point
    depth = -dot(towards, camera.forward)
    if depth <= 0.0:
        return SensorPoint(lens_point, towards, 0.0, 0.0, 0.0, 0.0, 0.0)
    film = _film_direction(camera.lens, camera, lens_point, towards * (-1.0 / depth))
    x, y = film_position(camera, film)
    cos_theta = depth / math.sqrt(dot(towards, towards))
    density = 1.0 / (_pixel_area(camera) * cos_theta * cos_theta * cos_theta)
    area = cos_theta * _lens_area(camera.lens)
    return SensorPoint(lens_point, towards, x, y, density / n_pixels, density, area)


class LensHit(NamedTuple):
    """Where light has met the lens; `t` is negative where it has not."""

    t: float  # along the ray
    film_x: float  # pixels
    film_y: float
    importance: float  # the value of one pixel per flux: W_e of (1.23)
    cos_theta: float
    area: float  # of the lens, render-space units^2


@function
def hit_lens(camera, origin, direction):
    """The `LensHit` of light along a ray of unit direction, which only hits the front of the lens; not for pinholes.

    The film point is that whose image the focus plane has where the ray comes from (theory 1.6).
    """
    cos_theta = -dot(direction, camera.forward)
    t = -1.0
    if cos_theta > 0.0:
        t = dot(origin - camera.position, camera.forward) / cos_theta
    if t > 0.0:
        point = origin + direction * t
        offset = (point - camera.position) * (1.0 / camera.lens.radius)
        x = dot(offset, camera.right) / math.sqrt(dot(camera.right, camera.right))
        y = dot(offset, camera.down) / math.sqrt(dot(camera.down, camera.down))
        if is_in_aperture(camera.lens, x, y):
            film = _film_direction(camera.lens, camera, point, direction * (-1.0 / cos_theta))
            film_x, film_y = film_position(camera, film)
            area, pixel = aperture_area(camera.lens), _pixel_area(camera)
            importance = 1.0 / (pixel * area * cos_theta * cos_theta * cos_theta * cos_theta)
            return LensHit(t, film_x, film_y, importance, cos_theta, area)
    return LensHit(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@function
def _pixel_area(camera):
    """Area of a pixel at distance 1 along the optical axis."""
    return math.sqrt(dot(camera.right, camera.right) * dot(camera.down, camera.down))


@function
def _lens_area(lens):
    if lens is None:
        return 0.0
    return aperture_area(lens)


@function
def projected_lens_area(camera, direction):
    """Area of the lens as it is seen along the unit `direction` into the scene, render-space units^2; 0: a pinhole."""
    return dot(direction, camera.forward) * _lens_area(camera.lens)


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
    return 1.0 / (n_pixels * _pixel_area(camera) * cos_theta * cos_theta * cos_theta)


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
