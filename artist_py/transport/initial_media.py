"""Which dielectrics a point lies in: found once, by following a ray out of the scene."""

import math

from ..core.vector import dot
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import leave_surface, surface_at
from ..scene.tables import DIELECTRIC
from .media import enter_medium

MAX_CROSSINGS = 10_000


def media_at(scene, origin, direction):
    """State of media.py at `origin`: of the dielectrics that a ray leaves without entering, the first is innermost."""
    entered, left = [], []
    for _ in range(MAX_CROSSINGS):
        hit = closest_hit(scene.geometry.embree, origin, direction, math.inf)
        if hit.geometry == INVALID_ID:
            break
        surface = surface_at(scene.geometry, scene.needs, origin, direction, hit)
        material = scene.materials[surface.material]
        if material.kind == DIELECTRIC:
            medium = int(material.medium)
            if dot(direction, surface.normal) < 0.0:
                entered.append(medium)
            elif medium in entered:
                entered.remove(medium)
            else:
                left.append(medium)
        origin = leave_surface(surface, direction)
    media = 0
    for medium in reversed(left):
        media = enter_medium(media, medium)
    return media
