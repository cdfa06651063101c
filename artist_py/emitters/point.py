"""Points that emit: into all directions, or into a cone (spot).

They take part as if they had an area of 1 that everybody sees frontally: "density" per area 1, cosine 1. All these
factors cancel (theory 1.5), and the intensity, W sr^-1 nm^-1, takes the place of the radiance.

Rays end and begin beside the point by the rounding error of its place: where it lies on a surface, that must hide it
from one side only.
"""

import math

from ..core.affine import load_vec3
from ..core.frame import frame_around, to_world
from ..core.vector import dot
from ..core.warp import square_to_cone, square_to_sphere
from ..geometry.surface import largest
from ..jit import function
from .area import no_emitter_point
from .types import Emission, EmitterPoint, no_emission


@function
def sample_point(needed, emitter, reference):
    """The point, as it is seen from `reference`."""
    if needed is None:
        return no_emitter_point()
    position = load_vec3(emitter.origin)
    away = reference - position
    distance_squared = dot(away, away)
    if not distance_squared > 0.0:
        return no_emitter_point()
    return EmitterPoint(
        position, away * (1.0 / math.sqrt(distance_squared)), distance_squared, largest(position)
    )


@function
def sample_spot(needed, emitter, reference):
    """The point, where its cone reaches `reference`."""
    point = sample_point(needed, emitter, reference)
    if spot_falloff(needed, emitter, point.normal) == 0.0:
        return no_emitter_point()
    return point


@function
def pdf_point(emitter, reference):
    """The density that `sample_point` states, sr^-1 at `reference`."""
    away = reference - load_vec3(emitter.origin)
    return dot(away, away)


@function
def spot_falloff(needed, emitter, direction):
    """Share of the axis's intensity in `direction`, in [0, 1]: a smooth step in the cosine between the two cones."""
    if needed is None:
        return 0.0
    # |d - a|^2 = 2 (1 - cos), exact where the cosine rounds to 1.
    off_axis = direction - load_vec3(emitter.normal)
    one_minus_cos = 0.5 * dot(off_axis, off_axis)
    if one_minus_cos <= emitter.inner_cone:
        return 1.0
    if one_minus_cos >= emitter.cone:
        return 0.0
    t = (emitter.cone - one_minus_cos) / (emitter.cone - emitter.inner_cone)
    return t * t * (3.0 - 2.0 * t)


@function
def emit_from_point(needed, emitter, u, v):
    """A start in any direction; `Emission`."""
    if needed is None:
        return no_emission()
    direction = square_to_sphere(u, v)
    density = emitter.pdf_select * pdf_direction_of_point(emitter)
    position = load_vec3(emitter.origin)
    return Emission(position, direction, direction, density, 1.0, 0.0, largest(position))


@function
def emit_from_spot(needed, emitter, u, v):
    """A start within the cone, uniform; `Emission`."""
    if needed is None:
        return no_emission()
    frame = frame_around(load_vec3(emitter.normal))
    direction = to_world(frame, square_to_cone(u, v, emitter.cone))
    density = emitter.pdf_select * pdf_direction_of_point(emitter)
    position = load_vec3(emitter.origin)
    return Emission(position, direction, direction, density, 1.0, 0.0, largest(position))


@function
def pdf_direction_of_point(emitter):
    """Density of directions that points and spots emit into, sr^-1; a point's `cone` is the whole sphere, 2."""
    return 1.0 / (2.0 * math.pi * emitter.cone)
