"""Fluorescence: light absorbed at one wavelength and given off at longer ones, in all techniques (theory 3).

Every subpath of an iteration has the same M sets of wavelengths, and every fluorescent event leads from set m + 1, as
light travels, to set m; the sensor looks at set 0. Light subpaths and radiance carry all sets at once, eye subpaths
the matrix from all of them to set 0 (core/sets.py). So where two subpaths meet nothing needs to be matched.

A fluorescent material is one that reflects elastically, and besides has a matrix of reradiation between each two
sets. `fluorescence` is `Scene.fluorescence`: `None`, and nothing of this compiled, where no material fluoresces.
Under a clear coat (plastic.py) the matrix holds all that happens below it, and the coat's transmittances are put to it
here; what the coat mirrors stays at its wavelength.
"""

from ..core.sets import first_lanes, from_next_set, from_previous_set, received, row_of
from ..core.vector import lane_max, splat
from ..core.warp import INV_PI
from ..jit import function
from ..scene.tables import PLASTIC
from .dispatch import is_black
from .plastic import coat_reflectance, through


@function
def reradiation_factor(fluorescence, needs, material, wo, wi):
    """f_fl of (3.1), what reradiation is multiplied by for these directions, sr^-1; 0 if nothing fluoresces."""
    if fluorescence is None:
        return 0.0
    if material.fluorescence < 0 or wo.z * wi.z <= 0.0 or is_black(needs.one_sided, material, wo):
        return 0.0
    return INV_PI * _through_coat(needs.coated_dyes, material, wo, wi)


@function
def _through_coat(needed, material, wo, wi):
    """T(wo) T(wi) / T_m of the coat (plastic.py), 1 where there is none."""
    if needed is None:
        return 1.0
    if material.kind != PLASTIC:
        return 1.0
    return _transmitted(material, wo, wi)


@function
def _transmitted(material, wo, wi):
    return through(material, coat_reflectance(material, wo), coat_reflectance(material, wi))


@function
def scattered_light(fluorescence, material, light, f, factor):
    """`light` at all wavelengths after it has been scattered: (3.2), with the elastic part f and f_fl `factor`."""
    elastic = light * f
    if fluorescence is None:
        return elastic
    if factor == 0.0:
        return elastic
    return elastic + reradiated(fluorescence, material, light) * factor


@function
def joined_light(fluorescence, light, first_material, first, second_material, second):
    """`light` scattered at the first vertex and then the second; `first` and `second` are each a `Scattering`."""
    between = scattered_light(fluorescence, first_material, light, first.f_cos, first.glow)
    return scattered_light(fluorescence, second_material, between, second.f_cos, second.glow)


@function
def throughput_after(fluorescence, needs, material, throughput, elastic, sample, wo, light_walk):
    """Throughput after a sampled step, of a light subpath (3.2) or, with `light_walk` `None`, an eye subpath (3.3).

    `elastic` is what it would be without fluorescence.
    """
    if fluorescence is None:
        return elastic
    if material.fluorescence < 0 or sample.is_delta or not sample.pdf > 0.0:
        return elastic
    factor = reradiation_factor(fluorescence, needs, material, wo, sample.wi) * abs(sample.wi.z) / sample.pdf
    return elastic + _onwards(light_walk, fluorescence, material, throughput) * factor


@function
def ratio_after(fluorescence, material, sample):
    """r of (2.6) after a sampled step: the hero is drawn anew where all wavelengths mix (theory 3.7)."""
    if fluorescence is None:
        return sample.ratio
    return _new_ratio(sample.ratio, material, sample.is_delta)


@function
def _new_ratio(ratio, material, is_delta):
    if ratio is None:
        return ratio
    return ratio if material.fluorescence < 0 or is_delta else splat(ratio, 1.0)


@function
def _onwards(light_walk, fluorescence, material, throughput):
    if light_walk is None:
        coefficients = row_of(fluorescence.towards_light, material.fluorescence, fluorescence.matrix)
        return from_previous_set(coefficients, throughput, fluorescence.zero)
    return reradiated(fluorescence, material, throughput)


@function
def reradiated(fluorescence, material, light):
    """What `light` at all wavelengths makes the material give off, per f_fl: the sum of (3.2)."""
    coefficients = row_of(fluorescence.towards_eye, material.fluorescence, fluorescence.matrix)
    return from_next_set(coefficients, light, fluorescence.zero)


@function
def brightness(fluorescence, throughput):
    """The most that a path brings of light of radiance 1 at all wavelengths, for Russian roulette."""
    if fluorescence is None:
        return lane_max(throughput)
    return lane_max(received(fluorescence, throughput, splat(fluorescence.zero, 1.0)))


@function
def albedo_under_white(fluorescence, needs, material, reflectance, wo, like):
    """Radiance towards `wo` at the film's wavelengths of the material under light of 1 from everywhere.

    `reflectance` is what it reflects at its own wavelengths.
    """
    if fluorescence is None:
        return first_lanes(reflectance, like)
    white = splat(fluorescence.zero, 1.0)
    share = 0.0 if material.fluorescence < 0 else _leaving(needs.coated_dyes, material, wo)
    return first_lanes(scattered_light(fluorescence, material, white, reflectance, share), like)


@function
def _leaving(needed, material, wo):
    """Share of what is given off that comes out towards `wo`: the integral of pi f_fl cos over `wi`."""
    if needed is None:
        return 1.0
    return 1.0 if material.kind != PLASTIC else 1.0 - coat_reflectance(material, wo)
