"""Fresnel's and Snell's equations against textbook values and against arithmetic of fifty digits."""

import cmath
import math
from decimal import Decimal, localcontext

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from artist_py.core.frame import length
from artist_py.core.fresnel import (
    fresnel_conductor,
    fresnel_dielectric,
    fresnel_dielectric_lanes,
    refract,
    slab_reflectance,
)
from artist_py.core.vector import Spectrum, Vec3, dot, lane
from artist_py.jit import kernel

INDICES = (1.31, 1.333, 1.5168, 2.417, 4.0, 1 / 1.5168, 1 / 2.417)


def textbook_reflectance(cos_theta_i, eta):
    """Fresnel's equations as they are printed, with fifty digits."""
    with localcontext() as context:
        context.prec = 50
        c, n = Decimal(cos_theta_i), Decimal(eta)
        cos_squared_t = 1 - (1 - c * c) / (n * n)
        if cos_squared_t <= 0:
            return 1.0
        t = cos_squared_t.sqrt()
        s = (c - n * t) / (c + n * t)
        p = (n * c - t) / (n * c + t)
        return float((s * s + p * p) / 2)


def complex_reflectance(cos_theta_i, eta, k):
    """The same with a complex index of refraction."""
    n = complex(eta, k)
    t = cmath.sqrt(1.0 - (1.0 - cos_theta_i**2) / (n * n))
    s = (cos_theta_i - n * t) / (cos_theta_i + n * t)
    p = (n * cos_theta_i - t) / (n * cos_theta_i + t)
    return 0.5 * (abs(s) ** 2 + abs(p) ** 2)


class TestDielectric:
    """Reflectance between two clear media."""

    @pytest.mark.parametrize("eta", INDICES)
    def test_normal_incidence(self, eta):
        reflectance, cos_theta_t = fresnel_dielectric(1.0, eta)
        assert reflectance == pytest.approx(((eta - 1.0) / (eta + 1.0)) ** 2, rel=1e-12)
        assert cos_theta_t == 1.0

    @pytest.mark.parametrize("eta", INDICES)
    def test_at_brewsters_angle_only_perpendicular_light_is_reflected(self, eta):
        reflectance, cos_theta_t = fresnel_dielectric(math.cos(math.atan(eta)), eta)
        assert reflectance == pytest.approx(0.5 * ((eta**2 - 1.0) / (eta**2 + 1.0)) ** 2, rel=1e-12)
        assert math.acos(cos_theta_t) == pytest.approx(math.pi / 2 - math.atan(eta), rel=1e-9)

    def test_total_reflection_starts_at_the_critical_angle(self):
        critical = math.asin(1.0 / 1.5)
        assert fresnel_dielectric(math.cos(critical + 1e-9), 1.0 / 1.5) == (1.0, 0.0)
        below, cos_theta_t = fresnel_dielectric(math.cos(critical - 1e-9), 1.0 / 1.5)
        assert 0.9997 < below < 1.0
        assert cos_theta_t > 0.0

    @pytest.mark.parametrize("eta", [*INDICES, 1.0 + 1e-7, 1.0 - 1e-7, 1.0 + 1e-12, 0.2, 10.0])
    @pytest.mark.parametrize("cos_theta_i", [1.0, 0.9, 0.5, 0.1, 1e-2, 1e-3, 1e-6, 1e-9])
    def test_fifty_digits_agree_to_twelve(self, cos_theta_i, eta):
        # eta itself is stored to 1e-16, which is all that is known of eta - 1.
        reflectance, _ = fresnel_dielectric(cos_theta_i, eta)
        assert reflectance == pytest.approx(textbook_reflectance(cos_theta_i, eta), rel=1e-12)

    def test_grazing_light_is_reflected_from_either_side(self):
        assert fresnel_dielectric(0.0, 1.5)[0] == pytest.approx(1.0)
        assert fresnel_dielectric(0.0, 1.0 / 1.5)[0] == 1.0

    def test_equal_media_reflect_nothing(self):
        for cos_theta_i in (1.0, 0.5, 1e-9):
            assert fresnel_dielectric(cos_theta_i, 1.0) == (0.0, pytest.approx(cos_theta_i))

    @settings(derandomize=True, deadline=None)
    @given(st.floats(0.0, 1.0), st.floats(0.2, 5.0))
    def test_reflectance_is_the_same_from_the_other_side(self, cos_theta_i, eta):
        reflectance, cos_theta_t = fresnel_dielectric(cos_theta_i, eta)
        assert 0.0 <= reflectance <= 1.0 + 1e-12
        if cos_theta_t > 1e-6:
            back, cos_back = fresnel_dielectric(cos_theta_t, 1.0 / eta)
            # Near the critical angle the reflectance follows the root of what rounding leaves of cos_theta_t.
            assert back == pytest.approx(reflectance, abs=1e-6)
            assert cos_back == pytest.approx(cos_theta_i, abs=1e-6)

    def test_lanes_agree_with_the_scalar(self):
        for cos_theta_i in np.linspace(0.0, 1.0, 101):
            for etas in (INDICES[:4], INDICES[3:], (1.5, 1.51, 1.52, 1 / 1.5)):
                expected = [fresnel_dielectric(cos_theta_i, eta)[0] for eta in etas]
                lanes = fresnel_dielectric_lanes(cos_theta_i, Spectrum([eta**2 - 1.0 for eta in etas]))
                np.testing.assert_allclose(lanes, expected, atol=2e-6)


