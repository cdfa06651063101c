"""Reflection and refraction at smooth interfaces: how much (Fresnel) and where (Snell).

`eta` is the relative index of refraction, transmitted side over incident side. All reflectances are of
unpolarised light, so that they are the same from both sides at the two refracted angles, and that walks may
use them as discrete probabilities that are equal in both directions (theory 1.7).
"""

import math

from ..jit import function
from .vector import maximum, reciprocal, splat, square_root, vec3

# Keeps 0 / 0 out of float32 lanes where a "metal" has the indices of its surroundings.
TINY = 1e-30


@function
def fresnel_dielectric(cos_theta_i, eta):
    """`(reflectance, cos_theta_t)` in [0, 1] for the incident cosine `cos_theta_i` >= 0; total reflection is (1, 0).

    With g = eta cos_theta_t the amplitudes' numerators are the differences of squares c^2 - g^2 = 1 - eta^2
    and eta^4 c^2 - g^2; in this form nothing cancels at grazing angles or where eta is nearly 1.
    Born and Wolf 1999, Principles of Optics, section 1.5.2.
    """
    eta_squared_minus_1 = (eta - 1.0) * (eta + 1.0)
    g_squared = eta_squared_minus_1 + cos_theta_i * cos_theta_i
    if g_squared <= 0.0:
        return 1.0, 0.0
    g = math.sqrt(g_squared)
    eta_squared = eta * eta
    s = 1.0 / (cos_theta_i + g)
    p = 1.0 / (eta_squared * cos_theta_i + g)
    r_s = eta_squared_minus_1 * s * s
    r_p = eta_squared_minus_1 * ((eta_squared + 1.0) * cos_theta_i * cos_theta_i - 1.0) * p * p
    return 0.5 * (r_s * r_s + r_p * r_p), min(g / eta, 1.0)


@function
def fresnel_dielectric_lanes(cos_theta_i, eta_squared_minus_1):
    """Reflectance of `fresnel_dielectric` for a spectrum of indices, given as eta^2 - 1 to spare float32 a difference.

    Where the reflection is total, g is 0 and the formula rises above 1.
    """
    cos_squared = cos_theta_i * cos_theta_i
    eta_squared = eta_squared_minus_1 + 1.0
    zero = splat(eta_squared_minus_1, 0.0)
    g = square_root(maximum(eta_squared_minus_1 + cos_squared, zero))
    s = reciprocal(g + cos_theta_i)
    p = reciprocal(eta_squared * cos_theta_i + g)
    r_s = eta_squared_minus_1 * s * s
    r_p = eta_squared_minus_1 * ((eta_squared + 1.0) * cos_squared - 1.0) * p * p
    return 1.0 - maximum(1.0 - 0.5 * (r_s * r_s + r_p * r_p), zero)


@function
def refract(w, eta, cos_theta_t):
    """Unit direction of the light that leaves on the other side of the interface from the local direction `w`.

    `w` and the result point away from the surface; `cos_theta_t` is that of `fresnel_dielectric`.
    """
    return vec3(-w.x / eta, -w.y / eta, -math.copysign(cos_theta_t, w.z))


@function
def slab_reflectance(reflectance):
    """Reflectance of a thin clear slab whose faces reflect `reflectance` each: R + T^2 R + T^2 R^3 + ..., T = 1 - R.

    Works for a number and for a spectrum. Stokes 1862, On the intensity of the light reflected from or
    transmitted through a pile of plates.
    """
    return 2.0 * reflectance / (1.0 + reflectance)


@function
def fresnel_conductor(cos_theta_i, eta, absorption):
    """Reflectance spectrum of a metal of the relative index `eta` + i `absorption`, for the cosine `cos_theta_i` > 0.

    a + i b is the square root of (eta + i absorption)^2 - sin^2. Half of |.| +- t0 is a^2 or b^2, but the lesser of the
    two would be a small difference of large numbers: it is taken from their product, and t0 separates them.
    Born and Wolf 1999, Principles of Optics, section 14.2.
    """
    cos_squared = cos_theta_i * cos_theta_i
    sin_squared = max(0.0, 1.0 - cos_squared)
    zero = splat(eta, 0.0)
    t0 = (eta - absorption) * (eta + absorption) - sin_squared
    t0_size = maximum(t0, -t0)
    product = eta * absorption
    product = product * product
    lesser = 2.0 * product / (square_root(t0 * t0 + 4.0 * product) + t0_size + TINY)
    b_squared = lesser + maximum(-t0, zero)
    a = square_root(lesser + maximum(t0, zero))
    r_s = _ratio(a, cos_theta_i, b_squared)
    return 0.5 * r_s * (1.0 + _ratio(a * cos_theta_i, sin_squared, b_squared * cos_squared))


@function
def _ratio(a, c, b_squared):
    """|a + i b - c|^2 / |a + i b + c|^2."""
    difference, total = a - c, a + c
    return (difference * difference + b_squared + TINY) / (total * total + b_squared + TINY)
