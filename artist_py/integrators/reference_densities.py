"""Weights of multiple importance sampling by brute force: every technique's density as a product over the whole path.

This is theory (1.3) and (1.4) as they stand, and shares nothing with the recurrences of transport/mis.py, whose oracle
it is. p>_i and p<_i are the area densities of vertex x_i when a subpath from the light or from the eye has found it.
"""

import math

from ..bsdf.dispatch import pdf_bsdf
from ..bsdf.plastic import coat_reflectance, colour_below, mirror_probability
from ..bsdf.thin_dielectric import sheet_reflectance
from ..cameras.lens import aperture_area
from ..cameras.sensor import pdf_camera_direction
from ..core.frame import to_local
from ..core.fresnel import fresnel_dielectric
from ..core.spectra import ior_of_lane, lane_of
from ..core.vector import dot, lane_count, lane_sum
from ..emitters.dispatch import can_be_hit, pdf_emitter
from ..emitters.emission import pdf_emission_of_background, pdf_emission_of_hit
from ..emitters.point import pdf_direction_of_point
from ..scene.tables import DIELECTRIC, DIRECTIONAL_EMITTER, PLASTIC, POINT_EMITTER, THIN_DIELECTRIC
from ..transport.subpath import is_on_side, vertex_on

HIT, NEE, VC, LT, LENS, VM = "hit", "nee", "vc", "lt", "lens", "vm"


def light_densities(scene, wavelengths, path):
    """p>_i of every vertex, the lens among them.

    The density of the first direction stands with that of the first point: they never come alone.
    """
    nodes, edges = path.nodes, path.edges
    found = [
        emission_density(scene, path),
        edges[0].cos_end / edges[0].distance_squared,
    ]
    for i in range(1, len(edges)):
        edge = edges[i]
        density = pdf_direction(scene, wavelengths, nodes[i], -edges[i - 1].direction, edge.direction)
        found.append(density * edge.cos_end / edge.distance_squared)
    return found


def emission_density(scene, path):
    """p>_0 s>_0 of a light subpath's start, or p>_0 and the density of places on the disk of theory 1.5."""
    emitter, towards = emitter_of(scene, path), -path.edges[0].direction
    if emitter.kind >= DIRECTIONAL_EMITTER:
        return pdf_emission_of_background(scene, emitter, towards)
    if emitter.kind >= POINT_EMITTER:
        return emitter.pdf_select * pdf_direction_of_point(emitter)
    return pdf_emission_of_hit(scene, emitter, path.nodes[0].surface, towards)


def eye_densities(scene, camera, n_pixels, wavelengths, path):
    """p<_i of every vertex (1.22)."""
    nodes, edges = path.nodes, path.edges
    found = [pdf_lens_point(camera)]
    for i in reversed(range(len(edges))):
        edge = edges[i]
        if i == len(edges) - 1:
            density = pdf_camera_direction(camera, n_pixels, -edge.direction)
        else:
            density = pdf_direction(scene, wavelengths, nodes[i + 1], edges[i + 1].direction, -edge.direction)
        found.append(density * edge.cos_start / edge.distance_squared)
    return found[::-1]


def pdf_lens_point(camera):
    """p<_k and pc_k: density of points on the lens, m^-2; 1 for a pinhole, whose delta function cancels."""
    return 1.0 if camera.lens is None else 1.0 / aperture_area(camera.lens)


def pdf_direction(scene, wavelengths, node, wo_world, wi_world):
    """Density of a walk that came from `wo_world` to go on in `wi_world`, roulette included, sr^-1.

    Of a delta lobe it is the factor of the delta function. That one stands in the measure n^2 cos dw, which smooth
    interfaces conserve, so that it is the same for both walks and cancels; what stays is the lobe's probability times
    n^2 cos on the side left in. Its ratio for the two walks is (1.24).
    """
    smooth = scene.needs.smooth_triangles
    wo = vertex_on(scene, node.surface, wo_world, wavelengths).wo
    wi = to_local(node.frame, wi_world)
    if not is_on_side(smooth, node.surface, wi_world, wi):
        return 0.0
    material = scene.materials[node.surface.material]
    if not node.is_delta:
        pdf = pdf_bsdf(scene.needs, material, node.reflectance, scene.spectra, wavelengths, wo, wi)
        return pdf * node.survival
    index = ior_on_side(scene, wavelengths, material, node, wi)
    cosine = abs(dot(wi_world, node.surface.normal))
    return lobe_probability(scene, wavelengths, material, node, wo, wi) * index**2 * cosine * node.survival


