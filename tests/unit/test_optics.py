"""Refractive indices agree with the catalogues they come from; metals reflect as measured."""

import numpy as np
import pytest

from artist_py.errors import SceneError
from artist_py.scene import optics
from artist_py.scene.optics import glasses, ior_table, is_dispersive, metal_table, metals
from artist_py.scene.spectrum_types import Cauchy, Constant, File, Named, Sampled, Sellmeier
from artist_py.scene.where import Source, Where

D_F_C = np.array([587.5618, 486.1327, 656.2725])  # Fraunhofer lines, nm


def index_and_abbe_number(name):
    n_d, n_f, n_c = glasses()[name].index(D_F_C)
    return n_d, (n_d - 1.0) / (n_f - n_c)


@pytest.mark.parametrize(
    ("name", "n_d", "v_d"),
    [
        ("N-BK7", 1.51680, 64.17),
        ("SF10", 1.72825, 28.41),
        ("N-SF10", 1.72828, 28.53),
        ("SF11", 1.78472, 25.76),
        ("N-SF11", 1.78472, 25.68),
        ("F2", 1.62004, 36.37),
        ("N-F2", 1.62005, 36.43),
        ("N-LAK8", 1.71300, 53.83),
        ("N-SF66", 1.92286, 20.88),
        ("fused-silica", 1.45846, 67.82),
        ("fluorite", 1.43384, 95.23),
    ],
)
def test_well_known_glasses(name, n_d, v_d):
    assert index_and_abbe_number(name) == (pytest.approx(n_d, abs=2e-5), pytest.approx(v_d, rel=3e-3))


def test_the_whole_catalogue_agrees_with_its_own_constants():
    catalogued = {name: glass for name, glass in glasses().items() if glass.n_d}
    assert len(catalogued) > 100
    for name, glass in catalogued.items():
        n_d, v_d = index_and_abbe_number(name)
        assert n_d == pytest.approx(glass.n_d, abs=2e-5), name
        assert v_d == pytest.approx(glass.v_d, abs=0.02), name


@pytest.mark.parametrize(
    ("name", "nm", "n", "tolerance"),
    [  # textbook values at the sodium line
        ("water", 589.3, 1.3330, 5e-4),
        ("ice", 589.3, 1.3097, 2e-4),
        ("diamond", 589.3, 2.4175, 1e-3),
        ("sapphire", 589.3, 1.7682, 5e-4),
        ("quartz", 589.3, 1.5442, 3e-4),
        ("calcite", 589.3, 1.6584, 3e-4),
        ("salt", 589.3, 1.5441, 3e-4),
        ("acrylic", 589.3, 1.4905, 1e-3),
        ("polycarbonate", 589.3, 1.585, 1e-3),
        ("cubic-zirconia", 589.3, 2.158, 2e-3),
        ("rutile", 589.3, 2.613, 3e-3),
    ],
)
def test_other_media(name, nm, n, tolerance):
    assert glasses()[name].index(np.array([nm]))[0] == pytest.approx(n, abs=tolerance)


def test_every_index_is_tame_over_the_whole_range():
    for name in glasses():
        table = ior_table(Named(name), 300, 830)
        assert 1.0 <= table.min() and table.max() < 3.5, name
        assert np.all(np.diff(table) <= 0), name  # normal dispersion; no pole is near


def test_names_that_mean_the_same():
    assert np.array_equal(ior_table(Named("PMMA"), 380, 780), ior_table(Named("acrylic"), 380, 780))


def test_formulas_at_bin_centres():
    centers = (np.arange(380, 780) + 0.5) / 1000
    cauchy = ior_table(Cauchy((1.5, 0.004, 1e-5)), 380, 780)
    assert cauchy == pytest.approx(1.5 + 0.004 / centers**2 + 1e-5 / centers**4, abs=1e-14)
    sellmeier = ior_table(Sellmeier(((1.0, 0.01), (0.5, 100.0))), 380, 780)
    squared = 1 + centers**2 / (centers**2 - 0.01) + 0.5 * centers**2 / (centers**2 - 100)
    assert sellmeier == pytest.approx(np.sqrt(squared), abs=1e-14)


def test_schott_glass_by_its_coefficients_is_the_glass_by_name():
    terms = ((1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653))
    assert ior_table(Sellmeier(terms), 300, 780) == pytest.approx(
        ior_table(Named("N-BK7"), 300, 780), abs=1e-12
    )


