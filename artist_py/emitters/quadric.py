"""Emitting exact shapes: spheres by the cone that they subtend, all others by area in their canonical frame."""

import math

from ..core.affine import load_vec3
from ..core.frame import frame_around, normalize, to_world
from ..core.vector import dot, vec3
from ..core.warp import square_to_cone, square_to_sphere
from ..geometry.quadrics import pdf_quadric_area, sample_quadric
from ..geometry.surface import extent_of
from ..jit import function
from .area import no_emitter_point, solid_angle_density
from .types import EmitterPoint

# A reference this near to the sphere lies on it, within rounding, and must not be taken for outside.
ON_SPHERE = 1.0 - 1e-9


@function
def _cone_of_sphere(emitter, reference):
    """`(axis to the centre, distance squared, 1 - cos of the half angle)`; the last is 0 from inside."""
    axis = load_vec3(emitter.origin) - reference
    distance_squared = dot(axis, axis)
    sin_squared = emitter.radius * emitter.radius / distance_squared
    if not sin_squared < ON_SPHERE:
        return axis, distance_squared, 0.0
    return axis, distance_squared, sin_squared / (1.0 + math.sqrt(1.0 - sin_squared))


@function
def sample_sphere(needed, emitter, reference, u, v):
    """Point of a sphere, uniform in the cone it subtends (Shirley, Wang and Zimmerman 1996); by area from inside."""
    if needed is None:
        return no_emitter_point()
    axis, distance_squared, one_minus_cos = _cone_of_sphere(emitter, reference)
    centre = load_vec3(emitter.origin)
    if one_minus_cos == 0.0:
        outward = square_to_sphere(u, v)
        position = centre + outward * emitter.radius
        density = solid_angle_density(1.0 / emitter.area, reference, position, outward)
    else:
        distance = math.sqrt(distance_squared)
        direction = square_to_cone(u, v, one_minus_cos)
        sin_squared = direction.x * direction.x + direction.y * direction.y
        half_chord = math.sqrt(max(0.0, emitter.radius * emitter.radius - distance_squared * sin_squared))
        along = distance * direction.z - half_chord
        outward = normalize(to_world(frame_around(axis * (1.0 / distance)), direction) * along - axis)
        position = centre + outward * emitter.radius
        density = 1.0 / (2.0 * math.pi * one_minus_cos)
    size = vec3(emitter.radius, 0.0, 0.0)
    return EmitterPoint(position, outward * emitter.flip, density, extent_of(position, size, size))


@function
def pdf_sphere(needed, emitter, reference, position, normal):
    """Density, sr^-1 at `reference`, of `sample_sphere` finding `position`."""
    if needed is None:
        return 0.0
    _, _, one_minus_cos = _cone_of_sphere(emitter, reference)
    if one_minus_cos == 0.0:
        return solid_angle_density(1.0 / emitter.area, reference, position, normal)
    return 1.0 / (2.0 * math.pi * one_minus_cos)


@function
def sample_quadric_emitter(needed, emitter, quadrics, reference, u, v):
    """Point of any exact shape, uniform by area in its canonical frame."""
    if needed is None:
        return no_emitter_point()
    position, normal, pdf_area = sample_quadric(quadrics[emitter.quadric], u, v)
    density = solid_angle_density(pdf_area, reference, position, normal)
    return EmitterPoint(position, normal * emitter.flip, density, extent_of(position, position, normal * 0.0))


@function
def pdf_quadric_emitter(needed, emitter, quadrics, reference, position, normal):
    """Density, sr^-1 at `reference`, of `sample_quadric_emitter` finding `position`."""
    if needed is None:
        return 0.0
    pdf_area = pdf_quadric_area(quadrics[emitter.quadric], position)
    return solid_angle_density(pdf_area, reference, position, normal)
