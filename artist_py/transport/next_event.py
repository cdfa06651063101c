"""Next-event estimation: connecting a surface point to an emitter."""

import math
from typing import NamedTuple

from ..bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from ..bsdf.fluorescence import reradiation_factor, scattered_light
from ..core.frame import to_local
from ..core.rng import random_pair
from ..core.sets import chosen, received
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
from ..jit import function
from .mis import balance
from .recording import HIT, record
from .subpath import is_on_side
from .visibility import is_blocked


class Connection(NamedTuple):
    """What a connection or a hit brings, how many shadow rays it took, and the MIS weight it holds."""

    radiance: Spectrum
    rays: int
    weight: float


@function
def connect_to_emitter(scene, vertex, wavelengths, stream, pair, u_select):
    """Radiance that an emitter sends over `vertex` to `vertex.wo`, by sampling the emitter, with its MIS weight.

    A `Connection` in W m^-2 sr^-1 nm^-1 per wavelength; `pair` is the pair of random dimensions used.
    """
    return _connect(scene.emitters, scene, vertex, wavelengths, stream, pair, u_select)


@function
def _connect(emitters, scene, vertex, wavelengths, stream, pair, u_select):
    if emitters is None:
        return Connection(black(wavelengths), 0, 0.0)
    material = scene.materials[vertex.surface.material]
    emitter = emitters.records[choose_emitter(emitters.alias, u_select)]
    u, v = random_pair(stream, pair)
    point = sample_emitter(scene, emitter, vertex.surface.position, u, v)
    towards = point.position - vertex.surface.position
    if point.pdf_solid_angle == 0.0 or not is_emitting_towards(emitter, point.normal, -towards):
        return Connection(black(wavelengths), 0, 0.0)
    wi_world = towards * (1.0 / math.sqrt(dot(towards, towards)))
    wi = to_local(vertex.frame, wi_world)
    pdf_scatter = pdf_bsdf(
        scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi
    )
    if pdf_scatter == 0.0 or not is_on_side(scene.needs.smooth_triangles, vertex.surface, wi_world, wi):
        return Connection(black(wavelengths), 0, 0.0)
    if is_blocked(scene, vertex.surface, wi_world, point.position, point.normal, point.extent):
        return Connection(black(wavelengths), 1, 0.0)
    f = evaluate_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    pdf_light = point.pdf_solid_angle * emitter.pdf_select
    # The balance heuristic over the density: w / p = 1 / (p + p').
    pdf_hit = pdf_scatter * can_be_hit(scene.needs.surfaceless_emitters, emitter)
    weight = abs(wi.z) / (pdf_light + pdf_hit)
    radiance = emitted_radiance(scene, emitter, -wi_world, wavelengths)
    glow = reradiation_factor(scene.fluorescence, scene.needs, material, vertex.wo, wi)
    scattered = scattered_light(scene.fluorescence, material, radiance, f, glow)
    radiance = chosen(scene.fluorescence, radiance * f, scattered) * weight
    return Connection(radiance, 1, balance(pdf_light, pdf_hit))


@function
def radiance_of_hit(scene, surface, path, length, wavelengths):
    """Radiance that the surface hit by `path` emits against it, with the MIS weight of having been hit: a `Connection`.

    The weight is 1 where no emitter could have been sampled: behind the camera and delta lobes.
    """
    return _of_hit(scene.emitters, scene, surface, path, length, wavelengths)


@function
def _of_hit(emitters, scene, surface, path, length, wavelengths):
    if emitters is None:
        return Connection(black(wavelengths), 0, 0.0)
    if surface.emitter < 0:
        return Connection(black(wavelengths), 0, 0.0)
    emitter = emitters.records[surface.emitter]
    if not is_emitting_towards(emitter, surface.normal, -path.direction):
        return Connection(black(wavelengths), 0, 0.0)
    if is_hidden(scene.needs.hidden_emitters, emitter, length):
        return Connection(black(wavelengths), 0, 0.0)
    radiance = emitted_radiance(scene, emitter, -path.direction, wavelengths)
    if path.pdf_solid_angle == 0.0:
        return Connection(radiance, 0, 1.0)
    pdf_light = pdf_emitter(scene, emitter, path.reference, surface.position, surface.normal)
    weight = balance(path.pdf_solid_angle, pdf_light)
    return Connection(radiance * weight, 0, weight)


@function
def radiance_of_background(scene, path, length, place, wavelengths, tables):
    """Radiance that `path`, which leaves the scene, finds at infinity, with the MIS weight of having found it.

    That of each emitter is noted in the `TechniqueTables`, if there are any.
    """
    return _of_background(scene.emitters, scene, path, length, place, wavelengths, tables)


@function
def _of_background(emitters, scene, path, length, place, wavelengths, tables):
    if emitters is None:
        return black(wavelengths)
    return _sum_of_background(
        emitters.background, emitters.records, scene, path, length, place, wavelengths, tables
    )


@function
def _sum_of_background(first, records, scene, path, length, place, wavelengths, tables):
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
            radiance = emitted_radiance(scene, emitter, -path.direction, wavelengths) * weight
            total = total + radiance
            contribution = received(scene.fluorescence, path.throughput, radiance)
            record(tables, scene.spectra, place, HIT, length, length, contribution, weight)
    return total