def test_numbers_samples_and_files(tmp_path):
    path = tmp_path / "index.csv"
    path.write_text("nm,n\n400,1.6\n500,1.5\n")
    assert np.all(ior_table(1.5, 380, 780) == 1.5)
    assert np.all(ior_table(Constant(1.4), 380, 780) == 1.4)
    for ior in (Sampled((400, 500), (1.6, 1.5)), File(str(path))):
        table = ior_table(ior, 380, 780)
        assert table[[0, 20, 60, 200]] == pytest.approx([1.6, 1.5995, 1.5595, 1.5], abs=1e-12)


def test_what_is_dispersive():
    assert not is_dispersive(ior_table(1.5, 380, 780))
    assert not is_dispersive(ior_table(Cauchy((1.5,)), 380, 780))
    assert not is_dispersive(ior_table(Sampled((500,), (1.5,)), 380, 780))
    assert is_dispersive(ior_table(Cauchy((1.5, 1e-9)), 380, 780))
    assert is_dispersive(ior_table(Named("N-BK7"), 380, 780))


@pytest.mark.parametrize(
    "ior", [Constant(0.0), Cauchy((-1.0, 0.1)), Sellmeier(((1.0, 0.2),)), Sellmeier(((-3.0, 0.0),))]
)
def test_impossible_indices_are_refused(ior):
    with pytest.raises(SceneError, match="expected a refractive index above 0, found"):
        ior_table(ior, 380, 780)


@pytest.mark.parametrize(
    ("call", "hint"),
    [
        (lambda: ior_table(Named("bk7"), 380, 780), '"N-BK7"'),
        (lambda: ior_table(Named("Water"), 380, 780), '"water"'),
        (lambda: metal_table("GOLD", 380, 780), '"gold"'),
        (lambda: metal_table("alumnium", 380, 780), '"aluminium"'),
    ],
)
def test_unknown_names_lead_to_known_ones(call, hint):
    with pytest.raises(SceneError, match="did you mean") as caught:
        call()
    assert hint in str(caught.value)


def test_unknown_metal_stands_where_the_scene_names_it():
    source = Source("a.toml", '[materials.m]\nmetal = "unobtainium"\n', {})
    node = Constant(1.0, where=Where(source, ("materials", "m")))
    with pytest.raises(SceneError, match="a.toml:2: materials.m.metal: unknown metal"):
        metal_table("unobtainium", 380, 780, node)


def normal_reflectance(name):
    eta, k = metal_table(name, 300, 780)
    return ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)


@pytest.mark.parametrize(
    ("name", "at_450", "at_550", "at_650"),
    [  # reflectance of polished metal at normal incidence, as handbooks have it
        ("Ag", 0.97, 0.98, 0.98),
        ("Au", 0.39, 0.80, 0.96),
        ("Cu", 0.55, 0.63, 0.94),
        ("Al", 0.92, 0.915, 0.905),
        ("Cr", 0.56, 0.55, 0.56),
        ("Ni", 0.57, 0.64, 0.70),
    ],
)
def test_metals_reflect_as_handbooks_say(name, at_450, at_550, at_650):
    assert normal_reflectance(name)[[150, 250, 350]] == pytest.approx([at_450, at_550, at_650], abs=0.03)


def test_all_metals_are_sound():
    assert {"Au", "Ag", "Cu", "Al", "Cr", "Ni", "Ti", "W", "Fe", "Pt", "Pd", "brass"} <= set(metals())
    for name, (nm, eta, k) in metals().items():
        assert np.all(np.diff(nm) > 0) and np.all(eta > 0) and np.all(k > 0), name
        assert nm[0] < 400 and nm[-1] > 780, name
        assert 0.03 < normal_reflectance(name).min() and normal_reflectance(name).max() < 1.0, name


def test_measured_samples_are_met_exactly():
    # Johnson and Christy 1972, gold at 1.88 eV: n = 0.14, k = 3.697.
    nm, eta, k = metals()["gold"]
    at = int(np.argmin(abs(nm - 659.5)))
    assert (nm[at], eta[at], k[at]) == (659.5, 0.14, 3.697)


def test_tables_are_read_once():
    assert optics.glasses() is optics.glasses() and optics.metals() is optics.metals()
