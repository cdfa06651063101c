"""Reradiation by bins: closed forms of dyes and bell curves, measured matrices, and that no power is gained."""

import math

import numpy as np
import pytest
from fluorescence import CASCADE, RANGE, colours, on_bins, on_sets, room
from rendering import compile_tables, shape

from artist_py.scene.reader import read_scene_text
from artist_py.scene.reradiation import glow_of
from artist_py.stress.toml import to_toml

CENTRES = np.arange(*RANGE) + 0.5
MATRIX = """excitation,400,410,420,430
400,0.30,0,0.0004,0
410,0.001,0.31,0,0
420,0.002,0.003,0.32,0
430,0.004,0.005,-0.0001,0.33
"""


def material(**keys):
    """A `Fluorescent` of these keys."""
    camera = {"type": "pinhole", "position": [0, 0, 0], "look_at": [1, 0, 0]}
    return read_scene_text(to_toml({"camera": camera, "materials": {"dye": keys}})).materials["dye"]


def dye(**keys):
    return material(type="fluorescent", **keys)


def boxed(low, high, value=1.0):
    """A spectrum that is `value` between two wavelengths, with edges of 1 / 1000 nm."""
    return {
        "wavelengths": [low - 0.001, low, high, high + 0.001],
        "values": [0, value, value, 0],
    }


def test_a_dye_gives_off_its_yield_of_photons():
    """Absorption below, emission above: photons off per photon on are Q a, whatever the wavelengths."""
    glow = glow_of(dye(absorption=boxed(400, 450, 0.6), emission=boxed(520, 600), quantum_yield=0.8), *RANGE)
    photons = (glow.matrix * CENTRES[:, None] / CENTRES).sum(axis=0)
    expected = np.where((CENTRES > 400) & (CENTRES < 450), 0.8 * 0.6, 0.0)
    np.testing.assert_allclose(photons, expected, atol=1e-3)
    # Of the same power per nm, the energy of one photon over that of the other is the ratio of wavelengths.
    mean_emitted = CENTRES[220:300].mean()
    np.testing.assert_allclose(glow.matrix[:, 125].sum(), 0.8 * 0.6 * CENTRES[125] / mean_emitted, rtol=1e-3)


def test_nothing_is_given_off_outside_the_bands():
    glow = glow_of(dye(absorption=boxed(400, 450, 0.6), emission=boxed(520, 600)), *RANGE)
    out, into = np.nonzero(glow.matrix)
    assert CENTRES[out].min() > 519 and CENTRES[out].max() < 601
    assert CENTRES[into].min() > 399 and CENTRES[into].max() < 451


def test_light_is_given_off_at_longer_wavelengths_only():
    """A Stokes shift of 1 nm: half of the emission would lie below, and none is."""
    glow = glow_of(dye(absorption={"gaussian": [500, 20]}, emission={"gaussian": [501, 20]}), *RANGE)
    assert np.triu(glow.matrix).max() == 0.0 and glow.matrix.max() > 0.0
    assert glow.matrix.sum(axis=0).max() <= 1.0


def test_bell_curves_give_off_their_strength():
    glow = glow_of(dye(reradiation={"excitation": [400, 10], "emission": [550, 20], "strength": 0.7}), *RANGE)
    bell = np.exp(-0.5 * ((CENTRES - 400) / 10) ** 2)
    np.testing.assert_allclose(glow.matrix.sum(axis=0), 0.7 * bell, atol=1e-3)


def measured(tmp_path, **keys):
    path = tmp_path / "matrix.csv"
    path.write_text(MATRIX, encoding="utf-8")
    return glow_of(dye(reradiation={"file": str(path), **keys}), *RANGE)


def test_measured_values_hold_for_their_bands(tmp_path):
    glow = measured(tmp_path)
    assert glow.matrix[432 - 300, 401 - 300] == 0.004 and glow.matrix[424 - 300, 406 - 300] == 0.003
    assert glow.matrix[436 - 300, 401 - 300] == 0.0 and glow.matrix[432 - 300, 394 - 300] == 0.0
    assert np.triu(glow.matrix).max() == 0.0
    np.testing.assert_allclose(glow.reflectance[[100, 110, 130]], [0.3005, 0.3105, 0.33], atol=1e-9)
    assert len(glow.warnings) == 2  # one negative value, one at a shorter wavelength


def test_values_at_shorter_wavelengths_are_kept_if_asked_for(tmp_path):
    glow = measured(tmp_path, anti_stokes=True)
    assert glow.matrix[400 - 300, 420 - 300] == 0.0004 and len(glow.warnings) == 1


def test_values_per_band_are_spread_over_it(tmp_path):
    assert math.isclose(measured(tmp_path, unit="per band", scale=0.5).matrix[132, 101], 0.5 * 0.004 / 10)


# --- sets of wavelengths ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("count", "iterations", "precision"), [(4, 1024, 3e-3), (8, 256, 3e-3), (1, 4096, 2e-2)]
)
def test_means_over_sets_are_the_solution_on_bins(count, iterations, precision):
    """Up to two fluorescent events are exact with three sets (3.5); a third is next to impossible here."""
    compiled = room(hero_count=count)
    found = np.mean([colours(on_sets(compiled, i), 5) for i in range(iterations)], axis=0)
    np.testing.assert_allclose(found, colours(on_bins(compiled), 5), rtol=precision)


def test_two_sets_are_exact_for_one_event():
    compiled = room(inner={"type": "diffuse", "reflectance": 0.4}, wavelength_sets=2, max_path_length=2)
    found = np.mean([colours(on_sets(compiled, i), 2) for i in range(4096)], axis=0)
    np.testing.assert_allclose(found, colours(on_bins(compiled), 2), rtol=1e-3)


def test_more_power_is_never_given_off_than_absorbed():
    """In the closed room, whatever lights it: power per nm, summed, is at most what reflecting alone would allow."""
    surfaces = on_bins(room())
    assert surfaces.scatter.sum(axis=1).max() <= 1.0
    assert surfaces.scatter.min() >= 0.0


def test_a_scene_that_fluoresces_begins_in_the_ultraviolet():
    def lit(material):
        return compile_tables(
            {
                "camera": {"type": "pinhole", "position": [0, -4, 0], "look_at": [0, 0, 0]},
                "materials": {"dye": CASCADE, "plain": {"type": "diffuse"}},
                "shapes": [shape("sphere", material, center=[0, 0, 0], radius=1, emission=1)],
            }
        )

    glowing, plain = lit("dye"), lit("plain")
    assert glowing.wavelength_range == (300, 780) and glowing.graph.render.wavelengths == "shared"
    assert plain.wavelength_range == (380, 780) and plain.fluorescence is None
