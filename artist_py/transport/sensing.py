"""Which wavelengths a path has, and what its radiance is to the film."""

from typing import NamedTuple

from ..core.rng import random_pair
from ..core.sets import first_lanes, given
from ..core.spectra import spectrum_at
from ..core.table import Table
from ..core.vector import Spectrum, lane, lane_count, lane_sum, with_lane
from ..core.wavelengths import sample_wavelengths
from ..jit import function

RED, GREEN, BLUE = 0, 1, 2  # rows of the scene's spectra: the sensor, linear sRGB per radiance and nm


class Bands(NamedTuple):
    """A spectral image of one iteration."""

    image: Table  # float32 (h, w, n), radiance averaged over each band, W m^-2 sr^-1 nm^-1
    first: float  # nm, lower edge of band 0
    width: float  # nm


class Sensing(NamedTuple):
    """Wavelengths and sensor of one iteration; `shared` is absent where every path has wavelengths of its own."""

    zero: Spectrum  # zero at every wavelength of a path: says how many there are, in all sets
    ratio: (
        Spectrum | None
    )  # one at every wavelength, absent where no density depends on it: r of theory (2.6)
    nodes: Table  # float64 (n + 1,), see core/wavelengths.py
    shared: Table | None  # float64 (2, C): wavelengths in nm, and weights 1 / (C p) in nm
    bands: Bands | None
    seen: Spectrum | None = (
        None  # zero at those that the film sees, set 0; absent where there is only one set
    )
    start: Spectrum | None = (
        None  # the first throughput of eye subpaths, where that is a matrix (core/sets.py)
    )


@function
def wavelengths_of_path(sensing, stream, pair):
    """`(wavelengths, weights)` of a path: its own, or those of the iteration; weights of those that the film sees."""
    return _wavelengths(sensing.shared, sensing, stream, pair)


@function
def _wavelengths(shared, sensing, stream, pair):
    if shared is None:
        wavelengths, weights = sample_wavelengths(sensing.nodes, sensing.zero, random_pair(stream, pair)[0])
        return wavelengths, first_lanes(weights, given(sensing.seen, weights))
    wavelengths, weights = sensing.zero, given(sensing.seen, sensing.zero)
    for i in range(lane_count(wavelengths)):
        wavelengths = with_lane(wavelengths, i, shared[0, i])
    for i in range(lane_count(weights)):
        weights = with_lane(weights, i, shared[1, i])
    return wavelengths, weights


@function
def rgb_of(spectra, contribution, wavelengths):
    """Linear RGB (r, g, b) of radiance times the weights of its wavelengths, the first of `wavelengths`."""
    wavelengths = first_lanes(wavelengths, contribution)
    red = lane_sum(contribution * spectrum_at(spectra, RED, wavelengths))
    green = lane_sum(contribution * spectrum_at(spectra, GREEN, wavelengths))
    blue = lane_sum(contribution * spectrum_at(spectra, BLUE, wavelengths))
    return red, green, blue


@function
def store_sample(sensing, spectra, image, row, column, radiance, wavelengths, weights):
    """Write linear RGB of `radiance` to `image[row, column]`, and its spectrum where one is wanted."""
    contribution = radiance * weights
    red, green, blue = rgb_of(spectra, contribution, wavelengths)
    image[row, column, 0] = red
    image[row, column, 1] = green
    image[row, column, 2] = blue
    _store_bands(sensing.bands, row, column, contribution, wavelengths)


@function
def add_sample(sensing, spectra, image, row, column, contribution, wavelengths):
    """Add to `image[row, column]`, and to its spectrum where one is wanted, radiance times its wavelengths' weights."""
    red, green, blue = rgb_of(spectra, contribution, wavelengths)
    image[row, column, 0] += red
    image[row, column, 1] += green
    image[row, column, 2] += blue
    _add_bands(sensing.bands, row, column, contribution, wavelengths)


@function
def _add_bands(bands, row, column, contribution, wavelengths):
    if bands is None:
        return
    for i in range(lane_count(contribution)):
        band = int((lane(wavelengths, i) - bands.first) / bands.width)
        band = min(max(band, 0), bands.image.shape[2] - 1)
        bands.image[row, column, band] += lane(contribution, i) / bands.width


@function
def _store_bands(bands, row, column, contribution, wavelengths):
    if bands is None:
        return
    count = bands.image.shape[2]
    for i in range(count):
        bands.image[row, column, i] = 0.0
    _add_bands(bands, row, column, contribution, wavelengths)
