"""An ideal mirror: the reflected direction, coloured by a reflectance."""

from ..core.frame import reflect
from ..core.spectra import black
from ..jit import function
from .types import absorption, delta_sample, evaluate_delta, pdf_delta

evaluate_mirror = evaluate_delta
pdf_mirror = pdf_delta


@function
def sample_mirror(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """The mirrored direction."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    return delta_sample(reflect(wo), reflectance, 1.0, 1.0, ratio)


@function
def reflectance_mirror(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]."""
    if needed is None:
        return black(wavelengths)
    return reflectance
