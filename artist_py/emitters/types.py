"""What sampling an emitter returns."""

from typing import NamedTuple

from ..core.vector import Vec3, vec3
from ..jit import function


class EmitterPoint(NamedTuple):
    """A point on an emitter as seen from a reference point.

    `pdf_solid_angle` is the density of its direction there, sr^-1, without the choice of the emitter; 0 where nothing
    was found.
    """

    position: Vec3
    normal: Vec3  # unit, on the emitting side; without a surface the way that light takes to the reference
    pdf_solid_angle: float
    extent: float  # see geometry/surface.py


class Emission(NamedTuple):
    """The start of a light subpath, and what weights need to know of it (theory 1.5).

    `density` is p>_0 s>_0 with the choice of the emitter: of position and direction together, or of direction and
    place on the disk for emitters at infinity.
    """

    position: Vec3
    normal: Vec3  # unit, on the side of `direction`; without a surface `direction` itself
    direction: Vec3  # unit
    density: float
    cos_theta: float  # of `direction` with `normal`; 1 where there is no surface
    can_be_hit: float  # 1, or 0 for emitters that eye subpaths cannot hit
    extent: float


@function
def no_emission():
    """Nothing emitted: density 0."""
    zero = vec3(0.0, 0.0, 0.0)
    return Emission(zero, zero, zero, 0.0, 1.0, 0.0, 0.0)
