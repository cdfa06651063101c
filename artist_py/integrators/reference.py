"""The reference integrator: vertex connection and merging by brute force, in plain Python. Slow, and easy to check.

Every path found is written down in full, and weighed with the densities of all techniques that could have found it
(reference_densities.py). An iteration takes `n_light` light subpaths and `eye_samples` eye subpaths per pixel, all with
the same wavelengths; every eye subpath is connected to one light subpath drawn at random, or to as many as
[render.samples] says.
"""

from ..cameras.perspective import camera_ray, sample_film
from ..core.rng import random_number, random_pair, stream_of
from ..emitters.dispatch import choose_emitter, emitted_radiance
from ..emitters.emission import sample_emission
from ..geometry.surface import offset_position
from ..transport.subpath import Path, start_path
from .pair import LIGHT_SEED
from .path_tracing import lens_numbers
from .reference_paths import end_node, light_node, trace_subpath
from .reference_techniques import connections, hits, merges, next_events, photon_map, splats

# Random dimensions of the beginning of a subpath.
FILM, POSITION, DIRECTION = 0, 0, 1
EMITTER, N_PARTNERS, PARTNER = 0, 1, 60_000

# --- subpaths -----------------------------------------------------------------------------------------------------


def trace_light(reference, index):
    """Light subpath `index`; `None` in scenes without emitters."""
    scene, sensing = reference.scene, reference.sensing
    if scene.emitters is None:
        return None
    stream = stream_of(reference.seed ^ LIGHT_SEED, reference.iteration, index, 0)
    number = choose_emitter(scene.emitters.alias, random_number(stream, EMITTER))
    emitter = scene.emitters.records[number]
    pairs = *random_pair(stream, POSITION), *random_pair(stream, DIRECTION)
    start = sample_emission(scene, emitter, *pairs)
    if not start.density > 0.0:
        return None
    radiance = emitted_radiance(scene, emitter, start.direction, reference.wavelengths)
    path = Path(
        offset_position(start.position, start.normal, start.extent, start.direction), start.direction,
        radiance * (start.cos_theta / start.density), 0.0, start.position, 1.0, sensing.ratio, emitter.media, False,
    )  # fmt: skip
    node = light_node(scene, number, start)
    return trace_subpath(
        scene, reference.camera, reference.limits, stream, reference.wavelengths, node, path, True
    )


def trace_eye(reference, x, y, sample):
    """`(subpath, stream, film weight)` of eye subpath number `sample` of pixel (x, y)."""
    camera = reference.camera
    index = (y << 16 | x) + (sample << 32)
    stream = stream_of(reference.seed, reference.iteration, index, 0)
    film_x, film_y, film_weight = sample_film(reference.pixel_filter, x, y, *random_pair(stream, FILM))
    lens_u, lens_v = lens_numbers(camera.lens, stream)
    lens_point, origin, direction = camera_ray(camera, film_x, film_y, lens_u, lens_v)
    path = start_path(origin, direction, reference.sensing, camera.media)
    node = end_node(lens_point, camera.forward, 0.0, -1)
    scene, limits = reference.scene, reference.limits
    subpath = trace_subpath(scene, camera, limits, stream, reference.wavelengths, node, path, None)
    return subpath, stream, film_weight


# --- an image -----------------------------------------------------------------------------------------------------


def pixel_radiance(reference, x, y, eye_samples, light_subpaths, photons):
    """Radiance of pixel (x, y) by all techniques but the light image."""
    total = reference.sensing.zero
    for sample in range(eye_samples):
        eye, stream, film_weight = trace_eye(reference, x, y, sample)
        found = hits(reference, eye) + next_events(reference, eye, stream)
        if light_subpaths:
            for partner in partners(reference, stream):
                found = found + connections(reference, eye, light_subpaths[partner])
            found = found + merges(reference, eye, photons)
        total = total + found * film_weight
    return total * (1.0 / eye_samples)


def partners(reference, stream):
    """Indices of the light subpaths that an eye subpath is connected to: drawn at random, `counts.vc` on average."""
    count = int(reference.counts.vc + random_number(stream, N_PARTNERS))
    return [int(random_number(stream, PARTNER + i) * reference.n_light) for i in range(count)]


def render_reference(reference, eye_samples, is_stopped):
    """Yields `((row, column), radiance)` in the window: contributions to pixels, to be added up."""
    light_subpaths = [trace_light(reference, i) for i in range(reference.n_light)]
    photons = photon_map(light_subpaths, reference.chosen.merge)
    x0, x1, y0, y1 = reference.crop
    for index, light in enumerate(light_subpaths):
        for pixel, value in splats(reference, light, index):
            yield divmod(pixel, x1 - x0), value
    for y in range(y0, y1):
        for x in range(x0, x1):
            if is_stopped():
                return
            value = pixel_radiance(reference, x, y, eye_samples, light_subpaths, photons)
            yield (y - y0, x - x0), value
