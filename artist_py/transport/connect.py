"""Connections: eye vertex to emitter, eye vertex to light vertex, light vertex to lens; with their weights."""

import math
from typing import NamedTuple

from ..bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from ..bsdf.fluorescence import joined_light, reradiation_factor, scattered_light
from ..core.frame import to_local
from ..core.sets import chosen
from ..core.spectra import black
from ..core.vector import Spectrum, dot
from ..emitters.dispatch import (
    can_be_hit,
    choose_emitter,
    emitted_radiance,
    is_emitting_towards,
    sample_emitter,
)
from ..emitters.emission import emission_over_next_event
from ..geometry.surface import largest
from ..jit import function
from .mis import (
    bracket,
    weight_of_connection,
    weight_of_light_image,
    weight_of_next_event,
)
from .subpath import adjoint_factor, is_on_side, on_geometric_side
from .visibility import is_blocked


class Scattering(NamedTuple):
    """A BSDF evaluated for one more direction; densities hold the survival probability."""

    f_cos: Spectrum  # f |cos| with the shading normal
    glow: float  # the same of f_fl, for what is reradiated at other wavelengths (theory 3.1)
    pdf_fwd: float  # of sampling the direction, sr^-1
    pdf_rev: float  # of sampling back along the subpath when coming from the direction, sr^-1
    cos_theta: float  # |cos| with the geometric normal
    is_black: bool


@function
def scattering_towards(scene, vertex, wi_world, wavelengths, survival, light_walk):
    """What the BSDF at `vertex` does for light between its subpath and the unit direction `wi_world`."""
    material = scene.materials[vertex.surface.material]
    smooth = scene.needs.smooth_triangles
    wi = to_local(vertex.frame, wi_world)
    agrees = is_on_side(smooth, vertex.surface, wi_world, wi)
    wi = on_geometric_side(smooth, vertex.surface, wi_world, wi)
    pdf = pdf_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    pdf_rev = pdf_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, wi, vertex.wo)
    f = evaluate_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    adjoint = adjoint_factor(light_walk, smooth, vertex, wi_world, wi)
    return Scattering(
        f * (abs(wi.z) * adjoint),
        reradiation_factor(scene.fluorescence, scene.needs, material, vertex.wo, wi) * abs(wi.z) * adjoint,
        pdf * survival if agrees else 0.0,
        pdf_rev * survival if vertex.is_sampled_back else 0.0,
        abs(dot(wi_world, vertex.surface.normal)),
        pdf == 0.0 or not (agrees or _may_leave(light_walk)),
    )


@function
def _may_leave(light_walk):
    """Whether light goes into directions on whose side the normals disagree: from a light walk's vertex it does."""
    return light_walk is not None


class Connected(NamedTuple):
    """What a connection brings, weighted, the shadow rays it took, and the weight: 0 if it brings nothing."""

    value: Spectrum
    rays: int
    weight: float


@function
def no_connection(wavelengths):
    """A connection that brings nothing and took no ray."""
    return Connected(black(wavelengths), 0, 0.0)


@function
def connect_to_light(scene, counts, vertex, partial, survival, wavelengths, u, v, u_select):
    """Next-event estimation at an eye vertex with its weight (1.15); radiance per throughput."""
    return _to_light(scene.emitters, scene, counts, vertex, partial, survival, wavelengths, u, v, u_select)


