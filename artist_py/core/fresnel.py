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

    a + i b is the square root of (eta + i absorption)^2 - sin^2. a^2 is half of |.| + t0, which for metals
    would be a small difference of large numbers; where t0 < 0 it is therefore taken as 2 (eta absorption)^2 /
    (|.| - t0).
    Born and Wolf 1999, Principles of Optics, section 14.2.
    """
    cos_squared = cos_theta_i * cos_theta_i
    sin_squared = max(0.0, 1.0 - cos_squared)
    product = eta * absorption
    t0 = (eta - absorption) * (eta + absorption) - sin_squared
    t0_positive = maximum(t0, splat(t0, 0.0))
    t0_size = t0_positive * 2.0 - t0
    size = square_root(t0 * t0 + 4.0 * product * product)
    a_squared = t0_positive + 2.0 * product * product / (size + t0_size + TINY)
    two_a_cos = 2.0 * cos_theta_i * square_root(a_squared)
    r_s = (size + cos_squared - two_a_cos) / (size + cos_squared + two_a_cos + TINY)
    p_even = cos_squared * size + sin_squared * sin_squared
    p_odd = two_a_cos * sin_squared
    return 0.5 * r_s * (1.0 + (p_even - p_odd) / (p_even + p_odd + TINY))
