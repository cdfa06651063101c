"""Reading spectra in kernels: at the iteration's shared wavelengths, or from 1 nm bins at a path's own."""

from ..jit import function
from .vector import lane, lane_count, splat, with_lane


@function
def spectrum_at(spectra, row, wavelengths):
    """Values of spectrum `row` at the path's wavelengths."""
    return _read(spectra.resolved, spectra.dense, spectra.first, row, wavelengths)


@function
def _read(resolved, dense, first, row, wavelengths):
    values = wavelengths
    if resolved is None:
        for i in range(lane_count(wavelengths)):
            values = with_lane(values, i, dense[row, int(lane(wavelengths, i) - first)])
        return values
    for i in range(lane_count(wavelengths)):
        values = with_lane(values, i, resolved[row, i])
    return values


@function
def ior_at(spectra, row, wavelength):
    """Index of refraction at one wavelength (nm), linear between the centres of the 1 nm bins."""
    dense = spectra.dense
    position = min(max(wavelength - spectra.first - 0.5, 0.0), dense.shape[1] - 1.001)
    bin_index = int(position)
    fraction = position - bin_index
    return dense[row, bin_index] * (1.0 - fraction) + dense[row, bin_index + 1] * fraction


@function
def black(wavelengths):
    """Zero at every wavelength."""
    return splat(wavelengths, 0.0)
