"""Light and eye subpaths in pairs: the one walk that light tracing, BPT, photon mapping and VCM are subsets of.

A technique that a method does not use is `None` in `Techniques` and is not compiled (theory 1.9).
"""

from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf
from ..cameras.perspective import camera_ray, sample_film
from ..cameras.sensor import connect_to_lens, pdf_camera_direction
from ..core.atomic import fetch_and_add
from ..core.rng import random_number, random_pair, stream_of
from ..core.spectra import black
from ..core.table import Table
from ..core.vector import Spectrum, dot
from ..emitters.dispatch import choose_emitter, emitted_radiance, is_emitting_towards, pdf_emitter
from ..emitters.emission import pdf_emission_position, pdf_emitted_direction, sample_emission
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import offset_position, surface_at
from ..jit import function, kernel
from ..scene.tables import ABSORBER
from ..transport.connect import Connected, connect_to_camera, connect_to_light, connect_vertices
from ..transport.mis import Counts, Partial, after_delta, after_scatter, on_arrival, weight_of_hit
from ..transport.roulette import local_survival
from ..transport.sensing import store_sample, wavelengths_of_path
from ..transport.splats import choose_pixel, store_splat
from ..transport.subpath import Path, go_straight, is_passed_through, scatter, start_path, vertex_at
from ..transport.vertices import CHUNK, Pool, has_room, load_vertex, store_vertex
from .path_tracing import FILM, NEXT_TILE, RAYS, SHADOW_RAYS, STOP, TILE, WAVELENGTH, Pass, lens_numbers

LIGHT_SEED = 0x4C49474854  # makes the random numbers of light subpaths others than those of eye subpaths
FIRST_VERTEX = 3
# Single random numbers (core/rng.py): one for the emitter, one per vertex for roulette, one per splat for its pixel.
EMITTER_CHOICE, ROULETTE, PIXEL_CHOICE = 0, 0, 1 << 20
EMITTER, BSDF, CHOICE, SENSOR, PAIRS_PER_VERTEX = range(5)


class Techniques(NamedTuple):
    """What a method uses: `True`, or `None` for what is not compiled."""

    nee: bool | None
    connect: bool | None
    light_image: bool | None
    merge: bool | None
    merge_once: bool | None  # merge at the first vertex that is not specular, and end there (photon mapping)
    light_paths: bool | None


class Stores(NamedTuple):
    """Where subpaths leave what is needed later."""

    light: Pool | None
    eye: Pool | None
    splats: Pool | None
    paths: Table  # path_dtype, one row per pixel of the window
    resume: Table  # int64 (threads, 2): tile (or -1) and pixel in it at which records ran short


path_dtype = np.dtype(
    [("first_vertex", "i8"), ("first_splat", "i8"), ("n_vertices", "i4"), ("n_splats", "i4")], align=True
)


class Walk(NamedTuple):
    """What tracing a subpath has cost and, for eye subpaths, brought."""

    radiance: Spectrum
    rays: int
    shadow_rays: int


class Method(NamedTuple):
    """A method's techniques and how many samples of each it takes."""

    techniques: Techniques
    counts: Counts
    n_light_paths: float  # per iteration
    hits_everything: bool  # hitting an emitter is a technique like the others; else only where no other can


