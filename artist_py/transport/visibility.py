"""Shadow rays."""

from ..geometry.embree import is_occluded
from ..geometry.surface import leave_surface, offset_position
from ..jit import function


@function
def is_blocked(scene, surface, towards, position, normal, extent):
    """Whether something stands between `surface` and `position`, which lies in the unit direction `towards`.

    The ray ends before what lies at `position`, on whose surface `normal` stands; see `offset_position`.
    """
    start = leave_surface(surface, towards)
    end = offset_position(position, normal, max(extent, surface.extent), -towards)
    return is_occluded(scene.geometry.embree, start, end - start, 1.0)
