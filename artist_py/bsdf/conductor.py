"""A smooth metal: mirror reflection with the Fresnel reflectance of its complex index of refraction."""

from ..core.frame import reflect
from ..core.fresnel import fresnel_conductor
from ..core.spectra import black, spectrum_at
from ..jit import function
from .types import absorption, delta_sample, evaluate_delta, pdf_delta

evaluate_conductor = evaluate_delta
pdf_conductor = pdf_delta


@function
def sample_conductor(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """The mirrored direction."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    weight = reflectance_conductor(needed, material, reflectance, spectra, wavelengths, wo, ior_outside)
    return delta_sample(reflect(wo), weight, 1.0, 1.0, ratio)


@function
def reflectance_conductor(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]; a metal in glass reflects less than one in air."""
    if needed is None:
        return black(wavelengths)
    eta = spectrum_at(spectra, material.eta, wavelengths) / ior_outside
    k = spectrum_at(spectra, material.absorption, wavelengths) / ior_outside
    return reflectance * fresnel_conductor(wo.z, eta, k)
