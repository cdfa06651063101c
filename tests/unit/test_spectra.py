"""Spectra become exact bin averages; files are read or refused by line; names lead to the CIE's tables."""

import math
import os
import runpy
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from artist_py import data
from artist_py.errors import SceneError
from artist_py.scene import spectra
from artist_py.scene.sample_files import read_samples
from artist_py.scene.spectra import check_emission, check_reflectance, integrate, luminance, tabulate
from artist_py.scene.spectrum_types import (
    Blackbody,
    Constant,
    File,
    Gaussian,
    Lines,
    Named,
    Rgb,
    Sampled,
)

FIRST, LAST = 300, 780


def light(spectrum, first=FIRST, last=LAST):
    return tabulate(spectrum, first, last, "emission")


def material(spectrum, first=FIRST, last=LAST):
    return tabulate(spectrum, first, last, "reflectance")


def test_constant_is_scaled():
    assert np.array_equal(light(Constant(2.0, scale=1.5)), np.full(480, 3.0))


# --- exact bin averages -----------------------------------------------------------------------------------


def test_narrow_line_keeps_its_energy_in_one_bin():
    table = light(Lines(((546.07, 3.0),), width=0.1))
    assert table[246] == pytest.approx(3.0, rel=1e-12)
    assert np.count_nonzero(table) == 1


def test_line_on_an_edge_is_shared_by_both_bins():
    table = light(Lines(((500.0, 1.0),), width=0.1))
    assert table[199:201] == pytest.approx([0.5, 0.5], abs=1e-12)


def test_line_at_the_end_of_the_range_loses_what_lies_beyond():
    assert integrate(light(Lines(((380.0, 1.0),), width=2.0), first=380)) == pytest.approx(0.5, abs=1e-12)


@given(st.floats(330, 750), st.floats(1e-3, 50), st.floats(1e-6, 1e6))
def test_lines_of_any_width_keep_their_energy(nm, width, weight):
    assert integrate(light(Lines(((nm, weight),), width=width))) == pytest.approx(weight, rel=1e-12)


@given(st.floats(310, 700), st.floats(1e-3, 30), st.floats(1e-3, 30))
def test_triangle_keeps_its_area(left, rise, fall):
    triangle = Sampled((left, left + rise, left + rise + fall), (0.0, 2.0, 0.0))
    assert integrate(light(triangle)) == pytest.approx(rise + fall, rel=1e-12)


def test_triangle_within_one_bin():
    table = light(Sampled((500.25, 500.5, 500.75), (0.0, 4.0, 0.0)))
    assert table[200] == pytest.approx(1.0, abs=1e-14)
    assert np.count_nonzero(table) == 1


def test_averages_of_a_ramp_are_its_values_at_bin_centres():
    table = light(Sampled((300, 780), (0.0, 480.0)))
    assert table == pytest.approx(np.arange(480) + 0.5, abs=1e-12)


@given(
    st.lists(
        st.tuples(st.floats(320, 760), st.floats(0, 100)), min_size=2, max_size=30, unique_by=lambda s: s[0]
    )
)
def test_samples_are_integrated_exactly_and_stay_within_their_values(samples):
    nm, values = np.array(sorted(samples)).T
    table = light(Sampled(tuple(nm), tuple(values)))
    assert integrate(table) == pytest.approx(np.trapezoid(values, nm), rel=1e-11, abs=1e-11)
    assert table.min() >= 0.0 and table.max() <= values.max() * (1 + 1e-12)


def test_box_between_samples_starts_and_ends_sharply():
    table = light(Sampled((400.25, 410.0), (1.0, 1.0)))
    assert table[99:101] == pytest.approx([0.0, 0.75], abs=1e-15)
    assert table[109:111] == pytest.approx([1.0, 0.0], abs=1e-15)


