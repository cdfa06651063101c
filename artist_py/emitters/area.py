"""Emitting triangles and parallelograms, sampled uniformly by area."""

import math

from ..core.affine import load_vec3
from ..core.vector import dot, vec3
from ..core.warp import square_to_triangle
from ..geometry.surface import extent_of
from ..jit import function
from .types import EmitterPoint


@function
def no_emitter_point():
    """Nothing found: density 0."""
    zero = vec3(0.0, 0.0, 0.0)
    return EmitterPoint(zero, zero, 0.0, 0.0)


@function
def solid_angle_density(pdf_area, reference, position, normal):
    """`pdf_area` (per unit area at `position`) per solid angle at `reference`; 0 in the plane of the emitter."""
    d = position - reference
    distance_squared = dot(d, d)
    cos_theta = abs(dot(normal, d))
    return pdf_area * distance_squared * math.sqrt(distance_squared) / cos_theta if cos_theta > 0.0 else 0.0


@function
def sample_triangle(needed, emitter, reference, u, v):
    """Uniform point of a triangle."""
    if needed is None:
        return no_emitter_point()
    b1, b2 = square_to_triangle(u, v)
    return _point(emitter, reference, b1, b2)


@function
def sample_parallelogram(needed, emitter, reference, u, v):
    """Uniform point of a parallelogram."""
    if needed is None:
        return no_emitter_point()
    return _point(emitter, reference, u, v)


@function
def _point(emitter, reference, a, b):
    edge0, edge1 = load_vec3(emitter.edge0), load_vec3(emitter.edge1)
    position = load_vec3(emitter.origin) + edge0 * a + edge1 * b
    normal = load_vec3(emitter.normal)
    density = solid_angle_density(1.0 / emitter.area, reference, position, normal)
    return EmitterPoint(position, normal, density, extent_of(position, edge0, edge1))
