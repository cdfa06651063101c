"""Choosing an emitter by power, sampling a point on it, and the density of having done so."""

from ..core.alias_table import sample_alias
from ..core.spectra import spectrum_at
from ..core.vector import dot
from ..jit import function
from ..scene.tables import PARALLELOGRAM_EMITTER, QUADRIC_EMITTER, SPHERE_EMITTER
from .area import sample_parallelogram, sample_triangle, solid_angle_density
from .quadric import pdf_quadric_emitter, pdf_sphere, sample_quadric_emitter, sample_sphere


@function
def choose_emitter(alias, u):
    """Index of an emitter, with probability `pdf_select` of its record."""
    if alias is None:
        return 0
    return sample_alias(alias, u)


@function
def sample_emitter(needs, geometry, emitter, reference, u, v):
    """A point on `emitter` (a record) for `reference`; `EmitterPoint`."""
    kind = emitter.kind
    if kind == PARALLELOGRAM_EMITTER:
        return sample_parallelogram(needs.parallelogram_emitters, emitter, reference, u, v)
    if kind == SPHERE_EMITTER:
        return sample_sphere(needs.sphere_emitters, emitter, reference, u, v)
    if kind == QUADRIC_EMITTER:
        return sample_quadric_emitter(needs.quadric_emitters, emitter, geometry.quadrics, reference, u, v)
    return sample_triangle(needs.triangle_emitters, emitter, reference, u, v)


@function
def pdf_emitter(needs, geometry, emitter, reference, position, normal):
    """Density, sr^-1 at `reference`, of choosing `emitter` and sampling `position` on it."""
    kind = emitter.kind
    if kind == SPHERE_EMITTER:
        density = pdf_sphere(needs.sphere_emitters, emitter, reference, position, normal)
    elif kind == QUADRIC_EMITTER:
        density = pdf_quadric_emitter(
            needs.quadric_emitters, emitter, geometry.quadrics, reference, position, normal
        )
    else:
        density = solid_angle_density(1.0 / emitter.area, reference, position, normal)
    return density * emitter.pdf_select


@function
def is_emitting_towards(emitter, normal, direction):
    """Whether the side of `normal` or, for two-sided emitters, any side emits into `direction`."""
    return emitter.two_sided != 0 or dot(normal, direction) > 0.0


@function
def emitted_radiance(spectra, emitter, wavelengths):
    """Radiance that the emitter's front gives off, W m^-2 sr^-1 nm^-1 per wavelength."""
    return spectrum_at(spectra, emitter.spectrum, wavelengths) * emitter.scale
