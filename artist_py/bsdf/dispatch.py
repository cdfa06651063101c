"""All BSDFs behind one interface: the material's kind chooses, and its two sides are told apart here only.

`needs` is `tables.Needs`: a kind that the scene does not use is `None` there and is compiled out. Directions
are unit, local to the shading frame and point away from the surface. What only reflects is evaluated on the
side z > 0; for light at the other side both directions are turned over, or it is black where the material is
not two-sided.
"""

from ..core.spectra import black
from ..core.vector import vec3
from ..jit import function
from ..scene.tables import CONDUCTOR, DIELECTRIC, DIFFUSE, MIRROR, OREN_NAYAR, PASS_THROUGH, THIN_DIELECTRIC
from .conductor import reflectance_conductor, sample_conductor
from .dielectric import reflectance_dielectric, sample_dielectric
from .diffuse import evaluate_diffuse, pdf_diffuse, reflectance_diffuse, sample_diffuse
from .mirror import reflectance_mirror, sample_mirror
from .oren_nayar import evaluate_oren_nayar, pdf_oren_nayar, reflectance_oren_nayar, sample_oren_nayar
from .pass_through import reflectance_pass_through, sample_pass_through
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
    if kind == DIFFUSE:
        return sample_diffuse(
            needs.diffuse,
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
    if kind == OREN_NAYAR:
        return sample_oren_nayar(
            needs.oren_nayar,
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
    if wo.z * wi.z <= 0.0 or is_black(needs.one_sided, material, wo):
        return black(wavelengths)
    kind = material.kind
    if kind == DIFFUSE:
        return evaluate_diffuse(
            needs.diffuse, material, reflectance, spectra, wavelengths, _turned(wo, wo), _turned(wi, wo)
        )
    if kind == OREN_NAYAR:
        return evaluate_oren_nayar(
            needs.oren_nayar, material, reflectance, spectra, wavelengths, _turned(wo, wo), _turned(wi, wo)
        )
    return black(wavelengths)


@function
def pdf_bsdf(needs, material, wo, wi):
    """Density of `sample_bsdf` at `wi` for `wo`, sr^-1; with swapped directions, that of the reverse walk."""
    if wo.z * wi.z <= 0.0 or is_black(needs.one_sided, material, wo):
        return 0.0
    kind = material.kind
    if kind == DIFFUSE:
        return pdf_diffuse(needs.diffuse, material, _turned(wo, wo), _turned(wi, wo))
    if kind == OREN_NAYAR:
        return pdf_oren_nayar(needs.oren_nayar, material, _turned(wo, wo), _turned(wi, wo))
    return 0.0


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
    if kind == DIFFUSE:
        return reflectance_diffuse(
            needs.diffuse, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
    if kind == OREN_NAYAR:
        return reflectance_oren_nayar(
            needs.oren_nayar, material, reflectance, spectra, wavelengths, wo, ior_outside
        )
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
def is_delta_bsdf(material):
    """Whether the material has delta lobes only, so that nothing can be connected to it or merged at it."""
    return material.kind != DIFFUSE and material.kind != OREN_NAYAR


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
