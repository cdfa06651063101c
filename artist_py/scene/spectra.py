"""From the description of a spectrum to numbers: its exact averages over the 1 nm bins of the tables.

Between samples everything is linear. Outside its samples a light is dark ("zero") and a property of a
material goes on as at the end ("hold"). Averages, not point values: so a line of 0.1 nm keeps its energy.
"""

import math
from difflib import get_close_matches
from functools import cache

import numpy as np

from artist_py import data
from artist_py.errors import SceneError
from artist_py.scene.messages import listing, show
from artist_py.scene.sample_files import read_samples
from artist_py.scene.spectrum_types import (
    Blackbody,
    Constant,
    File,
    Gaussian,
    Lines,
    Named,
    Rgb,
    Sampled,
)
from artist_py.scene.where import problem

# CODATA 2018, exact: 2 h c^2 in W m^2 and h c / k in m K.
TWO_H_C2 = 2 * 6.62607015e-34 * 299792458.0**2
HC_OVER_K = 6.62607015e-34 * 299792458.0 / 1.380649e-23
LUMENS_PER_WATT = 683.002  # K_m, CIE S 023: 683 lm/W at 540 THz in air, where ybar is just below 1
STANDARD_OBSERVER = "CIE 1931 2"
ROUNDING = 1e-9


def tabulate(spectrum, first_nm, last_nm, purpose, extend=None):
    """Averages of a spectrum over the bins [first, first + 1), ... of 1 nm; float64 (last - first,).

    `purpose` is "emission" or "reflectance" (meaning any property of a material). It decides what RGB is and,
    unless `extend` says so, whether samples end in "zero" (lights) or "hold" (materials). Raises SceneError.
    """
    if found := [problem(spectrum, key, message) for key, message in spectrum.problems()]:
        raise SceneError(found)
    extend = extend or ("zero" if purpose == "emission" else "hold")
    edges = np.arange(first_nm, last_nm + 1, dtype=np.float64)
    values = spectrum.scale * _AVERAGES[type(spectrum)](spectrum, edges, purpose, extend)
    if purpose == "emission" and (message := check_emission(values, first_nm)):
        raise SceneError([problem(spectrum, None, message)])
    return values


def _constant(spectrum, edges, purpose, extend):
    return np.full(len(edges) - 1, float(spectrum.value))


def _rgb(spectrum, edges, purpose, extend):
    return np.asarray(spectrum.rgb, np.float64) @ rgb_basis(int(edges[0]), int(edges[-1]), purpose)


def _named(spectrum, edges, purpose, extend):
    if spectrum.name in data.names("illuminant"):
        return bin_averages(*illuminant(spectrum.name), edges, "zero")
    if spectrum.name in data.names("reflectance"):
        return bin_averages(*data.table(f"reflectance/{spectrum.name}").T, edges, extend)
    known = data.names("illuminant") + data.names("reflectance")
    raise SceneError([problem(spectrum, None, unknown("spectrum", spectrum.name, known))])


def _blackbody(spectrum, edges, purpose, extend):
    """Planck's law, W m^-2 sr^-1 nm^-1; Gauss-Legendre quadrature, exact to rounding over 1 nm."""
    nodes, weights = np.polynomial.legendre.leggauss(5)
    metres = (edges[:-1, None] + 0.5 + 0.5 * nodes) * 1e-9
    with np.errstate(over="ignore"):
        per_metre = TWO_H_C2 / metres**5 / np.expm1(HC_OVER_K / (metres * spectrum.kelvin))
    return per_metre @ weights * 0.5e-9


def _gaussian(spectrum, edges, purpose, extend):
    errors = [math.erf(x) for x in (edges - spectrum.center) / (spectrum.sigma * math.sqrt(2))]
    return spectrum.peak * spectrum.sigma * math.sqrt(math.pi / 2) * np.diff(errors)


def _lines(spectrum, edges, purpose, extend):
    averages = np.zeros(len(edges) - 1)
    for nm, weight in spectrum.lines:
        low, high = nm - 0.5 * spectrum.width, nm + 0.5 * spectrum.width
        overlap = np.minimum(high, edges[1:]) - np.maximum(low, edges[:-1])
        averages += weight / (high - low) * np.maximum(overlap, 0.0)
    return averages


def _sampled(spectrum, edges, purpose, extend):
    if len(spectrum.wavelengths) == 1 and extend == "zero":
        message = "one sample makes no light, expected two or more samples (or lines)"
        raise SceneError([problem(spectrum, None, message)])
    nm, values = np.array(spectrum.wavelengths, np.float64), np.array(spectrum.values, np.float64)
    return bin_averages(nm, values, edges, extend)


def _file(spectrum, edges, purpose, extend):
    return _sampled(samples_of(spectrum), edges, purpose, extend)


