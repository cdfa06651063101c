"""Dyes under a clear coat: the light that the coat keeps inside, what comes out of it, and what lobes are chosen by."""

from types import SimpleNamespace

import numpy as np
import pytest
from fluorescence import CASCADE, ORANGE, RANGE
from rendering import look, scene, shape
from scipy import integrate

from artist_py.bsdf.dispatch import evaluate_bsdf, pdf_bsdf
from artist_py.bsdf.fluorescence import albedo_under_white, reradiation_factor
from artist_py.bsdf.plastic import base_below, colour_below
from artist_py.core.fresnel import fresnel_dielectric
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3
from artist_py.scene.optics import diffuse_transmittance, internal_reflectance
from artist_py.scene.reradiation import under_coat
from artist_py.scene.tables import PLASTIC, Fluorescence, Needs, Spectra, material_dtype

BINS = 60
INDICES = [1.0, 1.33, 1.5, 3.0, 10.0]
NEEDS = Needs(plastic=True, coated_dyes=True, fluorescence=True, one_sided=True)
SPECTRA = Spectra(Table(np.zeros((1, 2), np.float32)), None, 300.0)
LANES = Spectrum([400.0, 500.0])
ANGLES = [0.0, 40.0, 75.0, 89.0]


def base(seed=0, total=1.0):
    """Reflectance and matrix, at random, of a base that gives off `total` of the light at every wavelength."""
    random = np.random.default_rng(seed)
    reflectance = random.uniform(0.0, 0.6, BINS) * total
    reflectance[-1] = total
    matrix = np.tril(random.uniform(size=(BINS, BINS)), -1)
    matrix *= (total - reflectance) / np.maximum(matrix.sum(axis=0), 1e-9)
    return reflectance, matrix


@pytest.mark.parametrize("ior", INDICES)
def test_light_meets_the_base_again_and_again(ior):
    """What leaves the coat, bounce by bounce: the same as the closed form."""
    reflectance, matrix = base(total=0.9)
    inside = internal_reflectance(ior)
    scatter = np.diag(reflectance) + matrix
    leaving, part = np.zeros((BINS, BINS)), np.eye(BINS)
    for _ in range(400):
        part = scatter @ part
        leaving += (1.0 - inside) * part
        part = inside * part
    elastic = (1.0 - inside) * reflectance / (1.0 - inside * reflectance)
    np.testing.assert_allclose(under_coat(reflectance, matrix, ior), leaving - np.diag(elastic), atol=1e-12)


@pytest.mark.parametrize("ior", INDICES)
def test_a_base_of_the_colour_that_is_seen(ior):
    """A base that is to be seen in some colour through the coat, even one that gives off more than it receives."""
    coat = SimpleNamespace(transmittance=diffuse_transmittance(ior), ior=ior)
    below = Spectrum([0.0, 0.3, 0.99, 1.7])
    np.testing.assert_allclose(colour_below(coat, base_below(coat, below)).values, below.values, rtol=2e-4)


@pytest.mark.parametrize("ior", INDICES)
def test_power_is_kept(ior):
    """A base that gives off all that arrives gives off, through the coat, all that has entered it; others less."""
    reflectance, matrix = base()
    inside = internal_reflectance(ior)
    elastic = (1.0 - inside) * reflectance / (1.0 - inside * reflectance)
    total = elastic + under_coat(reflectance, matrix, ior).sum(axis=0)
    np.testing.assert_allclose(total, 1.0, rtol=1e-12)
    darker = under_coat(*base(total=0.9), ior).sum(axis=0)
    assert (darker < 1.0).all() and (darker >= 0.0).all()


def test_a_coat_like_what_surrounds_it_changes_nothing():
    reflectance, matrix = base()
    np.testing.assert_allclose(under_coat(reflectance, matrix, 1.0), matrix, atol=1e-14)


def test_nothing_is_given_off_outside_the_bands():
    """Zeros of the matrix stay zeros: above the diagonal, below the absorption, outside the emission."""
    reflectance = np.linspace(0.1, 0.6, BINS)
    matrix = np.zeros((BINS, BINS))
    matrix[40:50, 10:20] = 0.03
    coated = under_coat(reflectance, matrix, 1.5)
    assert (coated[40:50, 10:20] > 0.0).all()
    coated[40:50, 10:20] = 0.0
    assert (coated == 0.0).all()


# --- directions ---------------------------------------------------------------------------------------------------


def coated(reflectance_row=0, ior=1.5, two_sided=1, glow=0.3):
    """A row of the materials."""
    table = np.zeros(1, material_dtype)
    table["kind"], table["reflectance"], table["two_sided"], table["glow"] = (
        PLASTIC,
        reflectance_row,
        two_sided,
        glow,
    )
    table["ior"], table["transmittance"], table["texture"] = ior, diffuse_transmittance(ior), -1
    return Table(table)[0]


