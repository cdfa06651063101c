"""What sampling an emitter returns."""

from typing import NamedTuple

from ..core.vector import Vec3


class EmitterPoint(NamedTuple):
    """A point on an emitter as seen from a reference point.

    `pdf_solid_angle` is the density of its direction there, sr^-1, without the choice of the emitter; 0 where nothing
    was found.
    """

    position: Vec3
    normal: Vec3  # unit, on the emitting side
    pdf_solid_angle: float
    extent: float  # see geometry/surface.py
