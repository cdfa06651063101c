"""Every BSDF that is not a delta against its density.

Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared, Sidak over its cases).
Samples of delta lobes count as rejected here; tests/unit/test_delta_bsdfs.py enumerates them.
"""

import numpy as np
import pytest
from chi_squared import ChiSquaredTest

from artist_py.bsdf.dispatch import pdf_bsdf, sample_bsdf
from artist_py.bsdf.reflectance import reflectance_at
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3, vec3
from artist_py.jit import kernel
from artist_py.scene.optics import diffuse_transmittance
from artist_py.scene.tables import DIFFUSE, OREN_NAYAR, PHONG, PLASTIC, Needs, Spectra, material_dtype

NEEDS = Needs(diffuse=True, oren_nayar=True, phong=True, plastic=True, coated_dyes=True, one_sided=True)
MATT, GLOSSY = 0, 1  # rows of the spectra
SPECTRA = Spectra(Table(np.array([[0.5], [0.3]], np.float32)), None, 380.0)
WAVELENGTHS = Spectrum([550.0])
# From the normal, in front and behind; the last are grazing.
ANGLES = (0.0, 45.0, 80.0, 89.9, 100.0, 150.0)
MATERIALS = {
    "diffuse": {"kind": DIFFUSE},
    "smooth oren-nayar": {"kind": OREN_NAYAR, "roughness": np.radians(5.0)},
    "oren-nayar": {"kind": OREN_NAYAR, "roughness": np.radians(30.0)},
    "rough oren-nayar": {"kind": OREN_NAYAR, "roughness": np.radians(90.0)},
    "phong": {"kind": PHONG, "specular": GLOSSY, "exponent": 25.0},
    "broad phong": {"kind": PHONG, "specular": GLOSSY, "exponent": 0.5},
    "plastic": {"kind": PLASTIC, "ior": 1.5, "transmittance": diffuse_transmittance(1.5)},
    "coated dyes": {"kind": PLASTIC, "ior": 1.5, "transmittance": diffuse_transmittance(1.5), "glow": 0.3},
    "one-sided": {"kind": DIFFUSE, "two_sided": 0},
    "one-sided phong": {"kind": PHONG, "specular": GLOSSY, "exponent": 25.0, "two_sided": 0},
}


@kernel
def sample_rows(needs, materials, spectra, wavelengths, wo, numbers, out):
    reflectance = reflectance_at(None, materials[0], spectra, wavelengths, 0.0, 0.0)
    for i in range(len(numbers)):
        sample = sample_bsdf(
            needs,
            materials[0],
            reflectance,
            spectra,
            wavelengths,
            wo,
            numbers[i, 0],
            numbers[i, 1],
            numbers[i, 2],
            None,
            1.0,
            None,
        )
        if not sample.is_delta:
            out[i, 0], out[i, 1], out[i, 2] = sample.wi.x, sample.wi.y, sample.wi.z


@kernel
def pdf_rows(needs, materials, spectra, wavelengths, wo, directions, out):
    reflectance = reflectance_at(None, materials[0], spectra, wavelengths, 0.0, 0.0)
    for i in range(len(directions)):
        wi = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        out[i] = pdf_bsdf(needs, materials[0], reflectance, spectra, wavelengths, wo, wi)


def case(name, degrees):
    materials = np.zeros(1, material_dtype)
    for key, value in {"reflectance": MATT, "two_sided": 1, **MATERIALS[name]}.items():
        materials[key] = value
    materials = Table(materials)
    angle = np.radians(degrees)
    wo = Vec3((0.6 * np.sin(angle), 0.8 * np.sin(angle), np.cos(angle)))

    def sample(numbers):
        out = np.full((len(numbers), 3), np.nan)
        sample_rows(NEEDS, materials, SPECTRA, WAVELENGTHS, wo, numbers, out)
        return out

    def density(directions):
        out = np.empty(len(directions))
        pdf_rows(NEEDS, materials, SPECTRA, WAVELENGTHS, wo, directions, out)
        return out

    return ChiSquaredTest(sample, density, dimensions=3, seed=CASES.index((name, degrees)))


CASES = [(name, degrees) for name in MATERIALS for degrees in ANGLES]


@pytest.mark.parametrize(("name", "degrees"), CASES)
def test_samples_follow_their_density(name, degrees):
    case(name, degrees).assert_passes(len(CASES))