def test_gaussian_has_its_integral_and_matches_quadrature():
    table = light(Gaussian((530.0, 20.0), peak=0.7, scale=2.0))
    assert integrate(table) == pytest.approx(1.4 * 20 * math.sqrt(2 * math.pi), rel=1e-12)
    fine = 512 + (np.arange(1000) + 0.5) / 1000
    assert table[212] == pytest.approx(1.4 * np.mean(np.exp(-0.5 * ((fine - 530) / 20) ** 2)), rel=1e-7)


def test_gaussian_narrower_than_a_bin_keeps_its_energy():
    table = light(Gaussian((555.5, 0.01)))
    assert table[255] == pytest.approx(0.01 * math.sqrt(2 * math.pi), rel=1e-12)


@pytest.mark.parametrize("kelvin", [100, 1000, 2856, 6500, 20000])
def test_blackbody_matches_scipys_constants(kelvin):
    from scipy.constants import c, h, k
    from scipy.integrate import quad

    def planck(nm):
        metres = nm * 1e-9
        return 2e-9 * h * c**2 / metres**5 / np.expm1(h * c / (metres * k * kelvin))

    table = light(Blackbody(kelvin))
    for nm in (300, 555, 779):
        assert table[nm - 300] == pytest.approx(quad(planck, nm, nm + 1)[0], rel=1e-10)


def test_blackbody_obeys_stefan_and_boltzmann():
    table = tabulate(Blackbody(6000.0), 50, 200_000, "emission")
    assert math.pi * integrate(table) == pytest.approx(5.670374419e-8 * 6000**4, rel=1e-4)


def test_cold_blackbody_is_dark_not_undefined():
    assert np.all(light(Blackbody(1.0)) == 0.0)


# --- the ends of samples ----------------------------------------------------------------------------------


def test_lights_end_and_materials_go_on():
    samples = Sampled((400, 700), (0.25, 0.75))
    assert light(samples)[[50, 450]] == pytest.approx([0.0, 0.0])
    assert material(samples)[[50, 450]] == pytest.approx([0.25, 0.75])
    assert tabulate(samples, FIRST, LAST, "reflectance", extend="zero")[50] == 0.0


def test_samples_outside_the_range_are_cut():
    table = light(Sampled((100, 2000), (1.0, 1.0)), 380, 780)
    assert table == pytest.approx(np.ones(400), abs=1e-15)
    assert np.all(light(Sampled((900, 1000), (1.0, 1.0))) == 0.0)
    assert np.all(material(Sampled((900, 1000), (0.3, 1.0))) == 0.3)


def test_one_sample_is_a_constant_material_but_no_light():
    assert np.all(material(Sampled((550,), (0.4,))) == 0.4)
    with pytest.raises(SceneError, match="one sample makes no light"):
        light(Sampled((550,), (0.4,)))


def test_samples_that_do_not_increase_are_refused():
    with pytest.raises(SceneError, match="a wavelength above 500, since they increase"):
        material(Sampled((500, 500), (0.1, 0.2)))
    with pytest.raises(SceneError, match="one per wavelength"):
        material(Sampled((500, 600), (0.1,)))


# --- names ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["A", "C", "D50", "D65", "D75", "E"])
def test_broad_illuminants_are_one_at_560_nm(name):
    assert np.interp(560.0, *spectra.illuminant(name)) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("name", ["FL2", "FL11", "HP1", "LED-B3", "LED-RGB1"])
def test_lamps_are_as_luminous_as_a_flat_spectrum(name):
    flat = luminance(np.ones(530), 300)
    assert luminance(light(Named(name), 300, 830), 300) == pytest.approx(flat, rel=1e-12)


def test_every_documented_illuminant_exists_and_is_a_light():
    documented = ["A", "B", "C", "D50", "D55", "D60", "D65", "D75", "E", "LED-RGB1", "LED-V1"]
    documented += [f"FL{i}" for i in range(1, 13)] + [
        f"{lamp}{i}" for lamp in ("HP", "LED-B") for i in range(1, 6)
    ]
    assert set(documented) <= set(data.names("illuminant"))
    for name in data.names("illuminant"):
        assert check_emission(light(Named(name)), FIRST) is None
        assert integrate(light(Named(name))) > 0


