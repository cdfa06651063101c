"""Emitters at infinity: directional light, suns, and environments as far as they are alike.

A point on them is a direction. Light subpaths start on a disk around the scene, perpendicular to the direction; what
other emitters have as a density of directions is here the density 1 / area of places on that disk (theory 1.5).
Directional light takes part as if it came from a solid angle of 1 with density 1; both cancel, and its irradiance,
W m^-2 nm^-1, takes the place of the radiance.
"""

import math

from ..core.affine import load_vec3
from ..core.frame import frame_around, to_world
from ..core.vector import dot, vec3
from ..core.warp import square_to_cone, square_to_disk
from ..jit import function
from ..scene.tables import ENVIRONMENT_EMITTER, SUN_EMITTER
from .environment import pdf_environment, sample_environment
from .types import Emission, EmitterPoint

BEYOND_THE_SCENE = 4.0  # in radii of the scene; two would be enough


@function
def sample_infinite(scene, emitter, reference, u, v):
    """A point far away in a direction that the emitter shines from; its `normal` is the way that light takes."""
    towards = sample_towards(scene, emitter, u, v)
    position = reference + towards * (BEYOND_THE_SCENE * emitter.radius)
    return EmitterPoint(position, -towards, pdf_towards(scene, emitter, towards), 0.0)


@function
def sample_towards(scene, emitter, u, v):
    """Unit direction towards the emitter."""
    if emitter.kind == ENVIRONMENT_EMITTER:
        return sample_environment(scene.needs.environments, scene, emitter, u, v)
    return _sample_distant(scene.needs.distant_emitters, emitter, u, v)


@function
def _sample_distant(needed, emitter, u, v):
    axis = load_vec3(emitter.normal)
    if needed is None:
        return axis
    if emitter.kind == SUN_EMITTER:
        return to_world(frame_around(axis), square_to_cone(u, v, emitter.cone))
    return axis


@function
def pdf_towards(scene, emitter, towards):
    """Density of `sample_towards`, sr^-1, without the choice of the emitter; 1 for directional light."""
    if emitter.kind == ENVIRONMENT_EMITTER:
        return pdf_environment(scene.needs.environments, scene, emitter, towards)
    return _pdf_distant(scene.needs.distant_emitters, emitter)


@function
def _pdf_distant(needed, emitter):
    if needed is None:
        return 1.0
    return 1.0 / (2.0 * math.pi * emitter.cone) if emitter.kind == SUN_EMITTER else 1.0


@function
def emit_from_infinity(scene, emitter, u, v, u_direction, v_direction):
    """A start on the disk of the scene, (u, v), perpendicular to a direction; `Emission`."""
    towards = sample_towards(scene, emitter, u_direction, v_direction)
    x, y = square_to_disk(u, v)
    position = to_world(frame_around(towards), vec3(x, y, 1.0)) * emitter.radius
    density = pdf_towards(scene, emitter, towards) * emitter.pdf_select / emitter.area
    can_be_hit = 1.0 if emitter.kind >= SUN_EMITTER else 0.0
    return Emission(position, -towards, -towards, density, 1.0, can_be_hit, 0.0)


@function
def is_in_background(emitter, towards):
    """Whether a ray that leaves the scene in the direction `towards` finds the emitter, a sun or an environment."""
    if emitter.kind == ENVIRONMENT_EMITTER:
        return True
    off_axis = towards - load_vec3(emitter.normal)
    return 0.5 * dot(off_axis, off_axis) <= emitter.cone