def ior_on_side(scene, wavelengths, material, node, w):
    """Index of refraction of the medium that the local direction `w` lies in, at the wavelength that has led on."""
    return ior_at(scene, wavelengths, material, node, w, node.lane)


def ior_at(scene, wavelengths, material, node, w, lane):
    """Index of refraction of the medium that the local direction `w` lies in, at one of the wavelengths."""
    if material.kind != DIELECTRIC or w.z > 0.0:
        return lane_of(node.outside, lane)
    if material.is_dispersive:
        return ior_of_lane(scene.spectra, material.eta, wavelengths, lane)
    return float(material.ior)


def lobe_probability(scene, wavelengths, material, node, wo, wi):
    """Probability of the delta lobe that leads from `wo` to `wi`.

    With dispersion, reflection has the mean of the wavelengths', and refraction that of the one refracted (theory 2.4).
    """
    if material.kind == DIELECTRIC:
        is_reflected = wo.z * wi.z > 0.0
        lanes = range(lane_count(wavelengths)) if is_reflected else [node.lane]
        found = [fresnel_of_lane(scene, wavelengths, material, node, wo, lane) for lane in lanes]
        reflectance = sum(found) / len(found)
    elif material.kind == THIN_DIELECTRIC:
        ratio = wavelengths if scene.needs.dispersion else None
        lanes = sheet_reflectance(ratio, material, scene.spectra, wavelengths, wo, node.outside)
        reflectance = lane_sum(lanes) / lane_count(lanes)
    elif material.kind == PLASTIC:
        face = coat_reflectance(material, wo)
        return mirror_probability(face, colour_below(material, node.reflectance))
    else:
        return 1.0
    return reflectance if wo.z * wi.z > 0.0 else 1.0 - reflectance


def fresnel_of_lane(scene, wavelengths, material, node, wo, lane):
    """Fresnel's reflectance at one wavelength."""
    sides = [ior_at(scene, wavelengths, material, node, w, lane) for w in (wo, -wo)]
    return fresnel_dielectric(abs(wo.z), sides[1] / sides[0])[0]


def emitter_of(scene, path):
    """Record of the emitter that the path begins on."""
    return scene.emitters.records[path.nodes[0].surface.emitter]


def next_event_density(scene, path):
    """pc_0: density, m^-2, of the path's first vertex in next-event estimation from its second."""
    first, edge, emitter = path.nodes[0].surface, path.edges[0], emitter_of(scene, path)
    density = pdf_emitter(scene, emitter, path.second, first.position, first.normal)
    return density * edge.cos_start / edge.distance_squared


def technique_densities(scene, camera, counts, n_pixels, wavelengths, path, hits_everything=True):
    """n p of every technique that finds the path: `{(kind, s): density}`, theory (1.3).

    s is the number of light vertices, or the index of the vertex merged at. A method with lens hits that does not hit
    everything takes hits for what cannot be connected to the lens only (theory 1.9).
    """
    light = light_densities(scene, wavelengths, path)
    eye = eye_densities(scene, camera, n_pixels, wavelengths, path)
    k = len(path.edges)
    can_join = [0 < i < k and not node.is_delta for i, node in enumerate(path.nodes)]
    emitter = emitter_of(scene, path)
    is_hit = hits_everything or not can_join[k - 1]
    hit = counts.hit * can_be_hit(scene.needs.surfaceless_emitters, emitter) if is_hit else 0.0
    found = {(HIT, 0): hit * math.prod(eye)}
    if k > 1 and can_join[1]:
        found[NEE, 1] = counts.nee * next_event_density(scene, path) * math.prod(eye[1:])
    if k > 1 and can_join[k - 1]:
        found[LT, k] = counts.lt * math.prod(light[:k]) * pdf_lens_point(camera)
    if counts.lens is not None and (k > 1 or emitter.kind < POINT_EMITTER):
        found[LENS, k + 1] = counts.lens * math.prod(light)
    for s in range(2, k):
        if can_join[s - 1] and can_join[s]:
            found[VC, s] = counts.vc * math.prod(light[:s]) * math.prod(eye[s:])
    for m in range(1, k):
        if can_join[m] and path.nodes[m].can_merge:
            found[VM, m] = counts.vm_area * math.prod(light[: m + 1]) * math.prod(eye[m:])
    return found


def weight_of(technique, densities, power=1):
    """Weight of `technique` by the balance (`power` 1) or power heuristic (1.4).

    A method without hits leaves to them, with weight 1, what nothing else finds (theory 1.9).
    """
    largest = max(densities.values())
    if largest == 0.0:
        return 1.0 if technique[0] == HIT else 0.0
    shares = {name: (density / largest) ** power for name, density in densities.items()}
    return shares[technique] / sum(shares.values())