_AVERAGES = {
    Constant: _constant,
    Rgb: _rgb,
    Named: _named,
    Blackbody: _blackbody,
    Gaussian: _gaussian,
    Lines: _lines,
    Sampled: _sampled,
    File: _file,
}


def samples_of(file):
    """The samples that a `File` stands for; one sample alone is a constant. Raises SceneError."""
    wavelengths, values = read_samples(file.path, file.column)
    return Sampled(wavelengths, values, file.scale, where=file.where)


def unknown(kind, name, known):
    """The message for a name that is not among the `known`, with up to three that are near it."""
    exact = {other.lower(): other for other in known}
    near = [exact[match] for match in get_close_matches(name[:60].lower(), exact, cutoff=0.5)]
    hint = f"did you mean {listing(near)}?" if near else f"expected {listing(known)}"
    return f"unknown {kind} {show(name)}, {hint}"


def bin_averages(nm, values, edges, extend):
    """Exact averages over [edge, next edge) of the straight lines through samples; float64 (bins,)."""
    cuts = np.union1d(edges, nm[(nm > edges[0]) & (nm < edges[-1])])
    heights = np.interp(cuts, nm, values)
    areas = 0.5 * np.diff(cuts) * (heights[1:] + heights[:-1])
    if extend == "zero":
        middles = 0.5 * (cuts[1:] + cuts[:-1])
        areas[(middles < nm[0]) | (middles > nm[-1])] = 0.0
    return np.add.reduceat(areas, np.searchsorted(cuts, edges[:-1])) / np.diff(edges)


@cache
def illuminant(name):
    """Wavelengths in nm and relative radiance of a CIE illuminant; two float64 (samples,).

    A, B, C, D.., ID.. and E are 1 at 560 nm. Lamps (FL.., HP.., LED-..), where 560 nm means nothing, have the
    luminance of E, a flat spectrum of 1.
    """
    nm, values = data.table(f"illuminant/{name}").T
    if name.startswith(("FL", "HP", "LED")):
        return nm, values / _relative_luminance(nm, values)
    return nm, values / np.interp(560.0, nm, values)


@cache
def rgb_basis(first_nm, last_nm, purpose):
    """Three spectra whose sum, weighted by linear sRGB, has that colour; float64 (3, bins).

    Reflectances lie in [0, 1] for rgb in [0, 1], and white is 1 everywhere. Lights are the same times D65,
    with (1, 1, 1) as luminous as a flat spectrum of 1: with the film's default white they render as this rgb.
    Mallett and Yuksel 2019, Spectral primary decomposition for rendering with sRGB reflectance.
    """
    nm, *primaries = data.table("basis/sRGB").T
    edges = np.arange(first_nm, last_nm + 1, dtype=np.float64)
    extend = "zero" if purpose == "emission" else "hold"
    basis = np.array([bin_averages(nm, primary, edges, extend) for primary in primaries])
    if purpose == "emission":
        white_nm, white = illuminant("D65")
        basis *= bin_averages(white_nm, white / _relative_luminance(white_nm, white), edges, "zero")
    return basis


def _relative_luminance(nm, values):
    """Luminance relative to that of a flat spectrum of 1."""
    ybar = data.observer_bins(STANDARD_OBSERVER, 300, 830)[1]
    averages = bin_averages(nm, values, np.arange(300.0, 831.0), "zero")
    return averages @ ybar / data.luminous_integral(STANDARD_OBSERVER)


def integrate(values):
    """Integral over wavelength of averages over 1 nm bins, in the unit of the values times nm."""
    return float(np.sum(values))


def luminance(values, first_nm):
    """Luminance of a tabulated radiance, cd m^-2 (CIE 1931 2 degree observer)."""
    ybar = data.observer_bins(STANDARD_OBSERVER, first_nm, first_nm + len(values))[1]
    return LUMENS_PER_WATT * float(np.dot(values, ybar))


def check_reflectance(values, first_nm):
    """What is wrong with a tabulated reflectance, or None; it must lie within [0, 1]."""
    return _out_of_bounds(values, first_nm, 1.0 + ROUNDING, "a reflectance from 0 to 1")


def check_emission(values, first_nm):
    """What is wrong with a tabulated light, or None; it must not be negative."""
    return _out_of_bounds(values, first_nm, np.finfo(np.float32).max, "a radiance of at least 0")


def _out_of_bounds(values, first_nm, highest, what):
    values = np.asarray(values)
    bad = ~((values >= -ROUNDING) & (values <= highest))  # true for NaN
    if not bad.any():
        return None
    worst = int(np.argmax(np.where(bad, np.abs(values - 0.5), -1.0)))
    return f"expected {what}, found {values[worst]:.6g} at {first_nm + worst} nm"
