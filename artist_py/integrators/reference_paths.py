"""Subpaths and full paths of the reference integrator: explicit lists of vertices, plain Python and float64.

Nothing here is compiled. The functions that kernels are made of are called as the Python that they are, with spectra of
double precision.
"""

from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf, is_mergeable
from ..cameras.sensor import LensHit, hit_lens
from ..core.frame import Frame, frame_around
from ..core.rng import random_number
from ..core.vector import Spectrum, Vec3, dot, lane, lane_count
from ..emitters.infinite import BEYOND_THE_SCENE, is_in_background
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import Surface, surface_at
from ..scene.tables import ABSORBER, DIRECTIONAL_EMITTER
from ..transport.media import ior_around
from ..transport.roulette import local_survival, survived
from ..transport.subpath import go_straight, is_passed_through, scatter, vertex_on

# Random dimensions of a vertex: a pair for the direction; single numbers for the lobe and for roulette.
FIRST_PAIR, LOBE, ROULETTE = 8, 10_000, 20_000


class DoubleSpectrum(Spectrum):
    """A spectrum of float64, for plain Python only."""

    __slots__ = ()
    dtype = np.float64


class Node(NamedTuple):
    """A vertex and all that its densities depend on besides directions; also for points of emitters and of the lens."""

    surface: Surface
    frame: Frame
    outside: object  # index of refraction around a dielectric: a number, or one per wavelength
    survival: float  # probability that roulette lets a subpath go on
    is_delta: bool  # whether the walk has left by a delta lobe
    can_join: bool  # whether connections are possible here, and merges unless `can_merge` says otherwise
    reflectance: Spectrum | None  # of the material here; a point of an emitter or of the lens has none
    can_merge: bool = False
    is_far: bool = False  # at infinity: a direction, which has neither a distance nor a cosine (theory 1.5)
    lane: int = 0  # the wavelength whose index of refraction has led the walk on


class Edge(NamedTuple):
    """The way from a vertex to the next; |cos| with geometric normals.

    Kept as it was traced: rays start a rounding error above surfaces, so that the positions give directions that differ
    from those sampled by 1e-7.
    """

    direction: Vec3  # unit
    distance_squared: float
    cos_start: float
    cos_end: float


class EmitterHit(NamedTuple):
    """An emitter that a subpath has met."""

    n_nodes: int  # nodes of the subpath up to there
    surface: Surface
    edge: Edge
    throughput: Spectrum
    is_far: bool = False


class LensMeeting(NamedTuple):
    """The lens, met by a light subpath."""

    n_nodes: int  # nodes of the subpath up to there
    hit: LensHit
    node: Node
    edge: Edge
    throughput: Spectrum


class Subpath(NamedTuple):
    """Vertices from an emitter or from the lens on; `edges[i]` and `throughputs[i]` arrive at `nodes[i + 1]`."""

    nodes: list
    edges: list
    throughputs: list
    hits: list  # EmitterHit of eye subpaths, LensMeeting of those from a light


class FullPath(NamedTuple):
    """A path from an emitter to the lens; `edges[i]` joins `nodes[i]` and `nodes[i + 1]`."""

    nodes: list
    edges: list
    second: Vec3  # `nodes[1]` as its first edge has found it: merges move it by up to a radius


def end_node(position, normal, extent, emitter, is_far=False):
    """The node of a point that ends paths, on an emitter or (`emitter` < 0) on the lens."""
    surface = Surface(position, normal, normal, 0.0, 0.0, extent, -1, emitter)
    return Node(surface, frame_around(normal), 1.0, 1.0, False, True, None, is_far=is_far)


def light_node(scene, number, point):
    """The node of a point on emitter `number`; `point` has a position, a normal and an extent."""
    is_far = scene.emitters.records[number].kind >= DIRECTIONAL_EMITTER
    return end_node(point.position, point.normal, point.extent, number, is_far)


