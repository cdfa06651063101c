"""What every BSDF returns; all directions are unit, in the shading frame, and point away from the surface."""

from typing import NamedTuple

from ..core.vector import Spectrum, Vec3


class BsdfSample(NamedTuple):
    """A sampled direction.

    `weight` is f |cos| / density per wavelength. `pdf` is the lane mean of the density, sr^-1 (theory 2.5), or the
    discrete probability of a delta lobe. `eta` is the index of refraction on the side of `wi` over that on the side of
    `wo`. `ratio` is the running r of theory (2.6), `None` where no density depends on wavelength.
    A sample with `pdf` 0 is absorption.
    """

    wi: Vec3
    weight: Spectrum
    pdf: float
    eta: float
    is_delta: bool
    ratio: Spectrum | None
