"""Every BSDF that is not a delta against its density.

Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared, Sidak over its cases).
Delta lobes are enumerated in tests/unit/test_bsdf.py.
"""

import numpy as np
import pytest
from chi_squared import ChiSquaredTest

from artist_py.bsdf.dispatch import pdf_bsdf, sample_bsdf
from artist_py.bsdf.reflectance import reflectance_at
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3, vec3
from artist_py.jit import kernel
from artist_py.scene.tables import DIFFUSE, OREN_NAYAR, Needs, Spectra, material_dtype

NEEDS = Needs(diffuse=True, oren_nayar=True, one_sided=True)
SPECTRA = Spectra(Table(np.full((1, 1), 0.5, np.float32)), None, 380.0)
WAVELENGTHS = Spectrum([550.0])
# From the normal, in front and behind; the last are grazing.
ANGLES = (0.0, 45.0, 80.0, 89.9, 100.0, 150.0)
MATERIALS = {
    "diffuse": (DIFFUSE, 0.0, 1),
    "smooth oren-nayar": (OREN_NAYAR, 5.0, 1),
    "oren-nayar": (OREN_NAYAR, 30.0, 1),
    "rough oren-nayar": (OREN_NAYAR, 90.0, 1),
    "one-sided": (DIFFUSE, 0.0, 0),
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
        if sample.pdf > 0.0:
            out[i, 0], out[i, 1], out[i, 2] = sample.wi.x, sample.wi.y, sample.wi.z


@kernel
def pdf_rows(needs, materials, wo, directions, out):
    for i in range(len(directions)):
        wi = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        out[i] = pdf_bsdf(needs, materials[0], wo, wi)


def case(name, degrees):
    kind, roughness, two_sided = MATERIALS[name]
    materials = np.zeros(1, material_dtype).view(np.recarray)
    materials.kind, materials.two_sided, materials.roughness = kind, two_sided, np.radians(roughness)
    materials = Table(materials)
    angle = np.radians(degrees)
    wo = Vec3((0.6 * np.sin(angle), 0.8 * np.sin(angle), np.cos(angle)))

    def sample(numbers):
        out = np.full((len(numbers), 3), np.nan)
        sample_rows(NEEDS, materials, SPECTRA, WAVELENGTHS, wo, numbers, out)
        return out

    def density(directions):
        out = np.empty(len(directions))
        pdf_rows(NEEDS, materials, wo, directions, out)
        return out

    return ChiSquaredTest(sample, density, dimensions=3, seed=CASES.index((name, degrees)))


CASES = [(name, degrees) for name in MATERIALS for degrees in ANGLES]


@pytest.mark.parametrize(("name", "degrees"), CASES)
def test_samples_follow_their_density(name, degrees):
    case(name, degrees).assert_passes(len(CASES))
