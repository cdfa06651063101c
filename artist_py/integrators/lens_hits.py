"""Light that hits the lens: the technique without a vertex of the eye (t = 0, theory 1.2 and 1.6).

The lens is no geometry. A light subpath's ray is tested against it before its next vertex, and goes on behind it, for
the lens casts no shadow. With a pinhole all of this is absent.

An emitter without a surface is not seen by itself: neither can rays hit a point, nor do light subpaths from infinity
cover a lens outside of the scene. Their paths of one edge are left to hits.
"""

from ..cameras.sensor import hit_lens, pdf_camera_direction
from ..core.rng import random_number
from ..core.sets import at_film
from ..core.vector import dot
from ..emitters.dispatch import is_hidden
from ..jit import function
from ..scene.tables import POINT_EMITTER
from ..transport.mis import Partial, on_arrival, weight_of_lens_hit
from ..transport.recording import LENS
from ..transport.splats import choose_pixel, store_splat
from .pair import FIRST_VERTEX, PAIRS_PER_VERTEX, PIXEL_CHOICE


@function
def longest_light_subpath(lens, limits):
    """Edges of the longest light subpath: the last one of a path can only end on the lens."""
    if lens is None:
        return limits.max_length - 1
    return limits.max_length


@function
def splats_per_vertex(lens):
    """How many splats a vertex of a light subpath can bring: one by a connection, and one by the ray that left it."""
    if lens is None:
        return 1
    return 2


@function
def splat_lens_hit(setup, thread, index, emitter, path, partial, t_surface, wavelengths, stream, length):
    """Add what `path` brings if it meets the lens nearer than at `t_surface`, with its weight (1.18)."""
    _splat_lens_hit(
        setup.method.counts.lens, setup, thread, index, emitter, path, partial, t_surface, wavelengths, stream,
        length,
    )  # fmt: skip


@function
def _splat_lens_hit(
    needed, setup, thread, index, emitter, path, partial, t_surface, wavelengths, stream, length
):
    if needed is None:
        return
    hit = hit_lens(setup.camera, path.origin, path.direction)
    if hit.t < 0.0 or hit.t >= t_surface or not is_seen(setup.scene, emitter, length):
        return
    number = random_number(stream, PIXEL_CHOICE + 1 + FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX)
    pixel = choose_pixel(setup.pixel_filter, hit.film_x, hit.film_y, number, setup.work.crop)
    if pixel.index < 0:
        return
    weight = _weight(setup.camera, setup.method, path, partial, hit)
    scale = weight * hit.importance * pixel.weight / setup.method.n_image_paths
    stores, value = setup.stores, at_film(setup.sensing.start, path.throughput) * scale
    store_splat(
        stores.techniques,
        stores.splats,
        thread,
        stores.paths[index],
        pixel.index,
        value,
        LENS,
        length,
        weight,
    )


@function
def is_seen(scene, emitter, length):
    """Whether paths of `length` edges from the emitter may end on the lens."""
    if length == 1 and emitter.kind >= POINT_EMITTER:
        return False
    return not is_hidden(scene.needs.hidden_emitters, emitter, length)


@function
def _weight(camera, method, path, partial, hit):
    way = path.origin + path.direction * hit.t - path.reference
    image_ratio = 0.0
    if path.pdf_solid_angle > 0.0:
        image_ratio = dot(way, way) / (path.pdf_solid_angle * hit.cos_theta * hit.area)
        partial = without_hits(method, partial)
    camera_density = pdf_camera_direction(camera, method.n_pixels, -path.direction) / hit.area
    arrived = on_arrival(partial, dot(way, way), hit.cos_theta)
    return weight_of_lens_hit(method.counts, image_ratio, camera_density, arrived)


@function
def without_hits(method, partial):
    """C and E of a light subpath for a path whose last vertex before the lens can be connected to it.

    A method that hits emitters only where no connection can find them (light tracing) finds none of these by hits, and
    its E knows of nothing else (theory 1.9).
    """
    return _without_hits(method.counts.lens, method, partial)


@function
def _without_hits(lens, method, partial):
    if lens is None:
        return partial
    return Partial(partial.c, partial.e if method.hits_everything else 0.0)
