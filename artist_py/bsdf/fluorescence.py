"""Fluorescence: light absorbed at one wavelength and given off at longer ones, in all techniques (theory 3).

Every subpath of an iteration has the same M sets of wavelengths, and every fluorescent event leads from set m + 1, as
light travels, to set m; the sensor looks at set 0. Light subpaths and radiance carry all sets at once, eye subpaths
the matrix from all of them to set 0 (core/sets.py). So where two subpaths meet nothing needs to be matched.

Which wavelengths are in set 0 is chance, and what is seen of a narrow emission band depends on it. But all that the
film gets of that band is known, so that a control variate can tell the two apart (theory 3.9, on the eye's side and for
the film's channels). Eye subpaths then carry what each channel gets instead of each wavelength, and subpaths a further
lane per channel. On the light's side it holds what the channel should get of all wavelengths less what it gets of those
of set 0, from where light comes to be there, be it emitted or given off by a dye of what it absorbs of set 1: a number
of mean zero. From there on this lane is scattered elastically with the mean of the material's spectrum over
wavelengths. On the eye's side it holds that scattering alone. It is one linear operator, the same in both directions,
so that all techniques still estimate the same and any MIS weights will do; and the more alike the wavelengths are
scattered the less of the chance is left. Images by wavelength do without.

A fluorescent material is one that reflects elastically, and besides has a matrix of reradiation between each two
sets. `fluorescence` is `Scene.fluorescence`: `None`, and nothing of this compiled, where no material fluoresces.
Under a clear coat (plastic.py) the matrix holds all that happens below it, and the coat's transmittances are put to it
here; what the coat mirrors stays at its wavelength.
"""

from ..core.sets import (
    diagonal,
    first_lanes,
    from_next_set,
    from_previous_set,
    lanes_after,
    placed,
    received,
    row_of,
    tiled,
    widened,
)
from ..core.vector import lane_max, maximum, splat
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
    return INV_PI * through_coat(needs.coated_dyes, material, wo, wi)


@function
def through_coat(needed, material, wo, wi):
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
    return _new_ratio(sample.ratio, fluorescence.ratio, material, sample.is_delta)


@function
def _new_ratio(ratio, anew, material, is_delta):
    if ratio is None:
        return ratio
    return ratio if material.fluorescence < 0 or is_delta else anew


@function
def _onwards(light_walk, fluorescence, material, throughput):
    if light_walk is None:
        return _importance(fluorescence, material, throughput)
    return reradiated(fluorescence, material, throughput)


@function
def _importance(fluorescence, material, throughput):
    """The sum of (3.3), of the matrix that an eye subpath carries."""
    coefficients = row_of(fluorescence.towards_light, material.fluorescence, fluorescence.coefficients)
    sums = from_previous_set(coefficients, first_lanes(throughput, fluorescence.rows), fluorescence.sets)
    result = widened(sums, fluorescence.matrix)
    return _with_controlled_importance(fluorescence.control, fluorescence, material, throughput, result)


@function
def _with_controlled_importance(control, fluorescence, material, throughput, result):
    if control is None:
        return result
    flat = diagonal(lanes_after(throughput, fluorescence.rows, control.block), control.colour)
    of_set_1 = row_of(control.table, material.fluorescence, control.matrix) * tiled(flat, control.matrix)
    return result + placed(of_set_1, control.matrix, fluorescence.matrix)


@function
def reradiated(fluorescence, material, light):
    """What `light` at all wavelengths makes the material give off, per f_fl: the sum of (3.2)."""
    coefficients = row_of(fluorescence.towards_eye, material.fluorescence, fluorescence.coefficients)
    sums = from_next_set(coefficients, first_lanes(light, fluorescence.sets), fluorescence.sets)
    result = widened(sums, fluorescence.zero)
    return _with_controlled_light(fluorescence.control, fluorescence, material, light, result)


@function
def _with_controlled_light(control, fluorescence, material, light, result):
    if control is None:
        return result
    of_set_1 = row_of(control.table, material.fluorescence, control.matrix)
    colour = received(control, of_set_1, lanes_after(light, control.set, control.set))
    return result + placed(colour, fluorescence.sets, fluorescence.zero)


@function
def brightness(fluorescence, throughput):
    """The most that a path brings of light of radiance 1 at all wavelengths, for Russian roulette."""
    if fluorescence is None:
        return lane_max(throughput)
    # Of absolute values: a channel of the film counts some wavelengths as negative.
    size = maximum(throughput, throughput * -1.0)
    by_wavelengths = received(fluorescence, size, fluorescence.white)
    by_control = received(fluorescence, size, fluorescence.colour)
    return lane_max(maximum(by_wavelengths, by_control) * fluorescence.unit)


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
