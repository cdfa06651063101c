"""The wavelengths of an iteration, and the spectra at them."""

import numpy as np

from ..core.table import Table
from ..scene.tables import Spectra


def van_der_corput(index):
    """Radical inverse of `index` in base 2, in [0, 1)."""
    return int(f"{index:b}"[::-1], 2) / (1 << index.bit_length()) if index else 0.0


def shared_wavelengths(nodes, count, seed, iteration):
    """Wavelengths (nm) and weights 1 / (C p) (nm) that all paths of `iteration` share, float64 (2, C).

    The offsets follow van der Corput's sequence, shifted at random; even and odd iterations have shifts of their own,
    like all their random numbers (core/rng.py).
    """
    shift = np.random.default_rng([seed, iteration & 1]).random()
    offset = (shift + van_der_corput(iteration >> 1)) % 1.0
    entries = len(nodes) - 1
    position = (offset + np.arange(count)) / count * entries
    index = np.minimum(position.astype(int), entries - 1)
    width = nodes[index + 1] - nodes[index]
    return np.array([nodes[index] + (position - index) * width, width * entries / count])


def mean_acceptance(nodes, count, tolerance, steps=4096):
    """Mean over an eye path's wavelengths of P_acc (theory 2.7; transport/rotation.py), in (0, 1].

    It lowers n_vm in the weights of all techniques; merges themselves are divided by the exact probability.
    """
    shares = np.linspace(0.0, 1.0, len(nodes))
    position = (np.arange(steps) + 0.5) / steps
    wavelength = np.interp(position, shares, nodes)
    low = np.maximum(np.interp(wavelength - tolerance, nodes, shares), position - 0.5 / count)
    high = np.minimum(np.interp(wavelength + tolerance, nodes, shares), position + 0.5 / count)
    return float(count * np.mean(high - low))


def resolve_spectra(dense, ior_rows, first, wavelengths):
    """`Spectra` at the given wavelengths only: by bin, and indices of refraction linear between the bins' centres."""
    last = dense.shape[1] - 1
    bins = np.clip((wavelengths - first).astype(int), 0, last)
    values = dense[:, bins]
    if ior_rows:
        centres = first + 0.5 + np.arange(last + 1)
        values[ior_rows] = [np.interp(wavelengths, centres, dense[row]) for row in ior_rows]
    return Spectra(Table(values), None, float(first))
