"""What each technique of the reference integrator brings: estimates of full paths, weighted by brute force."""

import math
from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from ..cameras.sensor import connect_to_lens
from ..core.frame import to_local
from ..core.rng import random_number, random_pair, stream_of
from ..core.vector import dot
from ..emitters.dispatch import (
    choose_emitter,
    emitted_radiance,
    is_emitting_towards,
    is_hidden,
    sample_emitter,
)
from ..geometry.surface import largest
from ..scene.tables import Camera, Filter, Scene
from ..transport.connect import scattering_towards
from ..transport.merge import Merging
from ..transport.mis import Counts
from ..transport.roulette import Limits
from ..transport.sensing import Sensing
from ..transport.shares import Chosen, is_chosen
from ..transport.splats import choose_pixel
from ..transport.subpath import is_on_side
from ..transport.visibility import is_blocked
from .lens_hits import is_seen
from .methods import ALL
from .pair import LIGHT_SEED
from .reference_densities import HIT, LENS, LT, NEE, VC, VM, technique_densities, weight_of
from .reference_paths import (
    connecting_edge,
    end_node,
    joined,
    light_node,
    merged,
    path_of_hit,
    up_to,
    vertex_of,
)

# Random dimensions of what vertex i is connected to (+ i); see also reference_paths.py.
EMITTER_POINT, LENS_POINT, EMITTER_CHOICE, PIXEL_CHOICE = 10_000, 20_000, 30_000, 40_000
LENS_PIXEL_CHOICE, NEXT_RAY = 50_000, 100_000  # NEXT_RAY: from one shadow ray of a vertex to the next


class Reference(NamedTuple):
    """Everything that an iteration needs."""

    scene: Scene
    camera: Camera
    pixel_filter: Filter
    sensing: Sensing
    wavelengths: object  # DoubleSpectrum, nm
    limits: Limits
    min_length: int  # edges; shorter paths are left out
    counts: Counts  # per eye subpath
    merging: Merging
    crop: tuple
    n_light: int  # light subpaths
    chosen: Chosen  # of them, by what is done with them
    n_image_paths: float  # those that the camera sees, on average
    seed: int
    iteration: int

    @property
    def n_pixels(self):
        """Pixels of the window."""
        x0, x1, y0, y1 = self.crop
        return (x1 - x0) * (y1 - y0)


def counts_of(mode, n_eye, n_light, radius, power, samples=ALL, lens=False):
    """`Counts` of a mode: "vcm", "bdpt" (no merges) or "bdpm" (merges alone); `power` says by which heuristic.

    `samples` are those of [render.samples], `lens` says whether there is one that light can hit.
    """
    next_event, connections, image, merging = (
        1 if each is None else each for each in samples_in(mode, samples)
    )
    area = merging * n_light * math.pi * radius**2
    light_image = image * n_light / n_eye
    return Counts(
        float(mode != "bdpm"),
        float(next_event),
        float(connections * (n_light > 0)),
        light_image,
        area,
        power or None,
        light_image if lens and light_image > 0.0 else None,
    )


def samples_in(mode, samples):
    """`(next_event, connections, light_image, merging)` of [render.samples] in a mode, 0 what it leaves out."""
    given = samples.next_event, samples.connections, samples.light_image, samples.merging
    return {"vcm": given, "bdpt": (*given[:3], 0), "bdpm": (0, 0, 0, given[3])}[mode]


# --- techniques: what each brings, weighted -----------------------------------------------------------------------


def weight(reference, technique, path):
    """Weight of `technique` for a full path; 0 for paths of a length that is left out."""
    length = len(path.edges)
    if not reference.min_length <= length <= reference.limits.max_length:
        return 0.0
    densities = technique_densities(
        reference.scene, reference.camera, reference.counts, reference.n_pixels, reference.wavelengths, path
    )
    return weight_of(technique, densities, 2 if reference.counts.power else 1)


def hits(reference, eye):
    """Radiance of the emitters that an eye subpath has met."""
    scene, total = reference.scene, reference.sensing.zero
    for hit in eye.hits:
        emitter = scene.emitters.records[hit.surface.emitter]
        is_seen = not is_hidden(scene.needs.hidden_emitters, emitter, hit.n_nodes)
        if is_seen and is_emitting_towards(emitter, hit.surface.normal, -hit.edge.direction):
            radiance = emitted_radiance(scene, emitter, -hit.edge.direction, reference.wavelengths)
            w = weight(reference, (HIT, 0), path_of_hit(eye, hit))
            total = total + hit.throughput * radiance * w
    return total


