"""A smooth interface between two clear media: reflection, or refraction with Snell's law and dispersion.

`wo.z` > 0 lies in the medium outside, whose index of refraction `ior_outside` the caller knows: a number, or
a spectrum where the surrounding medium itself may be dispersive. Reflection is chosen with the probability of
Fresnel's reflectance, which is the same for the reverse walk.

Where wavelengths refract into different directions, the walk keeps all of them for as long as they are
reflected and draws the one that goes on only at a refraction (theory 2.4, the lazy hero). `ratio` is the
lanes' running ratio of densities r, of mean 1, and turns by (2.6).
"""

from ..core.frame import reflect
from ..core.fresnel import fresnel_dielectric, fresnel_dielectric_lanes, refract
from ..core.spectra import black, choose_lane, ior_of_lane, lane_of
from ..core.vector import lane, lane_count, lane_max, lane_min, lane_sum, splat, with_lane
from ..jit import function
from .types import absorption, delta_sample, evaluate_delta, pdf_delta

evaluate_dielectric = evaluate_delta
pdf_dielectric = pdf_delta


@function
def sample_dielectric(
    needed, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """The mirrored or the refracted direction.

    `light_walk` is `None` on a walk from the eye, which scales radiance by (n_o / n_i)^2 at a refraction.
    """
    if needed is None:
        return absorption(wo, wavelengths, ratio)
    if is_dispersive(ratio, material, ior_outside):
        return sample_dispersive(ratio, material, spectra, wavelengths, wo, w, ior_outside, light_walk)
    eta = relative_ior(material.ior, lane_of(ior_outside, 0), wo)
    fresnel, cos_theta_t = fresnel_dielectric(abs(wo.z), eta)
    if w < fresnel:
        return delta_sample(reflect(wo), splat(wavelengths, 1.0), fresnel, 1.0, ratio)
    weight = splat(wavelengths, radiance_scale(light_walk, eta))
    return delta_sample(refract(wo, eta, cos_theta_t), weight, 1.0 - fresnel, eta, ratio)


@function
def is_dispersive(ratio, material, ior_outside):
    """Whether the wavelengths of this path refract into different directions here."""
    if ratio is None:
        return False
    outside = black(ratio) + ior_outside
    return material.is_dispersive != 0 or lane_min(outside) < lane_max(outside)


@function
def relative_ior(ior_inside, ior_outside, wo):
    """Index of refraction beyond the interface over that on the side of `wo`."""
    return ior_inside / ior_outside if wo.z > 0.0 else ior_outside / ior_inside


@function
def radiance_scale(light_walk, eta):
    """Factor of a refraction: radiance shrinks as etendue grows, flux stays (theory 1.7)."""
    if light_walk is None:
        return 1.0 / (eta * eta)
    return 1.0


@function
def sample_dispersive(ratio, material, spectra, wavelengths, wo, w, ior_outside, light_walk):
    """`sample_dielectric` with an index of refraction per wavelength.

    The hero is drawn with probability r_h / C from `w`, whose rest then decides on reflection with F_h: over
    heroes, with q = mean(r F). The `pdf` of a refraction leaves out its factor 1 / C, as theory 2.4 does for
    the weights.
    """
    if ratio is None:
        return absorption(wo, wavelengths, ratio)
    reflectance = reflectance_lanes(material, spectra, wavelengths, wo, ior_outside)
    hero, rest = choose_lane(ratio, w)
    if rest < lane(reflectance, hero):
        turned = ratio * reflectance
        scale = lane_count(ratio) / lane_sum(turned)
        mean = lane_sum(reflectance) / lane_count(ratio)
        return delta_sample(reflect(wo), reflectance * scale, mean, 1.0, turned * scale)
    eta = lane_eta(material, spectra, wavelengths, wo, ior_outside, hero)
    hero_reflectance, cos_theta_t = fresnel_dielectric(abs(wo.z), eta)
    weight = radiance_scale(light_walk, eta) * lane_count(ratio) / lane(ratio, hero)
    return delta_sample(
        refract(wo, eta, cos_theta_t),
        with_lane(black(wavelengths), hero, weight),
        1.0 - hero_reflectance,
        eta,
        with_lane(black(wavelengths), hero, lane_count(ratio)),
    )


@function
def lane_eta(material, spectra, wavelengths, wo, ior_outside, index):
    """`relative_ior` of one wavelength."""
    ior_inside = material.ior
    if material.is_dispersive != 0:
        ior_inside = ior_of_lane(spectra, material.eta, wavelengths, index)
    return relative_ior(ior_inside, lane_of(ior_outside, index), wo)


@function
def reflectance_lanes(material, spectra, wavelengths, wo, ior_outside):
    """Fresnel's reflectance per wavelength."""
    eta_squared_minus_1 = wavelengths
    for i in range(lane_count(wavelengths)):
        eta = lane_eta(material, spectra, wavelengths, wo, ior_outside, i)
        eta_squared_minus_1 = with_lane(eta_squared_minus_1, i, (eta - 1.0) * (eta + 1.0))
    return fresnel_dielectric_lanes(abs(wo.z), eta_squared_minus_1)


@function
def reflectance_dielectric(needed, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered: all of it."""
    if needed is None:
        return black(wavelengths)
    return splat(wavelengths, 1.0)
