"""From Embree's hit to a shading point: position and normals in float64, recomputed from the primitive itself.

Positions never come from o + t d in float32. Rays leave a surface from a point moved along the geometric normal by a
bound on the rounding error of Embree's float32 arithmetic at that place, so that there is no fixed epsilon.
"""

from typing import NamedTuple

from ..core.affine import load_vec3, transform_direction, transform_normal, transform_point
from ..core.frame import normalize
from ..core.vector import Vec3, cross, dot, vec3
from ..jit import function
from ..scene.tables import PARALLELOGRAMS, QUADRICS, SMOOTH_TRIANGLES
from .embree import INVALID_ID
from .quadrics import quadric_normal, quadric_position, quadric_uv

# Sixteen units in the last place of float32: vertex and origin rounding (1 each), Embree's robust edge tests (about 6),
# the rounding of the offset origin itself (1), and as much again for the other end of the ray.
ERROR_SCALE = 2.0**-20


class Surface(NamedTuple):
    """A point on a surface; `normal` is geometric, `shading_normal` interpolated, both unit, on the outer side."""

    position: Vec3
    normal: Vec3
    shading_normal: Vec3
    u: float
    v: float
    extent: float  # size of the numbers that the intersection was computed with, render-space units
    material: int
    emitter: int  # index, negative for none


class _Patch(NamedTuple):
    """A surface point before instancing, flipping and materials."""

    position: Vec3
    normal: Vec3
    shading_normal: Vec3
    u: float
    v: float
    extent: float


@function
def surface_at(geometry, needs, origin, direction, hit):
    """The surface point of a `hit` of the ray (origin, direction)."""
    placement = geometry.placements[_placement_index(needs.instances, geometry, hit)]
    patch = _patch_at(geometry, needs, placement, origin, direction, hit)
    patch = _leave_instance(needs.instances, geometry, hit, patch)
    flip = float(placement.flip)
    emitter = placement.emitter + hit.primitive if placement.emitter >= 0 else -1
    return Surface(
        patch.position,
        patch.normal * flip,
        patch.shading_normal * flip,
        patch.u,
        patch.v,
        patch.extent,
        placement.material,
        emitter,
    )


@function
def _placement_index(instances, geometry, hit):
    if instances is None:
        return hit.geometry
    if hit.instance == INVALID_ID:
        return hit.geometry
    return geometry.instances[hit.instance - geometry.first_instance].first_placement + hit.geometry


@function
def _patch_at(geometry, needs, placement, origin, direction, hit):
    kind = placement.kind
    index = placement.first + hit.primitive
    if kind == PARALLELOGRAMS:
        return _parallelogram_patch(needs.parallelograms, geometry, index, hit)
    if kind == QUADRICS:
        return _quadric_patch(needs.quadrics, needs, geometry, index, origin, direction, hit)
    return _triangle_patch(needs.triangles, needs, geometry, index, kind == SMOOTH_TRIANGLES, hit)


@function
def _no_patch():
    zero = vec3(0.0, 0.0, 0.0)
    return _Patch(zero, zero, zero, 0.0, 0.0, 0.0)


@function
def largest(v):
    """Size of the largest coordinate."""
    return max(max(abs(v.x), abs(v.y)), abs(v.z))


@function
def extent_of(p, a, b):
    """Largest coordinate plus the size of the edges: what float32 rounding is relative to."""
    return largest(p) + largest(a) + largest(b)


@function
def _parallelogram_patch(needed, geometry, index, hit):
    if needed is None:
        return _no_patch()
    face = geometry.parallelograms[index]
    position = load_vec3(face.corner) + load_vec3(face.edge0) * hit.u + load_vec3(face.edge1) * hit.v
    normal = load_vec3(face.normal)
    return _Patch(position, normal, normal, hit.u, hit.v, largest(position) + face.extent)