def emitter_node(hit):
    """The node of an emitter that a subpath has met."""
    frame = frame_around(hit.surface.shading_normal)
    return Node(hit.surface, frame, 1.0, 1.0, False, True, None, is_far=hit.is_far)


def reverse(edge):
    """The edge in the other direction."""
    return Edge(-edge.direction, edge.distance_squared, edge.cos_end, edge.cos_start)


def connecting_edge(start, end):
    """The `Edge` between two nodes."""
    if start.is_far:
        direction = start.surface.normal
        return Edge(direction, 1.0, 1.0, abs(dot(direction, end.surface.normal)))
    way = end.surface.position - start.surface.position
    distance_squared = dot(way, way)
    direction = way * (1.0 / np.sqrt(distance_squared))
    cosines = (abs(dot(direction, node.surface.normal)) for node in (start, end))
    return Edge(direction, distance_squared, *cosines)


def vertex_of(scene, wavelengths, subpath, index):
    """The `Vertex` of node `index` > 0, its `wo` back along the subpath."""
    wo_world = -subpath.edges[index - 1].direction
    return vertex_on(scene, subpath.nodes[index].surface, wo_world, wavelengths)


def path_of_hit(eye, hit):
    """The full path of an eye subpath that has met an emitter."""
    nodes, edges = eye.nodes[: hit.n_nodes], eye.edges[: hit.n_nodes - 1]
    return joined([emitter_node(hit)], [], reverse(hit.edge), nodes, edges)


def joined(light_nodes, light_edges, edge, eye_nodes, eye_edges):
    """The full path of two subpaths and the edge from the last light node to the last eye node."""
    back = [reverse(each) for each in reversed(eye_edges)]
    nodes = [*light_nodes, *reversed(eye_nodes)]
    return FullPath(nodes, [*light_edges, edge, *back], nodes[1].surface.position)


def up_to(subpath, index):
    """`(nodes, edges)` of a subpath that is joined at node `index`: by no delta lobe, wherever it went on to."""
    nodes = [*subpath.nodes[:index], subpath.nodes[index]._replace(is_delta=False)]
    return nodes, subpath.edges[:index]


def merged(light_nodes, light_edges, eye_nodes, eye_edges):
    """The full path of two subpaths whose last nodes are taken for one: for that of the eye subpath."""
    back = [reverse(each) for each in reversed(eye_edges)]
    nodes = [*light_nodes[:-1], *reversed(eye_nodes)]
    return FullPath(nodes, [*light_edges, *back], light_nodes[1].surface.position)


def node_at(scene, vertex, media, wavelengths):
    """The node of a vertex that a walk through `media` has reached."""
    material = scene.materials[vertex.surface.material]
    outside = ior_around(scene.needs.media, scene, material, vertex.wo.z > 0.0, media, wavelengths)
    survival = local_survival(scene, vertex, wavelengths)
    is_delta = is_delta_bsdf(material)
    can_merge = not is_delta and is_mergeable(scene.needs.sharp, material)
    return Node(
        vertex.surface, vertex.frame, outside, survival, is_delta, not is_delta, vertex.reflectance, can_merge
    )


def trace_subpath(scene, camera, limits, stream, wavelengths, start, path, light_walk):
    """Follow `path` from the node `start` up to `limits.max_length` edges; ends met are noted, walls or not.

    These are emitters for eye subpaths, and for light subpaths (`light_walk`) the lens of `camera`, if there is one.
    """
    subpath = Subpath([start], [], [], [])
    while True:
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        _note_far_ends(scene, camera, subpath, path, hit, light_walk)
        if hit.geometry == INVALID_ID:
            return subpath
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        edge = edge_to(surface, path, subpath.nodes[-1])
        if surface.emitter >= 0 and not light_walk:
            subpath.hits.append(EmitterHit(len(subpath.nodes), surface, edge, path.throughput))
        material = scene.materials[surface.material]
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        vertex = vertex_on(scene, surface, -path.direction, wavelengths)
        if _is_end(limits, subpath, material, vertex, light_walk):
            return subpath
        node = node_at(scene, vertex, path.media, wavelengths)
        for values, value in zip(subpath[:3], (node, edge, path.throughput), strict=True):
            values.append(value)
        step = _next(scene, stream, wavelengths, vertex, path, len(subpath.edges), light_walk)
        if step.path.is_absorbed or random_number(stream, ROULETTE + len(subpath.edges)) >= node.survival:
            return subpath
        subpath.nodes[-1] = node._replace(is_delta=step.is_delta, lane=lane_left(step.path))
        path = survived(step.path, node.survival)


