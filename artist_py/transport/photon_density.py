"""How many photons lie around a point, from a pilot pass: what weights need to know of correlated merges (theory 6.2).

Merges at a point share their photons, and as soon as the kernel holds more than one they are no independent samples.
VCM+ (Jendersie and Grosch 2018) therefore weighs them as n_vm / max(1, A rho) samples instead of n_vm, with A = pi r^2
and rho the number of photons per area and iteration. In terms of q = rho / n_vm, that of one light subpath,

    a(x) = min(n_vm A, 1 / q(x)).

q depends on x alone, so that the recurrences of mis.py stay exact with a(x_i) for a on both sides. It is counted before
the first iteration, with random numbers of its own, and then stays: iterations do not depend on each other. A photon is
spread over the eight nearest cells of a hash grid. Cells that share a bucket add up, which makes weights a little less
good and nothing wrong.
"""

import math
from typing import NamedTuple

from ..core.atomic import fetch_and_add
from ..core.table import Table
from ..jit import function
from .mis import with_vm_area
from .photon_grid import bucket_of, cell_of

UNIT = 1024  # a photon in the counters: whole numbers, whose sum does not depend on the order of threads
# Mean share of a photon that the cell of a point gets, for photons spread over a plane along the grid: that of
# 1 - |h| over h in [-1/2, 1/2].
SHARE = 0.75


class PhotonDensity(NamedTuple):
    """Photons of the pilot pass by bucket."""

    counts: Table  # int64 (buckets,), a power of two, in parts of a photon
    cell: float  # edge of a cell, render-space units
    scale: float  # from a count to photons per light subpath and area


def scale_of(n_paths, cell):
    """`PhotonDensity.scale` after a pilot pass of so many light subpaths."""
    return 1.0 / (n_paths * UNIT * SHARE * cell**2)


@function
def deposit(density, x, y, z):
    """Count a photon at (x, y, z), by linear interpolation between the centres of cells."""
    buckets = density.counts.shape[0]
    x, y, z = x / density.cell - 0.5, y / density.cell - 0.5, z / density.cell - 0.5
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = x - i, y - j, z - k
    for corner in range(8):
        dx, dy, dz = corner & 1, (corner >> 1) & 1, corner >> 2
        share = (u if dx else 1.0 - u) * (v if dy else 1.0 - v) * (w if dz else 1.0 - w)
        fetch_and_add(density.counts, bucket_of(i + dx, j + dy, k + dz, buckets), int(share * UNIT + 0.5))


@function
def photons_per_area(density, position):
    """q: photons per light subpath and area around a point, render-space units^-2."""
    i, j, k = (
        cell_of(position.x, density.cell),
        cell_of(position.y, density.cell),
        cell_of(position.z, density.cell),
    )
    return density.counts[bucket_of(i, j, k, density.counts.shape[0])] * density.scale


@function
def counts_around(density, counts, position):
    """`Counts` for the weights at a vertex: with a(x) for a, where there is a `PhotonDensity`."""
    if density is None:
        return counts
    return _local(density, counts, position)


@function
def _local(density, counts, position):
    crowding = counts.vm_area * photons_per_area(density, position)  # A rho
    return with_vm_area(counts, counts.vm_area / max(crowding, 1.0))
