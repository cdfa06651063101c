"""A share of the light subpaths of an iteration, spread evenly over them: those that take part in a technique."""

import math
from typing import NamedTuple

from ..jit import function


class Share(NamedTuple):
    """Of `share` (0 to 1) of all subpaths in their order; absent where it is all of them.

    `offset` in [0, 1) is uniformly distributed over iterations: then every subpath is chosen with probability `share`.
    """

    share: float
    offset: float


class Chosen(NamedTuple):
    """Which light subpaths are connected, splatted and put into the photon map; `None` for all."""

    connect: Share | None
    light_image: Share | None
    merge: Share | None


@function
def is_chosen(share, index):
    """Whether subpath `index` takes part: wherever index * share + offset passes a whole number."""
    if share is None:
        return True
    before = math.floor(index * share.share + share.offset)
    return math.floor((index + 1) * share.share + share.offset) > before


@function
def is_vertex_wanted(chosen, index):
    """Whether the vertices of subpath `index` are connected or merged."""
    return is_chosen(chosen.connect, index) or is_chosen(chosen.merge, index)
