"""Photons sorted into a hash grid by a counting sort; its memory follows the photons, not the volume.

Cells are cubes of twice the merge radius, hashed to as many buckets as there are photons or more. Threads own ranges of
buckets and go over all paths in order, so that the order of photons does not depend on threads.
"""

import math
from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import is_mergeable
from ..core.affine import load_vec3
from ..core.table import Table
from ..jit import function, kernel
from .rotation import note_offset
from .shares import is_chosen
from .shifting import note_wavelength
from .vertices import store3

_U64 = np.uint64


def photon_dtype(lanes, with_offset=False, with_wavelength=False):
    """Layout of a photon: what a merge reads, and no more.

    `with_offset` adds what tells its own wavelengths where these are heroes (rotation.py), `with_wavelength` where it
    has one that shifts (shifting.py).
    """
    own = [("offset", "f4"), ("pixel", "i4")] if with_offset else []
    own += [("wavelength", "f4")] if with_wavelength else []
    return np.dtype(
        [
            ("position", "f4", 3),
            ("direction", "f4", 3),  # unit, back along the light subpath
            ("normal", "f4", 3),
            ("throughput", "f4", lanes),
            ("length", "i4"),
            ("c", "f4"),
            ("e", "f4"),
            *own,
        ],
        align=True,
    )


class Grid(NamedTuple):
    """Photons by bucket: those of bucket b are rows [starts[b], starts[b + 1])."""

    photons: Table  # photon_dtype
    starts: Table  # int32 (buckets + 1,), buckets a power of two
    cell: float  # edge of a cell, render-space units


@function
def cell_of(x, cell):
    """Integer coordinate of the cell that holds `x`."""
    return math.floor(x / cell)


@function
def bucket_of(i, j, k, buckets):
    """Bucket of a cell: a hash of its row (Teschner et al. 2003), and from there one after the other along x.

    So two neighbours in a row are one range of photons, and one place in memory instead of two.
    """
    mixed = (_U64(j) * _U64(19349663)) ^ (_U64(k) * _U64(83492791))
    mixed = (mixed ^ (mixed >> _U64(15))) * _U64(0x9E3779B97F4A7C15)
    return int(((mixed >> _U64(20)) + _U64(i)) & _U64(buckets - 1))


@kernel
def count_photons(grid, records, paths, share, materials, first, end):
    """Count the photons of buckets [first, end) into `starts[1 + bucket]`; returns their number.

    `share` is the `Share` of subpaths that are merged with; `materials` the scene's, absent where all are merged at.
    """
    buckets = grid.starts.shape[0] - 1
    for bucket in range(first, end):
        grid.starts[bucket + 1] = 0
    total = 0
    for index in range(paths.shape[0]):
        path = paths[index]
        if not is_chosen(share, index):
            continue
        for i in range(path.n_vertices):
            record = records[path.first_vertex + i]
            bucket = _bucket_of_vertex(record, grid.cell, buckets)
            if first <= bucket < end and _is_photon(materials, record):
                grid.starts[bucket + 1] += 1
                total += 1
    return total


@kernel
def place_photons(grid, records, paths, share, materials, first, end, before, offsets, with_wavelength):
    """Turn the counts of buckets [first, end) into starts, and copy their photons; `before` lie in earlier buckets.

    While photons are placed `starts[b + 1]` is where the next one of b goes; in the end it is where b + 1 starts.
    `offsets` are those of a `Rotation`, where there is one; `with_wavelength` is `True` where records have one.
    """
    buckets = grid.starts.shape[0] - 1
    position = before
    for bucket in range(first, end):
        count = grid.starts[bucket + 1]
        grid.starts[bucket + 1] = position
        position += count
    for index in range(paths.shape[0]):
        path = paths[index]
        if not is_chosen(share, index):
            continue
        for i in range(path.n_vertices):
            record = records[path.first_vertex + i]
            bucket = _bucket_of_vertex(record, grid.cell, buckets)
            if first <= bucket < end and _is_photon(materials, record):
                row = grid.starts[bucket + 1]
                grid.starts[bucket + 1] = row + 1
                _copy(record, grid.photons[row])
                note_offset(offsets, path, grid.photons[row])
                note_wavelength(with_wavelength, record, grid.photons[row])


@function
def _is_photon(materials, record):
    if materials is None:
        return True
    return is_mergeable(True, materials[record.material])


@function
def _bucket_of_vertex(record, cell, buckets):
    x, y, z = (np.float32(record.position[0]), np.float32(record.position[1]), np.float32(record.position[2]))
    return bucket_of(cell_of(x, cell), cell_of(y, cell), cell_of(z, cell), buckets)


@function
def is_in_pair(position, i, j, k, cell):
    """Whether a photon's position (float32) lies in cell (i, j, k) or (i + 1, j, k), by the arithmetic that sorts."""
    return (
        0 <= cell_of(np.float32(position[0]), cell) - i <= 1
        and cell_of(np.float32(position[1]), cell) == j
        and cell_of(np.float32(position[2]), cell) == k
    )


@function
def _copy(record, photon):
    store3(photon.position, load_vec3(record.position))
    store3(photon.direction, load_vec3(record.direction))
    store3(photon.normal, load_vec3(record.normal))
    for i in range(len(record.throughput)):
        photon.throughput[i] = record.throughput[i]
    photon.length = record.length
    photon.c = record.c
    photon.e = record.e
