"""Phong's lobe and plastic: energy, reciprocity, densities, and how likely each lobe is."""

import math

import numba
import numpy as np
import pytest
from bsdf_cases import (
    ALBEDO_TOLERANCE,
    ALL,
    BLACK,
    COLOUR,
    GLOSS,
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
    strata,
)

from artist_py.bsdf.dispatch import is_delta_bsdf, reflectance_bsdf, survival_bsdf
from artist_py.bsdf.phong import lobe_albedo
from artist_py.core.fresnel import fresnel_dielectric
from artist_py.core.vector import Spectrum, Vec3
from artist_py.errors import SceneError
from artist_py.scene.compile_materials import MaterialCompiler, SpectrumRows
from artist_py.scene.optics import diffuse_transmittance
from artist_py.scene.reader import read_scene_text
from artist_py.scene.tables import (
    ABSORBER,
    CONDUCTOR,
    DIELECTRIC,
    DIFFUSE,
    MIRROR,
    OREN_NAYAR,
    PASS_THROUGH,
    PHONG,
    PLASTIC,
    THIN_DIELECTRIC,
    Needs,
)

EXPONENTS = (0.0, 0.5, 1.0, 12.0, 100.0)
# The coarse rule that plain Python can afford would miss the sharpest lobe.
INTEGRATED = EXPONENTS[:-1] if numba.config.DISABLE_JIT else EXPONENTS
INDICES = (1.0, 1.0001, 1.33, 1.5, 2.4, 10.0)
ANGLES = (0.0, 40.0, 75.0, 88.0, 120.0)


def reflectance(table, wo):
    """`reflectance_bsdf` as plain Python, (C,)."""
    return reflectance_bsdf(ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, 1.0).values


class TestBoth:
    """What has a density must have."""

    MATERIALS = (
        *(materials(PHONG, exponent=n) for n in EXPONENTS),
        materials(PHONG, WHITE, specular=BLACK),
        materials(PHONG, BLACK, specular=WHITE),
        *(materials(PLASTIC, ior=ior) for ior in INDICES),
        materials(PLASTIC, WHITE),
        materials(PLASTIC, BLACK),
    )

    @pytest.mark.parametrize("table", MATERIALS)
    def test_is_reciprocal(self, table):
        rng = np.random.default_rng(1)
        for a, b in zip(random_directions(rng, 100), random_directions(rng, 100), strict=True):
            np.testing.assert_allclose(
                evaluate(table, Vec3(a), Vec3(b)), evaluate(table, Vec3(b), Vec3(a)), rtol=1e-6
            )

    @pytest.mark.parametrize("table", MATERIALS)
    @pytest.mark.parametrize("degrees", [0.0, 60.0, 89.9, 95.0, 160.0])
    def test_weights_are_f_cos_over_the_density(self, table, degrees):
        wo = direction(degrees)
        samples = sampled(table, wo, np.random.default_rng(2).random((1000, 3)))
        samples = samples[samples.is_delta == 0]
        f, pdf = evaluated(table, wo, samples.wi)
        np.testing.assert_allclose(samples.pdf, pdf, rtol=1e-6)
        expected = f * np.abs(samples.wi[:, 2:]) / pdf[:, None]
        np.testing.assert_allclose(samples.weight, expected, rtol=1e-5)
        for row in samples[:50]:
            assert row.pdf_rev == pytest.approx(density(table, Vec3(row.wi), wo), rel=1e-6)

    @pytest.mark.parametrize("table", MATERIALS)
    @pytest.mark.parametrize("degrees", ANGLES)
    def test_samples_bring_the_reflectance_and_no_more(self, table, degrees):
        """A stratified mean: its error is far below that of independent samples, 1 / sqrt(n)."""
        wo, side = direction(degrees), round(math.sqrt(STRATA))
        grid = (np.arange(side) + 0.5) / side
        u, v = (each.ravel() for each in np.meshgrid(grid, grid))
        numbers = np.column_stack([u, v, np.random.default_rng(3).permutation(side * side) / (side * side)])
        samples = sampled(table, wo, numbers)
        expected = reflectance(table, wo)
        assert np.all(expected <= 1.0 + 1e-6)
        np.testing.assert_allclose(samples.weight.astype(float).mean(0), expected, atol=2.0 / side)
        assert np.all(samples.wi[samples.pdf > 0.0, 2] * wo.z > 0.0)

    @pytest.mark.parametrize("kind", [PHONG, PLASTIC])
    def test_can_be_connected_and_lets_nothing_through(self, kind):
        table = materials(kind)
        assert not is_delta_bsdf(table[0])
        assert not evaluate(table, direction(20.0), direction(135.0)).any()
        assert density(table, direction(20.0), direction(135.0)) == 0.0