def scattering(reference, subpath, index, wi, light_walk):
    """`Scattering` at node `index` of a subpath towards `wi`."""
    vertex = vertex_of(reference.scene, reference.wavelengths, subpath, index)
    survival = subpath.nodes[index].survival
    return scattering_towards(reference.scene, vertex, wi, reference.wavelengths, survival, light_walk)


def connectable(subpath):
    """Indices of the nodes that can be connected."""
    return [i for i, node in enumerate(subpath.nodes) if i > 0 and node.can_join]


def mergeable(subpath):
    """Indices of the nodes that can be merged at."""
    return [i for i in connectable(subpath) if subpath.nodes[i].can_merge]


def next_events(reference, eye, stream):
    """Radiance by next-event estimation at all vertices of an eye subpath."""
    total = reference.sensing.zero
    if reference.scene.emitters is None or reference.counts.nee == 0.0:
        return total
    n_rays = int(reference.counts.nee)
    for index in connectable(eye):
        for ray in range(n_rays):
            value = next_event(reference, eye, index, stream, ray * NEXT_RAY)
            total = total + eye.throughputs[index - 1] * value * (1.0 / n_rays)
    return total


def next_event(reference, eye, index, stream, dimension):
    """Radiance per throughput from an emitter chosen for one vertex."""
    scene, nothing = reference.scene, reference.sensing.zero
    node = eye.nodes[index]
    number = choose_emitter(scene.emitters.alias, random_number(stream, EMITTER_CHOICE + index + dimension))
    emitter = scene.emitters.records[number]
    u, v = random_pair(stream, EMITTER_POINT + index + dimension)
    point = sample_emitter(scene, emitter, node.surface.position, u, v)
    if point.pdf_solid_angle == 0.0:
        return nothing
    light = light_node(scene, number, point)
    edge = connecting_edge(light, node)
    if not is_emitting_towards(emitter, point.normal, edge.direction):
        return nothing
    there = scattering(reference, eye, index, -edge.direction, None)
    ends = point.position, point.normal, point.extent
    if there.is_black or is_blocked(scene, node.surface, -edge.direction, *ends):
        return nothing
    path = joined([light], [], edge, *up_to(eye, index))
    w = weight(reference, (NEE, 1), path) / (point.pdf_solid_angle * emitter.pdf_select)
    return emitted_radiance(scene, emitter, edge.direction, reference.wavelengths) * there.f_cos * w


def connections(reference, eye, light):
    """Radiance by connecting all vertices of an eye subpath to all of a light subpath."""
    total = reference.sensing.zero
    if light is None or reference.counts.vc == 0.0:
        return total
    for i in connectable(eye):
        for j in connectable(light):
            if i + j + 1 <= reference.limits.max_length:
                value = connection(reference, eye, i, light, j)
                total = total + eye.throughputs[i - 1] * light.throughputs[j - 1] * value
    return total


def connection(reference, eye, i, light, j):
    """Radiance per throughputs by connecting node i of an eye subpath to node j of a light subpath."""
    start, end = light.nodes[j], eye.nodes[i]
    edge = connecting_edge(start, end)
    here = scattering(reference, eye, i, -edge.direction, None)
    there = scattering(reference, light, j, edge.direction, True)
    if here.is_black or there.is_black:
        return reference.sensing.zero
    far = start.surface
    if is_blocked(reference.scene, end.surface, -edge.direction, far.position, far.normal, far.extent):
        return reference.sensing.zero
    path = joined(*up_to(light, j), edge, *up_to(eye, i))
    w = weight(reference, (VC, j + 1), path)
    return here.f_cos * there.f_cos * (w / (reference.counts.vc * edge.distance_squared))


def splats(reference, light, index):
    """`[(pixel, value), ...]` of light subpath `index` connected to the lens; pixels row-major in the window."""
    found = []
    if light is None or reference.counts.lt == 0.0 or not is_chosen(reference.chosen.light_image, index):
        return found
    stream = stream_of(reference.seed ^ LIGHT_SEED, reference.iteration, index, 0)
    if reference.counts.lens is not None:
        found += lens_hits(reference, light, stream)
    for i in connectable(light):
        u, v = random_pair(stream, LENS_POINT + i)
        position = light.nodes[i].surface.position
        sensor = connect_to_lens(reference.camera, reference.n_pixels, position, u, v)
        if sensor.pdf_solid_angle > 0.0 and i + 1 <= reference.limits.max_length:
            number = random_number(stream, PIXEL_CHOICE + i)
            pixel = choose_pixel(reference.pixel_filter, sensor.film_x, sensor.film_y, number, reference.crop)
            if pixel.index >= 0:
                value = light.throughputs[i - 1] * splat(reference, light, i, sensor)
                found.append((pixel.index, value * (pixel.weight / reference.n_image_paths)))
    return found