def dyes():
    """`Fluorescence` of two sets of one wavelength: 0.5 of the second is given off at the first."""
    coefficients = Table(np.array([[0.5, 0.0]], np.float32)), Table(np.array([[0.0, 0.5]], np.float32))
    zero, one = Spectrum([0.0, 0.0]), Spectrum([1.0])
    return Fluorescence(
        *coefficients,
        survival=Table(np.ones(1)),
        zero=zero,
        sets=zero,
        rows=zero,
        coefficients=zero,
        matrix=Spectrum([1.0, 0.0]),
        white=Spectrum([1.0, 1.0]),
        colour=zero,
        unit=one,
        ratio=None,
        control=None,
    )


def towards(degrees, azimuth=0.0):
    angle = np.radians(degrees)
    return Vec3((np.sin(angle) * np.cos(azimuth), np.sin(angle) * np.sin(azimuth), np.cos(angle)))


def entering(degrees, ior=1.5):
    """1 - F."""
    return 1.0 - fresnel_dielectric(np.cos(np.radians(degrees)), ior)[0]


@pytest.mark.parametrize("degrees", ANGLES)
def test_light_leaves_as_it_enters(degrees):
    """f_fl is the same for swapped directions, and from behind the same as in front."""
    material, wo, wi = coated(), towards(degrees), towards(30.0, 1.0)
    forward = reradiation_factor(dyes(), NEEDS, material, wo, wi)
    assert forward == reradiation_factor(dyes(), NEEDS, material, wi, wo)
    assert forward == reradiation_factor(dyes(), NEEDS, material, -wo, -wi)
    expected = entering(degrees) * entering(30.0) / (np.pi * diffuse_transmittance(1.5))
    np.testing.assert_allclose(forward, expected, rtol=1e-12)


def test_nothing_goes_through_or_comes_from_a_black_back():
    up, down = towards(20.0), towards(150.0)
    assert reradiation_factor(dyes(), NEEDS, coated(), up, down) == 0.0
    assert reradiation_factor(dyes(), NEEDS, coated(two_sided=0), down, down) == 0.0
    assert reradiation_factor(dyes(), NEEDS, coated(two_sided=0), up, up) > 0.0


@pytest.mark.parametrize("degrees", ANGLES)
def test_diffuse_light_comes_out_as_it_goes_in(degrees):
    """The integral of f_fl cos over all directions is T(wo): what the albedo image takes it to be."""
    material, wo = coated(), towards(degrees)

    def ring(cosine):
        wi = towards(np.degrees(np.arccos(cosine)))
        return 2.0 * np.pi * cosine * reradiation_factor(dyes(), NEEDS, material, wo, wi)

    integral, _ = integrate.quad(ring, 0.0, 1.0, points=[0.01, 0.1], epsabs=1e-10)
    np.testing.assert_allclose(integral, entering(degrees), rtol=1e-8)
    black = Spectrum([0.0, 0.0])
    albedo = albedo_under_white(dyes(), NEEDS, material, black, wo, Spectrum([0.0]))
    np.testing.assert_allclose(albedo.values, [0.5 * entering(degrees)], rtol=1e-6)


def test_a_base_that_only_glows_is_sampled():
    """A black base reflects nothing at its own wavelength, but for its dye directions have to be drawn."""
    wo, wi, black = towards(20.0), towards(50.0), Spectrum([0.0, 0.0])
    for glow, is_drawn in ((0.3, True), (0.0, False)):
        pdf = pdf_bsdf(NEEDS, coated(glow=glow), black, SPECTRA, LANES, wo, wi)
        assert (pdf > 0.0) == is_drawn
    assert (evaluate_bsdf(NEEDS, coated(), black, SPECTRA, LANES, wo, wi).values == 0.0).all()


# --- scenes -------------------------------------------------------------------------------------------------------


def ball(*materials):
    """A compiled scene with a lit ball of each material."""
    shapes = [shape("sphere", f"m{i}", center=[3 * i, 4, 0], radius=1) for i in range(len(materials))]
    lamp = shape("sphere", center=[0, 0, 3], radius=0.5, emission={"spectrum": "D65"})
    return scene(
        [*shapes, lamp],
        materials={f"m{i}": material for i, material in enumerate(materials)},
        camera=look([0, 0, 0], [0, 1, 0]),
        render={"wavelength_range": RANGE},
    )


def test_a_coat_makes_a_fluorescent_material_plastic():
    compiled = ball({**CASCADE, "coat_ior": 1.4}, ORANGE)
    rows, fluorescence = compiled.scene.materials.array[1:], compiled.fluorescence
    assert rows["kind"][0] == PLASTIC != rows["kind"][1]
    assert rows["ior"][0] == 1.4 and rows["transmittance"][0] == diffuse_transmittance(1.4)
    assert compiled.scene.needs.plastic and compiled.scene.needs.coated_dyes
    assert (fluorescence.totals[0] == 1.0).all() and fluorescence.totals[1].max() < 1.0
    assert (0.0 < rows["glow"]).all() and (rows["glow"] < fluorescence.matrices.sum(axis=1).max(axis=1)).all()


@pytest.mark.parametrize("materials", [(CASCADE, {"type": "plastic"}), ({"type": "plastic"},)])
def test_without_a_coat_nothing_of_it_is_needed(materials):
    assert ball(*materials).scene.needs.coated_dyes is None