def test_ultraviolet_is_where_the_standard_has_it():
    assert light(Named("D65"))[0] > 0 and light(Named("A"))[0] > 0
    assert np.all(light(Named("FL2"))[:80] == 0.0)


def test_colorchecker_patches_are_reflectances():
    patches = data.names("reflectance")
    assert len(patches) == 24
    for name in patches:
        assert check_reflectance(material(Named(name)), FIRST) is None
    assert material(Named("ColorChecker white 9.5"), 420, 780).min() > 0.84


@pytest.mark.parametrize(("name", "hint"), [("D66", '"D65"'), ("led-b1", '"LED-B1"'), ("zzz", "expected")])
def test_unknown_names_lead_to_known_ones(name, hint):
    with pytest.raises(SceneError, match=f'unknown spectrum "{name}"') as caught:
        light(Named(name))
    assert hint in str(caught.value)


def test_luminance_matches_colour_science():
    colour = pytest.importorskip("colour")
    for name in ("A", "D65", "FL11", "HP1", "LED-B4"):
        theirs = (
            colour.SDS_ILLUMINANTS[name]
            .copy()
            .interpolate(colour.SpectralShape(380, 780, 1), interpolator=colour.LinearInterpolator)
        )
        scale = np.interp(560.0, *spectra.illuminant(name)) / theirs[560.0]
        ybar = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"][theirs.wavelengths][:, 1]
        expected = 683.002 * np.trapezoid(theirs.values * scale * ybar, theirs.wavelengths)
        assert luminance(light(Named(name), 380, 780), 380) == pytest.approx(expected, rel=1e-4)


def test_packaged_tables_are_what_the_script_bakes():
    pytest.importorskip("colour")
    script = Path(data.FOLDER).parents[1] / "scripts" / "bake_tables.py"
    bake = runpy.run_path(str(script))
    assert bake["is_current"](bake["baked_tables"]())


def test_luminance_of_the_definition_of_the_candela():
    # ybar at 555 nm is 1, and 1 W m^-2 sr^-1 there is 683 cd m^-2.
    line = light(Lines(((555.0, 1.0),), width=0.1))
    assert luminance(line, FIRST) == pytest.approx(683.0, rel=2e-4)


# --- RGB --------------------------------------------------------------------------------------------------


@given(st.tuples(*[st.floats(0, 1)] * 3))
def test_rgb_reflectances_stay_within_zero_and_one(rgb):
    assert check_reflectance(material(Rgb(rgb)), FIRST) is None


def test_white_is_exactly_white_and_rgb_is_linear():
    assert material(Rgb((1.0, 1.0, 1.0))) == pytest.approx(np.ones(480), abs=1e-15)
    basis = spectra.rgb_basis(FIRST, LAST, "reflectance")
    assert material(Rgb((0.2, 0.5, 0.7), scale=0.5)) == pytest.approx(0.5 * np.array([0.2, 0.5, 0.7]) @ basis)


def test_rgb_light_is_dark_in_the_ultraviolet():
    assert np.all(light(Rgb((1.0, 1.0, 1.0)))[:80] == 0.0)


# --- checks -----------------------------------------------------------------------------------------------


def test_checks_name_the_worst_wavelength():
    values = np.full(480, 0.5)
    assert check_reflectance(values, 300) is None
    values[[10, 20]] = 1.1, 1.5
    assert check_reflectance(values, 300) == "expected a reflectance from 0 to 1, found 1.5 at 320 nm"
    assert check_emission(values, 300) is None
    values[30] = -2.0
    assert "found -2 at 330 nm" in check_emission(values, 300)
    assert "nan" in check_emission(np.array([1.0, np.nan]), 300)
    assert "inf" in check_emission(np.array([1.0, np.inf]), 300)


# --- files ------------------------------------------------------------------------------------------------


