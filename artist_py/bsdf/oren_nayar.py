"""A rough diffuse reflector that keeps all energy: the EON model of Portsmouth, Kutz and Hill 2025 (JCGT 14(1)).

Its single scattering is Fujii's form of the Oren-Nayar model: f_1 = rho / pi A (1 + r s / t), with s = wo.wi
- cos cos, t = max(cos, cos) where s > 0 and 1 elsewhere, and A = 1 / (1 + (1/2 - 2/(3 pi)) r). What f_1
loses, light that facets scatter more than once, comes back in a second, separable term. The sum is reciprocal
and a white surface reflects everything.

The scene gives Oren and Nayar's sigma, the standard deviation of the facets' slope angle. r is set to B / A
of the qualitative model of Oren and Nayar 1994, so that the backscattering for a given sigma is theirs; it
grows from 0, Lambert's reflector, to 0.78 at 90 degrees.
"""

import math

from ..core.spectra import black
from ..core.vector import dot
from ..core.warp import INV_PI, square_to_cone, square_to_cosine_hemisphere
from ..jit import function
from .types import BsdfSample, absorption

LOSS = 0.5 - 2.0 / (3.0 * math.pi)
MEAN_GAIN = 2.0 / 3.0 - 28.0 / (15.0 * math.pi)
# Largest share of uniform directions among the samples, at grazing `wo`; measured, near the least variance.
UNIFORM_SHARE = 0.4


@function
def slope_ratio(roughness):
    """r of the model for sigma = `roughness`, radians."""
    variance = roughness * roughness
    return 0.45 * variance / (variance + 0.09) * (variance + 0.33) / (0.5 * variance + 0.33)


@function
def single_albedo(cos_theta, r):
    """Share of the light at `cos_theta` that leaves after one scattering, for rho = 1.

    Portsmouth et al. 2025, section 3, with (1 - sin^3) / cos written without the quotient.
    """
    sin_theta = math.sqrt(max(0.0, 1.0 - cos_theta * cos_theta))
    angle = math.acos(min(cos_theta, 1.0))
    back = sin_theta * (angle - sin_theta * cos_theta)
    ahead = sin_theta * cos_theta * (1.0 + sin_theta + sin_theta * sin_theta) / (1.0 + sin_theta) - sin_theta
    return (1.0 + r * INV_PI * (back + 2.0 / 3.0 * ahead)) / (1.0 + LOSS * r)


@function
def mean_albedo(r):
    """Cosine-weighted mean of `single_albedo`."""
    return (1.0 + MEAN_GAIN * r) / (1.0 + LOSS * r)


@function
def multiple_reflectance(rho, mean):
    """Reflectance of the light that scatters more than once: a geometric series over the facets."""
    return rho * rho * (mean / (1.0 - rho * (1.0 - mean)))


@function
def scattering(rho, r, wo, wi):
    """f for the facets' reflectance `rho`, sr^-1."""
    s = dot(wo, wi) - wo.z * wi.z
    ratio = s / max(wo.z, wi.z) if s > 0.0 else s
    single = INV_PI * (1.0 + r * ratio) / (1.0 + LOSS * r)
    mean = mean_albedo(r)
    if mean == 1.0:
        return rho * single
    lost = (1.0 - single_albedo(wo.z, r)) * (1.0 - single_albedo(wi.z, r)) / (1.0 - mean)
    return rho * single + multiple_reflectance(rho, mean) * (lost * INV_PI)


@function
def mixture_pdf(r, wo, wi):
    """Density of the sampled directions, sr^-1: cosine-distributed ones and a few uniform ones.

    Towards grazing pairs f grows as r / cos, which cosine-distributed samples alone would miss.
    """
    share = uniform_share(r, wo)
    return (1.0 - share) * wi.z * INV_PI + share * (0.5 * INV_PI)


@function
def uniform_share(r, wo):
    """Probability of a uniform direction."""
    height = 1.0 - wo.z
    return UNIFORM_SHARE * r * height * height


@function
def sample_oren_nayar(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """A direction of density `mixture_pdf`."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    r = slope_ratio(material.roughness)
    if w < uniform_share(r, wo):
        wi = square_to_cone(u, v, 1.0)
    else:
        wi = square_to_cosine_hemisphere(u, v)
    pdf = mixture_pdf(r, wo, wi)
    if pdf <= 0.0:
        return absorption(wo, wavelengths, ratio)
    weight = scattering(reflectance, r, wo, wi) * (wi.z / pdf)
    return BsdfSample(wi, weight, pdf, mixture_pdf(r, wi, wo), 1.0, False, ratio)


@function
def evaluate_oren_nayar(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """f, sr^-1."""
    if needed is None:
        return black(wavelengths)
    return scattering(reflectance, slope_ratio(material.roughness), wo, wi)


@function
def pdf_oren_nayar(needed, material, wo, wi):
    """Density of sampling `wi` from `wo`, sr^-1."""
    if needed is None:
        return 0.0
    return mixture_pdf(slope_ratio(material.roughness), wo, wi)


@function
def reflectance_oren_nayar(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]; the exact integral of f cos."""
    if needed is None:
        return black(wavelengths)
    r = slope_ratio(material.roughness)
    once = single_albedo(wo.z, r)
    return reflectance * once + multiple_reflectance(reflectance, mean_albedo(r)) * (1.0 - once)
