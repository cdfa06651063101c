"""All BSDFs behind one interface: the material's kind chooses, and its two sides are told apart here only.

`needs` is `tables.Needs`: a kind that the scene does not use is `None` there and is compiled out. Directions
are unit, local to the shading frame and point away from the surface. What only reflects is evaluated on the
side z > 0; for light at the other side both directions are turned over, or it is black where the material is
not two-sided.
"""

from ..core.spectra import black
from ..core.vector import lane_max, vec3
from ..jit import function
from ..scene.tables import CONDUCTOR, DIELECTRIC, MIRROR, PASS_THROUGH, PHONG, PLASTIC, THIN_DIELECTRIC
from .conductor import reflectance_conductor, sample_conductor
from .connectable import (
    evaluate_connectable,
    pdf_connectable,
    reflectance_connectable,
    sample_connectable,
)
from .dielectric import reflectance_dielectric, sample_dielectric
from .mirror import reflectance_mirror, sample_mirror
from .pass_through import reflectance_pass_through, sample_pass_through
from .phong import bound_phong
from .thin_dielectric import reflectance_thin_dielectric, sample_thin_dielectric
from .types import BsdfSample, absorption


@function
def sample_bsdf(
    needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    """A `BsdfSample` for `wo`, from the three uniform numbers `u`, `v`, `w`.

    `ratio` is the running r of theory (2.6), or `None` in scenes without dispersion. `ior_outside` is the
    index of refraction of the medium around the shape (of the side z > 0): a number, or a spectrum where
    media disperse. `light_walk` is `True` for walks from a light and `None` for walks from the eye, which
    scale radiance at refractions.
    """
    if is_transmissive(material):
        return _sample_transmissive(
            needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
        )
    if is_black(needs.one_sided, material, wo):
        return absorption(wo, wavelengths, ratio)
    sample = _sample_reflective(
        needs,
        material,
        reflectance,
        spectra,
        wavelengths,
        _turned(wo, wo),
        u,
        v,
        w,
        ratio,
        ior_outside,
        light_walk,
    )
    return BsdfSample(
        _turned(sample.wi, wo),
        sample.weight,
        sample.pdf,
        sample.pdf_rev,
        sample.eta,
        sample.is_delta,
        sample.ratio,
    )


@function
def _sample_reflective(
    needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    kind = material.kind
    if not is_delta_bsdf(material):
        return sample_connectable(
            needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
        )
    if kind == MIRROR:
        return sample_mirror(
            needs.mirror,
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
        )
    if kind == CONDUCTOR:
        return sample_conductor(
            needs.conductor,
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
        )
    return absorption(wo, wavelengths, ratio)


@function
def _sample_transmissive(
    needs, material, reflectance, spectra, wavelengths, wo, u, v, w, ratio, ior_outside, light_walk
):
    kind = material.kind
    if kind == DIELECTRIC:
        return sample_dielectric(
            needs.dielectric,
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
        )
    if kind == THIN_DIELECTRIC:
        return sample_thin_dielectric(
            needs.thin_dielectric,
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
        )
    if kind == PASS_THROUGH:
        return sample_pass_through(
            needs.pass_through,
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
        )
    return absorption(wo, wavelengths, ratio)


@function
def evaluate_bsdf(needs, material, reflectance, spectra, wavelengths, wo, wi):
    """f(wo, wi) without the cosine, sr^-1; symmetric in its directions, and zero for what has delta lobes only."""
    if wo.z * wi.z <= 0.0 or is_delta_bsdf(material) or is_black(needs.one_sided, material, wo):
        return black(wavelengths)
    return evaluate_connectable(
        needs, material, reflectance, spectra, wavelengths, _turned(wo, wo), _turned(wi, wo)
    )


@function
def pdf_bsdf(needs, material, reflectance, spectra, wavelengths, wo, wi):
    """Density of `sample_bsdf` at `wi` for `wo`, sr^-1; with swapped directions, that of the reverse walk.

    Where there are delta lobes as well, it holds the probability that none of these is sampled.
    """
    if wo.z * wi.z <= 0.0 or is_delta_bsdf(material) or is_black(needs.one_sided, material, wo):
        return 0.0
    return pdf_connectable(
        needs, material, reflectance, spectra, wavelengths, _turned(wo, wo), _turned(wi, wo)
    )


@function
def reflectance_bsdf(needs, material, reflectance, spectra, wavelengths, wo, ior_outside):
    """Share of the light from `wo` that is scattered into all directions, in [0, 1]."""
    if is_transmissive(material):
        return _transmissive_reflectance(needs, material, reflectance, spectra, wavelengths, wo, ior_outside)
    if is_black(needs.one_sided, material, wo):
        return black(wavelengths)
    return _reflective_reflectance(
        needs, material, reflectance, spectra, wavelengths, _turned(wo, wo), ior_outside
    )


@function
def _reflective_reflectance(needs, material, reflectance, spectra, wavelengths, wo, ior_outside):
    kind = material.kind
    if not is_delta_bsdf(material):
        return reflectance_connectable(needs, material, reflectance, spectra, wavelengths, wo, ior_outside)
    if kind == MIRROR:
        return reflectance_mirror(needs.mirror, material, reflectance, spectra, wavelengths, wo, ior_outside)
    if kind == CONDUCTOR:
        return reflectance_conductor(
            needs.conductor, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    return black(wavelengths)


@function
def _transmissive_reflectance(needs, material, reflectance, spectra, wavelengths, wo, ior_outside):
    kind = material.kind
    if kind == DIELECTRIC:
        return reflectance_dielectric(
            needs.dielectric, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    if kind == THIN_DIELECTRIC:
        return reflectance_thin_dielectric(
            needs.thin_dielectric, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    if kind == PASS_THROUGH:
        return reflectance_pass_through(
            needs.pass_through, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    return black(wavelengths)


@function
def survival_bsdf(needs, material, reflectance, spectra, wavelengths):
    """Probability in [0, 1] for a walk to go on after the material: the most that it scatters of light from anywhere.

    It is the same for both walks and for all directions, so that MIS densities may hold it (theory 1.8).
    """
    if material.kind == PLASTIC or material.kind >= DIELECTRIC:
        return 1.0
    if material.kind == PHONG:
        return _lane_survival(bound_phong(needs.phong, material, reflectance, spectra, wavelengths))
    return _lane_survival(reflectance)


@function
def _lane_survival(reflectance):
    return min(1.0, float(lane_max(reflectance)))


@function
def is_delta_bsdf(material):
    """Whether the material has delta lobes only, so that nothing can be connected to it or merged at it."""
    return material.kind >= MIRROR


@function
def is_mergeable(sharp, material):
    """Whether light subpaths may be merged at a material that has a density; `sharp` is `needs.sharp` (theory 4.6)."""
    if sharp is None:
        return True
    return material.is_sharp == 0


@function
def is_transmissive(material):
    """Whether light can go through; the kinds are numbered so that these stand together."""
    return DIELECTRIC <= material.kind <= PASS_THROUGH


@function
def is_black(one_sided, material, wo):
    """Whether `wo` is behind a surface that only scatters in front."""
    if one_sided is None:
        return False
    return material.two_sided == 0 and wo.z < 0.0


@function
def _turned(w, wo):
    """`w` where `wo` is above the surface, and else its image on the other side."""
    return w if wo.z >= 0.0 else vec3(w.x, w.y, -w.z)
