"""Fluorescence by shifting wavelengths: each path has its own, and at a fluorescent event they change.

So fluorescence was rendered before sets of wavelengths (bsdf/fluorescence.py) made it a matter of all wavelengths at
once; here it is for comparison, and for scenes without it nothing of it is compiled.

A path that arrives at a fluorescent surface is scattered either elastically or by a dye, by chance in proportion to
what either would bring. Where a dye did it the wavelength is drawn anew: of an eye subpath, whose outgoing wavelength
is known, that of the excitation, in proportion to R(out, in) over `in`; of a light subpath that of the emission, in
proportion to R(out, in) over `out` (Mojzik et al. 2018; theory 3.1). Either way the surface then scatters like a
diffuse one whose reflectance is the sum of both parts, and the walk goes on as always. Of the several wavelengths of
an eye subpath each shifts for itself: directions do not depend on it. Under a clear coat (bsdf/plastic.py) the sum is
that of what comes out again of light that has entered, and a walk that the coat mirrors leaves as it came.

Light subpaths of different wavelengths meet eye subpaths by merges within a tolerance d. A photon is a power P at a
wavelength l', and stands for a power per nm of P / w at all wavelengths l with |l - l'| <= d, where w is how much of
the rendered range lies within d of l: a constant spectrum stays what it is, near the ends of the range too. What a dye
makes of a photon needs no tolerance: R(l, l') is evaluated as it stands.
"""

from typing import NamedTuple

from ..bsdf.fluorescence import through_coat
from ..bsdf.plastic import base_below, colour_below
from ..core.rng import random_number, random_pair
from ..core.spectra import ONE_MINUS
from ..core.vector import lane, lane_count, with_lane
from ..core.warp import INV_PI
from ..core.wavelengths import sample_wavelengths
from ..emitters.environment import first_above
from ..jit import function
from ..scene.tables import PLASTIC
from .subpath import Vertex

WAVELENGTH = (
    2  # the pair of random dimensions that places the path's wavelengths, and draws for its first vertex
)
SHIFT = 1 << 21  # single random numbers of later vertices, see core/rng.py
INSIDE = 0.9999  # of a bin: what is drawn in it may be rounded to float32, and still lie in it


class Matching(NamedTuple):
    """Which photons an eye vertex accepts, by wavelength."""

    tolerance: float  # d, nm
    first: float  # nm, the ends of the rendered range
    last: float


# --- walks


@function
def shifted_back(excitation, needs, material, vertex, wavelengths, stream, length):
    """`(vertex, wavelengths)` of an eye subpath that is scattered at its vertex number `length`.

    The reflectance of the vertex is then that of the wavelengths it is left with, at which light arrives.
    """
    if excitation is None:
        return vertex, wavelengths
    return _shifted(excitation, needs.coated_dyes, material, vertex, wavelengths, stream, length)


@function
def shifted_onwards(reemission, needs, material, vertex, wavelengths, stream, length):
    """The same of a light subpath: the wavelengths are those at which light leaves."""
    if reemission is None:
        return vertex, wavelengths
    return _shifted(reemission.emission, needs.coated_dyes, material, vertex, wavelengths, stream, length)


@function
def _shifted(redistribution, coated_dyes, material, vertex, wavelengths, stream, length):
    if material.fluorescence < 0:
        return vertex, wavelengths
    u = random_number(stream, SHIFT + length) if length > 1 else random_pair(stream, WAVELENGTH)[1]
    count, scattered = lane_count(wavelengths), _below_coat(coated_dyes, material, vertex.reflectance)
    for i in range(count):
        # Evenly spread over the lanes, and uniformly distributed in each.
        number = u + i / count
        number -= 1.0 if number >= 1.0 else 0.0
        wavelength, total = redistributed(
            redistribution,
            material.fluorescence,
            float(lane(wavelengths, i)),
            float(lane(scattered, i)),
            number,
        )
        wavelengths, scattered = with_lane(wavelengths, i, wavelength), with_lane(scattered, i, total)
    reflectance = _reflectance_of(coated_dyes, material, scattered)
    return Vertex(vertex.surface, vertex.frame, vertex.wo, vertex.is_sampled_back, reflectance), wavelengths


@function
def _below_coat(needed, material, reflectance):
    """Share of the light that arrives, or that has entered the coat, that is scattered at its wavelength."""
    if needed is None:
        return reflectance
    return colour_below(material, reflectance) if material.kind == PLASTIC else reflectance


