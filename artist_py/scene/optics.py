"""Refractive indices: of glasses and liquids by name or formula, of metals by name (artist_py/data/*.csv)."""

import csv
from functools import cache
from typing import NamedTuple

import numpy as np

from artist_py import data
from artist_py.core.fresnel import fresnel_dielectric
from artist_py.errors import Problem, SceneError
from artist_py.scene.spectra import samples_of, unknown
from artist_py.scene.spectrum_types import Cauchy, Constant, File, Named, Sampled, Sellmeier
from artist_py.scene.where import problem


class Glass(NamedTuple):
    """One row of glasses.csv; the file says what the kinds of formula mean."""

    kind: str  # "sellmeier", "powers" or "samples"
    from_nm: float  # the index is held constant below
    n_d: float | None  # catalogue values, where there is a catalogue
    v_d: float | None
    coefficients: np.ndarray  # float64

    def index(self, nm):
        """Refractive index relative to air at wavelengths in nm; float64, shape of `nm`."""
        nm = np.maximum(nm, self.from_nm)
        first, second = self.coefficients[0::2], self.coefficients[1::2]
        if self.kind == "samples":
            return np.interp(nm, first, second)
        if self.kind == "powers":
            return sum(factor * (nm * 1e-3) ** power for factor, power in zip(first, second, strict=True))
        return np.sqrt(_sellmeier_squared(nm, self.coefficients[0], second, first[1:]))


def _sellmeier_squared(nm, constant, strengths, resonances):
    """n^2 = constant + sum of B l^2 / (l^2 - C); C in um^2. W. Sellmeier 1871."""
    squared = (np.asarray(nm) * 1e-3) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        terms = [b * squared / (squared - c) for b, c in zip(strengths, resonances, strict=True)]
    return constant + sum(terms)


def ior_table(ior, first_nm, last_nm):
    """Refractive index at the centres of the 1 nm bins; float64 (last - first,).

    `ior` is a number or one of `spectrum_types.RefractiveIndex`; outside its samples it goes on as at the
    ends. Raises SceneError where the index is not a positive number.
    """
    centers = np.arange(first_nm, last_nm) + 0.5
    if isinstance(ior, (int, float)):
        ior = Constant(float(ior))
    values = _INDEX[type(ior)](ior, centers)
    bad = ~((values > 0.0) & (values < np.inf))  # true for NaN
    if bad.any():
        message = f"expected a refractive index above 0, found {values[bad][0]:.6g} at {centers[bad][0]} nm"
        raise SceneError([problem(ior, None, message)])
    return values


def is_dispersive(table):
    """Whether a table of refractive indices depends on wavelength."""
    return bool(np.ptp(table) > 0.0)


def _constant(ior, nm):
    return np.full(len(nm), float(ior.value) * ior.scale)


def _named(ior, nm):
    if ior.name not in glasses():
        raise SceneError([problem(ior, None, unknown("glass", ior.name, glasses()))])
    return glasses()[ior.name].index(nm) * ior.scale


def _cauchy(ior, nm):
    return sum(c * (nm * 1e-3) ** (-2 * i) for i, c in enumerate(ior.coefficients))


def _sellmeier(ior, nm):
    strengths, resonances = zip(*ior.terms, strict=True)
    with np.errstate(invalid="ignore"):
        return np.sqrt(_sellmeier_squared(nm, 1.0, strengths, resonances))


def _sampled(ior, nm):
    return np.interp(nm, ior.wavelengths, ior.values) * ior.scale


def _file(ior, nm):
    return _sampled(samples_of(ior), nm)


_INDEX = {
    Constant: _constant,
    Named: _named,
    Cauchy: _cauchy,
    Sellmeier: _sellmeier,
    Sampled: _sampled,
    File: _file,
}


def diffuse_transmittance(ior):
    """Share of diffuse light that enters a smooth medium of the relative index `ior` >= 1: the mean of 1 - F.

    Gauss and Legendre's rule in the square root of the cosine, where F has its bend; exact to 1e-12.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    roots = 0.5 + 0.5 * nodes
    entering = [1.0 - fresnel_dielectric(root * root, ior)[0] for root in roots.tolist()]
    return float(np.sum(2.0 * weights * roots**3 * entering))


def internal_reflectance(ior):
    """Share of diffuse light inside a smooth medium of the relative index `ior` >= 1 that its surface reflects back.

    By Stokes' reversion n^2 times as much comes in as goes out.
    """
    return 1.0 - diffuse_transmittance(ior) / (ior * ior)


def metal_table(name, first_nm, last_nm, node=None):
    """Complex refractive index (eta, k) of a metal at the centres of the 1 nm bins; two float64 arrays.

    Linear between the measured samples, held constant outside. Raises SceneError for an unknown name, at
    the key `metal` of `node` where that is given.
    """
    if name not in metals():
        message = unknown("metal", name, metals())
        raise SceneError([problem(node, "metal", message) if node else Problem(message)])
    nm, eta, k = metals()[name]
    centers = np.arange(first_nm, last_nm) + 0.5
    return np.interp(centers, nm, eta), np.interp(centers, nm, k)


@cache
def glasses():
    """{name: Glass} of everything in glasses.csv; several names may mean the same."""
    found = {}
    for row in _rows("glasses.csv"):
        catalogue = [float(row[key]) if row[key] else None for key in ("n_d", "V_d")]
        coefficients = np.array(row["coefficients"].split(), np.float64)
        glass = Glass(row["kind"], float(row["from_nm"]), *catalogue, coefficients)
        found.update(dict.fromkeys(row["glass"].split("/"), glass))
    return found


@cache
def metals():
    """{name: float64 (3, samples) of wavelength in nm, eta and k} of everything in metals.csv."""
    samples = {}
    for row in _rows("metals.csv"):
        samples.setdefault(row["metal"], []).append([float(row[key]) for key in ("nm", "n", "k")])
    return {name: np.array(rows).T for names, rows in samples.items() for name in names.split("/")}


def _rows(name):
    with (data.FOLDER / name).open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(line for line in file if not line.startswith("#"))
