"""Mirrors, metals, glass and what is not there: directions, energy, and the lazy hero of dispersion."""

import math

import numpy as np
import pytest
from bsdf_cases import (
    ALL,
    COLOUR,
    DELTA,
    GLASS,
    GOLD_ETA,
    GOLD_K,
    LANES,
    RESOLVED,
    SPECTRA,
    STRATA,
    WAVELENGTHS,
    WHITE,
    density,
    direction,
    evaluate,
    materials,
    reflectance_of,
    sample,
    sampled,
    strata,
)

from artist_py.bsdf.dispatch import (
    is_delta_bsdf,
    reflectance_bsdf,
)
from artist_py.core.fresnel import fresnel_conductor, fresnel_dielectric, slab_reflectance
from artist_py.core.vector import Spectrum
from artist_py.scene.tables import (
    CONDUCTOR,
    DIELECTRIC,
    DIFFUSE,
    MIRROR,
    OREN_NAYAR,
    PASS_THROUGH,
    PHONG,
    PLASTIC,
    THIN_DIELECTRIC,
)


class TestDeltaKinds:
    """What scatters into one or two directions."""

    @pytest.mark.parametrize("kind", DELTA)
    def test_given_directions_never_fit(self, kind):
        table = materials(kind)
        assert is_delta_bsdf(table[0])
        assert not evaluate(table, direction(30.0), direction(30.0, 0.7 + math.pi)).any()
        assert density(table, direction(30.0), direction(150.0)) == 0.0

    @pytest.mark.parametrize("kind", [DIFFUSE, OREN_NAYAR, PHONG, PLASTIC])
    def test_kinds_with_a_density_are_no_delta(self, kind):
        assert not is_delta_bsdf(materials(kind)[0])

    @pytest.mark.parametrize("kind", DELTA)
    @pytest.mark.parametrize("degrees", [0.0, 50.0, 89.0, 91.0, 140.0])
    def test_light_walks_lose_only_what_is_absorbed(self, kind, degrees):
        """The mean of the weights is the reflectance: nothing is lost or won in the choice of a lobe."""
        table, wo = materials(kind), direction(degrees)
        samples = sampled(table, wo, strata(), light_walk=True)
        expected = reflectance_bsdf(
            ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, 1.0
        ).values
        np.testing.assert_allclose(samples.weight.astype(float).mean(0), expected, atol=10.0 / STRATA)
        assert samples.is_delta.all()
        np.testing.assert_array_equal(samples.pdf, samples.pdf_rev)

    def test_mirrors_mirror(self):
        wo = direction(40.0)
        result = sample(materials(MIRROR), wo, (0.1, 0.2, 0.3))
        np.testing.assert_allclose(result.wi, [-wo.x, -wo.y, wo.z])
        np.testing.assert_allclose(result.weight, RESOLVED[COLOUR])
        assert result.pdf == result.pdf_rev == result.eta == 1.0

    def test_metals_reflect_as_fresnel_says_and_less_in_water(self):
        wo = direction(40.0)
        eta, k = Spectrum(RESOLVED[GOLD_ETA]), Spectrum(RESOLVED[GOLD_K])
        for outside in (1.0, 1.333):
            result = sample(materials(CONDUCTOR, WHITE), wo, (0.1, 0.2, 0.3), ior_outside=outside)
            np.testing.assert_allclose(
                result.weight, fresnel_conductor(wo.z, eta / outside, k / outside), rtol=1e-6
            )
        coloured = sample(materials(CONDUCTOR), wo, (0.1, 0.2, 0.3), ior_outside=1.333)
        np.testing.assert_allclose(coloured.weight, result.weight * Spectrum(RESOLVED[COLOUR]), rtol=1e-6)

    def test_what_is_not_there_lets_everything_pass(self):
        wo = direction(70.0)
        result = sample(materials(PASS_THROUGH), wo, (0.1, 0.2, 0.3))
        np.testing.assert_array_equal(result.wi, -wo)
        np.testing.assert_array_equal(result.weight, np.ones(LANES))
        assert result.pdf == result.eta == 1.0

    @pytest.mark.parametrize("degrees", [0.0, 60.0, 85.0, 120.0])
    def test_thin_sheets_reflect_twice_as_much_and_do_not_bend(self, degrees):
        wo = direction(degrees)
        face, _ = fresnel_dielectric(abs(wo.z), 1.5)
        samples = sampled(materials(THIN_DIELECTRIC), wo, strata())
        reflected = samples.wi[:, 2] * wo.z > 0.0
        assert reflected.mean() == pytest.approx(slab_reflectance(face), abs=2.0 / STRATA)
        np.testing.assert_array_equal(samples.wi[~reflected][0], -np.asarray(wo)[:3])
        np.testing.assert_allclose(samples.weight, 1.0, rtol=1e-6)


