"""The ideal diffuse reflector of Lambert: f = reflectance / pi."""

from ..core.spectra import black
from ..core.warp import INV_PI, square_to_cosine_hemisphere
from ..jit import function
from .types import BsdfSample, absorption


@function
def sample_diffuse(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """A direction of density cos / pi."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    wi = square_to_cosine_hemisphere(u, v)
    return BsdfSample(wi, reflectance, wi.z * INV_PI, wo.z * INV_PI, 1.0, False, ratio)


@function
def evaluate_diffuse(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """f, sr^-1."""
    if needed is None:
        return black(wavelengths)
    return reflectance * INV_PI


@function
def pdf_diffuse(needed, material, wo, wi):
    """Density of sampling `wi` from `wo`, sr^-1."""
    if needed is None:
        return 0.0
    return wi.z * INV_PI


@function
def reflectance_diffuse(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]."""
    if needed is None:
        return black(wavelengths)
    return reflectance
