"""Exact spheres, disks, cylinders and cones under any invertible affine map, in float64.

Canonical shapes, and the side their normals point to (a mirroring map keeps it the outer side):
  SPHERE    x² + y² + z² = 1, away from the centre         DISK  x² + y² <= 1, z = 0, towards +z
  CYLINDER  x² + y² = 1, 0 <= z <= 1, away from the axis   CONE  x² + y² = (1 - z)², 0 <= z <= 1, away from the axis
Cylinders and cones are open; their caps are disks. *World* is the space that `object_to_world` maps to.
"""

import math

from ..core.affine import transform_direction, transform_normal, transform_point
from ..core.frame import length, normalize
from ..core.vector import cross, dot, vec3
from ..core.warp import square_to_disk, square_to_sphere
from ..jit import function
from ..scene.tables import CYLINDER, DISK, SPHERE

# Canonical length by which shapes reach beyond their edges, so that rounding opens no gap between a shape and its cap.
SEAM = 1e-12
CANONICAL_AREAS = (4.0 * math.pi, math.pi, 2.0 * math.pi, math.sqrt(2.0) * math.pi)


# --- maps between the canonical frame and the world --------------------------------------------------------------


@function
def _column(matrix, j):
    return vec3(matrix[0, j], matrix[1, j], matrix[2, j])


@function
def _to_canonical(quadric, point):
    # The centre is taken off first: close to a small shape far from the origin nothing is lost.
    return transform_direction(quadric.world_to_object, point - _column(quadric.object_to_world, 3))


@function
def _to_world(quadric, p):
    return transform_point(quadric.object_to_world, p)


# --- rays ---------------------------------------------------------------------------------------------------------


@function
def intersect_quadric(quadric, origin, direction, t_near, t_far):
    """Smallest t in (t_near, t_far) at which origin + t direction lies on the surface, from either side; inf if none.

    t counts in units of `direction`, of any length. The roots are taken about the point of the ray closest to the
    shape, and the discriminant from the ray's moment, so that a distance of n sizes costs a factor n of precision
    and not n² (the idea of Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection, for all shapes).
    """
    d = transform_direction(quadric.world_to_object, direction)
    o = _to_canonical(quadric, origin)
    t_middle = -dot(o, d) / dot(d, d)
    middle = o + d * t_middle
    first, last = _surface_roots(quadric.kind, middle, d)
    t = t_middle + first
    if t_near < t < t_far and _is_within_edges(quadric.kind, middle + d * first):
        return t
    t = t_middle + last
    if t_near < t < t_far and _is_within_edges(quadric.kind, middle + d * last):
        return t
    return math.inf


@function
def _surface_roots(kind, o, d):
    """Both parameters, ascending, at which the line o + s d meets the unbounded quadric; inf for those it has not."""
    if kind == DISK:
        return _ratio(-o.z, d.z), math.inf
    a, b, c, discriminant = _quadratic(kind, o, d)
    # Below zero by rounding alone: a ray through the apex of a cone.
    if not discriminant >= -SEAM * SEAM * dot(d, d):
        return math.inf, math.inf
    root = math.sqrt(max(discriminant, 0.0))
    q = -(b + math.copysign(root, b))
    first, last = _ratio(q, a), _ratio(c, q)
    if last < first:
        return last, first
    return first, last


@function
def _quadratic(kind, o, d):
    """(a, b, c, b² - a c) of a s² + 2 b s + c = 0; the last one from the moment o x d, without cancellation."""
    if kind == SPHERE:
        a, moment = dot(d, d), cross(o, d)
        return a, dot(o, d), dot(o, o) - 1.0, a - dot(moment, moment)
    if kind == CYLINDER:
        a, moment_z = d.x * d.x + d.y * d.y, o.x * d.y - o.y * d.x
        return a, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - 1.0, a - moment_z * moment_z
    # Cone, seen from its apex: the form x² + y² - z², for which Lagrange's identity changes the same sign.
    o = vec3(o.x, o.y, o.z - 1.0)
    moment = cross(o, d)
    return (
        d.x * d.x + d.y * d.y - d.z * d.z,
        o.x * d.x + o.y * d.y - o.z * d.z,
        o.x * o.x + o.y * o.y - o.z * o.z,
        moment.x * moment.x + moment.y * moment.y - moment.z * moment.z,
    )


@function
def _ratio(x, y):
    return x / y if y != 0.0 else math.inf


@function
def _is_within_edges(kind, p):
    if kind == SPHERE:
        return True
    if kind == DISK:
        return p.x * p.x + p.y * p.y <= 1.0 + 2.0 * SEAM
    return -SEAM <= p.z <= 1.0 + SEAM


# --- points on the surface ----------------------------------------------------------------------------------------


@function
def quadric_position(quadric, point):
    """The point of the surface next to `point` (next in the canonical frame), in world coordinates."""
    p = _to_canonical(quadric, point)
    if quadric.kind == SPHERE:
        return _to_world(quadric, p * (1.0 / length(p)))
    radius = math.sqrt(p.x * p.x + p.y * p.y)
    if quadric.kind == DISK:
        return _to_world(quadric, _on_circle(p, radius, min(radius, 1.0), 0.0))
    if quadric.kind == CYLINDER:
        return _to_world(quadric, _on_circle(p, radius, 1.0, _clamp(p.z)))
    # The foot of the perpendicular on the generator radius + z = 1.
    new_radius = _clamp(0.5 * (radius - p.z + 1.0))
    return _to_world(quadric, _on_circle(p, radius, new_radius, 1.0 - new_radius))


