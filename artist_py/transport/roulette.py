"""Ending paths: by length, where they are black, and by Russian roulette (Arvo and Kirk 1990)."""

from typing import NamedTuple

from ..bsdf.dispatch import survival_bsdf
from ..bsdf.fluorescence import brightness
from ..core.rng import random_number
from ..core.vector import lane_sum
from ..jit import function
from .subpath import Path, with_throughput


class Limits(NamedTuple):
    """How long paths may get, in edges."""

    max_length: int
    roulette_length: int  # longer paths may be ended by Russian roulette
    ends_black: bool | None = True  # absent where a path also stands for other wavelengths than its own


@function
def brings_nothing(ends_black, throughput):
    """Whether a path ends since it brings nothing at any of its wavelengths, nor will further along.

    A sum and not the largest lane, which passes over what is no number: that has to be found, and is not black.
    """
    if ends_black is None:
        return False
    return lane_sum(throughput) == 0.0


@function
def is_spent(ends_black, path):
    """Whether nothing is left of a path that has been scattered."""
    return path.is_absorbed or brings_nothing(ends_black, path.throughput)


@function
def survival_probability(fluorescence, limits, length, path):
    """Probability that `path`, about to get its edge number `length`, goes on.

    It depends on the throughput and so stays out of all MIS weights (theory 1.8). The n^2 that refraction has put into
    the throughput is taken out again, since it will leave with the medium. Survival may be certain: a limit below the
    albedo would make the weights of long paths grow without bound, and lossless paths end at the maximal length.
    """
    if length <= limits.roulette_length:
        return 1.0
    return min(1.0, brightness(fluorescence, path.throughput) * path.radiance_scale)


@function
def is_ended_by_roulette(fluorescence, limits, stream, length, path):
    """Whether the path ends here."""
    survival = survival_probability(fluorescence, limits, length, path)
    return survival < 1.0 and random_number(stream, length) >= survival


@function
def after_roulette(fluorescence, limits, length, path):
    """The path that survived, its throughput made up for those that did not."""
    survival = survival_probability(fluorescence, limits, length, path)
    return with_throughput(path, path.throughput * (1.0 / survival))


@function
def local_survival(scene, vertex, wavelengths):
    """Probability that a subpath goes on at a vertex: its reflectance, the same from both sides (theory 1.8).

    Unlike the throughput it may therefore be part of the densities that weights compare.
    """
    material = scene.materials[vertex.surface.material]
    return _local_survival(scene.fluorescence, scene, material, vertex.reflectance, wavelengths)


@function
def _local_survival(fluorescence, scene, material, reflectance, wavelengths):
    elastic = survival_bsdf(scene.needs, material, reflectance, scene.spectra, wavelengths)
    if fluorescence is None:
        return elastic
    return elastic if material.fluorescence < 0 else fluorescence.survival[material.fluorescence]


@function
def survived(path, survival):
    """The path that `local_survival` has spared; the density of its direction now holds the survival."""
    return Path(
        path.origin,
        path.direction,
        path.throughput * (1.0 / survival),
        path.pdf_solid_angle * survival,
        path.reference,
        path.radiance_scale,
        path.ratio,
        path.media,
        False,
    )
