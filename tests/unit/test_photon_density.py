"""The photon density that weights use: what it says of photons that lie evenly, as plain Python."""

import math

import numpy as np
import pytest

from artist_py.core.table import Table
from artist_py.core.vector import vec3
from artist_py.transport import photon_density
from artist_py.transport.mis import Counts
from artist_py.transport.photon_density import (
    PhotonDensity,
    counts_around,
    deposit,
    photons_per_area,
    scale_of,
)

CELL, COUNT = 0.05, 8000  # over the unit square: 20 per cell
COUNTS = Counts(1.0, 1.0, 1.0, 1.0, 3.0, None)


@pytest.fixture(autouse=True)
def _plain_hash(monkeypatch):
    """The grid's hash wants machine integers, which plain Python does not have."""
    monkeypatch.setattr(photon_density, "bucket_of", lambda *cell: hash(cell[:3]) % cell[3])


def density_of(points, n_paths):
    density = PhotonDensity(Table(np.zeros(1 << 16, np.int64)), CELL, scale_of(n_paths, CELL))
    for point in points:
        deposit(density, *point)
    return density


def on_plane(u, v, tilt):
    """Points of a unit square that is turned about the x axis and shifted off the grid."""
    return [(x, y * math.cos(tilt) + 0.013, y * math.sin(tilt) + 0.371) for x, y in zip(u, v, strict=True)]


@pytest.mark.parametrize("tilt", [0.1, 0.4, 0.7])
def test_even_photons(tilt):
    """The mean over points away from the edges is the density, within what a plane that is oblique to the grid does."""
    random = np.random.default_rng(3)
    density = density_of(on_plane(*random.random((2, COUNT)), tilt), n_paths=4 * COUNT)
    points = on_plane(*(0.15 + 0.7 * random.random((2, 400))), tilt)
    found = np.array([photons_per_area(density, vec3(*point)) for point in points])
    assert found.mean() == pytest.approx(0.25, rel=0.1)
    assert found.min() > 0.05
    assert photons_per_area(density, vec3(0.5, 0.5, 5.0)) == 0.0


def test_merges_count_less_where_photons_crowd():
    """a(x) = min(a, 1 / q)."""
    density = PhotonDensity(Table(np.full(16, 10, np.int64)), CELL, 0.1)
    crowded, sparse = (
        counts_around(density._replace(scale=scale), COUNTS, vec3(0, 0, 0)) for scale in (1.0, 0.01)
    )
    assert crowded == COUNTS._replace(vm_area=pytest.approx(0.1))
    assert sparse == COUNTS
    assert counts_around(None, COUNTS, vec3(0, 0, 0)) is COUNTS