class TestDielectric:
    """The smooth interface without dispersion."""

    @pytest.mark.parametrize("degrees", [0.0, 30.0, 80.0, 100.0, 135.0, 160.0])
    @pytest.mark.parametrize("outside", [1.0, 1.333, 2.0])
    def test_lobes_follow_fresnel_and_snell(self, degrees, outside):
        wo = direction(degrees)
        eta = 1.5 / outside if wo.z > 0.0 else outside / 1.5
        reflectance, _ = fresnel_dielectric(abs(wo.z), eta)
        samples = sampled(materials(DIELECTRIC), wo, strata(), ior_outside=outside)
        reflected = samples.wi[:, 2] * wo.z > 0.0
        assert reflected.mean() == pytest.approx(reflectance, abs=2.0 / STRATA)
        np.testing.assert_allclose(samples.pdf, np.where(reflected, reflectance, 1.0 - reflectance))
        np.testing.assert_allclose(samples.eta, np.where(reflected, 1.0, eta))
        weights = np.where(reflected, 1.0, 1.0 / eta**2)
        np.testing.assert_allclose(samples.weight, np.tile(weights[:, None], LANES), rtol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(samples.wi, axis=1), 1.0)
        np.testing.assert_allclose(
            samples.wi[~reflected, :2] * eta, np.tile([-wo.x, -wo.y], (np.sum(~reflected), 1)), atol=1e-12
        )

    def test_equal_media_let_light_pass_straight(self):
        wo = direction(70.0)
        result = sample(materials(DIELECTRIC), wo, (0.0, 0.0, 0.0), ior_outside=1.5)
        np.testing.assert_allclose(result.wi, -wo)
        assert result.pdf == 1.0

    def test_refraction_and_its_reverse_are_reciprocal(self):
        """f(wo, wi) / n_i^2 is symmetric: with unit |cos| densities, weight pdf eta^2 (Veach 1997, section 5.2)."""
        table = materials(DIELECTRIC)
        for degrees in (10.0, 50.0, 85.0, 145.0):
            there = sample(table, direction(degrees), (0.0, 0.0, 0.999999))
            back = sample(table, there.wi, (0.0, 0.0, 0.999999))
            np.testing.assert_allclose(back.wi, direction(degrees), atol=1e-12)
            assert there.pdf_rev == pytest.approx(back.pdf)
            assert there.eta * back.eta == pytest.approx(1.0)
            one, other = (each.weight.values[0] * each.pdf * each.eta**2 for each in (there, back))
            assert one == pytest.approx(other, rel=1e-6)

    def test_total_reflection(self):
        samples = sampled(materials(DIELECTRIC), direction(120.0), strata(1000))
        assert np.all(samples.wi[:, 2] < 0.0)
        assert np.all(samples.pdf == 1.0)

    def test_light_walks_keep_their_flux(self):
        result = sample(materials(DIELECTRIC), direction(30.0), (0.0, 0.0, 0.9), light_walk=True)
        assert result.eta == 1.5
        np.testing.assert_array_equal(result.weight, np.ones(LANES))


