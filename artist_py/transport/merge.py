"""Vertex merging: light vertices within a radius of an eye vertex (Georgiev et al. 2012; Hachisuka et al. 2012)."""

from typing import NamedTuple

from ..bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from ..bsdf.fluorescence import reradiation_factor, scattered_light
from ..core.affine import load_vec3
from ..core.frame import to_local
from ..core.sets import chosen, received
from ..core.spectra import black
from ..core.vector import Spectrum, dot
from ..jit import function
from .mis import Partial, bracket, weight_of_merge
from .photon_density import counts_around
from .photon_grid import bucket_of, cell_of, is_in_pair
from .recording import VM, record
from .rotation import Rotation, is_rejected, throughput_in_line
from .shifting import Matching, is_unmatched, of_power
from .subpath import is_on_side


class Merging(NamedTuple):
    """Constants of an iteration's merges."""

    radius: float  # render-space units
    normalization: float  # 1 / (pi r^2 N_L)
    # Photons on surfaces that face elsewhere are not of this surface: they would leak through edges and thin walls.
    min_normal_cosine: float
    epanechnikov: bool | None  # K = 2 (1 - d^2 / r^2) / (pi r^2) instead of the constant kernel 1 / (pi r^2)
    rotation: Rotation | None = None  # absent where all subpaths of an iteration share their wavelengths
    matching: Matching | None = None  # present where each photon has one wavelength of its own


class Merged(NamedTuple):
    """What the photons around a vertex bring per eye throughput, and how many there were."""

    value: Spectrum
    count: int


@function
def merge_at(scene, method, grid, merging, stored, survival, limits, tables, place, window):
    """Sum over the photons within the radius of the stored eye vertex, each with its weight (1.14).

    Each is also noted in the `TechniqueTables`, if there are any. `window` says which wavelengths are accepted.
    """
    wavelengths = place.wavelengths
    total, count = black(wavelengths), 0
    p = stored.vertex.surface.position
    i, j, k = _lower_cell(p.x, grid.cell), _lower_cell(p.y, grid.cell), _lower_cell(p.z, grid.cell)
    buckets = grid.starts.shape[0] - 1
    counts = counts_around(method.density, method.counts, p)
    scale = 1.0 / (merging.radius * merging.radius)
    material = scene.materials[stored.vertex.surface.material]
    for corner in range(8):
        x, y, z = corner & 1, j + ((corner >> 1) & 1), k + (corner >> 2)
        bucket = bucket_of(i + x, y, z, buckets)
        # The second of a row is gone over with the first, whose bucket it follows, but where buckets begin again.
        if x == 1 and bucket > 0:
            continue
        for row in range(grid.starts[bucket], grid.starts[min(bucket + 2 - x, buckets)]):
            photon = grid.photons[row]
            distance_squared = _distance_squared(photon, p) * scale
            # A photon counts in its own row only, since several of the four may share buckets.
            if (
                distance_squared <= 1.0
                and is_in_pair(photon.position, i, y, z, grid.cell)
                and not is_unmatched(merging.matching, material, photon, wavelengths)
            ):
                length = photon.length + stored.length
                throughput = throughput_in_line(window, photon, wavelengths)
                if length <= limits.max_length and not is_rejected(window, throughput):
                    merged = _merge(
                        scene, method, counts, merging, photon, throughput, stored, survival, wavelengths
                    )
                    value = merged.value * _kernel(merging.epanechnikov, distance_squared)
                    total = total + value
                    count += 1
                    value = received(scene.fluorescence, stored.throughput, value) * merging.normalization
                    record(tables, scene.spectra, place, VM, length, stored.length, value, merged.weight)
    return Merged(total * merging.normalization, count)


@function
def _lower_cell(x, cell):
    """The lower of the two cells that a ball of half a cell's size around `x` can touch."""
    return cell_of(x - 0.5 * cell, cell)


@function
def _distance_squared(photon, p):
    dx, dy, dz = photon.position[0] - p.x, photon.position[1] - p.y, photon.position[2] - p.z
    return dx * dx + dy * dy + dz * dz


class MergedPhoton(NamedTuple):
    """What one photon brings per eye throughput and density, weighted, and the weight."""

    value: Spectrum
    weight: float


@function
def _kernel(epanechnikov, distance_squared):
    """The kernel over 1 / (pi r^2), at a distance in radii; weights keep the area pi r^2 for either (theory 1.2)."""
    if epanechnikov is None:
        return 1.0
    return 2.0 * (1.0 - distance_squared)


@function
def _merge(scene, method, counts, merging, photon, throughput, stored, survival, wavelengths):
    vertex = stored.vertex
    normal = load_vec3(photon.normal)
    direction = load_vec3(photon.direction)
    wi = to_local(vertex.frame, direction)
    material = scene.materials[vertex.surface.material]
    pdf = pdf_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    if pdf == 0.0 or abs(dot(normal, vertex.surface.normal)) < merging.min_normal_cosine:
        return MergedPhoton(black(wavelengths), 0.0)
    if not is_on_side(scene.needs.smooth_triangles, vertex.surface, direction, wi):
        return MergedPhoton(black(wavelengths), 0.0)
    f = evaluate_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, vertex.wo, wi)
    f = of_power(
        merging.matching, scene.reemission, scene.needs, material, photon, wavelengths, f, vertex.wo, wi
    )
    weight = _weight(
        method.techniques.merge_once, scene, counts, photon, stored, material, wi, pdf, survival, wavelengths
    )
    shading = _shading_factor(scene.needs.smooth_triangles, normal, direction, wi)
    glow = reradiation_factor(scene.fluorescence, scene.needs, material, vertex.wo, wi)
    scattered = scattered_light(scene.fluorescence, material, throughput, f, glow)
    value = chosen(scene.fluorescence, throughput * f, scattered) * (weight * shading)
    return MergedPhoton(value, weight)


@function
def _weight(merge_once, scene, counts, photon, stored, material, wi, pdf, survival, wavelengths):
    """(1.14), or 1 where merging is the only technique."""
    if merge_once is not None:
        return 1.0
    vertex = stored.vertex
    pdf_rev = pdf_bsdf(scene.needs, material, vertex.reflectance, scene.spectra, wavelengths, wi, vertex.wo)
    if not vertex.is_sampled_back:
        pdf_rev = 0.0
    light = bracket(counts, Partial(photon.c, photon.e), pdf * survival)
    eye = bracket(counts, stored.partial, pdf_rev * survival)
    return weight_of_merge(counts, light, eye)


@function
def _shading_factor(smooth, normal, direction, wi):
    """|wi.Ns| / |wi.Ng|: the photon's flux was counted on the geometric surface (theory 1.7)."""
    if smooth is None:
        return 1.0
    return abs(wi.z) / max(abs(dot(normal, direction)), 1e-9)
