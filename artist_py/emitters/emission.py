"""Starting a light subpath: a point on an emitter and a direction from it."""

import math
from typing import NamedTuple

from ..core.affine import load_vec3
from ..core.frame import frame_around, to_world
from ..core.vector import Vec3, dot, vec3
from ..core.warp import INV_PI, square_to_cosine_hemisphere, square_to_sphere, square_to_triangle
from ..geometry.quadrics import pdf_quadric_area, sample_quadric
from ..geometry.surface import extent_of
from ..jit import function
from ..scene.tables import PARALLELOGRAM_EMITTER, QUADRIC_EMITTER, SPHERE_EMITTER


class Emission(NamedTuple):
    """The start of a light subpath; densities are without the choice of the emitter."""

    position: Vec3
    normal: Vec3  # unit, on the side of `direction`
    direction: Vec3  # unit
    pdf_area: float  # of `position`, render-space units^-2
    pdf_solid_angle: float  # of `direction`, sr^-1
    extent: float


class _Spot(NamedTuple):
    position: Vec3
    normal: Vec3
    pdf_area: float
    extent: float


@function
def sample_emission(needs, geometry, emitter, u, v, u_direction, v_direction):
    """A point on `emitter`, uniform by area, and a direction with density cos / pi on each emitting side."""
    spot = _spot(needs, geometry, emitter, u, v)
    side = 1.0
    if emitter.two_sided != 0:
        side = 1.0 if u_direction < 0.5 else -1.0
        u_direction = 2.0 * u_direction if side > 0.0 else 2.0 * u_direction - 1.0
    normal = spot.normal * side
    local = square_to_cosine_hemisphere(u_direction, v_direction)
    direction = to_world(frame_around(normal), local)
    pdf = pdf_emitted_direction(emitter, local.z)
    return Emission(spot.position, normal, direction, spot.pdf_area, pdf, spot.extent)


@function
def pdf_emitted_direction(emitter, cos_theta):
    """Density of `sample_emission` at a direction of this cosine with the normal, sr^-1."""
    return abs(cos_theta) * INV_PI * (0.5 if emitter.two_sided != 0 else 1.0)


@function
def _spot(needs, geometry, emitter, u, v):
    kind = emitter.kind
    if kind == SPHERE_EMITTER:
        return _sphere_spot(needs.sphere_emitters, emitter, u, v)
    if kind == QUADRIC_EMITTER:
        return _quadric_spot(needs.quadric_emitters, emitter, geometry.quadrics, u, v)
    if kind == PARALLELOGRAM_EMITTER:
        return _flat_spot(emitter, u, v)
    b1, b2 = square_to_triangle(u, v)
    return _flat_spot(emitter, b1, b2)


@function
def _flat_spot(emitter, a, b):
    edge0, edge1 = load_vec3(emitter.edge0), load_vec3(emitter.edge1)
    position = load_vec3(emitter.origin) + edge0 * a + edge1 * b
    return _Spot(position, load_vec3(emitter.normal), 1.0 / emitter.area, extent_of(position, edge0, edge1))


@function
def _no_spot():
    zero = vec3(0.0, 0.0, 0.0)
    return _Spot(zero, zero, 0.0, 0.0)


@function
def _sphere_spot(needed, emitter, u, v):
    if needed is None:
        return _no_spot()
    outward = square_to_sphere(u, v)
    position = load_vec3(emitter.origin) + outward * emitter.radius
    size = vec3(emitter.radius, 0.0, 0.0)
    return _Spot(position, outward * emitter.flip, 1.0 / emitter.area, extent_of(position, size, size))


@function
def _quadric_spot(needed, emitter, quadrics, u, v):
    if needed is None:
        return _no_spot()
    position, normal, pdf_area = sample_quadric(quadrics[emitter.quadric], u, v)
    return _Spot(position, normal * emitter.flip, pdf_area, extent_of(position, position, normal * 0.0))


@function
def cos_between(normal, towards):
    """|cos| of the angle between a unit normal and any vector."""
    return abs(dot(normal, towards)) / math.sqrt(dot(towards, towards))


@function
def pdf_emission_position(needs, geometry, emitter, position):
    """Density of `sample_emission` at `position` of the emitter, per area, with the choice of the emitter."""
    return _pdf_area(needs.quadric_emitters, geometry, emitter, position) * emitter.pdf_select


@function
def _pdf_area(needed, geometry, emitter, position):
    if needed is None:
        return 1.0 / emitter.area
    if emitter.kind == QUADRIC_EMITTER:
        return pdf_quadric_area(geometry.quadrics[emitter.quadric], position)
    return 1.0 / emitter.area
