"""What each BSDF returns: energy, reciprocity, densities, sides; compiled and as plain Python."""

import math

import numpy as np
import pytest
from bsdf_cases import (
    ALBEDO_TOLERANCE,
    ALL,
    COLOUR,
    REFLECTIVE,
    RESOLVED,
    SPECTRA,
    STRATA,
    WAVELENGTHS,
    WHITE,
    albedo,
    density,
    direction,
    evaluate,
    evaluated,
    materials,
    random_directions,
    reflectance_of,
    sample,
    sampled,
)

from artist_py.bsdf.dispatch import (
    evaluate_bsdf,
    is_delta_bsdf,
    pdf_bsdf,
    reflectance_bsdf,
    sample_bsdf,
)
from artist_py.bsdf.oren_nayar import mean_albedo, slope_ratio
from artist_py.core.vector import Spectrum, Vec3
from artist_py.scene.tables import (
    ABSORBER,
    DIFFUSE,
    OREN_NAYAR,
    Needs,
    Spectra,
)


class TestDiffuseKinds:
    """What has a density: diffuse and Oren-Nayar."""

    ROUGH = ((DIFFUSE, 0.0), *((OREN_NAYAR, sigma) for sigma in (0.0, 1e-3, 5.0, 20.0, 45.0, 90.0)))

    @pytest.mark.parametrize(("kind", "roughness"), ROUGH)
    @pytest.mark.parametrize("degrees", [0.0, 40.0, 75.0, 88.0, 110.0, 180.0])
    def test_white_surfaces_in_a_white_furnace_vanish(self, kind, roughness, degrees):
        total = albedo(materials(kind, WHITE, roughness=roughness), direction(degrees))
        np.testing.assert_allclose(total, 1.0, atol=ALBEDO_TOLERANCE)

    @pytest.mark.parametrize(("kind", "roughness"), ROUGH)
    @pytest.mark.parametrize("degrees", [0.0, 60.0, 88.0, 120.0])
    def test_reflectance_is_the_integral(self, kind, roughness, degrees):
        table, wo = materials(kind, roughness=roughness), direction(degrees)
        expected = reflectance_bsdf(
            ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, 1.0
        ).values
        assert np.all(expected <= RESOLVED[COLOUR] + 1e-6)
        np.testing.assert_allclose(albedo(table, wo), expected, atol=ALBEDO_TOLERANCE)

    @pytest.mark.parametrize(("kind", "roughness"), ROUGH)
    def test_is_reciprocal(self, kind, roughness):
        table = materials(kind, roughness=roughness)
        rng = np.random.default_rng(1)
        for a, b in zip(random_directions(rng, 100), random_directions(rng, 100), strict=True):
            np.testing.assert_allclose(
                evaluate(table, Vec3(a), Vec3(b)), evaluate(table, Vec3(b), Vec3(a)), rtol=1e-6
            )

    @pytest.mark.parametrize(("kind", "roughness"), ROUGH)
    @pytest.mark.parametrize("degrees", [0.0, 60.0, 89.9, 95.0, 160.0])
    def test_weights_are_f_cos_over_the_density(self, kind, roughness, degrees):
        table, wo = materials(kind, roughness=roughness), direction(degrees)
        samples = sampled(table, wo, np.random.default_rng(2).random((1000, 3)))
        assert np.all(samples.wi[:, 2] * wo.z > 0.0)
        assert not samples.is_delta.any()
        assert np.all(samples.eta == 1.0)
        f, pdf = evaluated(table, wo, samples.wi)
        np.testing.assert_allclose(samples.pdf, pdf, rtol=1e-9)
        expected = f * np.abs(samples.wi[:, 2:]) / pdf[:, None]
        np.testing.assert_allclose(samples.weight, expected, rtol=1e-5)
        for row in samples[:50]:
            assert row.pdf_rev == pytest.approx(density(table, Vec3(row.wi), wo), rel=1e-9)

    @pytest.mark.parametrize("kind", [DIFFUSE, OREN_NAYAR])
    def test_nothing_passes_through(self, kind):
        table = materials(kind)
        for degrees in (95.0, 135.0, 180.0):
            assert not evaluate(table, direction(20.0), direction(degrees)).any()
            assert density(table, direction(20.0), direction(degrees)) == 0.0

    def test_lambert_is_reflectance_over_pi(self):
        value = evaluate(materials(DIFFUSE), direction(10.0), direction(70.0))
        np.testing.assert_allclose(value, RESOLVED[COLOUR] / math.pi, rtol=1e-6)

    def test_oren_nayar_without_roughness_is_lambert(self):
        wo, wi = direction(80.0), direction(60.0, 2.0)
        np.testing.assert_allclose(
            evaluate(materials(OREN_NAYAR, roughness=0.0), wo, wi), RESOLVED[COLOUR] / math.pi, rtol=1e-6
        )

    def test_grazing_pairs_of_rough_surfaces_keep_their_weights_bounded(self):
        samples = sampled(
            materials(OREN_NAYAR, WHITE, roughness=90.0),
            direction(89.99),
            np.random.default_rng(3).random((STRATA // 5, 3)),
        )
        assert samples.weight.max() < 8.0


class TestOrenNayar:
    """The model behind `oren-nayar`."""

    @pytest.mark.parametrize("sigma", [5.0, 20.0, 45.0, 90.0])
    def test_backscattering_is_that_of_oren_and_nayars_qualitative_model(self, sigma):
        """Their A + B sin(alpha) tan(beta) over A, at alpha = beta = 60 degrees, for a dark surface."""
        variance = math.radians(sigma) ** 2
        a, b = 1.0 - 0.5 * variance / (variance + 0.33), 0.45 * variance / (variance + 0.09)
        angle = math.radians(60.0)
        expected = 1.0 + b / a * math.sin(angle) * math.tan(angle)
        table = materials(OREN_NAYAR, roughness=sigma)
        dark = Spectra(RESOLVED * np.float32(1e-4), None, 0.0)
        back, across = (
            evaluate_bsdf(
                ALL, table[0], reflectance_of(table, dark), dark, WAVELENGTHS, direction(60.0), wi
            ).values[0]
            for wi in (direction(60.0), direction(0.0))
        )
        assert back / across == pytest.approx(expected, rel=1e-3)

    def test_slope_ratio_grows_from_nothing_and_stays_below_one(self):
        values = [slope_ratio(math.radians(sigma)) for sigma in range(91)]
        assert values[0] == 0.0
        assert np.all(np.diff(values) > 0.0)
        assert values[-1] < 0.78

    def test_mean_albedo_is_the_mean(self):
        r = slope_ratio(0.5)
        nodes, weights = np.polynomial.legendre.leggauss(64)
        cosines = 0.5 * (nodes + 1.0)
        table = materials(OREN_NAYAR, WHITE, roughness=math.degrees(0.5))
        # A white surface scatters once what it does not scatter twice or more: take the first part alone.
        dark = Spectra(RESOLVED * np.float32(1e-4), None, 0.0)
        once = [
            reflectance_bsdf(
                ALL,
                table[0],
                reflectance_of(table, dark),
                dark,
                WAVELENGTHS,
                direction(math.degrees(math.acos(cosine))),
                1.0,
            ).values[0]
            for cosine in cosines
        ]
        assert (once * cosines * weights).sum() / 1e-4 == pytest.approx(mean_albedo(r), abs=2e-4)


class TestSides:
    """Two-sidedness, which the dispatcher handles for all kinds that reflect."""

    @pytest.mark.parametrize("kind", REFLECTIVE)
    @pytest.mark.parametrize("degrees", [30.0, 150.0])
    def test_two_sided_surfaces_look_alike_from_both_sides(self, kind, degrees):
        table, wo = materials(kind), direction(degrees)
        image = Vec3((wo.x, wo.y, -wo.z))
        numbers = np.random.default_rng(4).random((50, 3))
        one, other = sampled(table, wo, numbers), sampled(table, image, numbers)
        np.testing.assert_array_equal(one.wi * [1.0, 1.0, -1.0], other.wi)
        np.testing.assert_array_equal(one.weight, other.weight)
        np.testing.assert_array_equal(one.pdf, other.pdf)

    @pytest.mark.parametrize("kind", REFLECTIVE)
    def test_one_sided_surfaces_are_black_from_behind(self, kind):
        table, behind = materials(kind, two_sided=0), direction(120.0)
        assert sample(table, behind, (0.3, 0.4, 0.5)).pdf == 0.0
        assert not evaluate(table, behind, direction(150.0)).any()
        assert density(table, behind, direction(150.0)) == 0.0
        assert not reflectance_bsdf(
            ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, behind, 1.0
        ).values.any()
        assert sample(table, direction(60.0), (0.3, 0.4, 0.5)).pdf > 0.0

    def test_scenes_without_one_sided_materials_do_not_look(self):
        table = materials(DIFFUSE, two_sided=0)
        needs = Needs(diffuse=True)
        assert pdf_bsdf(
            needs, table[0], None, SPECTRA, WAVELENGTHS, direction(120.0), direction(180.0)
        ) == pytest.approx(1.0 / math.pi)


class TestCompiled:
    """Kernels and plain Python agree, and what a scene lacks is black."""

    @pytest.mark.parametrize("kind", range(9))
    @pytest.mark.parametrize("dispersive", [0, 1])
    def test_samples_agree_with_python(self, kind, dispersive):
        table = materials(kind, is_dispersive=dispersive)
        rng = np.random.default_rng(kind)
        numbers = rng.random((12, 3))
        ratio = Spectrum([0.4, 1.6, 1.2, 0.8])
        for row in random_directions(rng, 6):
            wo = Vec3(row)
            compiled = sampled(table, wo, numbers, ratio=ratio, ior_outside=1.1)
            for fast, uvw in zip(compiled, numbers, strict=True):
                slow = sample(table, wo, uvw.tolist(), ratio=ratio, ior_outside=1.1)
                np.testing.assert_allclose(fast.wi, slow.wi, atol=1e-12)
                # A few units in the last place of float32, whose products a kernel may fuse and reorder.
                np.testing.assert_allclose(fast.weight, slow.weight, rtol=3e-6, atol=1e-7)
                np.testing.assert_allclose(fast.ratio, slow.ratio, rtol=3e-6)
                for name in ("pdf", "pdf_rev", "eta"):
                    assert getattr(fast, name) == pytest.approx(getattr(slow, name), rel=1e-6)
                assert bool(fast.is_delta) == slow.is_delta

    @pytest.mark.parametrize("kind", range(9))
    def test_values_agree_with_python(self, kind):
        table = materials(kind)
        rng = np.random.default_rng(kind)
        wo, directions = Vec3(random_directions(rng, 1)[0]), random_directions(rng, 30)
        f, pdf = evaluated(table, wo, directions)
        for i, row in enumerate(directions):
            np.testing.assert_allclose(f[i], evaluate(table, wo, Vec3(row)), rtol=1e-6)
            assert pdf[i] == pytest.approx(density(table, wo, Vec3(row)), rel=1e-6)  # lanes have float32

    @pytest.mark.parametrize("kind", [*range(9), ABSORBER])
    def test_kinds_that_the_scene_does_not_need_are_black(self, kind):
        table, wo = materials(kind), direction(30.0)
        reflectance = Spectrum(RESOLVED[COLOUR])
        result = sample_bsdf(
            Needs(), table[0], reflectance, SPECTRA, WAVELENGTHS, wo, 0.5, 0.5, 0.5, None, 1.0, None
        )
        assert result.pdf == 0.0
        assert not result.weight.values.any()
        assert not evaluate_bsdf(Needs(), table[0], reflectance, SPECTRA, WAVELENGTHS, wo, wo).values.any()
        assert pdf_bsdf(Needs(), table[0], reflectance, SPECTRA, WAVELENGTHS, wo, wo) == 0.0
        assert not reflectance_bsdf(
            Needs(), table[0], reflectance, SPECTRA, WAVELENGTHS, wo, 1.0
        ).values.any()

    def test_absorbers_absorb(self):
        table, wo = materials(ABSORBER), direction(30.0)
        assert not sampled(table, wo, np.full((1, 3), 0.5)).pdf.any()
        assert not evaluate(table, wo, wo).any()
        assert not reflectance_bsdf(
            ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, 1.0
        ).values.any()
        assert is_delta_bsdf(table[0])
