"""A surface that is not there: everything goes straight on."""

from ..core.spectra import black
from ..core.vector import splat
from ..jit import function
from .types import absorption, delta_sample, evaluate_delta, pdf_delta

evaluate_pass_through = evaluate_delta
pdf_pass_through = pdf_delta


@function
def sample_pass_through(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """The opposite direction."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    return delta_sample(-wo, splat(wavelengths, 1.0), 1.0, 1.0, ratio)


@function
def reflectance_pass_through(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered: all of it."""
    if needed is None:
        return black(wavelengths)
    return splat(wavelengths, 1.0)