def write(folder, text, name="samples.csv"):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(path)


@pytest.mark.parametrize(
    "text",
    [
        "400,0.1\n500,0.2\n",
        "# measured\nnm,reflectance\n400, 0.1\n\n500, 0.2,\n",
        "400 0.1\n  500\t0.2\n".replace("\t", "   "),
        "400\t0.1\r\n500\t0.2\r\n",
        "400;0,1\n500;0,2\n",
        "400\t0,1\n500\t0,2\n",
        "\ufeff; comment\n400 1e-1 # first\n500 2e-1",
        "nm;\u00b5W\n400;0.1;9\n500;0.2;9\n".encode("latin-1"),
    ],
)
def test_files_of_many_dialects_say_the_same(tmp_path, text):
    assert read_samples(write(tmp_path, text)) == ((400.0, 500.0), (0.1, 0.2))


def test_a_column_of_several_and_the_scale(tmp_path):
    path = write(tmp_path, "nm,n,k\n400,1,3\n500,2,4\n")
    assert read_samples(path, 2)[1] == (3.0, 4.0)
    assert material(File(path, column=2, scale=0.1))[0] == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("text", "column", "line", "message"),
    [
        ("400 1\n390 2\n", 1, 2, "a wavelength above 400, since they increase, found 390"),
        ("400 1\n400 2\n", 1, 2, "a wavelength above 400"),
        ("400 1\n500 nan\n", 1, 2, 'a finite number, found "nan"'),
        ("400 1\ninf 2\n", 1, 2, 'a wavelength in nm, found "inf"'),
        ("-400 1\n500 2\n", 1, 1, 'a wavelength in nm, found "-400"'),
        ("400 1\n", 2, 1, "3 columns or more, found 2"),
        ("400,1\n500\n", 1, 2, "2 columns or more, found 1"),
        ("nm,R\nunit,percent\n400,1\n", 1, 2, 'a wavelength in nm, found "unit"'),
        ("400,1\n500,much\n", 1, 2, 'a finite number, found "much"'),
        ("0.4 1\n0.5 2\n", 1, 1, "looks like micrometres"),
        ("", 1, None, "found none"),
        ("# nothing\nnm,R\n", 1, None, "found none"),
        (b"\x89PNG\x00\x01", 1, None, "found no text"),
        ("400 1\n500 2\n".encode("utf-16"), 1, None, "found no text"),
    ],
)
def test_bad_files_are_refused_by_file_and_line(tmp_path, text, column, line, message):
    path = write(tmp_path, text)
    with pytest.raises(SceneError) as caught:
        light(File(path, column=column))
    (problem,) = caught.value.problems
    assert (problem.file, problem.line) == (path, line)
    assert message in problem.message


def test_lights_of_files_are_not_negative(tmp_path):
    path = write(tmp_path, "400 1\n500 -1\n600 1\n")
    assert material(File(path)).min() < 0  # a property, whose bounds are its material's
    with pytest.raises(SceneError, match="expected a radiance of at least 0, found -0.99 at 499 nm"):
        light(File(path))


def test_all_bad_lines_are_told_but_not_thousands(tmp_path):
    path = write(tmp_path, "nm R\n" + "x y\n" * 1000)
    with pytest.raises(SceneError) as caught:
        read_samples(path)
    assert [problem.line for problem in caught.value.problems] == [2, 3, 4, 5, 6, None]
    assert caught.value.problems[-1].message == "and 995 more like these"


def test_unreadable_files(tmp_path):
    with pytest.raises(SceneError, match="no such file"):
        read_samples(str(tmp_path / "missing.csv"))
    with pytest.raises(SceneError, match="is a directory"):
        read_samples(str(tmp_path))
    path = write(tmp_path, "400 1\n500 1\n")
    os.chmod(path, 0)
    if os.access(path, os.R_OK):
        pytest.skip("this user may read everything")
    with pytest.raises(SceneError, match="permission denied"):
        read_samples(path)
