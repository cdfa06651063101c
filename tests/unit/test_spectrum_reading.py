"""Reading spectra and indices of refraction in kernels, and drawing a lane."""

import numpy as np
import pytest

from artist_py.core.spectra import (
    choose_lane,
    ior_at,
    ior_lanes,
    ior_of_lane,
    lane_of,
    spectrum_at,
)
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, lane
from artist_py.jit import kernel
from artist_py.scene.tables import Spectra

WAVELENGTHS = Spectrum([380.0, 499.99, 500.0, 780.0])
DENSE = Table(np.stack([np.arange(400) / 400, 1.5 + 1e-4 * np.arange(400)]).astype(np.float32))
INDEPENDENT = Spectra(None, DENSE, 380.0)
SHARED = Spectra(Table(np.array([[0.1, 0.2, 0.3, 0.4], [1.5, 1.6, 1.7, 1.8]], np.float32)), None, 380.0)


@kernel
def read_rows(spectra, wavelengths, row, out):
    values, indices = spectrum_at(spectra, row, wavelengths), ior_lanes(spectra, row, wavelengths)
    for i in range(4):
        out[0, i], out[1, i] = lane(values, i), lane(indices, i)
        out[2, i] = ior_of_lane(spectra, row, wavelengths, i)


@kernel
def choose_rows(ratio, numbers, lanes, rests):
    for i in range(len(numbers)):
        lanes[i], rests[i] = choose_lane(ratio, numbers[i])


def test_bins_are_read_at_the_paths_wavelengths():
    """The last wavelength was rounded up to the end of the range, and belongs to the last bin."""
    np.testing.assert_allclose(spectrum_at(INDEPENDENT, 0, WAVELENGTHS), np.array([0, 119, 120, 399]) / 400)


def test_shared_wavelengths_are_read_as_they_stand():
    np.testing.assert_array_equal(spectrum_at(SHARED, 1, WAVELENGTHS), SHARED.resolved[1])
    np.testing.assert_array_equal(ior_lanes(SHARED, 1, WAVELENGTHS), SHARED.resolved[1])


@pytest.mark.parametrize("spectra", [INDEPENDENT, SHARED], ids=["independent", "shared"])
@pytest.mark.parametrize("row", [0, 1])
def test_compiled_reading_agrees_with_python(spectra, row):
    out = np.empty((3, 4))
    read_rows(spectra, WAVELENGTHS, row, out)
    np.testing.assert_array_equal(out[0], spectrum_at(spectra, row, WAVELENGTHS).values)
    np.testing.assert_allclose(out[1], ior_lanes(spectra, row, WAVELENGTHS).values, rtol=1e-7)
    np.testing.assert_allclose(
        out[2], [ior_of_lane(spectra, row, WAVELENGTHS, i) for i in range(4)], rtol=1e-15
    )


def test_indices_are_interpolated_between_the_centres_of_bins():
    assert ior_at(DENSE, 380.0, 1, 500.5) == pytest.approx(DENSE[1, 120], rel=1e-12)
    middle = 0.5 * (float(DENSE[1, 120]) + float(DENSE[1, 121]))
    assert ior_at(DENSE, 380.0, 1, 501.0) == pytest.approx(middle, rel=1e-12)
    assert ior_at(DENSE, 380.0, 1, 300.0) == DENSE[1, 0]
    assert ior_at(DENSE, 380.0, 1, 900.0) == pytest.approx(DENSE[1, 399], rel=1e-6)


@pytest.mark.parametrize(
    "ratio", [[1, 1, 1, 1], [0.1, 2.9, 0.3, 0.7], [0, 4, 0, 0], [0, 1, 0, 3], [1.5, 0, 2.5, 0]]
)
def test_lanes_are_drawn_in_proportion_and_the_rest_is_uniform(ratio):
    """Enumeration over 100 000 strata of w, of which each boundary between lanes may misplace one."""
    count = 100_000
    lanes, rests = np.empty(count, int), np.empty(count)
    choose_rows(Spectrum(ratio), (np.arange(count) + 0.5) / count, lanes, rests)
    np.testing.assert_allclose(np.bincount(lanes, minlength=4) / count, np.array(ratio) / 4, atol=2e-5)
    assert np.all((rests >= 0.0) & (rests < 1.0))
    for i in np.flatnonzero(ratio):
        mine = rests[lanes == i]
        np.testing.assert_allclose(mine, (np.arange(len(mine)) + 0.5) / len(mine), atol=2.0 / len(mine))


@pytest.mark.parametrize("w", [0.0, 1.0 - 2.0**-53])
@pytest.mark.parametrize(
    "ratio", [[0, 0.5, 3.5, 0], [0.1, 2.9, 0.3, 0.7], [4, 0, 0, 0], [0, 0, 0, 4.0000005]]
)
def test_the_ends_of_the_interval_belong_to_living_lanes(ratio, w):
    chosen, rest = choose_lane(Spectrum(ratio), w)
    assert ratio[chosen] > 0.0
    assert 0.0 <= rest < 1.0


def test_numbers_stand_for_all_lanes():
    assert lane_of(1.5, 3) == 1.5
    assert lane_of(Spectrum([1.0, 2.0]), 1) == 2.0
