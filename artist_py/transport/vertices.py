"""Vertices that outlive their subpath: where they are stored, and how they are read again.

Records come from one pool. Threads take it chunk by chunk, or as many chunks in a row as one pixel may fill; a path
whose vertices might not fit is not begun, the pool is enlarged and the path traced then, so that no vertex is ever
dropped. Which chunk a path lies in depends on threads, the order of paths does not: whoever reads the pool goes by
path.
"""

from typing import NamedTuple

import numpy as np

from ..core.affine import load_vec3
from ..core.atomic import fetch_and_add
from ..core.table import Table
from ..core.vector import Spectrum, Vec3, lane, lane_count, with_lane
from ..geometry.surface import Surface
from ..jit import function
from .mis import Partial
from .subpath import Vertex, vertex_on

CHUNK = 4096  # records; threads take whole numbers of chunks
LARGEST = (
    1e36  # of C and E, whose float32 must not become infinite: infinity times a density of 0 is no number
)
NEXT_CHUNK, SHORTAGE = range(2)  # in Pool.state


def vertex_dtype(lanes, with_shading=True, with_uv=True, with_wavelength=False):
    """Layout of a stored vertex of a subpath with `lanes` wavelengths.

    Shading normals are left out where all are geometric, surface coordinates where nothing has a texture; a wavelength
    is there where each subpath has its own (shifting.py).
    """
    shading = [("shading_normal", "f4", 3)] if with_shading else []
    uv = [("u", "f4"), ("v", "f4")] if with_uv else []
    wavelength = [("wavelength", "f4")] if with_wavelength else []
    return np.dtype(
        [
            ("position", "f8", 3),
            ("normal", "f4", 3),  # geometric
            ("direction", "f4", 3),  # unit, back along the subpath
            ("throughput", "f4", lanes),  # as it arrives
            ("c", "f4"),  # see mis.py, on arrival
            ("e", "f4"),
            ("extent", "f4"),
            ("material", "i4"),
            ("length", "i4"),  # edges of the subpath up to here
            ("pixel", "i4"),  # eye vertices: row-major in the window
            *shading,
            *uv,
            *wavelength,
        ],
        align=True,
    )


class Pool(NamedTuple):
    """Vertex records and who has them."""

    records: Table  # vertex_dtype, a multiple of CHUNK rows
    state: Table  # int64: next free chunk, whether records have run short
    ends: Table  # int64 (threads, 3): each thread's next free record, and end and first record of its chunks
    used: Table  # int32 (chunks,): how many records of each chunk hold something
    shading: bool | None = True  # what records have, see `vertex_dtype`
    uv: bool | None = True


@function
def has_room(pool, thread, count):
    """Whether `thread` may store `count` records in a row; takes new chunks where its own are too full.

    All threads ask for the same `count` of a pool, so that one that finds too few chunks is not overtaken by another.
    """
    if pool is None:
        return True
    if pool.ends[thread, 0] + count <= pool.ends[thread, 1]:
        return True
    chunks = (count + CHUNK - 1) // CHUNK
    chunk = fetch_and_add(pool.state, NEXT_CHUNK, chunks)
    if (chunk + chunks) * CHUNK > pool.records.shape[0]:
        fetch_and_add(pool.state, NEXT_CHUNK, -chunks)
        pool.state[SHORTAGE] = 1
        return False
    pool.ends[thread, 0] = chunk * CHUNK
    pool.ends[thread, 1] = (chunk + chunks) * CHUNK
    pool.ends[thread, 2] = chunk * CHUNK
    return True


@function
def rewind(pool, merge, thread):
    """Without merges nobody asks for the light vertices of earlier pixels: start the thread's chunks again."""
    if pool is None:
        return
    if merge is None:
        pool.ends[thread, 0] = pool.ends[thread, 2]


@function
def store3(field, v):
    """Write a vector to the three numbers of a record's field."""
    field[0] = v.x
    field[1] = v.y
    field[2] = v.z


@function
def store_vertex(pool, thread, surface, direction, throughput, partial, length, pixel):
    """Append a vertex; `direction` points back along the subpath. Room has been made sure of."""
    row = pool.ends[thread, 0]
    pool.ends[thread, 0] = row + 1
    pool.used[row // CHUNK] = row % CHUNK + 1
    record = pool.records[row]
    store3(record.position, surface.position)
    store3(record.normal, surface.normal)
    store3(record.direction, direction)
    for i in range(lane_count(throughput)):
        record.throughput[i] = lane(throughput, i)
    record.c = min(partial.c, LARGEST)
    record.e = min(partial.e, LARGEST)
    record.extent = surface.extent
    record.material = surface.material
    record.length = length
    record.pixel = pixel
    _store_shading(pool.shading, record, surface)
    _store_uv(pool.uv, record, surface)


@function
def _store_shading(needed, record, surface):
    if needed is None:
        return
    store3(record.shading_normal, surface.shading_normal)


@function
def _store_uv(needed, record, surface):
    if needed is None:
        return
    record.u = surface.u
    record.v = surface.v


@function
def _load_shading(needed, record, normal):
    if needed is None:
        return normal
    return load_vec3(record.shading_normal)


@function
def _load_uv(needed, record):
    if needed is None:
        return 0.0, 0.0
    return float(record.u), float(record.v)


class StoredVertex(NamedTuple):
    """A vertex as it was stored."""

    vertex: Vertex
    direction: Vec3
    throughput: Spectrum
    partial: Partial
    length: int


@function
def load_vertex(scene, record, zero, wavelengths):
    """The `StoredVertex` of a record, of a subpath with these `wavelengths`; `zero` has as many."""
    normal = load_vec3(record.normal)
    shading = _load_shading(scene.needs.smooth_triangles, record, normal)
    u, v = _load_uv(scene.needs.textures, record)
    direction = load_vec3(record.direction)
    surface = Surface(
        load_vec3(record.position),
        normal,
        shading,
        u,
        v,
        float(record.extent),
        record.material,
        -1,
    )
    vertex = vertex_on(scene, surface, direction, wavelengths)
    return StoredVertex(
        vertex, direction, load_throughput(record, zero), Partial(record.c, record.e), record.length
    )


@function
def load_throughput(record, zero):
    """The throughput of a record."""
    throughput = zero
    for i in range(lane_count(zero)):
        throughput = with_lane(throughput, i, record.throughput[i])
    return throughput
