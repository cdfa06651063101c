"""Maps of the unit square to directions and shapes, with their densities."""

import math

from ..jit import function
from .vector import vec3

INV_PI = 1.0 / math.pi


@function
def cos_sin_octant(x):
    """`(cos x, sin x)` for |x| <= pi / 4, to 1e-11: Taylor's series, with no branch and no call."""
    y = x * x
    cosine = 1.0 / 479001600.0
    cosine = cosine * y - 1.0 / 3628800.0
    cosine = cosine * y + 1.0 / 40320.0
    cosine = cosine * y - 1.0 / 720.0
    cosine = cosine * y + 1.0 / 24.0
    cosine = cosine * y - 0.5
    sine = -1.0 / 39916800.0
    sine = sine * y + 1.0 / 362880.0
    sine = sine * y - 1.0 / 5040.0
    sine = sine * y + 1.0 / 120.0
    sine = sine * y - 1.0 / 6.0
    return cosine * y + 1.0, (sine * y + 1.0) * x


@function
def square_to_disk(u, v):
    """Point (x, y) of the unit disk, uniform; concentric map of Shirley and Chiu 1997."""
    a = 2.0 * u - 1.0
    b = 2.0 * v - 1.0
    # Written without branches: they would be taken at random.
    is_wide = abs(a) > abs(b)
    radius = a if is_wide else b
    other = b if is_wide else a
    cosine, sine = cos_sin_octant(0.25 * math.pi * other / (radius if radius != 0.0 else 1.0))
    along, across = radius * cosine, radius * sine
    return along if is_wide else across, across if is_wide else along


@function
def square_to_cosine_hemisphere(u, v):
    """Local direction with density cos / pi per solid angle (Malley's method)."""
    x, y = square_to_disk(u, v)
    return vec3(x, y, math.sqrt(max(0.0, 1.0 - x * x - y * y)))


@function
def square_to_power_cosine(u, v, n):
    """Local direction with density (n + 1) / (2 pi) cos^n per solid angle, n >= 0.

    The logarithm of the cosine keeps narrow lobes exact where the cosine itself would round to 1.
    """
    log_cos = math.log1p(-u) / (n + 1.0)
    sin_theta = math.sqrt(-math.expm1(2.0 * log_cos))
    angle = 2.0 * math.pi * v
    return vec3(sin_theta * math.cos(angle), sin_theta * math.sin(angle), math.exp(log_cos))


@function
def square_to_sphere(u, v):
    """Unit direction, uniform: density 1 / (4 pi) per solid angle."""
    z = 1.0 - 2.0 * u
    radius = math.sqrt(max(0.0, 1.0 - z * z))
    angle = 2.0 * math.pi * v
    return vec3(radius * math.cos(angle), radius * math.sin(angle), z)


@function
def square_to_triangle(u, v):
    """Barycentric weights (b1, b2) of a uniform point; the fold of Heitz 2019 keeps nearby points near."""
    if v > u:
        b1 = 0.5 * u
        return b1, v - b1
    b2 = 0.5 * v
    return u - b2, b2


@function
def square_to_cone(u, v, one_minus_cos_max):
    """Local direction within the cone around z, uniform: density 1 / (2 pi (1 - cos_max)).

    Taking 1 - cos keeps narrow cones exact where the cosine itself would round to 1.
    """
    one_minus_cos = u * one_minus_cos_max
    sin_theta = math.sqrt(max(0.0, one_minus_cos * (2.0 - one_minus_cos)))
    angle = 2.0 * math.pi * v
    return vec3(sin_theta * math.cos(angle), sin_theta * math.sin(angle), 1.0 - one_minus_cos)
