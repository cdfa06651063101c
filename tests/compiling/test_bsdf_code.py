"""A scene's kernels contain the code of its own BSDFs and no other."""

import numba
import numpy as np
import pytest

from artist_py.bsdf.dispatch import evaluate_bsdf, pdf_bsdf, sample_bsdf
from artist_py.bsdf.reflectance import reflectance_at
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3
from artist_py.jit import kernel
from artist_py.scene.tables import Needs, Spectra, material_dtype

# A function that only the code of the kind calls. The LLVM names every function that was compiled for a kernel, also
# where it was inlined.
TELLTALES = {
    "diffuse": "square_to_cosine_hemisphere",
    "oren_nayar": "single_albedo",
    "phong": "square_to_power_cosine",
    "plastic": "colour_below",
    "conductor": "fresnel_conductor",
    "dielectric": "fresnel_dielectric",
    "thin_dielectric": "slab_reflectance",
}
DISPERSIVE = "reflectance_lanes"


@kernel
def scatter(needs, materials, spectra, wavelengths, wo, wi, ratio):
    reflectance = reflectance_at(None, materials[0], spectra, wavelengths, 0.0, 0.0)
    s = sample_bsdf(
        needs, materials[0], reflectance, spectra, wavelengths, wo, 0.1, 0.2, 0.3, ratio, 1.0, None
    )
    f = evaluate_bsdf(needs, materials[0], reflectance, spectra, wavelengths, wo, wi)
    return s.weight + f, s.pdf + pdf_bsdf(needs, materials[0], reflectance, spectra, wavelengths, wo, wi)


def compiled_code(needs, ratio=None):
    """LLVM of the kernel for these needs; numba shows none for what comes out of its cache."""
    uncached = numba.jit(**scatter.targetoptions)(scatter.py_func)
    materials = Table(np.zeros(1, material_dtype))
    spectra = Spectra(Table(np.ones((1, 4), np.float32)), None, 380.0)
    w = Vec3((0.0, 0.6, 0.8))
    uncached(needs, materials, spectra, Spectrum([400.0, 500.0, 600.0, 700.0]), w, w, ratio)
    (code,) = uncached.inspect_llvm().values()
    return code


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
class TestCode:
    """LLVM of one kernel for several scenes."""

    @pytest.fixture(scope="class")
    @staticmethod
    def diffuse():
        return compiled_code(Needs(diffuse=True))

    @pytest.fixture(scope="class")
    @staticmethod
    def everything():
        return compiled_code(Needs(**dict.fromkeys(TELLTALES, True)))

    def test_what_a_scene_lacks_is_not_compiled(self, diffuse, everything):
        assert all(name in everything for name in TELLTALES.values())
        assert [kind for kind, name in TELLTALES.items() if name in diffuse] == ["diffuse"]

    def test_dispersion_is_compiled_only_where_it_occurs(self, everything):
        assert DISPERSIVE not in everything
        dispersive = compiled_code(Needs(dielectric=True, dispersion=True), Spectrum(np.ones(4)))
        assert DISPERSIVE in dispersive
        assert TELLTALES["diffuse"] not in dispersive

    def test_diffuse_scenes_have_short_kernels(self, diffuse, everything):
        assert len(diffuse) < 0.5 * len(everything)
