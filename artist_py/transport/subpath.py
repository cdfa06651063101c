"""A walk from vertex to vertex: what a path carries, and one step of it."""

import math
from typing import NamedTuple

from ..bsdf.dispatch import sample_bsdf
from ..bsdf.fluorescence import ratio_after, throughput_after
from ..bsdf.reflectance import reflectance_at
from ..core.frame import Frame, frame_around, to_local, to_world
from ..core.rng import random_pair
from ..core.sets import chosen, given, repeated
from ..core.vector import Spectrum, Vec3, dot, splat, vec3
from ..geometry.surface import Surface, leave_surface
from ..jit import function
from ..scene.tables import PASS_THROUGH
from .media import ior_around, is_inside_another, media_beyond


class Path(NamedTuple):
    """The ray that a path is about to follow, and what it carries along."""

    origin: Vec3
    direction: Vec3  # unit
    throughput: Spectrum  # product of f |cos| / pdf so far; of an eye subpath the matrix of core/sets.py
    pdf_solid_angle: float  # density of `direction` at `reference`, sr^-1; 0 if it is a delta direction
    reference: Vec3  # the last vertex
    radiance_scale: float  # (n here / n at the camera)^2, which the throughput has been divided by
    ratio: Spectrum | None  # running r of theory (2.6); absent where no density depends on wavelength
    media: int  # dielectrics around, see media.py
    is_absorbed: bool


@function
def with_throughput(path, throughput):
    """The path with another throughput."""
    return Path(
        path.origin,
        path.direction,
        throughput,
        path.pdf_solid_angle,
        path.reference,
        path.radiance_scale,
        path.ratio,
        path.media,
        path.is_absorbed,
    )


@function
def seen_from(path, reference):
    """The path with another last vertex than its origin: the lens, for rays that start nearer to the scene."""
    return Path(
        path.origin,
        path.direction,
        path.throughput,
        path.pdf_solid_angle,
        reference,
        path.radiance_scale,
        path.ratio,
        path.media,
        path.is_absorbed,
    )


class Vertex(NamedTuple):
    """A surface point in the shading frame; `wo` points back along the path.

    Where interpolated normals put `wo` on the other side than the geometric one, no walk leaves into it (`scatter`): it
    is evaluated on the geometric side, and its reverse density is 0. Light may leave there but not arrive.
    """

    surface: Surface
    frame: Frame
    wo: Vec3
    is_sampled_back: bool
    reflectance: Spectrum  # of the material here, zero where it has none


@function
def start_path(origin, direction, sensing, media):
    """A path that leaves the camera."""
    throughput = given(sensing.start, splat(sensing.zero, 1.0))
    return Path(origin, direction, throughput, 0.0, origin, 1.0, sensing.ratio, media, False)


@function
def vertex_at(scene, surface, path, wavelengths):
    """The path's vertex on `surface`, which its ray has hit."""
    return vertex_on(scene, surface, -path.direction, wavelengths)


@function
def vertex_on(scene, surface, wo_world, wavelengths):
    """The vertex on `surface` of a path that came from `wo_world`."""
    frame = frame_around(surface.shading_normal)
    wo = to_local(frame, wo_world)
    agrees = is_on_side(scene.needs.smooth_triangles, surface, wo_world, wo)
    wo = on_geometric_side(scene.needs.smooth_triangles, surface, wo_world, wo)
    material = scene.materials[surface.material]
    reflectance = reflectance_at(scene.textures, material, scene.spectra, wavelengths, surface.u, surface.v)
    return Vertex(surface, frame, wo, agrees, reflectance)


@function
def on_geometric_side(needed, surface, wo_world, wo):
    """`wo` on the side of the surface that it really is on, which interpolated normals may deny near silhouettes."""
    if needed is None:
        return wo
    return vec3(wo.x, wo.y, math.copysign(wo.z, dot(wo_world, surface.normal)))