@function
def _reflectance_of(needed, material, scattered):
    """The reflectance of a material of which `_below_coat` says `scattered`."""
    if needed is None:
        return scattered
    return base_below(material, scattered) if material.kind == PLASTIC else scattered


@function
def unless_mirrored(redistribution, needs, wavelengths, arrived, is_delta):
    """The `wavelengths` of a vertex for the walk beyond it, or those it `arrived` with where the coat mirrored it."""
    if redistribution is None:
        return wavelengths
    return _unless_mirrored(needs.coated_dyes, wavelengths, arrived, is_delta)


@function
def _unless_mirrored(needed, wavelengths, arrived, is_delta):
    if needed is None:
        return wavelengths
    return arrived if is_delta else wavelengths


@function
def redistributed(redistribution, row, wavelength, elastic, u):
    """`(wavelength, total)`: where a wavelength (nm) is led to, and what is scattered in all, `elastic` included.

    `u` is uniform in [0, 1): one number decides whether and where to.
    """
    own = _bin_of(redistribution, wavelength)
    glow = float(redistribution.totals[row, own])
    total = elastic + glow
    if not u * total < glow:
        return wavelength, total
    u = min(u * total / glow, ONE_MINUS)
    shares, bins = redistribution.shares, redistribution.totals.shape[1]
    first = (row * bins + own) * bins
    reached = first_above(shares, first, bins, u)
    below = float(shares[first + reached - 1]) if reached > 0 else 0.0
    fraction = (u - below) / (float(shares[first + reached]) - below)
    return redistribution.first + reached + min(fraction, INSIDE), total


@function
def _bin_of(redistribution, wavelength):
    return min(max(int(wavelength - redistribution.first), 0), redistribution.totals.shape[1] - 1)


# --- photons


@function
def wavelengths_of_light(reemission, wavelengths, stream):
    """`(wavelengths, weights)` of a light subpath: those of its eye subpath and `None`, or its own and 1 / p, nm."""
    if reemission is None:
        return wavelengths, None
    return sample_wavelengths(reemission.nodes, wavelengths, random_pair(stream, WAVELENGTH)[0])


@function
def as_power(weights, throughput):
    """Throughput per nm as the power that the subpath's wavelengths stand for, where it has its own."""
    if weights is None:
        return throughput
    return throughput * weights


@function
def keep_wavelength(reemission, pool, thread, wavelengths):
    """Keep with the vertex that `thread` has just stored at which wavelength light arrives."""
    if reemission is None:
        return
    pool.records[pool.ends[thread, 0] - 1].wavelength = lane(wavelengths, 0)


@function
def note_wavelength(with_wavelength, record, photon):
    """Copy the wavelength of a stored vertex, where it has one of its own."""
    if with_wavelength is None:
        return
    photon.wavelength = record.wavelength


@function
def is_unmatched(matching, material, photon, wavelengths):
    """Whether a photon's wavelength rules it out."""
    if matching is None:
        return False
    return material.fluorescence < 0 and not _is_within(matching, photon, float(lane(wavelengths, 0)))


@function
def _is_within(matching, photon, wavelength):
    return abs(float(photon.wavelength) - wavelength) <= matching.tolerance


@function
def of_power(matching, reemission, needs, material, photon, wavelengths, f, wo, wi):
    """`f` for the photon's throughput: itself, or per nm where that is a power at a wavelength of its own."""
    if matching is None:
        return f
    return _of_power(matching, reemission, needs, material, photon, wavelengths, f, wo, wi)


@function
def _of_power(matching, reemission, needs, material, photon, wavelengths, f, wo, wi):
    wavelength, tolerance = float(lane(wavelengths, 0)), matching.tolerance
    accepted = min(wavelength + tolerance, matching.last) - max(wavelength - tolerance, matching.first)
    f = f * (1.0 / accepted if _is_within(matching, photon, wavelength) else 0.0)
    if material.fluorescence < 0:
        return f
    out, into = (
        _bin_of(reemission.emission, wavelength),
        _bin_of(reemission.emission, float(photon.wavelength)),
    )
    factor = INV_PI * through_coat(needs.coated_dyes, material, wo, wi)
    return f + with_lane(f, 0, factor * reemission.matrix[material.fluorescence, out, into])