@function
def _triangle_patch(needed, needs, geometry, index, is_smooth, hit):
    if needed is None:
        return _no_patch()
    faces, vertices = geometry.triangles, geometry.vertices
    p0 = load_vec3(vertices[faces[index, 0]].position)
    edge1 = load_vec3(vertices[faces[index, 1]].position) - p0
    edge2 = load_vec3(vertices[faces[index, 2]].position) - p0
    position = p0 + edge1 * hit.u + edge2 * hit.v
    normal = normalize(cross(edge1, edge2))
    extent = extent_of(position, edge1, edge2)
    u, v = _triangle_uv(needs.textures, geometry, index, hit)
    patch = _Patch(position, normal, normal, u, v, extent)
    return _smooth(needs.smooth_triangles, geometry, index, is_smooth, hit, patch)


@function
def _triangle_uv(textures, geometry, index, hit):
    if textures is None:
        return hit.u, hit.v
    faces, vertices = geometry.triangles, geometry.vertices
    a, b, c = vertices[faces[index, 0]].uv, vertices[faces[index, 1]].uv, vertices[faces[index, 2]].uv
    w = 1.0 - hit.u - hit.v
    return w * a[0] + hit.u * b[0] + hit.v * c[0], w * a[1] + hit.u * b[1] + hit.v * c[1]


@function
def _smooth(needed, geometry, index, is_smooth, hit, patch):
    """The interpolated normal; the geometric one is turned to its side, for the file's normals say what is outside."""
    if needed is None:
        return patch
    if not is_smooth:
        return patch
    faces, vertices = geometry.triangles, geometry.vertices
    shading = load_vec3(vertices[faces[index, 0]].normal) * (1.0 - hit.u - hit.v)
    shading = shading + load_vec3(vertices[faces[index, 1]].normal) * hit.u
    shading = normalize(shading + load_vec3(vertices[faces[index, 2]].normal) * hit.v)
    side = dot(shading, patch.normal)
    if not abs(side) > 0.0:  # opposite vertex normals, or none
        return patch
    normal = patch.normal if side > 0.0 else -patch.normal
    return _Patch(patch.position, normal, shading, patch.u, patch.v, patch.extent)


@function
def _quadric_patch(needed, needs, geometry, index, origin, direction, hit):
    if needed is None:
        return _no_patch()
    quadric = geometry.quadrics[index]
    guess = _to_instance(needs.instances, geometry, hit, origin + direction * hit.t)
    position = quadric_position(quadric, guess)
    normal = quadric_normal(quadric, position)
    u, v = _quadric_uv(needs.textures, quadric, position)
    return _Patch(position, normal, normal, u, v, extent_of(position, position, normal * 0.0))


@function
def _quadric_uv(textures, quadric, position):
    if textures is None:
        return 0.0, 0.0
    return quadric_uv(quadric, position)


@function
def _to_instance(instances, geometry, hit, p):
    if instances is None:
        return p
    if hit.instance == INVALID_ID:
        return p
    return transform_point(geometry.instances[hit.instance - geometry.first_instance].world_to_object, p)


@function
def _leave_instance(instances, geometry, hit, patch):
    """The patch in render space."""
    if instances is None:
        return patch
    if hit.instance == INVALID_ID:
        return patch
    instance = geometry.instances[hit.instance - geometry.first_instance]
    position = transform_point(instance.object_to_world, patch.position)
    size = transform_direction(instance.object_to_world, vec3(patch.extent, patch.extent, patch.extent))
    return _Patch(
        position,
        normalize(transform_normal(instance.world_to_object, patch.normal)),
        normalize(transform_normal(instance.world_to_object, patch.shading_normal)),
        patch.u,
        patch.v,
        extent_of(position, size, position),
    )


@function
def leave_surface(surface, direction):
    """Where a ray in `direction` starts so that it does not meet the surface that it leaves."""
    return offset_position(surface.position, surface.normal, surface.extent, direction)


@function
def offset_position(position, normal, extent, direction):
    """`position` moved to the side of `normal` that `direction` points to, by the rounding error of its place.

    At the far end of a ray `extent` is the larger one of both ends: rounding moves the ray's end by that of its start.
    """
    error = ERROR_SCALE * extent
    return position + normal * (error if dot(normal, direction) > 0.0 else -error)
