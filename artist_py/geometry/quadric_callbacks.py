"""The callbacks through which Embree asks for the bounds of quadrics and for their ray intersections.

Embree calls them from inside `rtcIntersect1` and `rtcOccluded1` with one ray at a time, and has tested the ray mask
before. Packets are not supported: `rtcIntersect4/8/16` must not be called on a scene with quadrics.
The user data of the geometry is the address of its first `quadric_dtype` record; memory layouts are those of Embree 4.4
with one instance level (rtcore_ray.h, rtcore_geometry.h).
"""

import ctypes
import functools

import numpy as np
from numba.core import types

from ..core.vector import primitive, vec3
from ..jit import callback, function
from ..scene.tables import quadric_dtype
from .quadrics import intersect_quadric, quadric_bounds, scaled_normal

bounds_query_dtype = np.dtype([("quadrics", "i8"), ("primitive", "u4"), ("time_step", "u4"), ("box", "i8")])
box_dtype = np.dtype([("lower", "f4", 4), ("upper", "f4", 4)])

# RTCIntersectFunctionNArguments and RTCOccludedFunctionNArguments; `ray` is the address of an RTCRayHit or an RTCRay.
ray_query_dtype = np.dtype(
    [
        ("valid", "i8"),
        ("quadrics", "i8"),
        ("primitive", "u4"),
        ("padding", "u4"),
        ("context", "i8"),
        ("ray", "i8"),
        ("ray_count", "u4"),
        ("geometry", "u4"),
    ]
)
context_dtype = np.dtype([("instance", "u4"), ("instance_primitive", "u4")])

RAY_FIELDS = [
    ("origin", "f4", 3),
    ("t_near", "f4"),
    ("direction", "f4", 3),
    ("time", "f4"),
    ("t_far", "f4"),
    ("mask", "u4"),
    ("id", "u4"),
    ("flags", "u4"),
]
HIT_FIELDS = [
    ("normal", "f4", 3),
    ("u", "f4"),
    ("v", "f4"),
    ("primitive", "u4"),
    ("geometry", "u4"),
    ("instance", "u4"),
    ("instance_primitive", "u4"),
    ("padding", "u4", 3),
]
ray_dtype = np.dtype(RAY_FIELDS)
ray_hit_dtype = np.dtype(RAY_FIELDS + HIT_FIELDS)

QUADRIC_BYTES = quadric_dtype.itemsize
# More than half the spacing of float32 numbers, relative: rounding a corner never moves it inwards.
PADDING = 2.0**-23


def record_at(address, dtype):
    """The record of type `dtype` at a memory address; writing its fields writes to memory."""
    memory = (ctypes.c_char * dtype.itemsize).from_address(int(address))
    return np.frombuffer(memory, dtype).view(np.recarray)[0]


def _resolve_record(address, dtype):
    is_known = isinstance(address, types.Integer) and isinstance(dtype, types.DType)
    return dtype.dtype if is_known and isinstance(dtype.dtype, types.Record) else None


def _lower_record(context, builder, result, arg_types, args):
    return builder.inttoptr(args[0], context.get_value_type(result))  # numba holds a record by its address


primitive(_resolve_record)(record_at, _lower_record)


@function
def report_bounds(address):
    """Write the box of one quadric, rounded outwards to float32, for the query at `address`."""
    query = record_at(address, bounds_query_dtype)
    lower, upper = quadric_bounds(record_at(query.quadrics + query.primitive * QUADRIC_BYTES, quadric_dtype))
    box = record_at(query.box, box_dtype)
    box.lower[0], box.upper[0] = lower.x - PADDING * abs(lower.x), upper.x + PADDING * abs(upper.x)
    box.lower[1], box.upper[1] = lower.y - PADDING * abs(lower.y), upper.y + PADDING * abs(upper.y)
    box.lower[2], box.upper[2] = lower.z - PADDING * abs(lower.z), upper.z + PADDING * abs(upper.z)


@function
def _ray_ends(ray):
    origin = vec3(ray.origin[0], ray.origin[1], ray.origin[2])
    return origin, vec3(ray.direction[0], ray.direction[1], ray.direction[2])


@function
def report_closest_hit(address):
    """Shorten the ray of the query at `address` to its first hit with one quadric and write it, if there is one."""
    query = record_at(address, ray_query_dtype)
    quadric = record_at(query.quadrics + query.primitive * QUADRIC_BYTES, quadric_dtype)
    hit = record_at(query.ray, ray_hit_dtype)
    origin, direction = _ray_ends(hit)
    t = intersect_quadric(quadric, origin, direction, hit.t_near, hit.t_far)
    if t < hit.t_far:
        normal = scaled_normal(quadric, origin + direction * t)
        context = record_at(query.context, context_dtype)
        hit.t_far = t
        hit.normal[0], hit.normal[1], hit.normal[2] = normal.x, normal.y, normal.z
        hit.u = hit.v = 0.0
        hit.primitive, hit.geometry = query.primitive, query.geometry
        hit.instance, hit.instance_primitive = context.instance, context.instance_primitive


@function
def report_occlusion(address):
    """Set t_far of the ray of the query at `address` to -inf, which means occluded, if the quadric is in its way."""
    query = record_at(address, ray_query_dtype)
    quadric = record_at(query.quadrics + query.primitive * QUADRIC_BYTES, quadric_dtype)
    ray = record_at(query.ray, ray_dtype)
    origin, direction = _ray_ends(ray)
    if intersect_quadric(quadric, origin, direction, ray.t_near, ray.t_far) < ray.t_far:
        ray.t_far = -np.inf


@functools.cache
def _compiled_callbacks():
    # Kept for good: Embree may call them as long as any scene lives.
    compiled = callback(types.void(types.intp))
    return compiled(report_bounds), compiled(report_closest_hit), compiled(report_occlusion)


def quadric_callbacks():
    """Addresses of the callbacks (bounds, intersect, occluded); the first call compiles them or loads the cache."""
    return tuple(each.address for each in _compiled_callbacks())
