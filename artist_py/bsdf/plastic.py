"""A diffuse base under a smooth clear coat, which reflects as Fresnel says and lets the rest in and out.

With the coat's transmittance T(w) = 1 - F(w) and the base's reflectance rho,
f = T(wo) T(wi) rho / (pi eta^2 (1 - rho F_i)): light that the coat reflects back onto the base, the share F_i
of diffuse light, meets the base again and again and takes on a deeper colour each time (Walter and Jakob's
internal scattering; Saunderson 1942, Calculation of the color of pigmented plastics). The coat has no
thickness and absorbs nothing. eta is the coat's index of refraction over that of what surrounds it.

By Stokes' reversion 1 - F_i = T_m / eta^2, where T_m is the transmittance of diffuse light from outside. With
the base's colour as seen through the coat, A = rho (1 - F_i) / (1 - rho F_i), this is
f = T(wo) T(wi) A / (pi T_m), and the share of the light that is scattered is F(wo) + T(wo) A: all of it for
rho = 1.

Where the base fluoresces rho is a matrix over wavelengths, and so is A = (1 - F_i) rho (1 - F_i rho)^-1. What never
meets a dye is the A of above; the rest is tabulated once (scene/reradiation.py) and given off by fluorescence.py. All
that is left for here is to sample the base for the sake of it as well.
"""

from ..core.frame import reflect
from ..core.fresnel import fresnel_dielectric
from ..core.spectra import black
from ..core.vector import lane_count, lane_sum, splat
from ..core.warp import INV_PI, square_to_cosine_hemisphere
from ..jit import function
from .types import BsdfSample, absorption, delta_sample


@function
def colour_below(material, rho):
    """A: how much of the light that has entered the coat comes out again, per wavelength."""
    leaving = material.transmittance / (material.ior * material.ior)
    return rho * leaving / ((1.0 - rho) + rho * leaving)


@function
def base_below(material, below):
    """The reflectance of the base that has A = `below`."""
    leaving = material.transmittance / (material.ior * material.ior)
    return below / (below * (1.0 - leaving) + splat(below, leaving))


@function
def with_dyes(coated_dyes, material, below):
    """A, and what the base gives off at other wavelengths besides: what lobes are chosen by."""
    if coated_dyes is None:
        return below
    return below + splat(below, material.glow)


@function
def coat_reflectance(material, w):
    """F(w), of the mirroring coat, from either side of the surface."""
    reflectance, _ = fresnel_dielectric(abs(w.z), material.ior)
    return reflectance


@function
def mirror_probability(reflectance, below):
    """Probability of the mirrored direction: its share of the lanes' mean of F + (1 - F) A.

    `below` is A, with what dyes give off (`with_dyes`). `reflectance` is F of the direction that is scattered, be it
    `wo` or, for the reverse walk, `wi`; the rest depends on the material alone, so that both walks can tell both
    probabilities (theory 4.5).
    """
    if reflectance <= 0.0:
        return 0.0
    mean = float(lane_sum(below)) / lane_count(below)
    return reflectance / (reflectance + (1.0 - reflectance) * mean)


@function
def diffuse_pdf(reflectance, below, w):
    """Density of the diffuse samples in direction `w`, with the probability that there is one, sr^-1.

    `reflectance` is F of the other direction.
    """
    return (1.0 - mirror_probability(reflectance, below)) * w.z * INV_PI


@function
def sample_plastic(
    needed,
    coated_dyes,
    material,
    reflectance,
    spectra,
    wavelengths,
    wo,
    u,
    v,
    w,
    ratio,
    ior_outside,
    light_walk,
):
    """The mirrored direction, or one of density cos / pi."""
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    below = colour_below(material, reflectance)
    shares = with_dyes(coated_dyes, material, below)
    mirrored = coat_reflectance(material, wo)
    probability = mirror_probability(mirrored, shares)
    if w < probability:
        return delta_sample(reflect(wo), splat(wavelengths, mirrored / probability), probability, 1.0, ratio)
    wi = square_to_cosine_hemisphere(u, v)
    if wi.z <= 0.0:
        return absorption(wo, wavelengths, ratio)
    mirrored_back = coat_reflectance(material, wi)
    weight = below * (through(material, mirrored, mirrored_back) / (1.0 - probability))
    pdf = diffuse_pdf(mirrored, shares, wi)
    return BsdfSample(wi, weight, pdf, diffuse_pdf(mirrored_back, shares, wo), 1.0, False, ratio)


@function
def through(material, mirrored, mirrored_back):
    """T(wo) T(wi) / T_m."""
    return (1.0 - mirrored) * (1.0 - mirrored_back) / material.transmittance


@function
def evaluate_plastic(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """f of the diffuse part, sr^-1."""
    if needed is None:
        return black(wavelengths)
    coat = through(material, coat_reflectance(material, wo), coat_reflectance(material, wi))
    return colour_below(material, reflectance) * (coat * INV_PI)


@function
def pdf_plastic(needed, coated_dyes, material, reflectance, spectra, wavelengths, wo, wi):
    """Density of sampling `wi` from `wo` by the diffuse part, with its probability, sr^-1."""
    if needed is None:
        return 0.0
    shares = with_dyes(coated_dyes, material, colour_below(material, reflectance))
    return diffuse_pdf(coat_reflectance(material, wo), shares, wi)


@function
def reflectance_plastic(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered, in [0, 1]."""
    if needed is None:
        return black(wavelengths)
    mirrored = coat_reflectance(material, wo)
    return colour_below(material, reflectance) * (1.0 - mirrored) + mirrored
