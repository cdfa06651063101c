"""Reading spectra in kernels: at the iteration's shared wavelengths, or from 1 nm bins at a path's own."""

import numpy as np
from numba.core import types

from ..jit import function
from .vector import Lanes, LanesType, lane, lane_count, primitive, splat, with_lane

# The largest float64 below 1.
ONE_MINUS = 1.0 - 2.0**-53


@function
def spectrum_at(spectra, row, wavelengths):
    """Values of spectrum `row` at the path's wavelengths."""
    return _read(spectra.resolved, spectra.dense, spectra.first, row, wavelengths)


# numba prunes a test for None only where the argument is None: what stands behind the test must compile in
# both cases.
@function
def _read(resolved, dense, first, row, wavelengths):
    if resolved is None:
        return _read_bins(dense, first, row, wavelengths)
    values = wavelengths
    # Unsigned, because numba would add a test for negative indices to every read.
    row = np.uintp(row)
    for i in range(lane_count(wavelengths)):
        values = with_lane(values, i, resolved[row, np.uintp(i)])
    return values


@function
def _read_bins(dense, first, row, wavelengths):
    values = wavelengths
    if dense is None:
        return values
    row = np.uintp(row)
    last_bin = dense.shape[1] - 1
    for i in range(lane_count(wavelengths)):
        # A wavelength just below the upper end may be rounded up to it.
        bin_index = min(int(lane(wavelengths, i) - first), last_bin)
        values = with_lane(values, i, dense[row, np.uintp(bin_index)])
    return values


@function
def ior_of_lane(spectra, row, wavelengths, index):
    """Index of refraction at the path's wavelength `index`, in float64."""
    return _read_ior(spectra.dense, spectra, row, wavelengths, index)


@function
def _read_ior(dense, spectra, row, wavelengths, index):
    if dense is None:
        return _read_resolved_ior(spectra.resolved, row, index)
    return ior_at(dense, spectra.first, row, np.float64(lane(wavelengths, index)))


@function
def _read_resolved_ior(resolved, row, index):
    if resolved is None:
        return 1.0
    return np.float64(resolved[row, index])


@function
def ior_at(dense, first, row, wavelength):
    """Index of refraction at one wavelength (nm), linear between the centres of the 1 nm bins."""
    if dense is None:
        return 1.0
    position = min(max(wavelength - first - 0.5, 0.0), dense.shape[1] - 1.001)
    bin_index = int(position)
    fraction = position - bin_index
    return (
        np.float64(dense[row, bin_index]) * (1.0 - fraction)
        + np.float64(dense[row, bin_index + 1]) * fraction
    )


@function
def ior_lanes(spectra, row, wavelengths):
    """Indices of refraction at the path's wavelengths."""
    values = wavelengths
    for i in range(lane_count(wavelengths)):
        values = with_lane(values, i, ior_of_lane(spectra, row, wavelengths, i))
    return values


@function
def choose_lane(ratio, w):
    """`(lane, rest)`: a lane drawn in proportion to `ratio`, and a number that is uniform on [0, 1) given the lane.

    `w` is uniform on [0, 1); `rest` is where it lies in its lane's part of that interval.
    """
    total = 0.0
    for i in range(lane_count(ratio)):
        total += np.float64(lane(ratio, i))
    remaining = w * total
    chosen, start, share = 0, remaining, 1.0
    for i in range(lane_count(ratio)):
        r = np.float64(lane(ratio, i))
        if r > 0.0 and remaining >= 0.0:
            chosen, start, share = i, remaining, r
            remaining -= r
    return chosen, min(start / share, ONE_MINUS)


@function
def black(wavelengths):
    """Zero at every wavelength."""
    return splat(wavelengths, 0.0)


def lane_of(value, index):
    """Lane `index` of a spectrum, or the number that stands for all lanes, as a float64."""
    return float(value.values[index] if isinstance(value, Lanes) else value)


def _lower_lane_of(context, builder, result, arg_types, args):
    if not isinstance(arg_types[0], LanesType):
        return context.cast(builder, args[0], arg_types[0], result)
    number = builder.extract_element(args[0], context.cast(builder, args[1], arg_types[1], types.int32))
    return context.cast(builder, number, arg_types[0].scalar, result)


primitive(lambda value, index: types.float64 if isinstance(value, (LanesType, types.Number)) else None)(
    lane_of, _lower_lane_of
)
