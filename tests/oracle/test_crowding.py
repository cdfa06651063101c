"""Weights with a(x) for a, as a photon density makes it (theory 6.2): exact, and still a partition of unity.

The density is a table of random numbers over large cells, which makes a(x) differ by orders of magnitude between the
vertices of a path.
"""

import functools
import math

import numpy as np
import oracle_scenes
import pytest
from recording import Recorder
from recurrences import Case, all_weights

from artist_py.core.table import Table
from artist_py.integrators.reference_densities import technique_densities, weight_of
from artist_py.transport import photon_density
from artist_py.transport.mis import Counts
from artist_py.transport.photon_density import PhotonDensity, counts_around

TOLERANCE = 1e-9
VM = 0.4
SUBSETS = {
    "vcm": Counts(1, 1, 1, 1, VM, None),
    "bpm": Counts(0, 0, 0, 0, VM, None),
    "parts": Counts(1, 0.7, 0.25, 0.31, VM, None),
}


@pytest.fixture(autouse=True)
def _plain_hash(monkeypatch):
    """The grid's hash wants machine integers, which plain Python does not have."""
    monkeypatch.setattr(photon_density, "bucket_of", lambda *cell: hash(cell[:3]) % cell[3])


@functools.cache
def scene_named(name):
    return oracle_scenes.SCENES[name]()


def record(patch, name, counts, pairs):
    """A `Recorder` that has traced so many pairs, with weights that know a photon density."""
    recorder = Recorder(patch, scene_named(name), counts)
    crowds = np.random.default_rng(7).integers(0, 100_000, 64) ** 2
    density = PhotonDensity(Table(crowds), 0.3, 1e-8)
    recorder.setup = recorder.setup._replace(method=recorder.setup.method._replace(density=density))
    for pair in range(pairs):
        recorder.trace(pair, pair % 8, 5 * pair // 2 % 8)
    return recorder


def brute_force(setup, wavelengths, path):
    """n p of every technique (1.3), with the a of its own vertex for merges."""
    method = setup.method
    found = technique_densities(setup.scene, setup.camera, method.counts, method.n_pixels, wavelengths, path)
    for kind, i in found:
        if kind == "vm":
            local = counts_around(method.density, method.counts, path.nodes[i].surface.position)
            found[kind, i] *= local.vm_area / method.counts.vm_area
    return found


def cases():
    """Every subset of techniques in every scene; by the power heuristic, which is one exponent, in one that is fast."""
    return [
        pytest.param(subset, name, power, marks=pytest.mark.slow if power and name != "mixed" else ())
        for subset in SUBSETS
        for name in ("mixed", "coated", "lens")
        for power in (None, True)
    ]


@pytest.mark.parametrize(("subset", "name", "power"), cases())
def test_weights(monkeypatch, name, subset, power):
    recorder = record(monkeypatch, name, SUBSETS[subset]._replace(power=power), 40)
    compared = {"vm": 0}
    for technique, weight, path in recorder.found:
        densities = brute_force(recorder.setup, recorder.wavelengths, path)
        expected = weight_of(technique, densities, 2 if power else 1)
        assert math.isclose(weight, expected, rel_tol=TOLERANCE), technique
        compared[technique[0]] = compared.get(technique[0], 0) + 1
    assert compared["vm"] >= 20
    assert subset == "bpm" or compared["vc"] >= 20


@pytest.mark.parametrize("power", [None, True], ids=["balance", "power"])
def test_weights_sum_to_one(monkeypatch, power):
    """Of all techniques that can find a path, by the recurrences along it from both ends."""
    recorder = record(monkeypatch, "mixed", SUBSETS["vcm"]._replace(power=power), 20)
    areas = set()
    for _, _, path in recorder.found:
        if len(path.edges) > 1:
            case = Case(recorder.setup, recorder.wavelengths, path)
            assert math.isclose(sum(all_weights(case).values()), 1.0, rel_tol=TOLERANCE)
            areas |= {case.counts(i).vm_area for i in range(1, len(path.edges))}
    assert len(areas) >= 20
    assert max(areas) == VM
    assert min(areas) < 0.1 * VM