@function
def is_on_side(needed, surface, w_world, w):
    """Whether shading and geometric normal agree on the side of a direction, given in the world and in the frame."""
    if needed is None:
        return True
    return w.z * dot(w_world, surface.normal) > 0.0


@function
def is_passed_through(scene, surface, material, path):
    """Whether light goes on here as if nothing were there."""
    if material.kind == PASS_THROUGH:
        return True
    is_entering = dot(path.direction, surface.normal) < 0.0
    return is_inside_another(scene.needs.media, scene.media, material, is_entering, path.media)


@function
def go_straight(scene, surface, material, path):
    """The path beyond a surface that is not there."""
    is_entering = dot(path.direction, surface.normal) < 0.0
    media = media_beyond(scene.needs.media, material, is_entering, path.media)
    return Path(
        leave_surface(surface, path.direction),
        path.direction,
        path.throughput,
        path.pdf_solid_angle,
        path.reference,
        path.radiance_scale,
        path.ratio,
        media,
        False,
    )


class Scattered(NamedTuple):
    """A sampled step: the path beyond the vertex, and what weights need to know of it."""

    path: Path
    pdf_fwd: float  # sr^-1, or the probability of a delta lobe
    pdf_rev: float  # the same for the walk that comes along the new direction
    is_delta: bool
    eta: float  # n on the new side over n on the old one


@function
def scatter(scene, vertex, path, wavelengths, stream, pair, u_lobe, light_walk):
    """One step: the BSDF at `vertex` sampled; `pair` is the pair of random dimensions used.

    `light_walk` is `True` for subpaths from a light, `None` for those from the eye (theory 1.7).
    """
    u, v = random_pair(stream, pair)
    needs, surface = scene.needs, vertex.surface
    material = scene.materials[surface.material]
    is_entering = vertex.wo.z > 0.0
    outside = ior_around(needs.media, scene, material, is_entering, path.media, wavelengths)
    sample = sample_bsdf(
        needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, u, v, u_lobe, path.ratio, outside,
        light_walk,
    )  # fmt: skip
    direction = to_world(vertex.frame, sample.wi)
    is_kept = sample.pdf > 0.0 and is_on_side(needs.smooth_triangles, surface, direction, sample.wi)
    is_refracted = sample.wi.z * vertex.wo.z < 0.0
    beyond = media_beyond(needs.media, material, is_entering, path.media)
    adjoint = adjoint_factor(light_walk, needs.smooth_triangles, vertex, direction, sample.wi)
    elastic = path.throughput * repeated(sample.weight, path.throughput)
    glowing = throughput_after(
        scene.fluorescence, needs, material, path.throughput, elastic, sample, vertex.wo, light_walk
    )
    onwards = Path(
        leave_surface(surface, direction),
        direction,
        chosen(scene.fluorescence, elastic, glowing) * adjoint,
        0.0 if sample.is_delta else sample.pdf,
        surface.position,
        path.radiance_scale * sample.eta * sample.eta,
        ratio_after(scene.fluorescence, material, sample),
        beyond if is_refracted else path.media,
        not is_kept,
    )
    pdf_rev = sample.pdf_rev if vertex.is_sampled_back else 0.0
    return Scattered(onwards, sample.pdf, pdf_rev, sample.is_delta, sample.eta)


@function
def adjoint_factor(light_walk, smooth, vertex, wi_world, wi):
    """What interpolated normals do to flux that leaves along `wi`: |wo.Ns| |wi.Ng| / (|wo.Ng| |wi.Ns|) (theory 1.7)."""
    if light_walk is None:
        return 1.0
    if smooth is None:
        return 1.0
    wo_world = to_world(vertex.frame, vertex.wo)
    normal = vertex.surface.normal
    return abs(vertex.wo.z * dot(wi_world, normal)) / max(abs(dot(wo_world, normal) * wi.z), 1e-9)
