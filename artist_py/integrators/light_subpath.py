"""Light subpaths: emitted, splatted to the camera at every vertex, stored for connections and merges."""

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf
from ..bsdf.fluorescence import scattered_light
from ..cameras.sensor import connect_to_lens
from ..core.rng import random_number, random_pair
from ..core.sets import at_film, chosen
from ..core.spectra import black
from ..core.vector import dot
from ..emitters.dispatch import choose_emitter, emitted_radiance
from ..emitters.emission import hit_over_emission, next_event_over_emission, sample_emission
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import offset_position, surface_at
from ..jit import function
from ..scene.tables import ABSORBER
from ..transport.connect import connect_to_camera
from ..transport.local_counts import counts_at
from ..transport.mis import Partial, on_arrival, partial_after
from ..transport.recording import LT
from ..transport.roulette import brings_nothing, is_spent, local_survival, survived
from ..transport.shares import is_chosen, is_vertex_wanted
from ..transport.shifting import (
    as_power,
    keep_wavelength,
    shifted_onwards,
    unless_mirrored,
    wavelengths_of_light,
)
from ..transport.splats import choose_pixel, store_splat
from ..transport.subpath import Path, go_straight, is_passed_through, scatter, vertex_at
from ..transport.vertices import store_vertex
from .lens_hits import longest_light_subpath, splat_lens_hit, without_hits
from .pair import (
    BSDF,
    CHOICE,
    EMITTER_CHOICE,
    FIRST_VERTEX,
    PAIRS_PER_VERTEX,
    PIXEL_CHOICE,
    ROULETTE,
    SENSOR,
    Walk,
)


@function
def trace_light_subpath(setup, thread, index, pixel, stream, wavelengths):
    """Light subpath `index`, of pixel `pixel`, where the method has some and the scene emitters; a `Walk`."""
    return _trace(
        setup.method.techniques.light_paths,
        setup.scene.emitters,
        setup,
        thread,
        index,
        pixel,
        stream,
        wavelengths,
    )


@function
def _trace(needed, emitters, setup, thread, index, pixel, stream, wavelengths):
    if needed is None:
        return Walk(black(wavelengths), 0, 0)
    if emitters is None:
        return Walk(black(wavelengths), 0, 0)
    begin_path(setup.stores, thread, index, pixel)
    emitter = emitters.records[choose_emitter(emitters.alias, random_number(stream, EMITTER_CHOICE))]
    u, v = random_pair(stream, 0)
    u_direction, v_direction = random_pair(stream, 1)
    start = sample_emission(setup.scene, emitter, u, v, u_direction, v_direction)
    if not start.density > 0.0:
        return Walk(black(wavelengths), 0, 0)
    wavelengths, weights = wavelengths_of_light(setup.scene.reemission, wavelengths, stream)
    radiance = emitted_radiance(setup.scene, emitter, start.direction, wavelengths)
    throughput = as_power(weights, radiance * (start.cos_theta / start.density))
    if brings_nothing(setup.limits.ends_black, throughput):
        return Walk(black(wavelengths), 0, 0)
    origin = offset_position(start.position, start.normal, start.extent, start.direction)
    path = Path(
        origin, start.direction, throughput, 0.0, start.position, 1.0, setup.sensing.ratio, emitter.media, False
    )  # fmt: skip
    return _walk(setup, thread, index, stream, wavelengths, emitter, start, path)


@function
def _walk(  # noqa: C901 - one loop, a line or two per step of the walk
    setup, thread, index, stream, wavelengths, emitter, start, path
):
    scene, limits, counts = setup.scene, setup.limits, setup.method.counts
    partial = Partial(counts.nee, counts.hit * hit_over_emission(start))
    longest = longest_light_subpath(counts.lens, limits)
    length, rays, shadow_rays = 1, 0, 0
    while True:
        rays += 1
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        if is_chosen(setup.method.chosen.light_image, index):
            splat_lens_hit(setup, thread, index, emitter, path, partial, hit.t, wavelengths, stream, length)
        if hit.geometry == INVALID_ID:
            break
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        material = scene.materials[surface.material]
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        if material.kind == ABSORBER or length >= limits.max_length:
            break
        cos_in = abs(dot(path.direction, surface.normal))
        partial = _arrived(scene, emitter, start, path, surface, partial, length, cos_in)
        vertex = vertex_at(scene, surface, path, wavelengths)
        if not vertex.is_sampled_back:  # no eye walk could go back there
            break
        here = counts_at(scene, setup.method, counts, surface)
        arrived = wavelengths
        vertex, wavelengths = shifted_onwards(
            scene.reemission, scene.needs, material, vertex, wavelengths, stream, length
        )
        survival = local_survival(scene, vertex, wavelengths)
        pair = FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
        if not is_delta_bsdf(material):
            _store(setup, thread, index, surface, path, partial, length, arrived)
            shadow_rays += splat(
                setup, here, thread, index, vertex, partial, survival, path, wavelengths, stream, length
            )
        if length >= longest or random_number(stream, ROULETTE + length) >= survival:
            break
        _, u_lobe = random_pair(stream, pair + CHOICE)
        step = scatter(scene, vertex, path, wavelengths, stream, pair + BSDF, u_lobe, True)
        if is_spent(limits.ends_black, step.path):
            break
        partial = partial_after(here, partial, step, surface, survival, cos_in)
        wavelengths, path = (
            unless_mirrored(scene.reemission, scene.needs, wavelengths, arrived, step.is_delta),
            survived(step.path, survival),
        )
        length += 1
    return Walk(black(wavelengths), rays, shadow_rays)


