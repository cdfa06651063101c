"""The BSDFs that have a density, so that vertices can be connected and merged; `wo` is above the surface."""

from ..core.spectra import black
from ..jit import function
from ..scene.tables import DIFFUSE, OREN_NAYAR, PHONG, PLASTIC
from .diffuse import evaluate_diffuse, pdf_diffuse, reflectance_diffuse, sample_diffuse
from .oren_nayar import evaluate_oren_nayar, pdf_oren_nayar, reflectance_oren_nayar, sample_oren_nayar
from .phong import evaluate_phong, pdf_phong, reflectance_phong, sample_phong
from .plastic import evaluate_plastic, pdf_plastic, reflectance_plastic, sample_plastic
from .types import absorption


@function
def sample_connectable(
    needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """A `BsdfSample`, which may be of a delta lobe that the material has besides."""
    kind = material.kind
    if kind == DIFFUSE:
        return sample_diffuse(
            needs.diffuse, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
        )  # fmt: skip
    if kind == OREN_NAYAR:
        return sample_oren_nayar(
            needs.oren_nayar, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
        )  # fmt: skip
    if kind == PHONG:
        return sample_phong(
            needs.phong, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
        )  # fmt: skip
    if kind == PLASTIC:
        return sample_plastic(
            needs.plastic, needs.coated_dyes, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio,
            ior_outside, light_walk,
        )  # fmt: skip
    return absorption(wo, wavelengths, ratio)


@function
def evaluate_connectable(needs, material, reflectance, spectra, wavelengths, wo, wi):
    """f without delta lobes, sr^-1, for directions on the same side."""
    kind = material.kind
    if kind == DIFFUSE:
        return evaluate_diffuse(needs.diffuse, material, reflectance, spectra, wavelengths, wo, wi)
    if kind == OREN_NAYAR:
        return evaluate_oren_nayar(needs.oren_nayar, material, reflectance, spectra, wavelengths, wo, wi)
    if kind == PHONG:
        return evaluate_phong(needs.phong, material, reflectance, spectra, wavelengths, wo, wi)
    if kind == PLASTIC:
        return evaluate_plastic(needs.plastic, material, reflectance, spectra, wavelengths, wo, wi)
    return black(wavelengths)


@function
def pdf_connectable(needs, material, reflectance, spectra, wavelengths, wo, wi):
    """Density of sampling `wi` from `wo`, sr^-1, for directions on the same side."""
    kind = material.kind
    if kind == DIFFUSE:
        return pdf_diffuse(needs.diffuse, material, wo, wi)
    if kind == OREN_NAYAR:
        return pdf_oren_nayar(needs.oren_nayar, material, wo, wi)
    if kind == PHONG:
        return pdf_phong(needs.phong, material, reflectance, spectra, wavelengths, wo, wi)
    if kind == PLASTIC:
        return pdf_plastic(
            needs.plastic, needs.coated_dyes, material, reflectance, spectra, wavelengths, wo, wi
        )
    return 0.0


@function
def reflectance_connectable(needs, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, delta lobes included, in [0, 1]."""
    kind = material.kind
    if kind == DIFFUSE:
        return reflectance_diffuse(
            needs.diffuse, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    if kind == OREN_NAYAR:
        return reflectance_oren_nayar(
            needs.oren_nayar, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    if kind == PHONG:
        return reflectance_phong(needs.phong, material, reflectance, spectra, wavelengths, wo, ior_outside)
    if kind == PLASTIC:
        return reflectance_plastic(
            needs.plastic, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    return black(wavelengths)
