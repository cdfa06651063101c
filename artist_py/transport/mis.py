"""Weights of multiple importance sampling over all techniques of vertex connection and merging.

A path is found by hitting an emitter (hit), next-event estimation (nee), connecting two subpaths (vc), connecting a
light subpath to the lens (lt), a light subpath that hits the lens (lens), or merging (vm). A subpath carries two
numbers per arrived vertex, C and E, from which the weight of every technique follows (theory 1.3): C is what all
connections that end in the edge just behind would do, E everything further away. In streaming form C and E change

* when a direction is sampled: (1.19), `after_scatter` and `after_delta`;
* on arrival at the next vertex: (1.20), `on_arrival`.

A technique that is switched off has a count of zero; nothing else changes (theory 1.9). The balance heuristic is the
default; for the power heuristic with beta = 2 sums become Euclidean norms, and C and E stay un-powered (4.1).
"""

import math
from typing import NamedTuple

from ..bsdf.dispatch import is_mergeable
from ..core.vector import dot
from ..jit import function


@function
def balance(pdf, pdf_other):
    """Balance heuristic for two techniques with one sample each: the weight of the first."""
    return pdf / (pdf + pdf_other)


class Counts(NamedTuple):
    """Samples of each technique per eye subpath (theory 1.2); 0 where it is off."""

    hit: float
    nee: float
    vc: float
    lt: float
    vm_area: float  # a = n_vm pi r^2 of (1.7), n_vm light subpaths in the photon map; render-space units^2
    power: bool | None  # the power heuristic instead of the balance heuristic
    lens: float | None = None  # absent for a pinhole, or a lens that light does not hit


@function
def counts_of_material(sharp, counts, material):
    """The counts at a vertex: without merges where the material forbids them, M = 0 of (1.7); see `is_mergeable`."""
    if sharp is None:
        return counts
    return counts_of_sharp(sharp, counts, material)


@function
def counts_of_sharp(sharp, counts, material):
    """As `counts_of_material`, where some materials are sharp."""
    if is_mergeable(sharp, material):
        return counts
    return with_vm_area(counts, 0.0)


@function
def with_vm_area(counts, area):
    """The counts with another `vm_area`, their fifth field: a may be local to a vertex (theory 1.4)."""
    return Counts(*(counts[:4] + (area,) + counts[5:]))  # noqa: RUF005 - numba wants literals and sums of tuples


class Partial(NamedTuple):
    """C and E of a subpath at its last vertex."""

    c: float
    e: float


@function
def on_arrival(partial, distance_squared, cos_theta):
    """(1.20): the subpath has reached a surface at |cos| `cos_theta`."""
    cos_theta = max(cos_theta, 1e-6)
    return Partial(partial.c * distance_squared / cos_theta, partial.e / cos_theta)


@function
def after_scatter(counts, partial, pdf_fwd, pdf_rev, cos_theta):
    """(1.19) at a vertex that can be connected and merged; `cos_theta` is that of the direction left in."""
    e = cos_theta / pdf_fwd * bracket(counts, partial, pdf_rev)
    return Partial(counts.vc / pdf_fwd, e)


@function
def after_delta(partial, cos_theta_in, eta):
    """(1.19) at a delta lobe, with the exact factor (1.24): `cos_theta_in` undoes the division on arrival.

    `eta` is n on the side left into over n on the side arrived from; the lobe's probability is the same both ways.
    """
    return Partial(0.0, partial.e * cos_theta_in / (eta * eta))


@function
def partial_after(counts, partial, step, surface, survival, cos_in):
    """C and E after a step (`Scattered`), survival of roulette included in its densities."""
    if step.is_delta:
        return after_delta(partial, cos_in, step.eta)
    cos_out = abs(dot(step.path.direction, surface.normal))
    return after_scatter(counts, partial, step.pdf_fwd * survival, step.pdf_rev * survival, cos_out)


@function
def bracket(counts, partial, pdf_rev):
    """B of (1.10), (1.12): what all other techniques on this side of the vertex do, given its reverse density."""
    return norm(counts.power, counts.vm_area, partial.c, pdf_rev * partial.e)


@function
def norm(power, x, y, z):
    """|| (x, y, z) ||_beta of (4.1), scaled by the largest so that no square overflows."""
    if power is None:
        return x + y + z
    largest = max(max(x, y), z)
    if largest == 0.0:
        return 0.0
    x, y, z = x / largest, y / largest, z / largest
    return largest * math.sqrt(x * x + y * y + z * z)


@function
def share(power, x, y, z):
    """x^beta / (x^beta + y^beta + z^beta)."""
    if power is None:
        return x / (x + y + z)
    y, z = y / x, z / x
    return 1.0 / (1.0 + y * y + z * z)


@function
def weight_of_connection(counts, density_at_light_vertex, light_bracket, density_at_eye_vertex, eye_bracket):
    """(1.13); densities are those of finding the one vertex by sampling from the other, per area."""
    light, eye = density_at_light_vertex * light_bracket, density_at_eye_vertex * eye_bracket
    return share(counts.power, counts.vc, light, eye)


@function
def weight_of_merge(counts, light_bracket, eye_bracket):
    """(1.14)."""
    return _merge_share(counts.power, counts.vm_area, light_bracket, eye_bracket)


@function
def _merge_share(power, area, light, eye):
    if power is None:
        return area / (light + eye - area)
    light, eye = light / area, eye / area
    return 1.0 / (light * light + eye * eye - 1.0)


@function
def weight_of_next_event(counts, hit_ratio, emission_ratio, eye_bracket):
    """(1.15): `hit_ratio` is p<_0 / pc_0, `emission_ratio` p>_0 p>_1 / pc_0."""
    return share(counts.power, counts.nee, counts.hit * hit_ratio, emission_ratio * eye_bracket)


@function
def weight_of_light_image(counts, camera_density, light_bracket, lens_ratio):
    """(1.16): `camera_density` is p<_{k-1} p<_k / pc_k, and `lens_ratio` p>_k / pc_k."""
    return share(counts.power, counts.lt, camera_density * light_bracket, _times(counts.lens, lens_ratio))


@function
def weight_of_lens_hit(counts, image_ratio, camera_density, partial):
    """(1.18): `image_ratio` is pc_k / p>_k, 0 where it cannot be; `camera_density` p<_k s<_k."""
    return share(counts.power, counts.lens, counts.lt * image_ratio, camera_density * partial.e)


@function
def eye_start(counts, camera_density, lens_area):
    """(1.11) before arrival at the first vertex.

    `camera_density` is that of the direction, sr^-1, `lens_area` the area of the lens times the cosine there.
    """
    return Partial(counts.lt / camera_density, _times(counts.lens, lens_area / camera_density))


@function
def _times(count, value):
    if count is None:
        return 0.0
    return count * value


@function
def weight_of_hit(counts, nee_ratio, emission_density, partial):
    """(1.17): `nee_ratio` is pc_0 / p<_0, 0 where it cannot be; `emission_density` p>_0 e."""
    return share(counts.power, counts.hit, counts.nee * nee_ratio, emission_density * partial.e)
