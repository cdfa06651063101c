"""Embree 4 through its C API: scenes are built with ctypes, rays are traced from inside nogil kernels.

The `embreex` wheel carries the library. `closest_hit` and `is_occluded` lower to direct calls of `rtcIntersect1` and
`rtcOccluded1` on a ray record that lives on the kernel's stack; both symbols are registered by name when this module
is imported, so that cached kernels find them.
"""

import ctypes
from importlib import metadata
from typing import NamedTuple

import numpy as np
from llvmlite import binding, ir
from numba.core import cgutils, types

from ..core.vector import VEC3, primitive
from ..errors import ArtistError

INVALID_ID = 0xFFFFFFFF
RAY_BYTES, RAYHIT_BYTES = 48, 96

GEOMETRY_TRIANGLE, GEOMETRY_QUAD, GEOMETRY_USER, GEOMETRY_INSTANCE = 0, 1, 120, 121
BUFFER_INDEX, BUFFER_VERTEX = 0, 1
FORMAT_UINT3, FORMAT_UINT4, FORMAT_FLOAT3, FORMAT_FLOAT3X4_ROW_MAJOR = 0x5003, 0x5004, 0x9003, 0x9134
SCENE_FLAG_ROBUST = 4
BUILD_QUALITY_MEDIUM, BUILD_QUALITY_HIGH = 1, 2
PROPERTY_VERSION_MAJOR = 1
SEEN, BLOCKS_LIGHT = 1, 2  # bits of a geometry's mask; shadow rays ask for BLOCKS_LIGHT

P = ctypes.c_void_p
SIGNATURES = {
    "rtcNewDevice": (P, ctypes.c_char_p),
    "rtcReleaseDevice": (None, P),
    "rtcGetDeviceError": (ctypes.c_int, P),
    "rtcGetDeviceProperty": (ctypes.c_ssize_t, P, ctypes.c_int),
    "rtcNewScene": (P, P),
    "rtcReleaseScene": (None, P),
    "rtcSetSceneFlags": (None, P, ctypes.c_int),
    "rtcSetSceneBuildQuality": (None, P, ctypes.c_int),
    "rtcCommitScene": (None, P),
    "rtcNewGeometry": (P, P, ctypes.c_int),
    "rtcReleaseGeometry": (None, P),
    "rtcCommitGeometry": (None, P),
    "rtcAttachGeometryByID": (None, P, P, ctypes.c_uint),
    "rtcSetGeometryMask": (None, P, ctypes.c_uint),
    "rtcSetSharedGeometryBuffer": (
        None, P, ctypes.c_int, ctypes.c_uint, ctypes.c_int, P, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_size_t,
    ),
    "rtcSetGeometryUserPrimitiveCount": (None, P, ctypes.c_uint),
    "rtcSetGeometryUserData": (None, P, P),
    "rtcSetGeometryBoundsFunction": (None, P, P, P),
    "rtcSetGeometryIntersectFunction": (None, P, P),
    "rtcSetGeometryOccludedFunction": (None, P, P),
    "rtcSetGeometryInstancedScene": (None, P, P),
    "rtcSetGeometryTransform": (None, P, ctypes.c_uint, ctypes.c_int, P),
    "rtcIntersect1": (None, P, P, P),
    "rtcOccluded1": (None, P, P, P),
}  # fmt: skip


def find_library():
    """Path of the Embree 4 library that the `embreex` wheel carries."""
    files = metadata.files("embreex") or []
    candidates = [
        file for file in files if "libs/" in str(file).replace("\\", "/") and "embree4" in file.name
    ]
    if not candidates:
        looked_for = "*libs/*embree4* of the installed package embreex"
        raise ArtistError(f"Embree 4 was not found: no file {looked_for}; reinstall embreex >= 4.4")
    return candidates[0].locate()


def load_library():
    """The Embree library with typed functions; its ray queries are made known to compiled kernels by name."""
    path = find_library()
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise ArtistError(f"Embree cannot be loaded from {path}: {error}") from None
    for name, (result, *arguments) in SIGNATURES.items():
        try:
            entry = getattr(library, name)
        except AttributeError:
            raise ArtistError(f"{path} is not Embree 4: it has no {name}") from None
        entry.restype, entry.argtypes = result, arguments
    for name in ("rtcIntersect1", "rtcOccluded1"):
        binding.add_symbol(f"artist_{name}", ctypes.cast(getattr(library, name), P).value)
    return library


rtc = load_library()


class EmbreeError(ArtistError):
    """Embree reported an error while a scene was built."""


ERROR_NAMES = {
    1: "unknown error",
    2: "invalid argument",
    3: "invalid operation",
    4: "out of memory",
    5: "unsupported CPU",
    6: "cancelled",
}


