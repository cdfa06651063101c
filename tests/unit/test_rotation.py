"""Merging paths of different wavelengths: over all offsets of the photons, each lane gets what it should.

The functions run as plain Python. Photons stand at evenly spaced offsets, so that a mean over them is an integral.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from artist_py.core.table import Table
from artist_py.core.vector import Spectrum
from artist_py.core.wavelengths import sample_wavelengths, share_below
from artist_py.samplers.wavelengths import mean_acceptance
from artist_py.transport.rotation import Rotation, is_rejected, throughput_in_line, window_of

STEPS = 4000
SHARES = np.linspace(0.0, 1.0, 1025)
NODES = {
    "uniform": 380 + 400 * SHARES,
    "warped": 380 + 400 * SHARES**1.5,
    "line": np.interp(SHARES, [0, 0.3, 0.7, 1], [380, 546, 547, 780]),
}


def photon(nodes, zero, offset, flux):
    """A photon whose throughput is `flux` of its wavelengths."""
    wavelengths, _ = sample_wavelengths(nodes, zero, offset)
    return SimpleNamespace(offset=offset, pixel=1, throughput=flux(np.asarray(wavelengths)))


def merged(nodes, count, tolerance, offset, flux):
    """Mean throughput in line with an eye vertex at `offset`, float64 (count,), and its wavelengths."""
    zero = Spectrum(np.zeros(count))
    rotation = Rotation(tolerance, Table(np.array([offset])))
    wavelengths, _ = sample_wavelengths(nodes, zero, offset)
    window = window_of(rotation, nodes, wavelengths, 0)
    total = np.zeros(count)
    for u in (np.arange(STEPS) + 0.5) / STEPS:
        total += np.asarray(throughput_in_line(window, photon(nodes, zero, u, flux), zero))
    return total / STEPS, np.asarray(wavelengths)


@pytest.mark.parametrize("kind", NODES)
@pytest.mark.parametrize(("count", "tolerance"), [(1, 20), (4, 5), (4, 1000), (8, 10)])
@pytest.mark.parametrize("offset", [0.003, 0.4, 0.98])
def test_constant_flux_is_kept(kind, count, tolerance, offset):
    """Whatever the density of wavelengths, the tolerance, and how near the ends of the range."""
    found, _ = merged(NODES[kind], count, tolerance, offset, np.ones_like)
    assert found == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize("count", [4, 8])
def test_lanes_are_those_of_near_wavelengths(count):
    """A flux that is the wavelength itself comes out within the tolerance, and in the middle without bias."""
    for offset in (0.05, 0.5, 0.95):
        found, wavelengths = merged(NODES["uniform"], count, 5.0, offset, lambda x: x)
        assert np.all(np.abs(found / wavelengths - 1.0) < 0.03)
    assert found[1:-1] == pytest.approx(wavelengths[1:-1], rel=3e-2)


def test_photons_of_the_same_pair_are_always_accepted():
    zero = Spectrum(np.zeros(4))
    wavelengths, _ = sample_wavelengths(NODES["uniform"], zero, 0.3)
    window = window_of(Rotation(1.0, Table(np.array([0.3]))), NODES["uniform"], wavelengths, 0)
    own = SimpleNamespace(offset=np.float32(0.3), pixel=0, throughput=np.arange(4.0))
    assert np.array_equal(np.asarray(throughput_in_line(window, own, zero)), np.arange(4.0))
    far = SimpleNamespace(offset=0.6, pixel=1, throughput=np.ones(4))
    assert is_rejected(window, throughput_in_line(window, far, zero))


@pytest.mark.parametrize(("count", "tolerance"), [(1, 7.0), (4, 5.0), (8, 20.0)])
def test_mean_acceptance_of_a_uniform_density(count, tolerance):
    """2 d C / S (theory 2.7), less what the two ends of the range S cut off: C d^2 / S^2."""
    share = tolerance / 400
    expected = count * (2 * share - share**2)
    assert mean_acceptance(NODES["uniform"], count, tolerance) == pytest.approx(expected, rel=1e-4)


def test_everything_is_accepted_with_a_large_tolerance():
    """But for lanes that would be rotated from red to violet: a quarter of a step at either end."""
    assert mean_acceptance(NODES["line"], 4, 1e4) == pytest.approx(1.0 - 0.25 / 4, rel=1e-6)


@pytest.mark.parametrize("kind", NODES)
def test_share_below_is_the_inverse(kind):
    for u in (0.0, 1e-9, 0.1234, 0.5, 0.87, 1.0):
        assert share_below(NODES[kind], np.interp(u, SHARES, NODES[kind])) == pytest.approx(u, abs=1e-12)
    assert share_below(NODES[kind], 0.0) == 0.0
    assert share_below(NODES[kind], 1e4) == 1.0
