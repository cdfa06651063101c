"""Next-event estimation: connecting a surface point to an emitter."""

import math
from typing import NamedTuple

from ..bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from ..core.frame import to_local
from ..core.rng import random_pair
from ..core.spectra import black
from ..core.vector import Spectrum, dot
from ..emitters.dispatch import (
    can_be_hit,
    choose_emitter,
    emitted_radiance,
    is_emitting_towards,
    is_hidden,
    pdf_emitter,
    sample_emitter,
)
from ..emitters.infinite import is_in_background
from ..geometry.embree import is_occluded
from ..geometry.surface import leave_surface, offset_position
from ..jit import function
from .mis import balance
from .subpath import is_on_side


class Connection(NamedTuple):
    """What a connection brings, and how many shadow rays it took."""

    radiance: Spectrum
    rays: int


@function
def connect_to_emitter(scene, vertex, wavelengths, stream, pair, u_select):
    """Radiance that an emitter sends over `vertex` to `vertex.wo`, by sampling the emitter, with its MIS weight.

    A `Connection` in W m^-2 sr^-1 nm^-1 per wavelength; `pair` is the pair of random dimensions used.
    """
    return _connect(scene.emitters, scene, vertex, wavelengths, stream, pair, u_select)


@function
def _connect(emitters, scene, vertex, wavelengths, stream, pair, u_select):
    if emitters is None:
        return Connection(black(wavelengths), 0)
    material = scene.materials[vertex.surface.material]
    emitter = emitters.records[choose_emitter(emitters.alias, u_select)]
    u, v = random_pair(stream, pair)
    point = sample_emitter(scene, emitter, vertex.surface.position, u, v)
    towards = point.position - vertex.surface.position
    if point.pdf_solid_angle == 0.0 or not is_emitting_towards(emitter, point.normal, -towards):
        return Connection(black(wavelengths), 0)
    wi_world = towards * (1.0 / math.sqrt(dot(towards, towards)))
    wi = to_local(vertex.frame, wi_world)
    pdf_scatter = pdf_bsdf(
        scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi
    )
    if pdf_scatter == 0.0 or not is_on_side(scene.needs.smooth_triangles, vertex.surface, wi_world, wi):
        return Connection(black(wavelengths), 0)
    start = leave_surface(vertex.surface, wi_world)
    end = offset_position(point.position, point.normal, point.extent, -wi_world)
    if is_occluded(scene.geometry.embree, start, end - start, 1.0):
        return Connection(black(wavelengths), 1)
    f = evaluate_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    pdf_light = point.pdf_solid_angle * emitter.pdf_select
    # The balance heuristic over the density: w / p = 1 / (p + p').
    pdf_hit = pdf_scatter * can_be_hit(scene.needs.surfaceless_emitters, emitter)
    weight = abs(wi.z) / (pdf_light + pdf_hit)
    return Connection(emitted_radiance(scene, emitter, -wi_world, wavelengths) * f * weight, 1)


@function
def radiance_of_hit(scene, surface, path, length, wavelengths):
    """Radiance that the surface hit by `path` emits against it, with the MIS weight of having been hit.

    The weight is 1 where no emitter could have been sampled: behind the camera and delta lobes.
    """
    return _of_hit(scene.emitters, scene, surface, path, length, wavelengths)


@function
def _of_hit(emitters, scene, surface, path, length, wavelengths):
    if emitters is None:
        return black(wavelengths)
    if surface.emitter < 0:
        return black(wavelengths)
    emitter = emitters.records[surface.emitter]
    if not is_emitting_towards(emitter, surface.normal, -path.direction):
        return black(wavelengths)
    if is_hidden(scene.needs.hidden_emitters, emitter, length):
        return black(wavelengths)
    radiance = emitted_radiance(scene, emitter, -path.direction, wavelengths)
    if path.pdf_solid_angle == 0.0:
        return radiance
    pdf_light = pdf_emitter(scene, emitter, path.reference, surface.position, surface.normal)
    return radiance * balance(path.pdf_solid_angle, pdf_light)


@function
def radiance_of_background(scene, path, length, wavelengths):
    """Radiance that `path`, which leaves the scene, finds at infinity, with the MIS weight of having found it."""
    return _of_background(scene.emitters, scene, path, length, wavelengths)


@function
def _of_background(emitters, scene, path, length, wavelengths):
    if emitters is None:
        return black(wavelengths)
    return _sum_of_background(emitters.background, emitters.records, scene, path, length, wavelengths)


@function
def _sum_of_background(first, records, scene, path, length, wavelengths):
    total = black(wavelengths)
    if first is None:
        return total
    for i in range(first, records.shape[0]):
        emitter = records[i]
        if is_in_background(emitter, path.direction) and not is_hidden(
            scene.needs.hidden_emitters, emitter, length
        ):
            weight = 1.0
            if path.pdf_solid_angle > 0.0:
                pdf_light = pdf_emitter(scene, emitter, path.reference, path.reference, -path.direction)
                weight = balance(path.pdf_solid_angle, pdf_light)
            total = total + emitted_radiance(scene, emitter, -path.direction, wavelengths) * weight
    return total