@function
def _to_light(emitters, scene, counts, vertex, partial, survival, wavelengths, u, v, u_select):
    nothing = no_connection(wavelengths)
    if emitters is None:
        return nothing
    emitter = emitters.records[choose_emitter(emitters.alias, u_select)]
    position = vertex.surface.position
    point = sample_emitter(scene, emitter, position, u, v)
    towards = point.position - position
    if point.pdf_solid_angle == 0.0 or not is_emitting_towards(emitter, point.normal, -towards):
        return nothing
    wi = towards * (1.0 / math.sqrt(dot(towards, towards)))
    there = scattering_towards(scene, vertex, wi, wavelengths, survival, None)
    if there.is_black:
        return nothing
    if is_blocked(scene, vertex.surface, wi, point.position, point.normal, point.extent):
        return Connected(black(wavelengths), 1, 0.0)
    pdf_light = point.pdf_solid_angle * emitter.pdf_select
    emission = emission_over_next_event(scene, emitter, point, towards, pdf_light)
    weight = weight_of_next_event(
        counts,
        can_be_hit(scene.needs.surfaceless_emitters, emitter) * there.pdf_fwd / pdf_light,
        emission * there.cos_theta,
        bracket(counts, partial, there.pdf_rev),
    )
    radiance = emitted_radiance(scene, emitter, -wi, wavelengths)
    material = scene.materials[vertex.surface.material]
    scattered = scattered_light(scene.fluorescence, material, radiance, there.f_cos, there.glow)
    radiance = chosen(scene.fluorescence, radiance * there.f_cos, scattered) * (weight / pdf_light)
    return Connected(radiance, 1, weight)


@function
def connect_vertices(
    scene, counts, eye, eye_partial, eye_survival, light, light_survival, wavelengths, light_counts
):
    """An eye vertex joined with a stored light vertex, with its weight (1.13); radiance per eye throughput.

    `counts` are those for weights at the eye vertex, `light_counts` at the light vertex.
    """
    nothing = no_connection(wavelengths)
    towards = light.vertex.surface.position - eye.surface.position
    distance_squared = dot(towards, towards)
    if distance_squared == 0.0:
        return nothing
    wi = towards * (1.0 / math.sqrt(distance_squared))
    here = scattering_towards(scene, eye, wi, wavelengths, eye_survival, None)
    if here.is_black:
        return nothing
    there = scattering_towards(scene, light.vertex, -wi, wavelengths, light_survival, True)
    if there.is_black:
        return nothing
    far = light.vertex.surface
    if is_blocked(scene, eye.surface, wi, far.position, far.normal, far.extent):
        return Connected(black(wavelengths), 1, 0.0)
    weight = weight_of_connection(
        counts,
        here.pdf_fwd * there.cos_theta / distance_squared,
        bracket(light_counts, light.partial, there.pdf_rev),
        there.pdf_fwd * here.cos_theta / distance_squared,
        bracket(counts, eye_partial, here.pdf_rev),
    )
    materials = scene.materials
    light_material, eye_material = materials[light.vertex.surface.material], materials[eye.surface.material]
    joined = joined_light(scene.fluorescence, light.throughput, light_material, there, eye_material, here)
    value = chosen(scene.fluorescence, light.throughput * here.f_cos * there.f_cos, joined)
    return Connected(value * (weight / (counts.vc * distance_squared)), 1, weight)


class Seen(NamedTuple):
    """What the lens sees of a light vertex per light throughput, weighted: as `Scattering`, and as `Connected`."""

    f_cos: Spectrum
    glow: float
    rays: int
    weight: float


@function
def connect_to_camera(scene, counts, vertex, partial, survival, sensor, wavelengths):
    """A light vertex joined with the lens, with its weight (1.16); pixel value per light throughput and light path."""
    distance_squared = dot(sensor.towards, sensor.towards)
    wi = sensor.towards * (1.0 / math.sqrt(distance_squared))
    there = scattering_towards(scene, vertex, wi, wavelengths, survival, True)
    if there.is_black:
        return Seen(black(wavelengths), 0.0, 0, 0.0)
    # The eye may lie on a surface.
    if is_blocked(scene, vertex.surface, wi, sensor.position, -wi, largest(sensor.position)):
        return Seen(black(wavelengths), 0.0, 1, 0.0)
    camera_density = sensor.pdf_solid_angle * there.cos_theta / distance_squared
    lens_ratio = there.pdf_fwd * sensor.lens_area / distance_squared
    light_bracket = bracket(counts, partial, there.pdf_rev)
    weight = weight_of_light_image(counts, camera_density, light_bracket, lens_ratio)
    scale = weight * sensor.importance / distance_squared
    return Seen(there.f_cos * scale, there.glow * scale, 1, weight)
