"""What every BSDF returns; all directions are unit, in the shading frame, and point away from the surface.

Every kind has `sample_*`, `evaluate_*`, `pdf_*` and `reflectance_*` of the same arguments; `reflectance` is that of
the material at the point (reflectance.py), and kinds without one do not look at it. Kinds that only
reflect see `wo` above the surface (`dispatch.py` turns the other side over), kinds that transmit see either
side.
"""

from typing import NamedTuple

from ..core.spectra import black
from ..core.vector import Spectrum, Vec3
from ..jit import function


class BsdfSample(NamedTuple):
    """A sampled direction.

    `weight` is f |cos| / density per wavelength. `pdf` is the lane mean of the density, sr^-1 (theory 2.5),
    or the discrete probability of a delta lobe; `pdf_rev` is the same for the walk that comes along `wi` and
    leaves along `wo`. `eta` is the index of refraction on the side of `wi` over that on the side of `wo`.
    `ratio` is the running r of theory (2.6), `None` where no density depends on wavelength. A sample with
    `pdf` 0 is absorption.
    """

    wi: Vec3
    weight: Spectrum
    pdf: float
    pdf_rev: float
    eta: float
    is_delta: bool
    ratio: Spectrum | None


@function
def absorption(wo, wavelengths, ratio):
    """The sample of a surface that scatters nothing."""
    return BsdfSample(wo, black(wavelengths), 0.0, 0.0, 1.0, True, ratio)


@function
def delta_sample(wi, weight, probability, eta, ratio):
    """The sample of a lobe of one direction; its discrete `probability` is the same for the reverse walk."""
    return BsdfSample(wi, weight, probability, probability, eta, True, ratio)


@function
def evaluate_delta(needed, material, reflectance, spectra, wavelengths, wo, wi):
    """f of a BSDF of delta lobes only: zero for any two given directions, sr^-1."""
    return black(wavelengths)


@function
def pdf_delta(needed, material, wo, wi):
    """Density per solid angle of a BSDF of delta lobes only: zero, sr^-1."""
    return 0.0