@function
def _on_circle(p, radius, new_radius, z):
    """`p`, at `radius` from the axis, moved to `new_radius` and to the height z."""
    if radius == 0.0:
        return vec3(new_radius, 0.0, z)
    scale = new_radius / radius
    return vec3(p.x * scale, p.y * scale, z)


@function
def _clamp(x):
    return min(max(x, 0.0), 1.0)


@function
def quadric_normal(quadric, point):
    """Unit outer normal in world space at a point on, or within rounding of, the surface; at an apex, the axis's."""
    return normalize(scaled_normal(quadric, point))


@function
def scaled_normal(quadric, point):
    """Outer normal M^-T n in world space; its length times |det M| is world area over canonical area."""
    return transform_normal(
        quadric.world_to_object, _canonical_normal(quadric.kind, _to_canonical(quadric, point))
    )


@function
def _canonical_normal(kind, p):
    """Outer unit normal of the canonical shape."""
    if kind == SPHERE:
        return normalize(p)
    radius = math.sqrt(p.x * p.x + p.y * p.y)
    if kind == DISK or radius == 0.0:
        return vec3(0.0, 0.0, 1.0)
    if kind == CYLINDER:
        return vec3(p.x / radius, p.y / radius, 0.0)
    scale = math.sqrt(0.5) / radius
    return vec3(p.x * scale, p.y * scale, math.sqrt(0.5))


@function
def quadric_uv(quadric, point):
    """Surface coordinates (u, v), both in [0, 1], of a point on the surface.

    u is the angle about the z axis from x over y, of a full turn. v is the height z (cylinder, cone), the distance from
    the axis (disk) or the angle from the south pole z = -1, of half a turn (sphere).
    """
    p = _to_canonical(quadric, point)
    turn = math.atan2(p.y, p.x) / (2.0 * math.pi)
    u = turn + 1.0 if turn < 0.0 else turn
    radius = math.sqrt(p.x * p.x + p.y * p.y)
    if quadric.kind == SPHERE:
        return u, math.atan2(radius, -p.z) / math.pi
    if quadric.kind == DISK:
        return u, _clamp(radius)
    return u, _clamp(p.z)


# --- sampling -----------------------------------------------------------------------------------------------------


@function
def sample_quadric(quadric, u, v):
    """(position, unit outer normal, pdf_area per world area) of a point that is uniform on the *canonical* surface."""
    p = _sample_canonical(quadric.kind, u, v)
    n = _canonical_normal(quadric.kind, p)
    normal = transform_normal(quadric.world_to_object, n)
    return _to_world(quadric, p), normalize(normal), _pdf_area(quadric, normal)


@function
def _sample_canonical(kind, u, v):
    if kind == SPHERE:
        return square_to_sphere(u, v)
    if kind == DISK:
        x, y = square_to_disk(u, v)
        return vec3(x, y, 0.0)
    angle = 2.0 * math.pi * u
    # A cone's area below the apex grows with the square of the distance from it.
    radius = 1.0 if kind == CYLINDER else math.sqrt(v)
    z = v if kind == CYLINDER else 1.0 - radius
    return vec3(radius * math.cos(angle), radius * math.sin(angle), z)


@function
def pdf_quadric_area(quadric, point):
    """Density per world area with which `sample_quadric` draws this point of the surface, (length unit)^-2."""
    return _pdf_area(quadric, scaled_normal(quadric, point))


@function
def _pdf_area(quadric, normal):
    """1 / (canonical area x area stretch) where `normal` is the scaled one."""
    m = quadric.object_to_world
    determinant = dot(_column(m, 0), cross(_column(m, 1), _column(m, 2)))
    return 1.0 / (CANONICAL_AREAS[quadric.kind] * abs(determinant) * length(normal))


# --- extent -------------------------------------------------------------------------------------------------------


@function
def quadric_bounds(quadric):
    """Corners (lower, upper) of the tight axis-aligned box, world coordinates in float64: pad when rounding them."""
    m, kind = quadric.object_to_world, quadric.kind
    centre, height = _column(m, 3), _column(m, 2)
    across = vec3(_reach(m, 0, kind), _reach(m, 1, kind), _reach(m, 2, kind))
    if kind == SPHERE or kind == DISK:
        return centre - across, centre + across
    top = across if kind == CYLINDER else across * 0.0
    return centre + _minimum(-across, height - top), centre + _maximum(across, height + top)


@function
def _reach(m, i, kind):
    """Farthest reach along world axis i of the unit sphere, or else of the unit circle in the xy plane."""
    squared = m[i, 0] * m[i, 0] + m[i, 1] * m[i, 1]
    return math.sqrt(squared + m[i, 2] * m[i, 2]) if kind == SPHERE else math.sqrt(squared)


@function
def _minimum(a, b):
    return vec3(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z))


@function
def _maximum(a, b):
    return vec3(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z))
