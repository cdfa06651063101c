"""Path tracing with next-event estimation: emitter and BSDF sampling joined by multiple importance sampling."""

from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf
from ..cameras.perspective import camera_ray, sample_film
from ..core.atomic import fetch_and_add
from ..core.rng import random_pair, stream_of
from ..core.sets import received
from ..core.spectra import black
from ..core.table import Table
from ..core.vector import Spectrum
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import surface_at
from ..jit import function, kernel
from ..scene.tables import ABSORBER, Camera, Filter, Scene
from ..transport.next_event import connect_to_emitter, radiance_of_background, radiance_of_hit
from ..transport.recording import HIT, NEE, Place, TechniqueTables, record
from ..transport.roulette import Limits, after_roulette, is_ended_by_roulette, is_spent
from ..transport.sensing import Sensing, store_sample, wavelengths_of_path
from ..transport.shifting import shifted_back, unless_mirrored
from ..transport.subpath import go_straight, is_passed_through, scatter, start_path, vertex_at

TILE = 32

# Pairs of random dimensions: the film, the lens and the wavelengths first, then a block for every vertex.
FILM, LENS, WAVELENGTH, FIRST_VERTEX = range(4)
EMITTER, BSDF, CHOICE, PAIRS_PER_VERTEX = range(4)


NEXT_TILE, STOP, RAYS, SHADOW_RAYS = range(4)  # in Pass.progress


class Traced(NamedTuple):
    """What a path brings, and the rays it took."""

    radiance: Spectrum
    rays: int
    shadow_rays: int


class Pass(NamedTuple):
    """One iteration over the image, shared by all threads."""

    seed: int
    iteration: int
    stratified_pairs: int  # pairs of dimensions drawn from Sobol points
    crop: tuple  # (x0, x1, y0, y1) pixels, half open
    width: int  # of the full image: pixels keep their random numbers in every crop
    progress: Table  # int64: next tile, stop flag, closest-hit rays, shadow rays


@kernel
def trace_paths(
    scene: Scene,
    camera: Camera,
    pixel_filter: Filter,
    sensing: Sensing,
    limits: Limits,
    work: Pass,
    image: Table,
    techniques: TechniqueTables | None,
):
    """Take tiles until none is left, trace one path per pixel, store linear RGB in `image` (h, w, 3) float32."""
    x0, x1, y0, y1 = work.crop
    tiles_x = (x1 - x0 + TILE - 1) // TILE
    tiles = tiles_x * ((y1 - y0 + TILE - 1) // TILE)
    while work.progress[STOP] == 0:
        tile = fetch_and_add(work.progress, NEXT_TILE, 1)
        if tile >= tiles:
            break
        rays, shadow_rays = 0, 0
        left, top = x0 + (tile % tiles_x) * TILE, y0 + (tile // tiles_x) * TILE
        for y in range(top, min(top + TILE, y1)):
            for x in range(left, min(left + TILE, x1)):
                traced = trace_pixel(
                    scene, camera, pixel_filter, sensing, limits, work, x, y, image, techniques
                )
                rays, shadow_rays = rays + traced.rays, shadow_rays + traced.shadow_rays
        fetch_and_add(work.progress, RAYS, rays)
        fetch_and_add(work.progress, SHADOW_RAYS, shadow_rays)


@function
def trace_pixel(scene, camera, pixel_filter, sensing, limits, work, x, y, image, techniques):
    """Trace one path through pixel (x, y), store what it brings, and return it."""
    stream = stream_of(work.seed, work.iteration, y * work.width + x, work.stratified_pairs)
    u, v = random_pair(stream, FILM)
    film_x, film_y, film_weight = sample_film(pixel_filter, x, y, u, v)
    lens_u, lens_v = lens_numbers(camera.lens, stream)
    _, origin, direction = camera_ray(camera, film_x, film_y, lens_u, lens_v)
    wavelengths, weights = wavelengths_of_path(sensing, stream, WAVELENGTH)
    row, column = y - work.crop[2], x - work.crop[0]
    place = Place(row, column, wavelengths, weights * film_weight)
    traced = path_radiance(scene, limits, sensing, stream, origin, direction, camera.media, place, techniques)
    store_sample(
        sensing, scene.spectra, image, row, column, traced.radiance * film_weight, wavelengths, weights
    )
    return traced


@function
def lens_numbers(lens, stream):
    """Two random numbers for the lens; none are drawn for a pinhole."""
    if lens is None:
        return 0.0, 0.0
    return random_pair(stream, LENS)


@function
def choice_numbers(scene, stream, pair):
    """Numbers for the choice of an emitter and of a lobe; none are drawn where there is nothing to choose."""
    return _choice_numbers(scene.emitters, scene.needs, stream, pair)


@function
def _choice_numbers(emitters, needs, stream, pair):
    if emitters is None:
        return _numbers_if(None, needs.lobes, stream, pair)
    return _numbers_if(emitters.alias, needs.lobes, stream, pair)


@function
def _numbers_if(alias, lobes, stream, pair):
    # Nested, because numba prunes a test for None but not a conjunction.
    if alias is None:  # noqa: SIM102
        if lobes is None:
            return 0.0, 0.0
    return random_pair(stream, pair)


@function
def path_radiance(scene, limits, sensing, stream, origin, direction, media, place, techniques):
    """`Traced` radiance along the ray, W m^-2 sr^-1 nm^-1 per wavelength, of up to `limits.max_length` edges."""
    wavelengths = place.wavelengths
    radiance = black(place.weights)
    path = start_path(origin, direction, sensing, media)
    length, rays, shadow_rays = 1, 0, 0
    while True:
        rays += 1
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        if hit.geometry == INVALID_ID:
            background = radiance_of_background(scene, path, length, place, wavelengths, techniques)
            radiance = radiance + received(scene.fluorescence, path.throughput, background)
            break
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        emitted = radiance_of_hit(scene, surface, path, length, wavelengths)
        radiance = radiance + received(scene.fluorescence, path.throughput, emitted.radiance)
        _record(techniques, scene, place, HIT, length, length, path, emitted)
        material = scene.materials[surface.material]
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        if length >= limits.max_length or material.kind == ABSORBER:
            break
        pair = FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
        vertex = vertex_at(scene, surface, path, wavelengths)
        arrived = wavelengths
        vertex, wavelengths = shifted_back(
            scene.excitation, scene.needs, material, vertex, wavelengths, stream, length
        )
        u_select, u_lobe = choice_numbers(scene, stream, pair + CHOICE)
        if not is_delta_bsdf(material):
            direct = connect_to_emitter(scene, vertex, wavelengths, stream, pair + EMITTER, u_select)
            radiance = radiance + received(scene.fluorescence, path.throughput, direct.radiance)
            _record(techniques, scene, place, NEE, length + 1, length, path, direct)
            shadow_rays += direct.rays
        step = scatter(scene, vertex, path, wavelengths, stream, pair + BSDF, u_lobe, None)
        wavelengths, path = (
            unless_mirrored(scene.excitation, scene.needs, wavelengths, arrived, step.is_delta),
            step.path,
        )
        length += 1
        if is_spent(limits.ends_black, path):
            break
        if is_ended_by_roulette(scene.fluorescence, limits, stream, length, path):
            break
        path = after_roulette(scene.fluorescence, limits, length, path)
    return Traced(radiance, rays, shadow_rays)


@function
def _record(tables, scene, place, technique, length, eye_length, path, found):
    contribution = received(scene.fluorescence, path.throughput, found.radiance)
    record(tables, scene.spectra, place, technique, length, eye_length, contribution, found.weight)
