"""A thin clear sheet with the same medium on both sides: light is mirrored, or goes straight on."""

from ..core.frame import reflect
from ..core.fresnel import fresnel_dielectric, slab_reflectance
from ..core.spectra import black, lane_of
from ..core.vector import lane_count, lane_sum, splat, vec3
from ..jit import function
from .dielectric import is_dispersive, reflectance_lanes
from .types import absorption, delta_sample, evaluate_delta, pdf_delta

evaluate_thin_dielectric = evaluate_delta
pdf_thin_dielectric = pdf_delta


@function
def sample_thin_dielectric(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """The mirrored or the opposite direction, after any number of reflections inside.

    All wavelengths take the same directions, so that they can share one probability of reflection: the lanes'
    mean.
    """
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    mirrored = sheet_reflectance(ratio, material, spectra, wavelengths, wo, ior_outside)
    probability = lane_sum(mirrored) / lane_count(mirrored)
    if w < probability:
        return delta_sample(reflect(wo), mirrored / probability, probability, 1.0, ratio)
    return delta_sample(-wo, (1.0 - mirrored) / (1.0 - probability), 1.0 - probability, 1.0, ratio)


@function
def sheet_reflectance(ratio, material, spectra, wavelengths, wo, ior_outside):
    """Reflectance of the sheet per wavelength."""
    if is_dispersive(ratio, material, ior_outside):
        return slab_reflectance(dispersive_face(ratio, material, spectra, wavelengths, wo, ior_outside))
    face, _ = fresnel_dielectric(abs(wo.z), material.ior / lane_of(ior_outside, 0))
    return splat(wavelengths, slab_reflectance(face))


@function
def dispersive_face(ratio, material, spectra, wavelengths, wo, ior_outside):
    """Fresnel's reflectance of one face per wavelength."""
    if ratio is None:
        return black(wavelengths)
    # Both faces are entered from outside, whichever side `wo` is on.
    return reflectance_lanes(material, spectra, wavelengths, vec3(wo.x, wo.y, abs(wo.z)), ior_outside)


@function
def reflectance_thin_dielectric(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered: all of it."""
    if needed is None:
        return black(wavelengths)
    return splat(wavelengths, 1.0)