class TestPhong:
    """Diffuse, and a power of the cosine about the mirrored direction."""

    @pytest.mark.parametrize("exponent", INTEGRATED)
    @pytest.mark.parametrize("degrees", ANGLES)
    def test_reflectance_is_the_integral(self, exponent, degrees):
        table, wo = materials(PHONG, exponent=exponent), direction(degrees)
        total = albedo(table, wo)
        assert np.all(total <= 1.0 + 1e-4)
        np.testing.assert_allclose(reflectance(table, wo), total, atol=3e-4 + 3.0 * ALBEDO_TOLERANCE)

    @pytest.mark.parametrize("exponent", [*EXPONENTS, 1e6])
    def test_light_along_the_normal_is_reflected_most(self, exponent):
        cosines = np.cos(np.radians(np.linspace(0.0, 90.0, 60)))
        shares = [lobe_albedo(float(cosine), exponent) for cosine in cosines]
        assert shares[0] == 1.0
        assert np.all(np.diff(shares) <= 1e-9)
        assert shares[-1] >= 0.0

    def test_f_is_that_of_the_box_reference(self):
        """rho / pi + k (n + 2) / (2 pi) cos^n alpha, in the plane of incidence."""
        table, n = materials(PHONG, exponent=40.0), 40.0
        wo, wi = direction(50.0, 0.7), direction(40.0, 0.7 + math.pi)
        lobe = (n + 2.0) / (2.0 * math.pi) * math.cos(math.radians(10.0)) ** n
        expected = RESOLVED[COLOUR] / math.pi + RESOLVED[GLOSS] * lobe
        np.testing.assert_allclose(evaluate(table, wo, wi), expected, rtol=1e-5)
        away = evaluate(table, direction(60.0), direction(60.0))
        np.testing.assert_allclose(away, RESOLVED[COLOUR] / math.pi, rtol=1e-6)

    def test_density_is_a_mixture_by_mean_albedo(self):
        n, share = 40.0, RESOLVED[GLOSS].sum() / (RESOLVED[GLOSS].sum() + RESOLVED[COLOUR].sum())
        wo, wi = direction(50.0, 0.7), direction(40.0, 0.7 + math.pi)
        lobe = (n + 1.0) / (2.0 * math.pi) * math.cos(math.radians(10.0)) ** n
        expected = (1.0 - share) * math.cos(math.radians(40.0)) / math.pi + share * lobe
        assert density(materials(PHONG), wo, wi) == pytest.approx(expected, rel=1e-6)

    def test_samples_below_the_surface_are_absorbed(self):
        """At grazing incidence nearly half of a sharp lobe lies below."""
        table = materials(PHONG, BLACK, exponent=1000.0)
        samples = sampled(table, direction(89.9999), np.random.default_rng(4).random((STRATA // 10, 3)))
        assert (samples.pdf == 0.0).mean() == pytest.approx(0.5, abs=3.0 / math.sqrt(STRATA // 10))
        assert not samples.weight[samples.pdf == 0.0].any()

    @pytest.mark.parametrize("exponent", [1e4, 1e6])
    def test_sharp_lobes_keep_their_energy(self, exponent):
        table = materials(PHONG, BLACK, specular=WHITE, exponent=exponent)
        samples = sampled(table, direction(45.0), np.random.default_rng(5).random((1000, 3)))
        expected = samples.wi[:, 2:] * (exponent + 2.0) / (exponent + 1.0)
        np.testing.assert_allclose(samples.weight, np.tile(expected, 4), rtol=1e-5)

    def test_what_reflects_nothing_brings_nothing(self):
        table = materials(PHONG, BLACK, specular=BLACK)
        assert not sampled(table, direction(30.0), strata(100)).weight.any()
        assert not evaluate(table, direction(30.0), direction(30.0)).any()


class TestPlastic:
    """A diffuse base under a smooth coat."""

    @pytest.mark.parametrize("ior", INDICES)
    @pytest.mark.parametrize("degrees", ANGLES)
    def test_diffuse_part_and_mirror_make_up_the_reflectance(self, ior, degrees):
        wo = direction(degrees)
        mirrored, _ = fresnel_dielectric(abs(wo.z), ior)
        for rho in (COLOUR, WHITE, BLACK):
            table = materials(PLASTIC, rho, ior=ior)
            total = albedo(table, wo) + mirrored
            np.testing.assert_allclose(reflectance(table, wo), total, atol=ALBEDO_TOLERANCE)

    @pytest.mark.parametrize("ior", INDICES)
    def test_a_white_base_reflects_everything(self, ior):
        for degrees in ANGLES:
            shares = reflectance(materials(PLASTIC, WHITE, ior=ior), direction(degrees))
            np.testing.assert_allclose(shares, 1.0, atol=1e-6)

    def test_equal_media_leave_lambert(self):
        value = evaluate(materials(PLASTIC, ior=1.0), direction(10.0), direction(70.0))
        np.testing.assert_allclose(value, RESOLVED[COLOUR] / math.pi, rtol=1e-6)

    def test_f_is_the_sum_over_internal_reflections(self):
        """T T rho / (pi eta^2) (1 + rho F_i + (rho F_i)^2 + ...), which makes colours deeper."""
        wo, wi, eta = direction(30.0), direction(65.0, 2.0), 1.5
        through = math.prod(1.0 - fresnel_dielectric(w.z, eta)[0] for w in (wo, wi))
        inside = 1.0 - diffuse_transmittance(eta) / eta**2
        rho = RESOLVED[COLOUR].astype(float)
        series = sum(rho * (rho * inside) ** k for k in range(200))
        expected = through / (math.pi * eta**2) * series
        np.testing.assert_allclose(evaluate(materials(PLASTIC), wo, wi), expected, rtol=1e-5)
        assert expected[0] / expected[3] < 0.9 * rho[0] / rho[3]

    @pytest.mark.parametrize("degrees", [0.0, 60.0, 89.0, 110.0])
    @pytest.mark.parametrize("rho", [COLOUR, WHITE, BLACK])
    def test_the_mirror_has_its_share_of_the_mean_reflectance(self, degrees, rho):
        table, wo = materials(PLASTIC, rho), direction(degrees)
        mirrored, _ = fresnel_dielectric(abs(wo.z), 1.5)
        mean = reflectance(table, wo).mean()
        samples = sampled(table, wo, strata())
        is_mirror = samples.is_delta == 1
        assert is_mirror.mean() == pytest.approx(mirrored / mean, abs=2.0 / STRATA)
        mirror = samples[is_mirror]
        np.testing.assert_allclose(mirror.pdf, mirrored / mean, rtol=1e-5)
        np.testing.assert_array_equal(mirror.pdf_rev, mirror.pdf)
        np.testing.assert_allclose(mirror.weight, mean, rtol=1e-5)
        np.testing.assert_allclose(mirror.wi, np.tile([-wo.x, -wo.y, wo.z], (len(mirror), 1)))

    def test_densities_hold_the_probability_of_either_direction(self):
        table, wo, wi = materials(PLASTIC), direction(30.0), direction(80.0, 2.0)
        for a, b in ((wo, wi), (wi, wo)):
            mirrored, _ = fresnel_dielectric(a.z, 1.5)
            chance = 1.0 - mirrored / reflectance(table, a).mean()
            assert density(table, a, b) == pytest.approx(chance * b.z / math.pi, rel=1e-5)
        result = sample(table, wo, (0.3, 0.4, 0.999))
        assert not result.is_delta
        assert result.pdf_rev == pytest.approx(density(table, result.wi, wo), rel=1e-6)

    @pytest.mark.parametrize(("ior", "expected"), [(1.0, 1.0), (1.5, 0.9082220407), (4.0, 0.6333619435)])
    def test_diffuse_transmittance(self, ior, expected):
        """Closed form of Walsh 1926 for the reflectance of diffuse light."""
        assert diffuse_transmittance(ior) == pytest.approx(expected, abs=1e-10)


class TestSurvival:
    """How likely walks go on: no less than any direction's reflectance, and the same for all directions."""

    LOSSLESS = (PLASTIC, DIELECTRIC, THIN_DIELECTRIC, PASS_THROUGH, ABSORBER)

    def survival(self, table):
        return survival_bsdf(ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS)

    @pytest.mark.parametrize("kind", [DIFFUSE, OREN_NAYAR, MIRROR, CONDUCTOR])
    def test_is_the_largest_reflectance(self, kind):
        assert self.survival(materials(kind)) == pytest.approx(RESOLVED[COLOUR].max())

    def test_of_phong_is_the_largest_sum(self):
        assert self.survival(materials(PHONG)) == pytest.approx((RESOLVED[COLOUR] + RESOLVED[GLOSS]).max())

    @pytest.mark.parametrize("kind", LOSSLESS)
    def test_is_certain_where_a_direction_may_lose_nothing(self, kind):
        assert self.survival(materials(kind)) == 1.0

    @pytest.mark.parametrize("kind", range(ABSORBER))
    def test_bounds_the_reflectance(self, kind):
        table = materials(kind)
        for degrees in ANGLES:
            assert reflectance(table, direction(degrees)).max() <= self.survival(table) + 1e-6

    def test_never_exceeds_one(self):
        bright = Spectrum(np.full(4, 1.0 + 1e-6))
        table = materials(DIFFUSE)
        assert survival_bsdf(Needs(diffuse=True), table[0], bright, SPECTRA, WAVELENGTHS) == 1.0


class TestCompile:
    """From scenes to rows."""

    def row(self, text):
        graph = read_scene_text(
            f"camera = {{type = 'pinhole', position = [0, 0, 0], look_at = [1, 0, 0]}}\n{text}"
        )
        compiler = MaterialCompiler(graph, {"m"}, SpectrumRows(380, 780))
        return compiler, compiler.table[compiler.rows["m"]]

    def test_phong(self):
        text = "[materials.m]\ntype = 'phong'\nreflectance = 0.25\nspecular = 0.75\nexponent = 90"
        compiler, row = self.row(text)
        assert row["kind"] == PHONG
        assert row["exponent"] == 90.0
        assert np.all(compiler.spectra.rows[row["reflectance"]] == 0.25)
        assert np.all(compiler.spectra.rows[row["specular"]] == 0.75)

    def test_plastic(self):
        _, row = self.row("[materials.m]\ntype = 'plastic'\nreflectance = 0.3")
        assert row["kind"] == PLASTIC
        assert row["ior"] == 1.5
        assert row["transmittance"] == pytest.approx(0.9082220407)

    @pytest.mark.parametrize(
        ("matte", "glossy", "found"),
        [
            ("0.5", "0.6", "1.1 at 380 nm"),
            ("{wavelengths = [400, 600], values = [0.1, 0.9]}", "0.2", "1.1 at 600 nm"),
            ("{checkerboard = [0.1, 0.8]}", "0.3", "1.1 at 380 nm"),
        ],
    )
    def test_phong_creates_no_energy(self, matte, glossy, found):
        with pytest.raises(SceneError) as caught:
            self.row(f"[materials.m]\ntype = 'phong'\nreflectance = {matte}\nspecular = {glossy}")
        message = f"materials.m.specular: expected reflectance + specular <= 1, found {found}"
        assert str(caught.value).endswith(message)