@function
def _arrived(scene, emitter, start, path, surface, partial, length, cos_in):
    """C and E on arrival; on the first edge C is what next-event estimation from here would do (1.5)."""
    way = surface.position - path.reference
    distance_squared = dot(way, way)
    if length > 1:
        return on_arrival(partial, distance_squared, cos_in)
    # For emitters at infinity the ratio has no square of the distance (theory 1.5), for others it holds it.
    ratio = next_event_over_emission(scene, emitter, start, surface.position)
    return on_arrival(Partial(partial.c * ratio, partial.e), 1.0, cos_in)


@function
def begin_path(stores, thread, index, pixel):
    """Note where the records of light subpath `index` begin."""
    record = stores.paths[index]
    record.n_vertices = 0
    record.n_splats = 0
    record.pixel = pixel
    record.first_vertex = _next_record(stores.light, thread)
    record.first_splat = _next_record(stores.splats, thread)


@function
def _next_record(pool, thread):
    if pool is None:
        return 0
    return pool.ends[thread, 0]


@function
def _store(setup, thread, index, surface, path, partial, length, wavelengths):
    if is_vertex_wanted(setup.method.chosen, index):
        _store_in(setup.stores.light, setup, thread, index, surface, path, partial, length, wavelengths)


@function
def _store_in(pool, setup, thread, index, surface, path, partial, length, wavelengths):
    if pool is None:
        return
    store_vertex(pool, thread, surface, -path.direction, path.throughput, partial, length, index)
    keep_wavelength(setup.scene.reemission, pool, thread, wavelengths)
    setup.stores.paths[index].n_vertices += 1


@function
def splat(setup, counts, thread, index, vertex, partial, survival, path, wavelengths, stream, length):
    """Connect a light vertex to the camera, where the method has a light image; returns the number of shadow rays.

    `counts` are those for weights here.
    """
    return _splat(
        setup.method.techniques.light_image, setup, counts, thread, index, vertex, partial, survival, path, wavelengths,
        stream, length,
    )  # fmt: skip


@function
def _splat(
    needed, setup, counts, thread, index, vertex, partial, survival, path, wavelengths, stream, length
):
    if needed is None:
        return 0
    if not is_chosen(setup.method.chosen.light_image, index):
        return 0
    stores, pair = setup.stores, FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
    u, v = random_pair(stream, pair + SENSOR)
    sensor = connect_to_lens(setup.camera, setup.method.n_pixels, vertex.surface.position, u, v)
    if sensor.pdf_solid_angle == 0.0:
        return 0
    number = random_number(stream, PIXEL_CHOICE + pair)
    pixel = choose_pixel(setup.pixel_filter, sensor.film_x, sensor.film_y, number, setup.work.crop)
    if pixel.index < 0:
        return 0
    partial = without_hits(setup.method, partial)
    connected = connect_to_camera(setup.scene, counts, vertex, partial, survival, sensor, wavelengths)
    material, fluorescence = setup.scene.materials[vertex.surface.material], setup.scene.fluorescence
    value = scattered_light(fluorescence, material, path.throughput, connected.f_cos, connected.glow)
    value = chosen(fluorescence, path.throughput * connected.f_cos, at_film(setup.sensing.start, value))
    value = value * (pixel.weight / setup.method.n_image_paths)
    store_splat(
        stores.techniques, stores.splats, thread, stores.paths[index], pixel.index, value, LT, length + 1,
        connected.weight,
    )  # fmt: skip
    return connected.rays
