"""Subpaths and full paths of the reference integrator: explicit lists of vertices, plain Python and float64.

Nothing here is compiled. The functions that kernels are made of are called as the Python that they are, with spectra of
double precision.
"""

from typing import NamedTuple

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf
from ..core.frame import Frame, frame_around
from ..core.rng import random_number
from ..core.vector import Spectrum, Vec3, dot
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import Surface, surface_at
from ..scene.tables import ABSORBER
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
    can_join: bool  # whether connections and merges are possible here
    reflectance: Spectrum | None  # of the material here; a point of an emitter or of the lens has none


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


class Subpath(NamedTuple):
    """Vertices from an emitter or from the lens on; `edges[i]` and `throughputs[i]` arrive at `nodes[i + 1]`."""

    nodes: list
    edges: list
    throughputs: list
    hits: list


class FullPath(NamedTuple):
    """A path from an emitter to the lens; `edges[i]` joins `nodes[i]` and `nodes[i + 1]`."""

    nodes: list
    edges: list
    second: Vec3  # `nodes[1]` as its first edge has found it: merges move it by up to a radius


def end_node(position, normal, extent, emitter):
    """The node of a point that ends paths, on an emitter or (`emitter` < 0) on the lens."""
    surface = Surface(position, normal, normal, 0.0, 0.0, extent, -1, emitter)
    return Node(surface, frame_around(normal), 1.0, 1.0, False, True, None)


def emitter_node(hit):
    """The node of an emitter that a subpath has met."""
    return Node(hit.surface, frame_around(hit.surface.shading_normal), 1.0, 1.0, False, True, None)


def reverse(edge):
    """The edge in the other direction."""
    return Edge(-edge.direction, edge.distance_squared, edge.cos_end, edge.cos_start)


def connecting_edge(start, end):
    """The `Edge` between two nodes."""
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
    return Node(vertex.surface, vertex.frame, outside, survival, is_delta, not is_delta, vertex.reflectance)


def trace_subpath(scene, limits, stream, wavelengths, start, path, light_walk):
    """Follow `path` from the node `start` up to `limits.max_length` edges; emitters met are noted, walls or not."""
    subpath = Subpath([start], [], [], [])
    while True:
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        if hit.geometry == INVALID_ID:
            return subpath
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        edge = edge_to(surface, path, subpath.nodes[-1])
        if surface.emitter >= 0:
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
        subpath.nodes[-1] = node._replace(is_delta=step.is_delta)
        path = survived(step.path, node.survival)


def _is_end(limits, subpath, material, vertex, light_walk):
    """Whether no vertex is made here: nor where no eye walk could go back on the way that a light walk came."""
    is_lost = light_walk and not vertex.is_sampled_back
    return material.kind == ABSORBER or len(subpath.nodes) >= limits.max_length or is_lost


def edge_to(surface, path, start):
    """The `Edge` of a ray that started from the node `start` and has hit `surface`."""
    way = surface.position - start.surface.position
    cosines = (abs(dot(path.direction, normal)) for normal in (start.surface.normal, surface.normal))
    return Edge(path.direction, dot(way, way), *cosines)


def _next(scene, stream, wavelengths, vertex, path, index, light_walk):
    """The `Scattered` step beyond vertex number `index`."""
    pair, u_lobe = FIRST_PAIR + index, random_number(stream, LOBE + index)
    return scatter(scene, vertex, path, wavelengths, stream, pair, u_lobe, light_walk)