@kernel
def trace_pairs(scene, camera, pixel_filter, sensing, limits, work: Pass, method, stores, thread, image):
    """Take tiles until none is left or records run short; a light and an eye subpath for every pixel."""
    x0, x1, y0, y1 = work.crop
    tiles_x = (x1 - x0 + TILE - 1) // TILE
    tiles = tiles_x * ((y1 - y0 + TILE - 1) // TILE)
    while work.progress[STOP] == 0:
        tile, first = stores.resume[thread, 0], stores.resume[thread, 1]
        if tile < 0:
            tile, first = fetch_and_add(work.progress, NEXT_TILE, 1), 0
        stores.resume[thread, 0] = -1
        if tile >= tiles:
            break
        left, top = x0 + (tile % tiles_x) * TILE, y0 + (tile // tiles_x) * TILE
        for index in range(first, TILE * TILE):
            x, y = left + index % TILE, top + index // TILE
            if x < x1 and y < y1:
                if not _has_room(stores, limits, thread):
                    stores.resume[thread, 0], stores.resume[thread, 1] = tile, index
                    return
                _trace_pair(scene, camera, pixel_filter, sensing, limits, work, method, stores, thread, x, y, image)


@function
def _has_room(stores, limits, thread):
    count = limits.max_length
    light = has_room(stores.light, thread, count)
    eye = has_room(stores.eye, thread, count)
    return has_room(stores.splats, thread, count) and light and eye


@function
def _trace_pair(scene, camera, pixel_filter, sensing, limits, work, method, stores, thread, x, y, image):
    pixel = y * work.width + x
    stream = stream_of(work.seed, work.iteration, pixel, work.stratified_pairs)
    wavelengths, weights = wavelengths_of_path(sensing, stream, WAVELENGTH)
    row, column = y - work.crop[2], x - work.crop[0]
    index = row * (work.crop[1] - work.crop[0]) + column
    light_stream = stream_of(work.seed ^ LIGHT_SEED, work.iteration, pixel, work.stratified_pairs)
    light = _light_subpath(
        method.techniques.light_paths, scene, camera, pixel_filter, sensing, limits, work, method, stores, thread,
        index, light_stream, wavelengths,
    )  # fmt: skip
    u, v = random_pair(stream, FILM)
    film_x, film_y, film_weight = sample_film(pixel_filter, x, y, u, v)
    lens_u, lens_v = lens_numbers(camera.lens, stream)
    origin, direction = camera_ray(camera, film_x, film_y, lens_u, lens_v)
    n_pixels = (work.crop[1] - work.crop[0]) * (work.crop[3] - work.crop[2])
    partial = Partial(method.counts.lt / pdf_camera_direction(camera, n_pixels, direction), 0.0)
    path = start_path(origin, direction, sensing, camera.media)
    eye = _eye_subpath(
        scene, sensing, limits, method, stores, thread, index, stream, wavelengths, path, partial, film_weight
    )
    store_sample(sensing, scene.spectra, image, row, column, eye.radiance * film_weight, wavelengths, weights)
    fetch_and_add(work.progress, RAYS, light.rays + eye.rays)
    fetch_and_add(work.progress, SHADOW_RAYS, light.shadow_rays + eye.shadow_rays)


# --- light subpaths


@function
def _light_subpath(
    needed, scene, camera, pixel_filter, sensing, limits, work, method, stores, thread, index, stream, wavelengths
):  # fmt: skip
    if needed is None:
        return Walk(black(wavelengths), 0, 0)
    return _emitted_subpath(
        scene.emitters, scene, camera, pixel_filter, sensing, limits, work, method, stores, thread, index, stream,
        wavelengths,
    )  # fmt: skip


@function
def _emitted_subpath(
    emitters, scene, camera, pixel_filter, sensing, limits, work, method, stores, thread, index, stream, wavelengths
):  # fmt: skip
    """Trace a light subpath: splat every vertex to the camera and store it for connections and merges."""
    if emitters is None:
        return Walk(black(wavelengths), 0, 0)
    counts, techniques = method.counts, method.techniques
    record = stores.paths[index]
    _begin_path(techniques, stores, thread, record)
    emitter = emitters.records[choose_emitter(emitters.alias, random_number(stream, EMITTER_CHOICE))]
    u, v = random_pair(stream, 0)
    u_direction, v_direction = random_pair(stream, 1)
    start = sample_emission(scene.needs, scene.geometry, emitter, u, v, u_direction, v_direction)
    pdf_start = start.pdf_area * emitter.pdf_select * start.pdf_solid_angle
    cos_start = dot(start.normal, start.direction)
    if not pdf_start > 0.0:
        return Walk(black(wavelengths), 0, 0)
    throughput = emitted_radiance(scene.spectra, emitter, wavelengths) * (cos_start / pdf_start)
    origin = offset_position(start.position, start.normal, start.extent, start.direction)
    path = Path(origin, start.direction, throughput, 0.0, start.position, 1.0, sensing.ratio, 0, False)
    partial = Partial(counts.nee * cos_start / pdf_start, counts.hit * cos_start / pdf_start)
    length, rays, shadow_rays = 1, 0, 0
    while True:
        rays += 1
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        if hit.geometry == INVALID_ID:
            break
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        material = scene.materials[surface.material]
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        if material.kind == ABSORBER or length >= limits.max_length:
            break
        way = surface.position - path.reference
        distance_squared = dot(way, way)
        cos_in = abs(dot(path.direction, surface.normal))
        if length == 1:
            # (1.5): next-event estimation would have found the emitter with this density from here.
            density = pdf_emitter(
                scene.needs, scene.geometry, emitter, surface.position, start.position, start.normal
            )
            partial = Partial(partial.c * density / distance_squared, partial.e)
        partial = on_arrival(partial, distance_squared, cos_in)
        vertex = vertex_at(scene, surface, path)
        survival = local_survival(scene, vertex, wavelengths)
        pair = FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
        if not is_delta_bsdf(material):
            _store_light(techniques, stores, thread, record, surface, path, partial, length, index)
            shadow_rays += _splat(
                techniques.light_image, scene, camera, pixel_filter, work, method, stores, thread, record, vertex,
                partial, survival, path, wavelengths, stream, pair + SENSOR,
            )  # fmt: skip
        if length + 1 >= limits.max_length or random_number(stream, ROULETTE + length) >= survival:
            break
        _, u_lobe = random_pair(stream, pair + CHOICE)
        step = scatter(scene, vertex, path, wavelengths, stream, pair + BSDF, u_lobe, True)
        if step.path.is_absorbed:
            break
        partial = _partial_after(counts, counts.vc, partial, step, surface, survival, cos_in)
        path = _survived(step.path, survival)
        length += 1
    return Walk(black(wavelengths), rays, shadow_rays)


@function
def _partial_after(counts, count_connections, partial, step, surface, survival, cos_in):
    """C and E after a step."""
    if step.is_delta:
        return after_delta(partial, cos_in, step.eta)
    cos_out = abs(dot(step.path.direction, surface.normal))
    return after_scatter(
        counts, count_connections, partial, step.pdf_fwd * survival, step.pdf_rev * survival, cos_out
    )


@function
def _survived(path, survival):
    """The path that roulette has spared; the density of its direction holds the survival."""
    return Path(
        path.origin,
        path.direction,
        path.throughput * (1.0 / survival),
        path.pdf_solid_angle * survival,
        path.reference,
        path.radiance_scale,
        path.ratio,
        path.media,
        False,
    )


@function
def _begin_path(techniques, stores, thread, record):
    record.n_vertices = 0
    record.n_splats = 0
    _begin_vertices(stores.light, techniques.merge, thread, record)
    _begin_splats(stores.splats, thread, record)


@function
def _begin_vertices(pool, merge, thread, record):
    if pool is None:
        return
    if merge is None:  # nobody asks for the vertices of earlier pairs
        pool.ends[thread, 0] = pool.ends[thread, 1] - CHUNK
    record.first_vertex = pool.ends[thread, 0]


@function
def _begin_splats(pool, thread, record):
    if pool is None:
        return
    record.first_splat = pool.ends[thread, 0]


@function
def _store_light(techniques, stores, thread, record, surface, path, partial, length, index):
    _store_in(stores.light, thread, record, surface, path, partial, length, index)


@function
def _store_in(pool, thread, record, surface, path, partial, length, index):
    if pool is None:
        return
    store_vertex(pool, thread, surface, -path.direction, path.throughput, partial, length, index)
    record.n_vertices += 1


@function
def _splat(
    needed, scene, camera, pixel_filter, work, method, stores, thread, record, vertex, partial, survival, path,
    wavelengths, stream, pair,
):  # fmt: skip
    """Connect a light vertex to the camera; returns the number of shadow rays."""
    if needed is None:
        return 0
    u, v = random_pair(stream, pair)
    x0, x1, y0, y1 = work.crop
    lens_u, lens_v = u, v
    sensor = connect_to_lens(camera, (x1 - x0) * (y1 - y0), vertex.surface.position, lens_u, lens_v)
    if sensor.pdf_solid_angle == 0.0:
        return 0
    pixel = choose_pixel(pixel_filter, sensor.film_x, sensor.film_y, random_number(stream, PIXEL_CHOICE + pair), x0, x1, y0, y1)
    if pixel.index < 0:
        return 0
    connected = connect_to_camera(scene, method.counts, vertex, partial, survival, sensor, wavelengths)
    value = path.throughput * connected.value * (pixel.weight / method.n_light_paths)
    store_splat(stores.splats, thread, record, pixel.index, value)
    return connected.rays


# --- eye subpaths


@function
def _eye_subpath(
    scene, sensing, limits, method, stores, thread, index, stream, wavelengths, path, partial, film_weight
):  # fmt: skip
    """Radiance along an eye subpath but for merges, whose vertices are stored."""
    counts, techniques = method.counts, method.techniques
    radiance = black(wavelengths)
    length, rays, shadow_rays = 1, 0, 0
    is_specular, begins_specular = True, True
    while True:
        rays += 1
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        if hit.geometry == INVALID_ID:
            break
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        material = scene.materials[surface.material]
        way = surface.position - path.reference
        cos_in = abs(dot(path.direction, surface.normal))
        arrived = on_arrival(partial, dot(way, way), cos_in)
        is_only_way = _is_only_way(techniques, length, is_specular, begins_specular)
        emitted = _hit(scene.emitters, scene, method, surface, path, arrived, is_only_way, wavelengths)
        radiance = radiance + path.throughput * emitted
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        if material.kind == ABSORBER or length >= limits.max_length:
            break
        partial = arrived
        vertex = vertex_at(scene, surface, path)
        survival = local_survival(scene, vertex, wavelengths)
        pair = FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
        u_select, u_lobe = random_pair(stream, pair + CHOICE)
        if not is_delta_bsdf(material):
            is_specular = False
            begins_specular = begins_specular and length > 1
            u, v = random_pair(stream, pair + EMITTER)
            nee = _next_event(
                techniques.nee, scene, counts, vertex, partial, survival, wavelengths, u, v, u_select
            )
            vc = _connect_all(
                techniques.connect, scene, sensing, limits, counts, stores, index, vertex, partial, survival, length,
                wavelengths,
            )  # fmt: skip
            radiance = radiance + path.throughput * (nee.value + vc.value)
            shadow_rays += nee.rays + vc.rays
            _store_eye(techniques.merge, stores.eye, thread, surface, path, partial, length, index, film_weight)
            if _ends_here(techniques.merge_once):
                break
        if _is_done(techniques, begins_specular) or random_number(stream, ROULETTE + length) >= survival:
            break
        step = scatter(scene, vertex, path, wavelengths, stream, pair + BSDF, u_lobe, None)
        if step.path.is_absorbed:
            break
        partial = _partial_after(counts, counts.vc, partial, step, surface, survival, cos_in)
        path = _survived(step.path, survival)
        length += 1
    return Walk(radiance, rays, shadow_rays)


@function
def _ends_here(merge_once):
    return merge_once is not None


@function
def _is_done(techniques, begins_specular):
    """Whether nothing can be found further along an eye subpath: light tracing alone, once a vertex is connectable."""
    return _finds_nothing(techniques.nee, techniques.connect, techniques.merge) and not begins_specular


@function
def _finds_nothing(nee, connect, merge):
    if nee is None:
        if connect is None:  # noqa: SIM102 - numba prunes tests for None one by one
            if merge is None:
                return True
    return False


@function
def _is_only_way(techniques, length, is_specular, begins_specular):
    """Whether no other technique of a method without hits can find a path that ends on an emitter here."""
    if techniques.merge is not None:
        return is_specular
    return length == 1 or begins_specular


@function
def _hit(emitters, scene, method, surface, path, partial, is_only_way, wavelengths):
    """Radiance of an emitter that was hit, with its weight (1.17)."""
    if emitters is None:
        return black(wavelengths)
    if surface.emitter < 0:
        return black(wavelengths)
    emitter = emitters.records[surface.emitter]
    if not is_emitting_towards(emitter, surface.normal, -path.direction):
        return black(wavelengths)
    radiance = emitted_radiance(scene.spectra, emitter, wavelengths)
    if not method.hits_everything:
        return radiance * (1.0 if is_only_way else 0.0)
    nee_ratio = 0.0
    if path.pdf_solid_angle > 0.0:
        density = pdf_emitter(
            scene.needs, scene.geometry, emitter, path.reference, surface.position, surface.normal
        )
        nee_ratio = density / path.pdf_solid_angle
    emission = pdf_emission_position(scene.needs, scene.geometry, emitter, surface.position)
    emission *= pdf_emitted_direction(emitter, dot(path.direction, surface.normal))
    return radiance * weight_of_hit(method.counts, nee_ratio, emission, partial)


@function
def _next_event(needed, scene, counts, vertex, partial, survival, wavelengths, u, v, u_select):
    nothing = connect_nothing(wavelengths)
    if needed is None:
        return nothing
    return connect_to_light(scene, counts, vertex, partial, survival, wavelengths, u, v, u_select)


@function
def _connect_all(
    needed, scene, sensing, limits, counts, stores, index, vertex, partial, survival, length, wavelengths
):  # fmt: skip
    """Connections of an eye vertex to all vertices of the pair's light subpath."""
    total, rays = black(wavelengths), 0
    if needed is None:
        return connect_nothing(wavelengths)
    record = stores.paths[index]
    for i in range(record.n_vertices):
        stored = load_vertex(
            scene.needs.smooth_triangles, stores.light.records[record.first_vertex + i], sensing.zero
        )
        if stored.length + length + 1 > limits.max_length:
            break
        light_survival = local_survival(scene, stored.vertex, wavelengths)
        joined = connect_vertices(scene, counts, vertex, partial, survival, stored, light_survival, wavelengths)
        total = total + joined.value
        rays += joined.rays
    return Connected(total, rays)


@function
def _store_eye(needed, pool, thread, surface, path, partial, length, index, film_weight):
    if needed is None:
        return
    throughput = path.throughput * film_weight
    store_vertex(pool, thread, surface, -path.direction, throughput, partial, length, index)


@function
def connect_nothing(wavelengths):
    """A connection that brings nothing."""
    return Connected(black(wavelengths), 0)