class Device:
    """An Embree device; every call is checked, and errors name what was being built."""

    def __init__(self, threads):
        self.handle = rtc.rtcNewDevice(f"threads={threads}".encode())
        if not self.handle:
            raise EmbreeError(
                f"Embree has no device: {ERROR_NAMES.get(rtc.rtcGetDeviceError(None), 'unknown error')}"
            )
        major = rtc.rtcGetDeviceProperty(self.handle, PROPERTY_VERSION_MAJOR)
        if major != 4:
            raise EmbreeError(f"{find_library()} is Embree {major}; version 4 is needed")

    def check(self, what):
        """Raise an `EmbreeError` that names `what` if the last calls failed."""
        code = rtc.rtcGetDeviceError(self.handle)
        if code:
            raise EmbreeError(f"{what}: Embree: {ERROR_NAMES.get(code, code)}")

    def __del__(self):
        if getattr(self, "handle", None) and rtc is not None:  # None when the interpreter is shutting down
            rtc.rtcReleaseDevice(self.handle)


class EmbreeScene:
    """A BVH under construction; `address` is what kernels trace against once it is committed.

    Arrays handed over are shared with Embree, not copied: the scene keeps them alive.
    """

    def __init__(self, device):
        self.device, self.kept = device, []
        self.address = rtc.rtcNewScene(device.handle)
        rtc.rtcSetSceneFlags(self.address, SCENE_FLAG_ROBUST)

    def _attach(self, geometry, geometry_id, name, blocks_light=True):
        rtc.rtcSetGeometryMask(geometry, SEEN | (BLOCKS_LIGHT if blocks_light else 0))
        rtc.rtcCommitGeometry(geometry)
        rtc.rtcAttachGeometryByID(self.address, geometry, geometry_id)
        rtc.rtcReleaseGeometry(geometry)
        self.device.check(name)

    def _share(self, geometry, kind, layout, array):
        rtc.rtcSetSharedGeometryBuffer(
            geometry, kind, 0, layout, array.ctypes.data, 0, array.strides[0], len(array)
        )
        self.kept.append(array)

    def add_faces(self, geometry_id, vertices, faces, name, blocks_light=True):
        """Triangles (n, 3) or parallelograms (n, 4), uint32 indices into `vertices` (vertex_dtype)."""
        is_quad = faces.shape[1] == 4
        geometry = rtc.rtcNewGeometry(self.device.handle, GEOMETRY_QUAD if is_quad else GEOMETRY_TRIANGLE)
        self._share(geometry, BUFFER_VERTEX, FORMAT_FLOAT3, vertices)
        self._share(geometry, BUFFER_INDEX, FORMAT_UINT4 if is_quad else FORMAT_UINT3, faces)
        self._attach(geometry, geometry_id, name, blocks_light)

    def add_quadrics(self, geometry_id, quadrics, callbacks, name, blocks_light=True):
        """Exact shapes (quadric_dtype) as user geometry; `callbacks` are addresses: bounds, intersect, occluded."""
        bounds, intersect, occluded = callbacks
        geometry = rtc.rtcNewGeometry(self.device.handle, GEOMETRY_USER)
        rtc.rtcSetGeometryUserPrimitiveCount(geometry, len(quadrics))
        rtc.rtcSetGeometryUserData(geometry, quadrics.ctypes.data)
        rtc.rtcSetGeometryBoundsFunction(geometry, bounds, None)
        rtc.rtcSetGeometryIntersectFunction(geometry, intersect)
        rtc.rtcSetGeometryOccludedFunction(geometry, occluded)
        self.kept.append(quadrics)
        self._attach(geometry, geometry_id, name, blocks_light)

    def add_instance(self, geometry_id, scene, object_to_world, name):
        """A committed scene under the affine map `object_to_world` (3, 4)."""
        geometry = rtc.rtcNewGeometry(self.device.handle, GEOMETRY_INSTANCE)
        rtc.rtcSetGeometryInstancedScene(geometry, scene.address)
        matrix = np.ascontiguousarray(object_to_world, np.float32)
        rtc.rtcSetGeometryTransform(geometry, 0, FORMAT_FLOAT3X4_ROW_MAJOR, matrix.ctypes.data)
        self.kept.append(scene)
        self._attach(geometry, geometry_id, name)

    def commit(self, name="scene"):
        """Build the BVH."""
        rtc.rtcSetSceneBuildQuality(self.address, BUILD_QUALITY_HIGH)
        rtc.rtcCommitScene(self.address)
        self.device.check(name)
        return self

    def __del__(self):
        if getattr(self, "address", None) and rtc is not None:
            rtc.rtcReleaseScene(self.address)


# --- ray queries in kernels ---------------------------------------------------------------------------------------


class Hit(NamedTuple):
    """What Embree says of the closest hit; `geometry` is INVALID_ID for a miss."""

    t: float  # in units of the ray's direction
    u: float
    v: float
    primitive: int
    geometry: int
    instance: int  # geometry ID of the instance in the top scene, INVALID_ID for none


