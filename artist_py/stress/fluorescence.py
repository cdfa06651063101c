"""Rooms whose wall fluoresces, and the light in them by linear algebra.

A sphere that emits and scatters everywhere alike is as bright everywhere. With its radiance E, and what is scattered of
light K = diag(reflectance) + R per bin of 1 nm, paths of up to n edges bring the sum of K^i E over i < n (theory 3.10).
Everything is constant within whole bins, so that nothing is lost between scene file and bins.

Paths with fewer fluorescent events than there are sets of wavelengths are exact, and more than that have a bias
(theory 3.3): scenes are limited to two events, by what their dyes can do or by the length of paths.
"""

from typing import NamedTuple

import numpy as np

from artist_py import data
from artist_py.stress.scenes import furnace

RANGE = (300, 780)  # nm
CENTRES = np.arange(*RANGE) + 0.5
OBSERVER = "CIE 1931 2"
TWO_EVENTS = 3  # edges


class Dye(NamedTuple):
    """One that absorbs a `share` of the light in one band, and gives off one photon for each in the other."""

    absorbs: tuple  # nm, first and end
    emits: tuple
    share: float = 1.0


def glowing_room(lamp, dyes, reflectance=0.0, edges=TWO_EVENTS):
    """`(scene, luminance)` of a room; `lamp` is the first and end wavelength and the radiance of its wall."""
    material = {"type": "fluorescent", "reflectance": reflectance, "dyes": [_table(dye) for dye in dyes]}
    matrix = sum(_matrix(dye) for dye in dyes)
    return room(lamp, material, np.diag(np.full(len(CENTRES), reflectance)) + matrix, edges)


def room(lamp, material, scatter, edges):
    """The same for any material, whose K is `scatter` (bins out, bins in)."""
    first, end, radiance = lamp
    tables = furnace(
        emission={"spectrum": _band(first, end, radiance)},
        materials={"wall": material},
        render={"wavelength_range": list(RANGE), "wavelengths": "shared", "max_path_length": edges},
    )
    return tables, luminance(light_in_room(radiance * _is_within(first, end), scatter, edges))


def light_in_room(emission, scatter, edges):
    """Radiance per bin (bins,) of paths of up to so many edges."""
    radiance, part = emission.astype(float), emission
    for _ in range(edges - 1):
        part = scatter @ part
        radiance = radiance + part
    return radiance


def luminance(radiance):
    """Luminance of a spectrum (bins,) over that of a flat one of radiance 1."""
    seen = data.observer_bins(OBSERVER, *RANGE)[1]
    return float(seen @ radiance / seen.sum())


def _is_within(first, end):
    return np.abs(CENTRES - 0.5 * (first + end)) < 0.5 * (end - first)


def _band(first, end, value):
    """A spectrum table; absorption and emission are 0 outside of their samples."""
    return {"wavelengths": [first, end], "values": [value, value]}


def _table(dye):
    return {"absorption": _band(*dye.absorbs, dye.share), "emission": _band(*dye.emits, 1.0)}


def _matrix(dye):
    """R (bins out, bins in), 1 / nm: of the photons absorbed at l' as many are given off, each with the energy of l.

    Power that is the same at all wavelengths of a band is a number of photons per nm proportional to l.
    """
    given_off = _is_within(*dye.emits)
    return np.outer(given_off / CENTRES[given_off].sum(), dye.share * _is_within(*dye.absorbs) * CENTRES)


# --- a measured matrix ----------------------------------------------------------------------------------------------

BANDS = np.arange(305, 780, 10)  # nm, their centres
NOISE = 3e-5  # standard deviation, 1 / nm; 0.4 % of the largest value off the diagonal


def noisy_matrix(seed):
    """A measured matrix (bands out, bands in): a reflectance of 0.3 on the diagonal, a dye, and noise everywhere."""
    out, into = BANDS[:, None], BANDS[None, :]
    dye = 0.008 * np.exp(-0.5 * ((out - 530) / 25) ** 2 - 0.5 * ((into - 400) / 40) ** 2)
    noise = np.random.default_rng(seed).normal(0.0, NOISE, dye.shape)
    return np.where(out == into, 0.3, dye) + noise


def write_noisy_matrix(path, seed):
    """The file of `noisy_matrix`."""
    rows = [["excitation", *BANDS], *([nm, *row] for nm, row in zip(BANDS, noisy_matrix(seed), strict=True))]
    path.write_text("\n".join(",".join(map(str, row)) for row in rows) + "\n", encoding="utf-8")


def measured_room(lamp, seed, name, edges=TWO_EVENTS):
    """`(scene, luminance)` of a room with that matrix, in the file `name`.

    Negative values count as 0, and so does what would be given off at shorter wavelengths. Each value holds for a
    whole band; the reflectance is linear between the bands' centres.
    """
    values = np.maximum(noisy_matrix(seed), 0.0)
    band = (CENTRES.astype(int) - RANGE[0]) // 10
    scatter = np.tril(values, -1)[np.ix_(band, band)]
    scatter += np.diag(np.interp(CENTRES, BANDS, np.diag(values)))
    return room(lamp, {"type": "fluorescent", "reradiation": {"file": name}}, scatter, edges)
