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
from ..scene.tables import (
    DIRECTIONAL_EMITTER,
    PARALLELOGRAM_EMITTER,
    POINT_EMITTER,
    QUADRIC_EMITTER,
    SPHERE_EMITTER,
    SPOT_EMITTER,
)
from .dispatch import pdf_emitter
from .infinite import emit_from_infinity, pdf_towards
from .point import emit_from_point, emit_from_spot, pdf_direction_of_point
from .types import Emission


class _Spot(NamedTuple):
    position: Vec3
    normal: Vec3
    pdf_area: float
    extent: float


@function
def sample_emission(scene, emitter, u, v, u_direction, v_direction):
    """A start on `emitter`: (u, v) choose the place, the others the direction; `Emission`."""
    needed = scene.needs.surfaceless_emitters
    return _sample(needed, scene, emitter, u, v, u_direction, v_direction)


@function
def _sample(needed, scene, emitter, u, v, u_direction, v_direction):
    if needed is None:
        return _emit_from_surface(scene.needs, scene.geometry, emitter, u, v, u_direction, v_direction)
    if emitter.kind >= DIRECTIONAL_EMITTER:
        return emit_from_infinity(scene, emitter, u, v, u_direction, v_direction)
    if emitter.kind == SPOT_EMITTER:
        return emit_from_spot(scene.needs.spot_emitters, emitter, u_direction, v_direction)
    if emitter.kind == POINT_EMITTER:
        return emit_from_point(scene.needs.point_emitters, emitter, u_direction, v_direction)
    return _emit_from_surface(scene.needs, scene.geometry, emitter, u, v, u_direction, v_direction)


@function
def _emit_from_surface(needs, geometry, emitter, u, v, u_direction, v_direction):
    """A point on `emitter`, uniform by area, and a direction with density cos / pi on each emitting side."""
    spot = _spot(needs, geometry, emitter, u, v)
    side = 1.0
    if emitter.two_sided != 0:
        side = 1.0 if u_direction < 0.5 else -1.0
        u_direction = 2.0 * u_direction if side > 0.0 else 2.0 * u_direction - 1.0
    normal = spot.normal * side
    local = square_to_cosine_hemisphere(u_direction, v_direction)
    direction = to_world(frame_around(normal), local)
    density = spot.pdf_area * emitter.pdf_select * _pdf_direction(emitter, local.z)
    return Emission(spot.position, normal, direction, density, local.z, 1.0, spot.extent)


@function
def next_event_over_emission(scene, emitter, start, position):
    """pc_0 / (p>_0 p>_1) without the cosine at the first vertex, which stands at `position`: C_1 of (1.5) times it."""
    density = pdf_emitter(scene, emitter, position, start.position, start.normal)
    return density * start.cos_theta / start.density


@function
def hit_over_emission(start):
    """g<_0 / (p>_0 p>_1) without the cosine at the first vertex: E_1 of (1.6) times it."""
    return start.can_be_hit * start.cos_theta / start.density


@function
def emission_over_next_event(scene, emitter, point, towards, pdf_light):
    """p>_0 p>_1 / pc_0 without the cosine at the first vertex, for a point that next-event estimation has found.

    `towards` leads from the vertex to the point, `pdf_light` is pc_0 as a density at the vertex, sr^-1.
    """
    needed = scene.needs.surfaceless_emitters
    return _over_next_event(needed, scene, emitter, point, towards, pdf_light)


@function
def _over_next_event(needed, scene, emitter, point, towards, pdf_light):
    if needed is None:
        return _surface_over_next_event(scene, emitter, point, towards, pdf_light)
    if emitter.kind >= DIRECTIONAL_EMITTER:
        return 1.0 / emitter.area  # the densities of the direction are the same
    if emitter.kind >= POINT_EMITTER:
        return emitter.pdf_select * pdf_direction_of_point(emitter) / pdf_light
    return _surface_over_next_event(scene, emitter, point, towards, pdf_light)


@function
def _surface_over_next_event(scene, emitter, point, towards, pdf_light):
    cos_light = cos_between(point.normal, towards)
    emission = _pdf_position(scene.needs, scene.geometry, emitter, point.position)
    return emission * _pdf_direction(emitter, cos_light) / (pdf_light * cos_light)


@function
def pdf_emission_of_hit(scene, emitter, surface, direction):
    """p>_0 s>_0 of (1.17): how light subpaths would have begun where an eye subpath has hit the emitter."""
    position = _pdf_position(scene.needs, scene.geometry, emitter, surface.position)
    return position * _pdf_direction(emitter, dot(direction, surface.normal))


@function
def pdf_emission_of_background(scene, emitter, towards):
    """p>_0 e of (1.17) for a sun or an environment that an eye subpath has found in the direction `towards`."""
    return pdf_towards(scene, emitter, towards) * emitter.pdf_select / emitter.area


@function
def _pdf_direction(emitter, cos_theta):
    """Density of directions from a surface at a direction of this cosine with the normal, sr^-1."""
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
def _pdf_position(needs, geometry, emitter, position):
    """Density of starts at `position` of a surface, per area, with the choice of the emitter."""
    return _pdf_area(needs.quadric_emitters, geometry, emitter, position) * emitter.pdf_select


@function
def _pdf_area(needed, geometry, emitter, position):
    if needed is None:
        return 1.0 / emitter.area
    if emitter.kind == QUADRIC_EMITTER:
        return pdf_quadric_area(geometry.quadrics[emitter.quadric], position)
    return 1.0 / emitter.area
