"""The wavelengths of an iteration, and the spectra at them."""

from typing import NamedTuple

import numpy as np

from ..core.table import Table
from ..core.vector import Spectrum
from ..scene.tables import ColourControl, Fluorescence, Spectra

CHANNELS = 3  # of the film
TINY = 1e-30  # of a channel that does not see the rendered range at all


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


def fluorescence_at(fluorescent, count, first, wavelengths, weights, in_colour, has_dispersion):
    """`Fluorescence` between sets of `count` wavelengths each, float64 (M C,); R by bin, like spectra.

    `in_colour`: eye subpaths carry what the film's channels get, and not its wavelengths.
    """
    n_sets = fluorescent.n_sets
    bins = _bins_of(fluorescent.totals, first, wavelengths)
    out = bins.reshape(n_sets, 1, count)
    into = np.roll(bins.reshape(n_sets, count), -1, axis=0)[:, :, None]
    weight = np.roll(weights.reshape(n_sets, count), -1, axis=0)[:, :, None]
    # (materials, m, j, k): to wavelength k of set m from j of m + 1
    rates = fluorescent.matrices[:, out, into] * weight
    towards_eye = rates.transpose(0, 2, 1, 3)
    towards_light = np.roll(rates, 1, axis=1).transpose(0, 3, 1, 2)  # (materials, k, m + 1, j)
    lanes, size = n_sets * count, (len(rates), -1)
    columns = _Columns(np.eye(lanes, count), np.zeros(lanes), np.ones(count), None)
    if in_colour:
        seen = fluorescent.sensor[:, bins[:count]] * weights[:count]
        columns = _channels(
            fluorescent, seen, _colour_control(fluorescent, seen, rates, bins, weights), lanes
        )
    more = len(columns.matrix) - lanes
    is_wavelength = np.repeat([1.0, 0.0], [lanes, more])
    return Fluorescence(
        towards_eye=_table(towards_eye.reshape(size)),
        towards_light=_table(towards_light.reshape(size)),
        survival=Table(fluorescent.totals[:, bins].max(axis=1)),
        zero=Spectrum(np.zeros(lanes + more)),
        sets=Spectrum(np.zeros(lanes)),
        rows=Spectrum(np.zeros(columns.matrix[:lanes].size)),
        coefficients=Spectrum(np.zeros(lanes * count)),
        matrix=Spectrum(columns.matrix.ravel()),
        white=Spectrum(is_wavelength),
        colour=Spectrum(columns.colour),
        unit=Spectrum(columns.unit),
        ratio=Spectrum(is_wavelength * (lanes + more) / lanes) if has_dispersion else None,
        control=columns.control,
    )


class _Columns(NamedTuple):
    """What the matrices of eye subpaths have columns for; see `Fluorescence`."""

    matrix: np.ndarray  # (lanes of light, columns)
    colour: np.ndarray  # (lanes of light,)
    unit: np.ndarray  # (columns,)
    control: ColourControl | None


def _channels(fluorescent, seen, control, lanes):
    """`_Columns` for the film's channels, which get `seen` (3, C) of set 0 and all of the control."""
    count = seen.shape[1]
    matrix = np.zeros((lanes + CHANNELS, CHANNELS))
    matrix[:count], matrix[lanes:] = seen.T, np.eye(CHANNELS)
    brought = np.maximum(np.abs(fluorescent.sensor).sum(axis=1), TINY)
    return _Columns(matrix, np.concatenate([np.zeros(lanes), brought]), 1.0 / brought, control)


def _colour_control(fluorescent, seen, rates, bins, weights):
    """`ColourControl` (theory 3.9, on the eye's side); `seen` (3, C) is what the film gets of set 0."""
    count = seen.shape[1]
    of_set_1 = slice(count, 2 * count)
    by_all = fluorescent.colours[:, :, bins[of_set_1]] * weights[of_set_1]
    by_set_0 = np.einsum("ck,rjk->rcj", seen, rates[:, 0])
    table = (by_all - by_set_0).transpose(0, 2, 1).reshape(len(rates), -1)
    sizes = count, CHANNELS, count * CHANNELS, CHANNELS**2
    return ColourControl(_table(table), *(Spectrum(np.zeros(size)) for size in sizes))


def _table(values):
    return Table(values.astype(np.float32))


def _bins_of(dense, first, wavelengths):
    return np.clip((wavelengths - first).astype(int), 0, dense.shape[1] - 1)


def resolve_spectra(dense, ior_rows, first, wavelengths):
    """`Spectra` at the given wavelengths only: by bin, and indices of refraction linear between the bins' centres."""
    return Spectra(Table(_values_at(dense, ior_rows, first, wavelengths)), None, float(first))


def _values_at(dense, ior_rows, first, wavelengths):
    """Float32 (rows, lanes)."""
    bins = _bins_of(dense, first, wavelengths)
    last, values = dense.shape[1] - 1, dense[:, bins]
    if ior_rows:
        centres = first + 0.5 + np.arange(last + 1)
        values[ior_rows] = [np.interp(wavelengths, centres, dense[row]) for row in ior_rows]
    return values


class ControlledSpectra:
    """The spectra of a scene at the wavelengths of an iteration, and for its `ColourControl`."""

    def __init__(self, compiled):
        self.dense, self.ior_rows = compiled.spectra, compiled.ior_rows
        self.light_rows, self.first = sorted(set(compiled.light_rows)), compiled.wavelength_range[0]
        dense = compiled.spectra.astype(float)
        self.sensor = compiled.fluorescence.sensor
        self.means = dense @ compiled.fluorescence.means.T  # (rows, 3)
        self.colours = dense[self.light_rows] @ self.sensor.T  # (lights, 3): what the film gets of them

    def at(self, wavelengths, weights, count):
        """`Spectra` at M sets of `count` wavelengths, and a lane for each channel of the film.

        There a property of a material has what stands for all wavelengths, and light what the film gets of all less
        what it gets of set 0. The sensor, which is asked for channels, is that of the channels themselves.
        """
        values = _values_at(self.dense, self.ior_rows, self.first, wavelengths)
        more, seen = self.means.copy(), _bins_of(self.dense, self.first, wavelengths[:count])
        by_set_0 = values[self.light_rows, :count].astype(float) @ (self.sensor[:, seen] * weights[:count]).T
        more[self.light_rows] = self.colours - by_set_0
        values = np.hstack([values, more.astype(np.float32)])
        values[:CHANNELS, :CHANNELS] = np.eye(CHANNELS)
        return Spectra(Table(values), None, float(self.first))
