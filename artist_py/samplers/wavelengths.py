"""The wavelengths of an iteration, and the spectra at them."""

import numpy as np

from ..core.table import Table
from ..core.vector import Spectrum
from ..scene.tables import Fluorescence, Spectra


def van_der_corput(index):
    """Radical inverse of `index` in base 2, in [0, 1)."""
    return int(f"{index:b}"[::-1], 2) / (1 << index.bit_length()) if index else 0.0


def shared_wavelengths(nodes, count, seed, iteration):
    """Wavelengths (nm) and weights 1 / (C p) (nm) that all paths of `iteration` share, float64 (2, C).

    The offsets follow van der Corput's sequence, shifted at random; even and odd iterations have shifts of their own,
    like all their random numbers (core/rng.py).
    """
    shift = np.random.default_rng([seed, iteration & 1]).random()
    return _at_offset(nodes, count, (shift + van_der_corput(iteration >> 1)) % 1.0)


def _at_offset(nodes, count, offset):
    """Wavelengths and weights of a set whose strata are all visited at `offset` in [0, 1), float64 (2, C)."""
    entries = len(nodes) - 1
    position = (offset + np.arange(count)) / count * entries
    index = np.minimum(position.astype(int), entries - 1)
    width = nodes[index + 1] - nodes[index]
    return np.array([nodes[index] + (position - index) * width, width * entries / count])


def tolerance_of(merging, iteration):
    """How far apart wavelengths that are merged may be in an iteration, nm: d_n = d_0 n^-s."""
    return merging.wavelength_tolerance * (iteration + 1.0) ** -merging.tolerance_exponent


def mean_acceptance(nodes, count, tolerance, steps=4096):
    """Mean over an eye path's wavelengths of P_acc (theory 2.7; transport/rotation.py), in (0, 1].

    It lowers n_vm in the weights of all techniques.
    """
    shares = np.linspace(0.0, 1.0, len(nodes))
    position = (np.arange(steps) + 0.5) / steps
    wavelength = np.interp(position, shares, nodes)
    low = np.maximum(np.interp(wavelength - tolerance, nodes, shares), position - 0.5 / count)
    high = np.minimum(np.interp(wavelength + tolerance, nodes, shares), position + 0.5 / count)
    return float(count * np.mean(high - low))


def sets_of_wavelengths(set_nodes, count, seed, iteration):
    """The same for M sets, one after the other, float64 (2, M C).

    Sets are independent of each other (theory 3.3): their offsets are those of a sequence in M dimensions, the
    additive recurrence of Roberts (2018), shifted at random.
    """
    n_sets = len(set_nodes)
    shift = np.random.default_rng([seed, iteration & 1]).random(n_sets)
    offsets = (shift + (iteration >> 1) * _golden(n_sets) ** -np.arange(1.0, n_sets + 1.0)) % 1.0
    return np.hstack([_at_offset(nodes, count, u) for nodes, u in zip(set_nodes, offsets, strict=True)])


def _golden(dimensions):
    """The root above 1 of x^(d + 1) = x + 1."""
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    return root


def fluorescence_at(fluorescent, count, first, wavelengths, weights):
    """`Fluorescence` between sets of `count` wavelengths each, float64 (M C,); R by bin, like spectra."""
    n_sets, last = fluorescent.n_sets, fluorescent.totals.shape[1] - 1
    bins = np.clip((wavelengths - first).astype(int), 0, last)
    out = bins.reshape(n_sets, 1, count)
    into = np.roll(bins.reshape(n_sets, count), -1, axis=0)[:, :, None]
    weight = np.roll(weights.reshape(n_sets, count), -1, axis=0)[:, :, None]
    rates = (
        fluorescent.matrices[:, out, into] * weight
    )  # (materials, m, j, k): to wavelength k of set m from j of m + 1
    towards_eye = rates.transpose(0, 2, 1, 3)
    towards_light = np.roll(rates, 1, axis=1).transpose(0, 3, 1, 2)  # (materials, k, m + 1, j)
    size = (len(rates), -1)
    survival = fluorescent.totals[:, bins].max(axis=1)
    return Fluorescence(
        Table(towards_eye.reshape(size).astype(np.float32)),
        Table(towards_light.reshape(size).astype(np.float32)),
        Table(survival),
        Spectrum(np.zeros(n_sets * count)),
        Spectrum(np.eye(n_sets * count, count).ravel()),
    )


def resolve_spectra(dense, ior_rows, first, wavelengths):
    """`Spectra` at the given wavelengths only: by bin, and indices of refraction linear between the bins' centres."""
    last = dense.shape[1] - 1
    bins = np.clip((wavelengths - first).astype(int), 0, last)
    values = dense[:, bins]
    if ior_rows:
        centres = first + 0.5 + np.arange(last + 1)
        values[ior_rows] = [np.interp(wavelengths, centres, dense[row]) for row in ior_rows]
    return Spectra(Table(values), None, float(first))
