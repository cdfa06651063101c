"""A glossy reflector: Lambert's, and Phong's lobe about the mirrored direction.

f = rho / pi + k (n + 2) / (2 pi) cos^n alpha, where alpha is the angle between `wi` and the mirror image of
`wo` (Lafortune and Willems 1994, Using the modified Phong reflectance model for physically based rendering).
The lobe is reciprocal and reflects k of the light that comes along the normal, and less of any other, since
part of it would lie below the surface. Samples that fall there are absorbed, and the density accounts for it.
"""

import math

from ..core.frame import frame_around, reflect, to_world
from ..core.spectra import black, spectrum_at
from ..core.vector import dot, lane_sum
from ..core.warp import INV_PI, square_to_cosine_hemisphere, square_to_power_cosine
from ..jit import function
from .types import BsdfSample, absorption

# Of the integral in `lobe_albedo`, for an error below 0.0003.
ALBEDO_NODES = 32


@function
def lobe_probability(rho, k):
    """Probability of sampling the lobe: its share of the lanes' mean albedo.

    It is the same for all directions, and so for both walks (theory 4.5).
    """
    diffuse, lobe = float(lane_sum(rho)), float(lane_sum(k))
    if lobe <= 0.0:
        return 0.0
    return lobe / (diffuse + lobe)


@function
def lobe_power(n, wo, wi):
    """cos^n alpha, and 0 where alpha is above 90 degrees."""
    cos_alpha = dot(reflect(wo), wi)
    if cos_alpha <= 0.0:
        return 0.0
    # Two unit vectors may be found to have a cosine above 1, which a high power would make a large number.
    return min(cos_alpha, 1.0) ** n


@function
def scattering(rho, k, n, wo, wi):
    """f, sr^-1."""
    return rho * INV_PI + k * (0.5 * INV_PI * (n + 2.0) * lobe_power(n, wo, wi))


@function
def mixture_pdf(probability, n, wo, wi):
    """Density of the samples above the surface, sr^-1."""
    lobe = 0.5 * INV_PI * (n + 1.0) * lobe_power(n, wo, wi)
    return (1.0 - probability) * wi.z * INV_PI + probability * lobe


@function
def sample_phong(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """A direction of density `mixture_pdf`."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    k, n = spectrum_at(spectra, material.specular, wavelengths), material.exponent
    probability = lobe_probability(reflectance, k)
    if w < probability:
        wi = to_world(frame_around(reflect(wo)), square_to_power_cosine(u, v, n))
    else:
        wi = square_to_cosine_hemisphere(u, v)
    pdf = mixture_pdf(probability, n, wo, wi)
    if wi.z <= 0.0 or pdf <= 0.0:
        return absorption(wo, wavelengths, ratio)
    weight = scattering(reflectance, k, n, wo, wi) * (wi.z / pdf)
    return BsdfSample(wi, weight, pdf, mixture_pdf(probability, n, wi, wo), 1.0, False, ratio)


@function
def evaluate_phong(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """f, sr^-1."""
    if needed is None:
        return black(wavelengths)
    k = spectrum_at(spectra, material.specular, wavelengths)
    return scattering(reflectance, k, material.exponent, wo, wi)


@function
def pdf_phong(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """Density of sampling `wi` from `wo`, sr^-1."""
    if needed is None:
        return 0.0
    k = spectrum_at(spectra, material.specular, wavelengths)
    return mixture_pdf(lobe_probability(reflectance, k), material.exponent, wo, wi)


@function
def reflectance_phong(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]."""
    if needed is None:
        return black(wavelengths)
    k = spectrum_at(spectra, material.specular, wavelengths)
    return reflectance + k * lobe_albedo(wo.z, material.exponent)


@function
def lobe_albedo(cos_theta, n):
    """Share of the light at `cos_theta` that the lobe reflects, for k = 1, in [0, 1].

    The whole lobe has the integral cos theta, to which the part below the surface contributes a negative share that
    must be taken out again: the mean of `_below` over t = cos^(n + 1) alpha, by the midpoint rule.
    """
    sin_theta = math.sqrt(max(0.0, 1.0 - cos_theta * cos_theta))
    total = 0.0
    for i in range(ALBEDO_NODES):
        cos_alpha = ((i + 0.5) / ALBEDO_NODES) ** (1.0 / (n + 1.0))
        sin_alpha = math.sqrt(max(0.0, 1.0 - cos_alpha * cos_alpha))
        total += _below(cos_alpha * cos_theta, sin_alpha * sin_theta)
    return cos_theta + (n + 2.0) / (n + 1.0) * total / ALBEDO_NODES


@function
def _below(a, b):
    """Mean of max(0, -a - b cos phi) over all phi."""
    if a >= b:
        return 0.0
    return INV_PI * (math.sqrt(b * b - a * a) - a * math.acos(a / b))


@function
def bound_phong(needed, material, reflectance, spectra, wavelengths):
    """The most that is scattered of light from anywhere, in [0, 1]: of light along the normal."""
    if needed is None:
        return black(wavelengths)
    return reflectance + spectrum_at(spectra, material.specular, wavelengths)