class TestRefraction:
    """Directions beyond an interface, and panes of two interfaces."""

    def test_thirty_degrees_in_water(self):
        """Snell: asin(0.5 / 1.333) = 22.03 degrees."""
        angle = math.radians(30.0)
        _, cos_theta_t = fresnel_dielectric(math.cos(angle), 1.333)
        wi = refract(Vec3((math.sin(angle), 0.0, math.cos(angle))), 1.333, cos_theta_t)
        assert math.degrees(math.atan2(-wi.x, -wi.z)) == pytest.approx(22.03, abs=0.005)

    @settings(derandomize=True, deadline=None)
    @given(
        st.floats(0.0, 1.0), st.floats(0.0, 2 * math.pi), st.floats(0.3, 3.0), st.sampled_from((-1.0, 1.0))
    )
    def test_direction_is_unit_coplanar_on_the_other_side_and_reversible(self, cosine, azimuth, eta, side):
        sine = math.sqrt(1.0 - cosine * cosine)
        wo = Vec3((sine * math.cos(azimuth), sine * math.sin(azimuth), side * cosine))
        _, cos_theta_t = fresnel_dielectric(cosine, eta)
        if cos_theta_t <= 1e-6:
            return
        wi = refract(wo, eta, cos_theta_t)
        assert length(wi) == pytest.approx(1.0, abs=1e-12)
        assert wi.z * side < 0.0
        assert math.hypot(wi.x, wi.y) * eta == pytest.approx(sine, abs=1e-12)
        assert wi.x * wo.y == pytest.approx(wi.y * wo.x, abs=1e-12)
        back = refract(wi, 1.0 / eta, fresnel_dielectric(cos_theta_t, 1.0 / eta)[1])
        assert dot(back, wo) == pytest.approx(1.0, abs=1e-9)

    def test_slab_sums_the_reflections_inside(self):
        """A pane of index 1.5 at normal incidence reflects 7.7 %."""
        face, _ = fresnel_dielectric(1.0, 1.5)
        series = face + sum((1.0 - face) ** 2 * face ** (2 * bounce + 1) for bounce in range(50))
        assert slab_reflectance(face) == pytest.approx(series, rel=1e-12)
        assert slab_reflectance(face) == pytest.approx(0.0769, abs=5e-5)
        assert slab_reflectance(1.0) == 1.0


