"""Orthonormal frames around a normal."""

import math
from typing import NamedTuple

from ..jit import function
from .vector import Vec3, dot, vec3


class Frame(NamedTuple):
    """Unit tangent, bitangent and normal; `z` of a local direction is its cosine with the normal."""

    tangent: Vec3
    bitangent: Vec3
    normal: Vec3


@function
def frame_around(normal):
    """A frame whose z axis is the unit vector `normal`. Duff et al. 2017, Building an Orthonormal Basis, Revisited."""
    sign = math.copysign(1.0, normal.z)
    a = -1.0 / (sign + normal.z)
    b = normal.x * normal.y * a
    return Frame(
        vec3(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        vec3(b, sign + normal.y * normal.y * a, -normal.y),
        normal,
    )


@function
def to_local(frame, w):
    """`w` in the frame."""
    return vec3(dot(w, frame.tangent), dot(w, frame.bitangent), dot(w, frame.normal))


@function
def to_world(frame, w):
    """`w`, given in the frame, in the space of the frame's axes."""
    return frame.tangent * w.x + frame.bitangent * w.y + frame.normal * w.z


@function
def length(v):
    """Euclidean length."""
    return math.sqrt(dot(v, v))


@function
def normalize(v):
    """`v` at unit length."""
    return v * (1.0 / math.sqrt(dot(v, v)))


@function
def reflect(w):
    """Mirror image of the local direction `w` about the normal."""
    return vec3(-w.x, -w.y, w.z)
