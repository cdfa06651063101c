"""Wavelengths that shift at fluorescent events: where they are led to, and what photons of others stand for.

The functions run as plain Python. Random numbers stand evenly spaced, so that a mean over them is an integral.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3
from artist_py.core.warp import INV_PI
from artist_py.samplers.wavelengths import tolerance_of
from artist_py.scene.compile_shifting import redistribution
from artist_py.scene.graph import Merging
from artist_py.scene.tables import Needs, Reemission
from artist_py.transport.shifting import Matching, is_unmatched, of_power, redistributed

FIRST, BINS = 400, 12
NEEDS, UP = Needs(), Vec3([0.0, 0.0, 1.0])
STEPS = 5_000
NUMBERS = (np.arange(STEPS) + 0.5) / STEPS


def matrices():
    """Two materials: of any numbers on either side of the diagonal, and of very unlike ones below it."""
    random = np.random.default_rng(3)
    rough = np.tril(10.0 ** random.uniform(-4, 0, (BINS, BINS)), -2)
    rough[5] = 0.0  # nothing is given off there
    return np.array([random.random((BINS, BINS)), rough])


@pytest.mark.parametrize("row", [0, 1])
@pytest.mark.parametrize("elastic", [0.0, 0.4])
def test_wavelengths_are_led_to_in_proportion_to_the_matrix(row, elastic):
    matrix = matrices()[row]
    table = redistribution(matrices(), FIRST)
    for own in range(BINS):
        start = FIRST + own + 0.25
        drawn = [redistributed(table, row, start, elastic, u) for u in NUMBERS]
        total = elastic + matrix[own].sum()
        assert all(found == pytest.approx(total, rel=1e-6) for _, found in drawn)
        reached = np.array([wavelength for wavelength, _ in drawn])
        is_new = reached != start
        counts = np.bincount((reached[is_new] - FIRST).astype(int), minlength=BINS) / STEPS
        expected = matrix[own] / total if total else np.zeros(BINS)
        # Every bin's numbers are one interval.
        assert counts == pytest.approx(expected, abs=2.5 / STEPS)
        assert (counts[expected == 0.0] == 0.0).all()


def test_what_is_drawn_stays_in_its_bin_in_float32():
    """The bin below a bright line must not be rounded into it."""
    table = redistribution(np.eye(BINS)[None, ::-1], FIRST)
    for u in (0.0, 0.3, 0.99999, 1.0 - 2.0**-53):
        wavelength, _ = redistributed(table, 0, FIRST + 2.5, 0.0, u)
        assert int(np.float32(wavelength)) == FIRST + BINS - 1 - 2


def photons(count=4000):
    """A power of 1 per nm, all over the range: photons at so many wavelengths."""
    wavelengths = FIRST + BINS * (np.arange(count) + 0.5) / count
    return [SimpleNamespace(wavelength=np.float32(nm)) for nm in wavelengths], BINS / count


@pytest.mark.parametrize("tolerance", [0.5, 3.0, 50.0])
@pytest.mark.parametrize("wavelength", [400.1, 402.0, 406.3, 411.9])
def test_a_constant_spectrum_is_kept(tolerance, wavelength):
    """At the ends of the range as well, and where the tolerance is larger than that."""
    matching = Matching(tolerance, float(FIRST), float(FIRST + BINS))
    plain, lane = SimpleNamespace(fluorescence=-1), Spectrum([wavelength])
    f, (all_photons, power) = Spectrum([0.2]), photons()
    accepted = [photon for photon in all_photons if not is_unmatched(matching, plain, photon, lane)]
    total = sum(
        float(of_power(matching, None, NEEDS, plain, photon, lane, f, UP, UP).values[0])
        for photon in accepted
    )
    assert total * power == pytest.approx(0.2, rel=3e-3)
    rejected = [photon for photon in all_photons if is_unmatched(matching, plain, photon, lane)]
    assert all(abs(photon.wavelength - wavelength) > tolerance for photon in rejected)


def test_a_dye_takes_photons_of_all_wavelengths():
    """The integral of R(out, in) over `in`, over pi, and besides what is matched."""
    matching = Matching(1.0, float(FIRST), float(FIRST + BINS))
    reemission = Reemission(
        redistribution(matrices().transpose(0, 2, 1), FIRST), Table(matrices().astype("f4")), None
    )
    dye, lane, (all_photons, power) = SimpleNamespace(fluorescence=1), Spectrum([408.5]), photons()
    assert not any(is_unmatched(matching, dye, photon, lane) for photon in all_photons)
    values = [
        of_power(matching, reemission, NEEDS, dye, photon, lane, Spectrum([0.2]), UP, UP)
        for photon in all_photons
    ]
    expected = 0.2 + INV_PI * matrices()[1, 8].sum()
    assert sum(float(value.values[0]) for value in values) * power == pytest.approx(expected, rel=3e-3)


def test_tolerance_shrinks():
    merging = Merging(wavelength_tolerance=50.0, tolerance_exponent=0.25)
    assert [tolerance_of(merging, n) for n in (0, 15, 9999)] == pytest.approx([50.0, 25.0, 5.0])
    assert tolerance_of(Merging(), 100) == 5.0