def lane_left(path):
    """The one wavelength that dispersion has left of a path; 0 where it has them all."""
    if path.ratio is None:
        return 0
    left = [i for i in range(lane_count(path.ratio)) if lane(path.ratio, i) > 0.0]
    return left[0] if len(left) == 1 else 0


def _note_far_ends(scene, camera, subpath, path, hit, light_walk):
    """Note the lens, or what is at infinity."""
    if light_walk and camera.lens is not None:
        _note_lens(subpath, camera, path, hit.t)
    elif not light_walk and hit.geometry == INVALID_ID:
        _note_background(scene, subpath, path)


def _note_lens(subpath, camera, path, t_surface):
    """Note the lens where `path` meets it before `t_surface`."""
    hit = hit_lens(camera, path.origin, path.direction)
    if 0.0 <= hit.t < t_surface:
        node = lens_node(camera, path, hit)
        edge = edge_to(node.surface, path, subpath.nodes[-1])
        subpath.hits.append(LensMeeting(len(subpath.nodes), hit, node, edge, path.throughput))


def lens_node(camera, path, hit):
    """The node of the point on the lens that `path` has hit."""
    return end_node(path.origin + path.direction * hit.t, camera.forward, 0.0, -1)


def _note_background(scene, subpath, path):
    """Note every emitter at infinity in the direction of `path`."""
    if scene.emitters is None or scene.emitters.background is None:
        return
    for number in range(scene.emitters.background, scene.emitters.records.shape[0]):
        if is_in_background(scene.emitters.records[number], path.direction):
            subpath.hits.append(background_hit(scene, subpath, path, number))


def background_hit(scene, subpath, path, number):
    """The `EmitterHit` of emitter `number` at infinity."""
    radius = scene.emitters.records[number].radius
    position = path.origin + path.direction * (BEYOND_THE_SCENE * radius)
    surface = end_node(position, -path.direction, 0.0, number).surface
    cosine = abs(dot(path.direction, subpath.nodes[-1].surface.normal))
    edge = Edge(path.direction, 1.0, cosine, 1.0)
    return EmitterHit(len(subpath.nodes), surface, edge, path.throughput, True)


def _is_end(limits, subpath, material, vertex, light_walk):
    """Whether no vertex is made here: nor where no eye walk could go back on the way that a light walk came."""
    is_lost = light_walk and not vertex.is_sampled_back
    return material.kind == ABSORBER or len(subpath.nodes) >= limits.max_length or is_lost


def edge_to(surface, path, start):
    """The `Edge` of a ray that started from the node `start` and has hit `surface`."""
    if start.is_far:
        return Edge(path.direction, 1.0, 1.0, abs(dot(path.direction, surface.normal)))
    way = surface.position - start.surface.position
    cosines = (abs(dot(path.direction, normal)) for normal in (start.surface.normal, surface.normal))
    return Edge(path.direction, dot(way, way), *cosines)


def _next(scene, stream, wavelengths, vertex, path, index, light_walk):
    """The `Scattered` step beyond vertex number `index`."""
    pair, u_lobe = FIRST_PAIR + index, random_number(stream, LOBE + index)
    return scatter(scene, vertex, path, wavelengths, stream, pair, u_lobe, light_walk)