def closest_hit(embree, origin, direction, t_far):
    """First hit of the ray within (0, t_far) as (t, u, v, primitive, geometry, instance)."""
    record = np.zeros(RAYHIT_BYTES // 4 + 4, np.float32)
    record = record[(-record.ctypes.data % 16) // 4 :][: RAYHIT_BYTES // 4]
    ids = record.view(np.uint32)
    record[0:3], record[3], record[4:7], record[8] = origin.values, T_NEAR, direction.values, t_far
    ids[9], ids[17:20] = SEEN, INVALID_ID
    rtc.rtcIntersect1(embree, record.ctypes.data, None)
    return Hit(*(float(x) for x in record[[8, 15, 16]]), *(int(i) for i in ids[17:20]))


def is_occluded(embree, origin, direction, t_far):
    """Whether anything lies on the ray within (0, t_far)."""
    record = np.zeros(RAY_BYTES // 4 + 4, np.float32)
    record = record[(-record.ctypes.data % 16) // 4 :][: RAY_BYTES // 4]
    record[0:3], record[3], record[4:7], record[8] = origin.values, T_NEAR, direction.values, t_far
    record.view(np.uint32)[9] = BLOCKS_LIGHT
    rtc.rtcOccluded1(embree, record.ctypes.data, None)
    return bool(record[8] < 0.0)


# Embree counts hits at its near end: rays from an eye on a surface through the origin would not leave it.
T_NEAR = float(np.finfo(np.float32).tiny)
_F32, _I32, _I64 = ir.FloatType(), ir.IntType(32), ir.IntType(64)
_POINTER = ir.IntType(8).as_pointer()


class _RayRecord:
    """An RTCRayHit (or RTCRay) on the kernel's stack."""

    def __init__(self, builder, size):
        self.builder = builder
        self.pointer = cgutils.alloca_once(builder, ir.ArrayType(_I32, size // 4))
        self.pointer.align = 64

    def slot(self, index, typ):
        base = self.builder.bitcast(self.pointer, typ.as_pointer())
        return self.builder.gep(base, [_I32(index)])

    def store(self, index, value):
        self.builder.store(value, self.slot(index, value.type))

    def load(self, index, typ):
        return self.builder.load(self.slot(index, typ))


def _query(builder, symbol, size, mask, embree, origin, direction, t_far):
    """Fill a ray record, call the query, return the record. Layout: RTCRayHit of Embree 4."""
    ray = _RayRecord(builder, size)
    for first, vector in ((0, origin), (4, direction)):
        for i in range(3):
            ray.store(first + i, builder.fptrunc(builder.extract_element(vector, _I32(i)), _F32))
    zero = ir.Constant(_F32, 0.0)
    ray.store(3, ir.Constant(_F32, T_NEAR))
    ray.store(7, zero)  # time
    ray.store(8, t_far)
    ray.store(9, _I32(mask))
    ray.store(10, _I32(0))
    ray.store(11, _I32(0))
    if size == RAYHIT_BYTES:
        for index in (17, 18, 19, 20):
            ray.store(index, _I32(-1))
    callee = cgutils.get_or_insert_function(
        builder.module, ir.FunctionType(ir.VoidType(), [_POINTER] * 3), symbol
    )
    record = builder.bitcast(ray.pointer, _POINTER)
    builder.call(callee, [builder.inttoptr(embree, _POINTER), record, ir.Constant(_POINTER, None)])
    return ray


HIT_TYPE = types.NamedTuple(
    [types.float64, types.float64, types.float64, types.int64, types.int64, types.int64], Hit
)


def _is_query(embree, origin, direction, t_far):
    return (
        isinstance(embree, types.Integer)
        and origin == VEC3
        and direction == VEC3
        and isinstance(t_far, types.Number)
    )


def _lower_closest_hit(context, builder, result, arg_types, args):
    embree = context.cast(builder, args[0], arg_types[0], types.int64)
    t_far = context.cast(builder, args[3], arg_types[3], types.float32)
    ray = _query(builder, "artist_rtcIntersect1", RAYHIT_BYTES, SEEN, embree, args[1], args[2], t_far)
    numbers = [builder.fpext(ray.load(i, _F32), ir.DoubleType()) for i in (8, 15, 16)]
    ids = [builder.zext(ray.load(i, _I32), _I64) for i in (17, 18, 19)]
    return context.make_tuple(builder, result, numbers + ids)


def _lower_is_occluded(context, builder, result, arg_types, args):
    embree = context.cast(builder, args[0], arg_types[0], types.int64)
    t_far = context.cast(builder, args[3], arg_types[3], types.float32)
    ray = _query(builder, "artist_rtcOccluded1", RAY_BYTES, BLOCKS_LIGHT, embree, args[1], args[2], t_far)
    return builder.fcmp_ordered("<", ray.load(8, _F32), ir.Constant(_F32, 0.0))


primitive(lambda *args: HIT_TYPE if _is_query(*args) else None)(closest_hit, _lower_closest_hit)
primitive(lambda *args: types.boolean if _is_query(*args) else None)(is_occluded, _lower_is_occluded)