class TestDispersion:
    """The lazy hero (theory 2.4 and 2.6)."""

    RATIOS = ([1.0, 1.0, 1.0, 1.0], [0.1, 2.9, 0.3, 0.7], [0.0, 4.0, 0.0, 0.0], [1.5, 0.0, 0.5, 2.0])
    # From inside, the critical angles of the four lanes lie between 39.9 and 41.8 degrees.
    ANGLES = (0.0, 60.0, 89.0, 160.0, 180.0 - 40.5, 180.0 - 41.0, 180.0 - 60.0)

    def lane_reflectances(self, wo, outside):
        return np.array(
            [
                fresnel_dielectric(abs(wo.z), n / out if wo.z > 0.0 else out / n)[0]
                for n, out in zip(RESOLVED[GLASS].astype(float), outside, strict=True)
            ]
        )

    @pytest.mark.parametrize("ratio", RATIOS)
    @pytest.mark.parametrize("degrees", ANGLES)
    @pytest.mark.parametrize("outside", [1.0, [1.345, 1.34, 1.335, 1.33]])
    def test_weights_and_ratios_have_the_right_means(self, ratio, degrees, outside):
        """Enumeration over w: the error is below the number of pieces of w, 8, times the largest weight / strata.

        E[weight_k, reflected] = F_k and E[weight_k, refracted] = 1 - F_k for every lane that is alive, and
        E[r_j] keeps its value, since it is a ratio of densities.
        """
        wo, table = direction(degrees), materials(DIELECTRIC, is_dispersive=1)
        ior_outside = Spectrum(outside) if isinstance(outside, list) else outside
        samples = sampled(
            table, wo, strata(), ratio=Spectrum(ratio), ior_outside=ior_outside, light_walk=True
        )
        reflectances = self.lane_reflectances(wo, np.broadcast_to(outside, LANES))
        reflected = samples.wi[:, 2] * wo.z > 0.0
        alive = np.array(ratio) > 0.0
        tolerance = 8.0 / STRATA * np.where(alive, LANES / np.maximum(ratio, 1e-9), 0.0)
        weight = samples.weight.astype(float)
        means = [(weight * chosen[:, None]).mean(0) for chosen in (reflected, ~reflected)]
        assert np.all(np.abs(means[0] - reflectances)[alive] < tolerance[alive] + 1e-5)
        assert np.all(np.abs(means[1] - (1.0 - reflectances))[alive] < tolerance[alive] + 1e-5)
        assert not weight[:, ~alive][~reflected].any()
        np.testing.assert_allclose(samples.ratio.astype(float).mean(0), ratio, atol=32.0 / STRATA + 1e-5)
        np.testing.assert_allclose(samples.ratio.mean(1), 1.0, rtol=1e-6)

    def test_each_refracted_lane_obeys_snell_with_its_own_index(self):
        wo = direction(60.0)
        samples = sampled(materials(DIELECTRIC, is_dispersive=1), wo, strata(1000))
        refracted = samples[samples.wi[:, 2] < 0.0]
        lanes = refracted.weight.argmax(1)
        assert set(lanes) == set(range(LANES))
        assert np.all(np.count_nonzero(refracted.weight, axis=1) == 1)
        assert np.all(np.count_nonzero(refracted.ratio, axis=1) == 1)
        ior = RESOLVED[GLASS].astype(float)[lanes]
        np.testing.assert_allclose(refracted.eta, ior)
        np.testing.assert_allclose(refracted.wi[:, 0] * ior, -wo.x, rtol=1e-12)
        np.testing.assert_allclose(refracted.weight.max(1), LANES / ior**2, rtol=1e-6)

    def test_densities_are_lane_means_and_reversible(self):
        wo, start = direction(60.0), Spectrum([0.1, 2.9, 0.3, 0.7])
        samples = sampled(materials(DIELECTRIC, is_dispersive=1), wo, strata(1000), ratio=start)
        reflectances = self.lane_reflectances(wo, np.ones(LANES))
        reflected = samples.wi[:, 2] > 0.0
        lanes = samples.weight.argmax(1)
        expected = np.where(reflected, reflectances.mean(), 1.0 - reflectances[lanes])
        np.testing.assert_allclose(samples.pdf, expected, rtol=1e-5)
        np.testing.assert_array_equal(samples.pdf, samples.pdf_rev)

    def test_a_collapsed_path_stays_on_its_lane(self):
        start = [0.0, 0.0, 4.0, 0.0]
        samples = sampled(
            materials(DIELECTRIC, is_dispersive=1), direction(60.0), strata(1000), ratio=Spectrum(start)
        )
        np.testing.assert_allclose(samples.ratio, np.tile(start, (1000, 1)), rtol=1e-6)

    def test_clear_glass_in_a_dispersive_scene_keeps_all_lanes(self):
        start = Spectrum([0.1, 2.9, 0.3, 0.7])
        samples = sampled(materials(DIELECTRIC), direction(60.0), strata(100), ratio=start)
        np.testing.assert_array_equal(samples.ratio, np.tile(start.values, (100, 1)))
        assert np.all(samples.weight > 0.0)

    def test_clear_glass_in_a_dispersive_liquid_disperses(self):
        wo, liquid = direction(60.0), np.array([1.345, 1.34, 1.335, 1.33])
        samples = sampled(materials(DIELECTRIC), wo, strata(1000), ior_outside=Spectrum(liquid))
        refracted = samples[samples.wi[:, 2] < 0.0]
        lanes = refracted.weight.argmax(1)
        assert set(lanes) == set(range(LANES))
        assert np.all(np.count_nonzero(refracted.weight, axis=1) == 1)
        np.testing.assert_allclose(refracted.wi[:, 0] * 1.5 / liquid[lanes], -wo.x, rtol=1e-6)

    def test_dispersive_thin_sheets_keep_all_lanes(self):
        start = Spectrum([0.1, 2.9, 0.3, 0.7])
        for degrees in (50.0, 130.0):
            wo = direction(degrees)
            samples = sampled(materials(THIN_DIELECTRIC, is_dispersive=1), wo, strata(), ratio=start)
            faces = [fresnel_dielectric(abs(wo.z), float(n))[0] for n in RESOLVED[GLASS]]
            reflected = samples.wi[:, 2] * wo.z > 0.0
            mean = (samples.weight * reflected[:, None]).mean(0)
            np.testing.assert_allclose(mean, slab_reflectance(np.array(faces)), atol=2.0 / STRATA)
            np.testing.assert_array_equal(samples.ratio, np.tile(start.values, (STRATA, 1)))
