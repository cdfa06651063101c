"""Where to put hero wavelengths: a density from sensor and light, and its inverse for kernels.

The density mixes the sensor's three responses to the scene's light, so that no channel is noisier than the
others, with a uniform part, so that no wavelength is forgotten.
"""

import numpy as np

from artist_py.film.color import RGB_TO_XYZ

CHANNEL_SHARE = 0.3  # of each of X, Y and Z; the rest is uniform
STEP = 1.5  # the density is called broken where neighbouring bins differ by more than this factor


def wavelength_density(sensor, emission):
    """Probability density of wavelengths, 1/nm, positive, summing to 1 over 1 nm bins; float64 (bins,).

    0.3 (X + Y + Z responses to the light, each normalised) + 0.1 uniform. `sensor` is the (3, bins) table of
    `sensor_table`, `emission` the power-weighted sum (bins,) of the scene's light spectra. A response that
    the light does not excite counts as if the light were flat.
    """
    n_bins = len(emission)
    density = np.full(n_bins, (1.0 - 3 * CHANNEL_SHARE) / n_bins)
    for response in np.maximum(RGB_TO_XYZ @ sensor, 0.0):
        density += CHANNEL_SHARE * normalised(response * np.maximum(emission, 0.0), response)
    return density / density.sum()


def excitation_density(seen, light, yields):
    """Density of the sets of wavelengths from which fluorescence leads to those that the film sees; float64 (bins,).

    Half of it is the density `seen` of these, and 0.45 goes where the `light` excites: `yields` is the share of the
    power that all fluorescent materials together give off again, by wavelength of excitation (theory 3.5).
    """
    excitation = normalised(np.maximum(light, 0.0) * yields, yields)
    return 0.5 * seen + 0.45 * excitation + 0.05 / len(seen)


def normalised(weights, fallback):
    """`weights` scaled to sum to 1; if they are all zero, `fallback`, and if that is, the same everywhere."""
    for candidate in (weights, fallback, np.ones_like(weights)):
        peak = candidate.max()
        if 0.0 < peak < np.inf:
            scaled = candidate / peak  # first, so that the sum of huge or tiny numbers is neither inf nor 0
            return scaled / scaled.sum()
    raise ValueError("no wavelengths")


def inverse_cdf(density, first_nm, n_entries=1024):
    """Wavelengths where the distribution reaches i / n_entries, nm; float64 (n_entries + 1,), increasing.

    Kernels take wavelengths *linear between these nodes*, with p = 1 / (n_entries (node[i+1] - node[i])),
    exact by definition. Where the density jumps, at the edge of a line, a node is put on the jump: an entry
    with both a line and the dark beside it would rarely hit the line and then count it too much.
    """
    density = np.asarray(density, np.float64)
    if not (np.all(density > 0.0) and len(density) < n_entries):
        raise ValueError("expected a positive density of fewer bins than entries")
    cdf = np.concatenate([[0.0], np.cumsum(density)])
    cdf /= cdf[-1]
    rise = density[1:] / density[:-1]
    jumps = 1 + np.flatnonzero((rise > STEP) | (rise < 1.0 / STEP))
    fixed = np.concatenate([[0], jumps, [len(density)]])
    snapped = _increasing_integers(cdf[fixed] * n_entries, n_entries) / n_entries
    cdf = np.interp(cdf, cdf[fixed], snapped)
    edges = first_nm + np.arange(len(cdf), dtype=np.float64)
    # Kernels round wavelengths to float32. One drawn in the dark just below a line must not round into the
    # line, where its small density would make it a firefly. One that rounds to the end is read in the last bin.
    upwards = 1 + np.flatnonzero(rise > STEP)
    edges[upwards] = np.nextafter(edges[upwards].astype(np.float32), np.float32(0))
    return np.interp(np.arange(n_entries + 1) / n_entries, cdf, edges)


def _increasing_integers(values, last):
    """Strictly increasing integers from 0 to `last` that are near increasing `values`."""
    order = np.arange(len(values))
    rounded = np.rint(values).astype(np.int64)
    rounded[0] = 0
    rounded = np.maximum.accumulate(rounded - order) + order
    room = last - order[::-1]  # the highest value that leaves room for those that follow
    return np.minimum(rounded, room)
