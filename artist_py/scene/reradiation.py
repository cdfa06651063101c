"""From the description of a fluorescent material to its reflectance and its matrix of reradiation, bin by bin.

The matrix R(out, in) is power given off per nm at `out` for power that arrives at `in` (theory 3.1), averages over
bins of 1 nm. A dye gives off Q a(in) photons per photon; of emission e, power per nm on any scale, a share e(out) out
/ integral(e l dl) of these is at `out`, and a photon's energy is proportional to 1 / l, so that

    R(out, in) = Q a(in) in e(out) / integral(e(l) l dl).

Light is given off at longer wavelengths than it was absorbed at (Stokes), bins on the diagonal left out; what a
dye's emission has at shorter ones is lost.

Under a clear coat (bsdf/plastic.py) the share F_i of what leaves the base comes back to it, again and again. With
B = diag(rho) + R, of all that has entered the coat (1 - F_i) B (1 + F_i B + ..) = (1 - F_i) B (1 - F_i B)^-1 leaves it.
"""

from typing import NamedTuple

import numpy as np

from artist_py.errors import SceneError
from artist_py.scene.fluorescent_types import MatrixFile
from artist_py.scene.optics import internal_reflectance
from artist_py.scene.reradiation_files import read_matrix
from artist_py.scene.reradiation_images import read_bispectral_image
from artist_py.scene.spectra import ROUNDING, check_reflectance, tabulate
from artist_py.scene.spectrum_types import Gaussian
from artist_py.scene.where import problem

EMISSION_RANGE = 200, 1600  # nm over which an emission is normalised
CONSERVATION = 1e-6  # power that may be gained by rounding


class Glow(NamedTuple):
    """A fluorescent material over the bins of a scene."""

    reflectance: np.ndarray  # elastic, of the base where there is a coat (bins,)
    matrix: np.ndarray  # R, 1 / nm (bins out, bins in); from within the coat to within, where there is one
    warnings: list
    is_coated: bool = False


def glow_of(material, first, last):
    """The `Glow` of a fluorescent material over [first, last) nm; raises SceneError if it gives off too much."""
    bins = last - first
    matrix, warnings = np.zeros((bins, bins)), []
    reflectance = np.zeros(bins)
    absorbed = np.zeros(bins)
    for dye in material.all_dyes():
        share, part = _dye(dye, first, last)
        absorbed += share
        matrix += part
    if isinstance(material.reradiation, MatrixFile):
        part, diagonal, warnings = _measured(material, first, last)
        matrix += part
        reflectance = diagonal
    elif material.reradiation is not None:
        matrix += _two_gaussians(material.reradiation, first, last)
    if material.reflectance is not None:
        reflectance = tabulate(material.reflectance, first, last, "reflectance")
    if message := check_reflectance(reflectance, first):
        raise SceneError([problem(material, "reflectance", message)])
    _check_power(material, first, reflectance, absorbed, matrix)
    reflectance = np.clip(reflectance, 0.0, 1.0)
    if material.coat_ior is None:
        return Glow(reflectance, matrix, warnings)
    return Glow(reflectance, under_coat(reflectance, matrix, material.coat_ior), warnings, True)


def under_coat(reflectance, matrix, ior):
    """What is given off at other wavelengths of light that has entered the coat, 1 / nm (bins out, bins in).

    With g = 1 / (1 - F_i rho), which is what light that stays at its wavelength grows to, it is
    (1 - F_i) diag(g) R (1 - F_i B)^-1: the last dye's light, and all that may have happened before.
    """
    inside = internal_reflectance(ior)
    last = matrix * ((1.0 - inside) / (1.0 - inside * reflectance))[:, None]
    before = np.eye(len(matrix)) - inside * (np.diag(reflectance) + matrix)
    # Transposed it is triangular for light that is given off at longer wavelengths: zeros stay zeros.
    return np.maximum(np.linalg.solve(before.T, last.T).T, 0.0)


