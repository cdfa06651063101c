"""Merging subpaths that have wavelengths of their own: lanes within a tolerance of each other, after a rotation.

The hero sets of two subpaths are F^-1((u + i) / C) with offsets u of their own (core/wavelengths.py). A cyclic rotation
of the lanes by at most one step brings each wavelength next to its nearest of the other set; where it wraps red onto
violet the lane is dropped. A lane of an eye vertex at wavelength l accepts photons with l' in a window around it:
[l - d, l + d], not beyond half a step to either side, nor beyond the ends of the range. It is accepted with probability
C (F(high) - F(low)), P_acc of theory (2.7), and as u' is uniform l' has density C p(l') there. A photon counts

    1 / (C p(l') (high - low)),

so that what merges bring is the mean of the flux over the window (2.8): exact wherever flux does not depend on
wavelength, elsewhere blurred over 2 d, a bias that does not shrink with the radius. Dividing by P_acc, which is the
same where p is constant, would give wavelengths with much light more than their share: lines became several times too
bright.
"""

from typing import NamedTuple

from ..core.spectra import black
from ..core.table import Table
from ..core.vector import Spectrum, lane, lane_count, lane_sum, with_lane
from ..core.wavelengths import sample_wavelengths, share_below, wavelength_at
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
    width: Spectrum  # of that in wavelength, nm
    nodes: Table  # float64 (n + 1,), see core/wavelengths.py
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
    low, high, width = black(wavelengths), black(wavelengths), black(wavelengths)
    offset, count = rotation.offsets[pixel], lane_count(wavelengths)
    for i in range(count):
        wavelength = float(lane(wavelengths, i))
        below = count * share_below(nodes, wavelength - rotation.tolerance)
        above = count * share_below(nodes, wavelength + rotation.tolerance)
        below, above = max(below, offset + i - 0.5), min(above, offset + i + 0.5)
        first, _ = wavelength_at(nodes, below / count)
        last, _ = wavelength_at(nodes, above / count)
        low, high = with_lane(low, i, below), with_lane(high, i, above)
        width = with_lane(width, i, last - first)
    return Window(low, high, width, nodes, offset, pixel)


@function
def wavelengths_of_pixel(offsets, sensing, shared, pixel):
    """`(wavelengths, weights)` of a pixel's eye subpath: `shared`, unless `offsets` say that it has its own."""
    if offsets is None:
        return shared
    return sample_wavelengths(sensing.nodes, sensing.zero, offsets[pixel])


@function
def throughput_in_line(window, photon, zero):
    """The photon's throughput at the wavelengths of the eye vertex, as it counts; zero for lanes not accepted."""
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
        position = photon.offset + (i + rotation)
        if lane(window.low, i) <= position < lane(window.high, i) and 0 <= i + rotation < count:
            _, inverse_density = wavelength_at(window.nodes, position / count)
            value = photon.throughput[i + rotation] * (inverse_density / (count * lane(window.width, i)))
            throughput = with_lane(throughput, i, value)
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