class TestConductor:
    """Reflectance of metals."""

    def test_gold_at_590_nm(self):
        """n = 0.2593, k = 3.1136 (Yakubovsky et al. 2017, 53 nm film): R = 0.908 at normal incidence."""
        lanes = fresnel_conductor(1.0, Spectrum([0.2593]), Spectrum([3.1136]))
        assert lanes.values[0] == pytest.approx(0.908, abs=5e-4)

    def test_normal_incidence(self):
        n, k = np.array([0.05, 0.2, 1.5, 3.0]), np.array([4.0, 3.1, 2.0, 3.3])
        expected = ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)
        np.testing.assert_allclose(fresnel_conductor(1.0, Spectrum(n), Spectrum(k)), expected, rtol=1e-6)

    def test_agrees_with_complex_arithmetic(self):
        n, k = np.array([0.05, 0.13, 1.5, 4.4, 0.5]), np.array([4.0, 7.0, 2.0, 0.3, 0.5])
        for cos_theta_i in (1.0, 0.9, 0.5, 0.2, 0.05, 0.01, 1e-4):
            expected = [complex_reflectance(cos_theta_i, *pair) for pair in zip(n, k, strict=True)]
            lanes = fresnel_conductor(cos_theta_i, Spectrum(n), Spectrum(k))
            np.testing.assert_allclose(lanes, expected, rtol=2e-6)

    def test_without_absorption_it_is_a_dielectric(self):
        """Total reflection included; at the critical angle float32 knows eta to 6e-8, and R to its root."""
        n = np.array([1.5, 2.4, 1 / 1.5, 1.0])
        critical = math.sqrt(1 - 1 / 1.5**2)
        for cos_theta_i, tolerance in ((1.0, 1e-6), (0.8, 1e-6), (critical, 5e-3), (0.7, 1e-6), (0.01, 1e-6)):
            expected = [fresnel_dielectric(cos_theta_i, eta)[0] for eta in n]
            lanes = fresnel_conductor(cos_theta_i, Spectrum(n), Spectrum(np.zeros(4)))
            np.testing.assert_allclose(lanes, expected, atol=tolerance)

    def test_grazing_light_is_reflected(self):
        lanes = fresnel_conductor(1e-7, Spectrum([0.2, 1.5]), Spectrum([3.0, 2.0]))
        np.testing.assert_allclose(lanes, 1.0, atol=1e-5)


@kernel
def tabulate(cosines, etas, eta_lanes, k_lanes, scalar, metal, glass):
    for i in range(len(cosines)):
        scalar[i, 0], scalar[i, 1] = fresnel_dielectric(cosines[i], etas[i])
        conductor = fresnel_conductor(cosines[i], eta_lanes, k_lanes)
        dielectric = fresnel_dielectric_lanes(cosines[i], eta_lanes * eta_lanes - 1.0)
        for j in range(4):
            metal[i, j] = lane(conductor, j)
            glass[i, j] = lane(dielectric, j)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="kernels divide by zero, plain Python does not")
def test_compiled_functions_agree_with_python_and_stay_finite_at_the_edges():
    rng = np.random.default_rng(1)
    cosines = np.concatenate([[0.0, 0.0, 1.0, 1e-300, 0.5], rng.random(200)])
    etas = np.concatenate([[1.0, 1.5, 1.0, 1.0, 1.0 / 1.5], rng.uniform(0.3, 3.0, 200)])
    eta_lanes, k_lanes = Spectrum([0.2, 1.0, 1.5, 0.5]), Spectrum([3.0, 0.0, 2.0, 0.0])
    scalar, metal, glass = np.empty((205, 2)), np.empty((205, 4)), np.empty((205, 4))
    tabulate(cosines, etas, eta_lanes, k_lanes, scalar, metal, glass)
    for table in (scalar, metal, glass):
        assert np.all((table >= 0.0) & (table <= 1.0 + 1e-6))
    # A Python float divides by zero with an exception, a kernel does not: only the kernel sees the edges of `glass`.
    for i in range(5, 205):
        np.testing.assert_allclose(scalar[i], fresnel_dielectric(cosines[i], etas[i]), rtol=1e-12)
        np.testing.assert_allclose(metal[i], fresnel_conductor(cosines[i], eta_lanes, k_lanes), rtol=2e-6)
        expected = fresnel_dielectric_lanes(cosines[i], eta_lanes * eta_lanes - 1.0)
        np.testing.assert_allclose(glass[i], expected, rtol=2e-6)