def _centres(first, last):
    return np.arange(first, last) + 0.5


def _stokes(matrix):
    """The matrix below its diagonal: given off at longer wavelengths only."""
    return np.tril(matrix, -1)


def _dye(dye, first, last):
    """Share absorbed (bins,) and matrix of a dye."""
    absorption = tabulate(dye.absorption, first, last, "reflectance", "zero")
    whole = tabulate(dye.emission, *EMISSION_RANGE, "emission")
    photons = float(whole @ _centres(*EMISSION_RANGE))
    if not photons > 0.0:
        raise SceneError([problem(dye, "emission", "expected an emission that is not zero everywhere")])
    emission = tabulate(dye.emission, first, last, "emission")
    excitation = dye.quantum_yield * absorption * _centres(first, last)
    return absorption, _stokes(np.outer(emission / photons, excitation))


def _two_gaussians(description, first, last):
    excitation = tabulate(Gaussian(shape=description.excitation), first, last, "reflectance")
    emission = tabulate(Gaussian(shape=description.emission), first, last, "emission")
    area = description.emission[1] * np.sqrt(2.0 * np.pi)
    return _stokes(np.outer(emission / area, description.strength * excitation))


def _measured(material, first, last):
    """`(matrix, elastic reflectance, warnings)` of a measured matrix: each value holds for a band around it."""
    description = material.reradiation
    is_image = description.path.lower().endswith(".exr")
    measured = (read_bispectral_image if is_image else read_matrix)(description.path)
    warnings = list(measured.warnings)
    is_anti_stokes = (measured.emission[:, None] < measured.excitation[None, :]) & (measured.values > 0.0)
    if is_anti_stokes.any() and not description.anti_stokes:
        warnings.append(
            f"{description.path}: {int(is_anti_stokes.sum())} values left out that say what is given off at shorter "
            "wavelengths than it was absorbed at; anti_stokes = true keeps them"
        )
    values = measured.values * description.scale
    if description.unit == "per band":
        values = values / np.diff(_edges(measured.emission))[:, None]
    rows, columns = (_band_of(nm, first, last) for nm in (measured.emission, measured.excitation))
    padded = np.pad(values, ((0, 1), (0, 1)))  # the last row and column stand for what was not measured
    matrix = padded[rows][:, columns]
    matrix = matrix if description.anti_stokes else _stokes(matrix)
    return matrix, _diagonal(measured, first, last), warnings


def _diagonal(measured, first, last):
    """Elastic reflectance (bins,): what stands at equal wavelengths, linear between."""
    if not len(measured.reflected):
        return np.zeros(last - first)
    return np.interp(_centres(first, last), measured.reflected, measured.reflectance)


def _edges(nm):
    """Edges of the bands around wavelengths: half way between neighbours (n + 1,)."""
    middles = 0.5 * (nm[1:] + nm[:-1])
    return np.concatenate([[2.0 * nm[0] - middles[0]], middles, [2.0 * nm[-1] - middles[-1]]])


def _band_of(nm, first, last):
    """Index of the band that each bin lies in; one beyond the last for bins in none."""
    edges = _edges(nm)
    index = np.searchsorted(edges, _centres(first, last), side="right") - 1
    return np.where((index < 0) | (index >= len(nm)), len(nm), index)


def _check_power(material, first, reflectance, absorbed, matrix):
    """Raise SceneError where more power leaves than arrives."""
    key = "reradiation" if material.reradiation is not None else "absorption"
    if material.dyes is not None:
        key = "dyes"
    for total, what in (
        (reflectance + absorbed, "reflectance + absorption"),
        (reflectance + matrix.sum(axis=0), "reflectance + what is given off"),
    ):
        worst = int(np.argmax(total))
        if total[worst] > 1.0 + max(CONSERVATION, ROUNDING):
            found = f"found {total[worst]:.6g} at {first + worst} nm"
            raise SceneError([problem(material, key, f"expected {what} <= 1, {found}")])
