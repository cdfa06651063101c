"""Merging subpaths that have wavelengths of their own: lanes within a tolerance of each other, after a rotation.

The hero sets of two subpaths are F^-1((u + i) / C) with offsets u of their own (core/wavelengths.py). A cyclic rotation
of the lanes by at most one step brings each wavelength next to its nearest of the other set; where it wraps red onto
violet the lane is dropped. A lane of an eye vertex at wavelength l accepts photons with l' in [l - d, l + d], and as
u' is uniform the probability of that is (theory 2.7, for any density of wavelengths and at the ends of the range)

    P_acc(l) = C (F(l + d) - F(l - d)),   not beyond half a step to either side.

Dividing by it makes merges exact wherever flux does not depend on wavelength; elsewhere they are blurred over 2 d
(2.8), a bias that does not shrink with the radius.
"""

from typing import NamedTuple

from ..core.spectra import black
from ..core.table import Table
from ..core.vector import Spectrum, lane, lane_count, lane_sum, with_lane
from ..core.wavelengths import sample_wavelengths, share_below
from ..jit import function
from .vertices import load_throughput


class Rotation(NamedTuple):
    """Where every pixel's subpaths have wavelengths of their own."""

    tolerance: float  # d, nm
    offsets: Table  # float64: u of each pixel of the window


class Window(NamedTuple):
    """What an eye vertex accepts: photons whose lane lies at u' + i in [low, high) of their C steps."""

    low: Spectrum
    high: Spectrum
    offset: float
    pixel: int


@function
def window_of(rotation, nodes, wavelengths, pixel):
    """The `Window` of an eye vertex with these wavelengths; `None` where all subpaths have the same."""
    if rotation is None:
        return None
    return _window(rotation, nodes, wavelengths, pixel)


@function
def _window(rotation, nodes, wavelengths, pixel):
    low, high = black(wavelengths), black(wavelengths)
    offset, count = rotation.offsets[pixel], lane_count(wavelengths)
    for i in range(count):
        wavelength = float(lane(wavelengths, i))
        below = count * share_below(nodes, wavelength - rotation.tolerance)
        above = count * share_below(nodes, wavelength + rotation.tolerance)
        low = with_lane(low, i, max(below, offset + i - 0.5))
        high = with_lane(high, i, min(above, offset + i + 0.5))
    return Window(low, high, offset, pixel)


@function
def wavelengths_of_pixel(offsets, sensing, shared, pixel):
    """`(wavelengths, weights)` of a pixel's eye subpath: `shared`, unless `offsets` say that it has its own."""
    if offsets is None:
        return shared
    return sample_wavelengths(sensing.nodes, sensing.zero, offsets[pixel])


@function
def throughput_in_line(window, photon, zero):
    """The photon's throughput at the wavelengths of the eye vertex, over P_acc; zero where a lane is not accepted."""
    if window is None:
        return load_throughput(photon, zero)
    return _rotated(window, photon, zero)


@function
def _rotated(window, photon, zero):
    if photon.pixel == window.pixel:
        return load_throughput(photon, zero)  # the same wavelengths, always: P_acc is 1
    throughput, count = black(zero), lane_count(zero)
    difference = photon.offset - window.offset
    rotation = 0
    if difference > 0.5:
        rotation = -1
    elif difference < -0.5:
        rotation = 1
    for i in range(count):
        low, high, position = lane(window.low, i), lane(window.high, i), photon.offset + (i + rotation)
        if low <= position < high and 0 <= i + rotation < count:
            throughput = with_lane(throughput, i, photon.throughput[i + rotation] / (high - low))
    return throughput


@function
def is_rejected(window, throughput):
    """Whether no lane of a photon is accepted."""
    if window is None:
        return False
    return lane_sum(throughput) == 0.0


@function
def note_offset(offsets, path, photon):
    """Keep with the photon what tells its wavelengths, where it has its own."""
    if offsets is None:
        return
    photon.pixel = path.pixel
    photon.offset = offsets[path.pixel]
