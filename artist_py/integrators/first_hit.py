"""Auxiliary outputs: what lies at the first hit of each pixel."""

import math
from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import reflectance_bsdf
from ..bsdf.fluorescence import albedo_under_white
from ..cameras.perspective import camera_ray, sample_film
from ..core.atomic import fetch_and_add
from ..core.rng import random_pair, stream_of
from ..core.table import Table
from ..core.vector import dot
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import surface_at
from ..jit import function, kernel
from ..scene.tables import ABSORBER
from ..transport.media import ior_around
from ..transport.sensing import rgb_of, wavelengths_of_path
from ..transport.subpath import start_path, vertex_at
from .path_tracing import FILM, NEXT_TILE, STOP, WAVELENGTH, lens_numbers


class FirstHits(NamedTuple):
    """Per pixel, float32; sums over samples, `coverage` counts those that hit something."""

    normal: Table  # (h, w, 3) geometric, towards the camera
    shading_normal: Table  # (h, w, 3)
    position: Table  # (h, w, 3) render space
    depth: Table  # (h, w, 1) distance along the optical axis, render space
    albedo: Table  # (h, w, 3) linear RGB of the reflectance as a radiance
    material: Table  # (h, w, 1) row of the material at the last sample, -1 for none
    coverage: Table  # (h, w, 1)


@kernel
def trace_first_hits(scene, camera, pixel_filter, sensing, work, hits):
    """Add one sample per pixel to `hits`; rows are the units of work."""
    x0, x1, y0, y1 = work.crop
    while work.progress[STOP] == 0:
        row = fetch_and_add(work.progress, NEXT_TILE, 1)
        if row >= y1 - y0:
            break
        for column in range(x1 - x0):
            _trace_pixel(scene, camera, pixel_filter, sensing, work, row, column, hits)


@function
def _trace_pixel(scene, camera, pixel_filter, sensing, work, row, column, hits):
    x, y = work.crop[0] + column, work.crop[2] + row
    stream = stream_of(work.seed, work.iteration, y * work.width + x, work.stratified_pairs)
    u, v = random_pair(stream, FILM)
    film_x, film_y, _ = sample_film(pixel_filter, x, y, u, v)
    lens_u, lens_v = lens_numbers(camera.lens, stream)
    _, origin, direction = camera_ray(camera, film_x, film_y, lens_u, lens_v)
    hit = closest_hit(scene.geometry.embree, origin, direction, np.inf)
    if hit.geometry == INVALID_ID:
        return
    surface = surface_at(scene.geometry, scene.needs, origin, direction, hit)
    side = math.copysign(1.0, -dot(direction, surface.normal))
    _add_vector(hits.normal, row, column, surface.normal * side)
    _add_vector(hits.shading_normal, row, column, surface.shading_normal * side)
    _add_vector(hits.position, row, column, surface.position)
    hits.depth[row, column, 0] += dot(surface.position - camera.position, camera.forward)
    hits.material[row, column, 0] = surface.material
    hits.coverage[row, column, 0] += 1.0
    _add_albedo(scene, camera, sensing, stream, surface, origin, direction, row, column, hits)


@function
def _add_vector(image, row, column, vector):
    image[row, column, 0] += vector.x
    image[row, column, 1] += vector.y
    image[row, column, 2] += vector.z


@function
def _add_albedo(scene, camera, sensing, stream, surface, origin, direction, row, column, hits):
    material = scene.materials[surface.material]
    if material.kind == ABSORBER:
        return
    wavelengths, weights = wavelengths_of_path(sensing, stream, WAVELENGTH)
    path = start_path(origin, direction, sensing, camera.media)
    vertex = vertex_at(scene, surface, path, wavelengths)
    outside = ior_around(scene.needs.media, scene, material, vertex.wo.z > 0.0, camera.media, wavelengths)
    albedo = reflectance_bsdf(
        scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, outside
    )
    albedo = albedo_under_white(scene.fluorescence, scene.needs, material, albedo, vertex.wo, weights)
    red, green, blue = rgb_of(scene.spectra, albedo * weights, wavelengths)
    hits.albedo[row, column, 0] += red
    hits.albedo[row, column, 1] += green
    hits.albedo[row, column, 2] += blue
