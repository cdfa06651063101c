"""Light and eye subpaths in pairs: the one walk that light tracing, BPT, photon mapping and VCM are subsets of.

A technique that a method does not use is `None` in `Techniques` and is not compiled (theory 1.9).
"""

from ..cameras.perspective import camera_ray, sample_film
from ..cameras.sensor import pdf_camera_direction, projected_lens_area
from ..core.atomic import fetch_and_add
from ..core.rng import random_pair, stream_of
from ..core.spectra import black
from ..jit import function, kernel
from ..transport.mis import eye_start
from ..transport.recording import Place
from ..transport.sensing import store_sample, wavelengths_of_path
from ..transport.subpath import seen_from, start_path
from ..transport.vertices import has_room, rewind
from .eye_subpath import trace_eye_subpath
from .lens_hits import splats_per_vertex
from .light_subpath import trace_light_subpath
from .pair import LIGHT_SEED, Walk, light_paths_of
from .path_tracing import FILM, NEXT_TILE, RAYS, SHADOW_RAYS, STOP, TILE, WAVELENGTH, lens_numbers


@kernel
def trace_pairs(setup, thread, image):
    """Take tiles until none is left or records run short; a light and an eye subpath for every pixel."""
    work, resume = setup.work, setup.stores.resume
    x0, x1, y0, y1 = work.crop
    tiles_x = (x1 - x0 + TILE - 1) // TILE
    tiles = tiles_x * ((y1 - y0 + TILE - 1) // TILE)
    while work.progress[STOP] == 0:
        tile, first = resume[thread, 0], resume[thread, 1]
        if tile < 0:
            tile, first = fetch_and_add(work.progress, NEXT_TILE, 1), 0
        resume[thread, 0] = -1
        if tile >= tiles:
            break
        left, top = x0 + (tile % tiles_x) * TILE, y0 + (tile // tiles_x) * TILE
        for index in range(first, TILE * TILE):
            x, y = left + index % TILE, top + index // TILE
            if x < x1 and y < y1:
                if not stores_have_room(setup, thread):
                    resume[thread, 0], resume[thread, 1] = tile, index
                    return
                trace_pair(setup, thread, x, y, image)


@function
def stores_have_room(setup, thread):
    """Whether the vertices of all subpaths of one pixel fit."""
    stores, length = setup.stores, setup.limits.max_length
    n_light = length * (int(setup.method.light_paths) + 1)
    light = has_room(stores.light, thread, n_light)
    eye = has_room(stores.eye, thread, length)
    splats = has_room(stores.splats, thread, n_light * splats_per_vertex(setup.method.counts.lens))
    return splats and light and eye


@function
def trace_light_subpaths(setup, thread, index, wavelengths):
    """The light subpaths of pixel `index`; a `Walk` of no radiance."""
    work = setup.work
    rewind(setup.stores.light, setup.method.techniques.merge, thread)
    first, end = light_paths_of(setup.method, index)
    rays, shadow_rays = 0, 0
    for path in range(first, end):
        stream = stream_of(work.seed ^ LIGHT_SEED, work.iteration, path, work.stratified_pairs)
        walk = trace_light_subpath(setup, thread, path, index, stream, wavelengths)
        rays, shadow_rays = rays + walk.rays, shadow_rays + walk.shadow_rays
    return Walk(black(wavelengths), rays, shadow_rays)


@function
def keep_offset(offsets, index, stream):
    """Keep the number that places the wavelengths of pixel `index`, where merges need it."""
    if offsets is None:
        return
    offsets[index] = random_pair(stream, WAVELENGTH)[0]


@function
def trace_pair(setup, thread, x, y, image):
    """Trace the pair of pixel (x, y), and store what the eye subpath brings without merges."""
    work, sensing = setup.work, setup.sensing
    pixel = y * work.width + x
    stream = stream_of(work.seed, work.iteration, pixel, work.stratified_pairs)
    wavelengths, weights = wavelengths_of_path(sensing, stream, WAVELENGTH)
    row, column = y - work.crop[2], x - work.crop[0]
    index = row * (work.crop[1] - work.crop[0]) + column
    keep_offset(setup.stores.offsets, index, stream)
    light = trace_light_subpaths(setup, thread, index, wavelengths)

    u, v = random_pair(stream, FILM)
    film_x, film_y, film_weight = sample_film(setup.pixel_filter, x, y, u, v)
    lens_u, lens_v = lens_numbers(setup.camera.lens, stream)
    lens_point, origin, direction = camera_ray(setup.camera, film_x, film_y, lens_u, lens_v)
    path = seen_from(start_path(origin, direction, sensing, setup.camera.media), lens_point)
    density = pdf_camera_direction(setup.camera, setup.method.n_pixels, direction)
    partial = eye_start(setup.method.counts, density, projected_lens_area(setup.camera, direction))
    place = Place(row, column, wavelengths, weights * film_weight)
    eye = trace_eye_subpath(setup, thread, index, stream, place, path, partial, film_weight)
    radiance = eye.radiance * film_weight
    store_sample(sensing, setup.scene.spectra, image, row, column, radiance, wavelengths, weights)
    fetch_and_add(work.progress, RAYS, light.rays + eye.rays)
    fetch_and_add(work.progress, SHADOW_RAYS, light.shadow_rays + eye.shadow_rays)
