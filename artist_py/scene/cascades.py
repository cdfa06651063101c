"""What an image loses where light goes through more fluorescent events than its sets of wavelengths can carry.

With M sets, paths of M events or more use one of them twice, which gives a bias (theory 3.3). How large it is depends
on dyes, lamps and on what stands next to what. It is worked out as if all surfaces were lit alike, along chains of the
materials that a path meets: with all wavelengths at once, which is exact, and with sets of them, drawn at random. Both
agree but for the bias; only the part of M events or more is compared, so that chance has little to say.

First the scene's dyes are taken to line a closed room: hardly a scene loses more. Where that is too much, paths from
the eye say which materials really follow each other; they are traced without kernels, in some 300 us per edge.
"""

import math
from typing import NamedTuple

import numpy as np

from artist_py.cameras.perspective import camera_ray
from artist_py.core.frame import frame_around, to_world
from artist_py.core.vector import dot
from artist_py.core.warp import square_to_cosine_hemisphere
from artist_py.geometry.embree import INVALID_ID, closest_hit
from artist_py.geometry.surface import leave_surface, surface_at
from artist_py.scene import tables

TOLERANCE = 0.01  # share of the image's light that may be wrong
CERTAINTY = 3.0  # standard errors that a loss has to be above 0
DRAWS = 2048  # of all sets of wavelengths, at a time
MOST_TIMES = 8
WALKS = 128
LONGEST = 16  # surfaces of a chain
SEED = 1
NOWHERE = -1
BLAS_ROWS = (
    4  # with more rows a product of this size is shared by threads, which takes longer while others are busy
)
STRAIGHT = {tables.DIELECTRIC, tables.THIN_DIELECTRIC, tables.PASS_THROUGH}


class Surfaces(NamedTuple):
    """What materials do to light, bin by bin of 1 nm."""

    reflectance: np.ndarray  # (materials, bins)
    dyes: np.ndarray  # int (materials,): rows of `matrices`, or -1
    matrices: np.ndarray  # R, 1 / nm (dyes, bins out, bins in)


class Loss(NamedTuple):
    """Relative to all light of the image."""

    share: float  # of light that has been through too many events
    wrong: float  # how much the image is too bright
    error: float  # standard error of that

    @property
    def is_large(self):
        """Whether it can be seen, and is no chance."""
        return abs(self.wrong) > max(TOLERANCE, CERTAINTY * self.error)

    @property
    def may_be_large(self):
        """Whether it cannot be told to be small."""
        return abs(self.wrong) + CERTAINTY * self.error > TOLERANCE


class Light(NamedTuple):
    """What a chain of materials begins and ends with, and the sets of wavelengths of its paths."""

    emitted: np.ndarray  # power per nm of all emitters (bins,)
    seen: np.ndarray  # how the film answers (bins,)
    set_nodes: tuple  # inverse distribution of each set, nm
    count: int  # wavelengths of a set
    first: int  # nm, lower edge of bin 0


def loss_among_dyes(surfaces, light, edges):
    """A rough `Loss` of a closed room whose walls are the mean of all that fluoresces."""
    dyes = surfaces.dyes >= 0
    mean = Surfaces(
        surfaces.reflectance[dyes].mean(axis=0, keepdims=True),
        np.zeros(1, int),
        surfaces.matrices[surfaces.dyes[dyes]].mean(axis=0, keepdims=True),
    )
    return loss(mean, np.zeros((1, min(edges - 1, LONGEST)), int), light, 1)


def chains_of_image(scene, camera, resolution, edges):
    """Chains of materials that paths from the eye meet, int (chains, surfaces)."""
    rng = np.random.default_rng(SEED)
    length = min(edges - 1, LONGEST)
    chains = np.full((WALKS, length), NOWHERE)
    for chain in chains:
        found = _walk(scene, camera_ray(camera, *rng.random(2) * resolution, *rng.random(2)), length, rng)
        chain[: len(found)] = found
    return chains


def _walk(scene, ray, length, rng):
    """Materials that a path from the eye meets, as if all but mirrors and glass were matte."""
    _, origin, direction = ray
    chain = []
    for _ in range(2 * length):  # what is transparent does not count
        hit = closest_hit(scene.geometry.embree, origin, direction, math.inf)
        if hit.geometry == INVALID_ID or len(chain) == length:
            break
        surface = surface_at(scene.geometry, scene.needs, origin, direction, hit)
        kind = scene.materials[surface.material].kind
        if kind not in STRAIGHT:
            chain.append(surface.material)
            direction = _scattered(surface.shading_normal, direction, kind, rng)
        origin = leave_surface(surface, direction)
    return chain


def _scattered(normal, direction, kind, rng):
    cosine = dot(normal, direction)
    if kind in {tables.MIRROR, tables.CONDUCTOR}:
        return direction - normal * (2.0 * cosine)
    facing = normal * -1.0 if cosine > 0.0 else normal
    return to_world(frame_around(facing), square_to_cosine_hemisphere(*rng.random(2)))