def lens_hits(reference, light, stream):
    """`[(pixel, value), ...]` of the lens, where the light subpath has hit it."""
    found, scene = [], reference.scene
    emitter = scene.emitters.records[light.nodes[0].surface.emitter]
    for meeting in light.hits:
        hit, length = meeting.hit, meeting.n_nodes
        if not is_seen(scene, emitter, length):
            continue
        number = random_number(stream, LENS_PIXEL_CHOICE + length)
        pixel = choose_pixel(reference.pixel_filter, hit.film_x, hit.film_y, number, reference.crop)
        if pixel.index >= 0:
            path = joined(light.nodes[:length], light.edges[: length - 1], meeting.edge, [meeting.node], [])
            scale = weight(reference, (LENS, length + 1), path) * hit.importance / reference.n_image_paths
            found.append((pixel.index, meeting.throughput * (pixel.weight * scale)))
    return found


def splat(reference, light, i, sensor):
    """Pixel value per throughput by connecting node i of a light subpath to the lens."""
    lens = end_node(sensor.position, reference.camera.forward, 0.0, -1)
    edge = connecting_edge(light.nodes[i], lens)
    there = scattering(reference, light, i, edge.direction, True)
    surface = light.nodes[i].surface
    ends = sensor.position, -edge.direction, largest(sensor.position)
    if there.is_black or is_blocked(reference.scene, surface, edge.direction, *ends):
        return reference.sensing.zero
    path = joined(*up_to(light, i), edge, [lens], [])
    w = weight(reference, (LT, i + 1), path)
    return there.f_cos * (w * sensor.importance / edge.distance_squared)


# --- merges -------------------------------------------------------------------------------------------------------


class Photons(NamedTuple):
    """All light vertices that can be merged with, and where they are."""

    tree: object  # scipy.spatial.cKDTree, None without photons
    places: list  # (subpath, index of its node)


def photon_map(light_subpaths, share):
    """`Photons` of those of an iteration's light subpaths that are in a `Share`."""
    from scipy.spatial import cKDTree

    chosen = [light for index, light in enumerate(light_subpaths) if light and is_chosen(share, index)]
    places = [(light, i) for light in chosen for i in mergeable(light)]
    positions = [light.nodes[i].surface.position.values for light, i in places]
    return Photons(cKDTree(np.array(positions)) if positions else None, places)


def merges(reference, eye, photons):
    """Radiance by merging all vertices of an eye subpath with the photons around them."""
    total = reference.sensing.zero
    if photons.tree is None or reference.counts.vm_area == 0.0:
        return total
    for i in mergeable(eye):
        position = eye.nodes[i].surface.position.values
        near = photons.tree.query_ball_point(position, reference.merging.radius)
        for light, j in (photons.places[each] for each in sorted(near)):
            if i + j <= reference.limits.max_length:
                value = merge(reference, eye, i, light, j) * kernel(reference.merging, eye, i, light, j)
                total = total + eye.throughputs[i - 1] * light.throughputs[j - 1] * value
    return total * reference.merging.normalization


def kernel(merging, eye, i, light, j):
    """The kernel between two nodes, over the constant one."""
    if merging.epanechnikov is None:
        return 1.0
    way = eye.nodes[i].surface.position - light.nodes[j].surface.position
    return 2.0 * (1.0 - dot(way, way) / merging.radius**2)


def merge(reference, eye, i, light, j):
    """What node j of a light subpath brings to node i of an eye subpath per throughputs and kernel, sr^-1."""
    scene, smooth = reference.scene, reference.scene.needs.smooth_triangles
    vertex, wi_world = vertex_of(scene, reference.wavelengths, eye, i), -light.edges[j - 1].direction
    material, wi = scene.materials[vertex.surface.material], to_local(vertex.frame, wi_world)
    photon_normal = light.nodes[j].surface.normal
    is_elsewhere = abs(dot(photon_normal, vertex.surface.normal)) < reference.merging.min_normal_cosine
    if is_elsewhere or not is_on_side(smooth, vertex.surface, wi_world, wi):
        return reference.sensing.zero
    given = scene.needs, material, vertex.reflectance, scene.spectra, reference.wavelengths, vertex.wo, wi
    if pdf_bsdf(*given) == 0.0:
        return reference.sensing.zero
    f = evaluate_bsdf(*given)
    path = merged(*up_to(light, j), *up_to(eye, i))
    # The photon's flux was counted on the geometric surface (theory 1.7).
    shading = abs(wi.z) / light.edges[j - 1].cos_end
    return f * (weight(reference, (VM, j), path) * shading)
