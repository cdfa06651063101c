"""Choosing an emitter by power, sampling a point on it, and the density of having done so.

`emitter` is a record of `scene.emitters`. What has no surface is behind `needs.surfaceless_emitters`: scenes without
it do not compile a single comparison for it.
"""

from ..core.alias_table import sample_alias
from ..core.spectra import spectrum_at
from ..core.vector import dot
from ..jit import function
from ..scene.tables import (
    DIRECTIONAL_EMITTER,
    ENVIRONMENT_EMITTER,
    PARALLELOGRAM_EMITTER,
    POINT_EMITTER,
    QUADRIC_EMITTER,
    SPHERE_EMITTER,
    SPOT_EMITTER,
    SUN_EMITTER,
)
from .area import sample_parallelogram, sample_triangle, solid_angle_density
from .environment import environment_radiance
from .infinite import pdf_towards, sample_infinite
from .point import pdf_point, sample_point, sample_spot, spot_falloff
from .quadric import pdf_quadric_emitter, pdf_sphere, sample_quadric_emitter, sample_sphere


@function
def choose_emitter(alias, u):
    """Index of an emitter, with probability `pdf_select` of its record."""
    if alias is None:
        return 0
    return sample_alias(alias, u)


@function
def sample_emitter(scene, emitter, reference, u, v):
    """A point on `emitter` for `reference`; `EmitterPoint`."""
    return _sample(scene.needs.surfaceless_emitters, scene, emitter, reference, u, v)


@function
def _sample(needed, scene, emitter, reference, u, v):
    if needed is None:
        return _sample_surface(scene.needs, scene.geometry, emitter, reference, u, v)
    if emitter.kind >= DIRECTIONAL_EMITTER:
        return sample_infinite(scene, emitter, reference, u, v)
    if emitter.kind == SPOT_EMITTER:
        return sample_spot(scene.needs.spot_emitters, emitter, reference)
    if emitter.kind == POINT_EMITTER:
        return sample_point(scene.needs.point_emitters, emitter, reference)
    return _sample_surface(scene.needs, scene.geometry, emitter, reference, u, v)


@function
def _sample_surface(needs, geometry, emitter, reference, u, v):
    kind = emitter.kind
    if kind == PARALLELOGRAM_EMITTER:
        return sample_parallelogram(needs.parallelogram_emitters, emitter, reference, u, v)
    if kind == SPHERE_EMITTER:
        return sample_sphere(needs.sphere_emitters, emitter, reference, u, v)
    if kind == QUADRIC_EMITTER:
        return sample_quadric_emitter(needs.quadric_emitters, emitter, geometry.quadrics, reference, u, v)
    return sample_triangle(needs.triangle_emitters, emitter, reference, u, v)


@function
def pdf_emitter(scene, emitter, reference, position, normal):
    """Density, sr^-1 at `reference`, of choosing `emitter` and sampling `position` on it.

    Without a surface, `normal` is the direction in which light comes from there.
    """
    density = _pdf(scene.needs.surfaceless_emitters, scene, emitter, reference, position, normal)
    return density * emitter.pdf_select


@function
def _pdf(needed, scene, emitter, reference, position, normal):
    if needed is None:
        return _pdf_surface(scene.needs, scene.geometry, emitter, reference, position, normal)
    if emitter.kind >= DIRECTIONAL_EMITTER:
        return pdf_towards(scene, emitter, -normal)
    if emitter.kind >= POINT_EMITTER:
        return pdf_point(emitter, reference)
    return _pdf_surface(scene.needs, scene.geometry, emitter, reference, position, normal)


@function
def _pdf_surface(needs, geometry, emitter, reference, position, normal):
    kind = emitter.kind
    if kind == SPHERE_EMITTER:
        density = pdf_sphere(needs.sphere_emitters, emitter, reference, position, normal)
    elif kind == QUADRIC_EMITTER:
        density = pdf_quadric_emitter(
            needs.quadric_emitters, emitter, geometry.quadrics, reference, position, normal
        )
    else:
        density = solid_angle_density(1.0 / emitter.area, reference, position, normal)
    return density


@function
def is_emitting_towards(emitter, normal, direction):
    """Whether the side of `normal` or, for two-sided emitters, any side emits into `direction`."""
    return emitter.two_sided != 0 or dot(normal, direction) > 0.0


@function
def can_be_hit(surfaceless, emitter):
    """1.0, or 0.0 for points, spots and directional light; `surfaceless` is `needs.surfaceless_emitters`."""
    if surfaceless is None:
        return 1.0
    return 0.0 if POINT_EMITTER <= emitter.kind < SUN_EMITTER else 1.0


@function
def is_hidden(hidden, emitter, length):
    """Whether the camera does not see the emitter after `length` edges; `hidden` is `needs.hidden_emitters`."""
    if hidden is None:
        return False
    return length == 1 and emitter.visible == 0


@function
def emitted_radiance(scene, emitter, direction, wavelengths):
    """Radiance that the emitter sends into the unit `direction`, W m^-2 sr^-1 nm^-1 per wavelength.

    Of points and spots intensity, W sr^-1 nm^-1, of directional light irradiance, W m^-2 nm^-1: see point.py and
    infinite.py.
    """
    return _radiance(scene.needs.surfaceless_emitters, scene, emitter, direction, wavelengths)


@function
def _radiance(needed, scene, emitter, direction, wavelengths):
    if needed is None:
        return spectrum_at(scene.spectra, emitter.spectrum, wavelengths) * emitter.scale
    if emitter.kind == ENVIRONMENT_EMITTER:
        return environment_radiance(scene.needs.environment_images, scene, emitter, -direction, wavelengths)
    scale = emitter.scale
    if emitter.kind == SPOT_EMITTER:
        scale = scale * spot_falloff(scene.needs.spot_emitters, emitter, direction)
    return spectrum_at(scene.spectra, emitter.spectrum, wavelengths) * scale