def surfaces_of(scene, spectra, matrices):
    """`Surfaces` of a scene's materials; what is no plain reflectance counts as white."""
    materials = scene.materials.array
    reflectance = spectra[materials["reflectance"]].astype(float)
    is_plain = np.isin(materials["kind"], (tables.DIFFUSE, tables.OREN_NAYAR, tables.PLASTIC, tables.MIRROR))
    reflectance[~is_plain | (materials["texture"] >= 0)] = 1.0
    reflectance[materials["kind"] == tables.ABSORBER] = 0.0
    return Surfaces(reflectance, materials["fluorescence"], matrices)


# --- light along chains ---------------------------------------------------------------------------------------------


def loss(surfaces, chains, light, most_times=MOST_TIMES):
    """The `Loss` along chains of materials (chains, surfaces), from the eye on; they end at -1.

    At each surface the light of the lamps arrives, besides that of the next surface. Light that hardly any of the image
    is made of loses nothing that counts.
    """
    exact = _by_events(surfaces, chains, light)
    total = exact.sum()
    share = float(exact[-1] / total) if total > 0.0 else 0.0
    result, parts = Loss(share, 0.0, 0.0), []
    if share < TOLERANCE:
        return result
    rng = np.random.default_rng(SEED)
    for _ in range(most_times):
        parts.append(_with_sets(surfaces, chains, light, rng) / total)
        found = np.concatenate(parts)
        error = found.std(ddof=1) / math.sqrt(len(found))
        result = Loss(share, float(found.mean()) - share, float(error))
        if result.is_large or not result.may_be_large:
            break
    return result


def _by_events(surfaces, chains, light):
    """Mean light of all chains by number of events, the last for M and more (M + 1,)."""
    n_sets = len(light.set_nodes)
    importance = np.zeros((len(chains), n_sets + 1, len(light.seen)))
    importance[:, 0] = light.seen
    result = np.zeros(n_sets + 1)
    for materials in chains.T:
        importance = np.array([_scatter(surfaces, *each) for each in zip(materials, importance, strict=True)])
        result += (importance @ light.emitted).sum(axis=0)
    return result / len(chains)


def _scatter(surfaces, material, importance):
    """Importance (events, bins) of light that arrives, from that of light that leaves."""
    if material == NOWHERE or not importance.any():
        return np.zeros_like(importance)
    result = importance * surfaces.reflectance[material]
    dye = surfaces.dyes[material]
    if dye >= 0:
        parts = np.array_split(importance, -(-len(importance) // BLAS_ROWS))
        given_off = np.concatenate([part @ surfaces.matrices[dye] for part in parts])
        result[1:] += given_off[:-1]
        result[-1] += given_off[-1]
    return result


def _with_sets(surfaces, chains, light, rng):
    """The same with sets of wavelengths, M events and more, of all draws (n,); each chain comes equally often.

    What chains differ by counts as chance too, so that the error is rather too large.
    """
    n_sets, length = len(light.set_nodes), chains.shape[1]
    chains = np.tile(chains, (-(-DRAWS // len(chains)), 1))
    bins, weights = _draw_sets(light, len(chains), rng)
    # By events, since these say which set it is: importance at the wavelengths of set (events mod M).
    importance = np.zeros((length + 1, len(chains), light.count))
    importance[0] = light.seen[bins[0]] * weights[0]
    result = np.zeros(len(chains))
    for i, materials in enumerate(chains.T):
        _scatter_sets(surfaces, materials, importance[: i + 2], bins, weights)
        for events in range(n_sets, i + 2):
            result += (importance[events] * light.emitted[bins[events % n_sets]]).sum(axis=1)
    return result


def _scatter_sets(surfaces, materials, importance, bins, weights):
    """Change importance (events, chains, C) from that of light that leaves to that of light that arrives."""
    dyes = np.where(materials == NOWHERE, NOWHERE, surfaces.dyes[materials])
    glowing = np.flatnonzero(dyes >= 0)
    for events in reversed(range(len(importance))):
        into, weight = bins[events % len(bins)], weights[events % len(bins)]
        here = surfaces.reflectance[materials[:, None], into]
        importance[events] *= np.where(materials[:, None] == NOWHERE, 0.0, here)
        if events:
            out = bins[(events - 1) % len(bins)][glowing]
            rates = surfaces.matrices[dyes[glowing, None, None], out[:, :, None], into[glowing, None, :]]
            given_off = np.einsum("nj,njk->nk", importance[events - 1][glowing], rates)
            importance[events][glowing] += given_off * weight[glowing]


def _draw_sets(light, n, rng):
    """Bins and weights, nm, of n draws of all sets, (sets, n, C); offsets are stratified."""
    last = len(light.seen) - 1
    bins, weights = [], []
    for nodes in light.set_nodes:
        offsets = (rng.permutation(n) + rng.random(n)) / n
        entries = len(nodes) - 1
        position = (offsets[:, None] + np.arange(light.count)) / light.count * entries
        entry = np.minimum(position.astype(int), entries - 1)
        width = np.diff(nodes)[entry]
        wavelength = nodes[entry] + (position - entry) * width
        bins.append(np.clip((wavelength - light.first).astype(int), 0, last))
        weights.append(width * entries / light.count)
    return np.array(bins), np.array(weights)
