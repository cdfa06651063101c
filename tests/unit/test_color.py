"""The sensor sees white points where the CIE puts them; curves for display; densities of wavelengths."""

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from artist_py.film import color
from artist_py.film.color import RGB_TO_XYZ, XYZ_TO_RGB, rgb_to_xyz, sensor_table, xy_of_xyz
from artist_py.film.wavelengths import inverse_cdf, wavelength_density
from artist_py.scene.spectra import tabulate
from artist_py.scene.spectrum_types import Lines, Named, Rgb

FIRST, LAST = 380, 780


def seen(spectrum, purpose="emission", observer="CIE 1931 2", first=FIRST, last=LAST):
    return sensor_table(first, last, observer) @ tabulate(spectrum, first, last, purpose)


# --- sensor and colour spaces -------------------------------------------------------------------------------


def test_matrix_is_that_of_the_standard():
    published = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    assert np.allclose(RGB_TO_XYZ, published, atol=5e-5)
    assert rgb_to_xyz([1.0, 1.0, 1.0]) == pytest.approx([0.3127 / 0.3290, 1.0, 0.3583 / 0.3290], abs=1e-12)
    assert XYZ_TO_RGB @ rgb_to_xyz([0.1, 0.5, 0.9]) == pytest.approx([0.1, 0.5, 0.9], abs=1e-14)


def test_flat_radiance_of_one_has_y_of_one():
    for observer in ("CIE 1931 2", "CIE 1964 10"):
        flat = sensor_table(300, 830, observer) @ np.ones(530)
        assert rgb_to_xyz(flat)[1] == pytest.approx(1.0, abs=1e-12)
    assert rgb_to_xyz(sensor_table(380, 780) @ np.ones(400))[1] == pytest.approx(1.0, abs=2e-5)
    assert color.flat_luminance() == pytest.approx(72983.3, abs=0.5)


@pytest.mark.parametrize(
    ("name", "xy"),
    [
        ("D65", (0.31272, 0.32903)),
        ("A", (0.44757, 0.40745)),
        ("C", (0.31006, 0.31616)),
        ("D50", (0.34567, 0.35850)),
        ("D75", (0.29902, 0.31485)),
        ("E", (0.33333, 0.33333)),
    ],
)
def test_white_points_of_cie_15(name, xy):
    assert xy_of_xyz(rgb_to_xyz(seen(Named(name)))) == pytest.approx(xy, abs=1e-4)
    assert color.illuminant_xy(name) == pytest.approx(xy, abs=1e-4)


@pytest.mark.parametrize(
    ("name", "xy"),
    [
        ("FL2", (0.3721, 0.3751)),
        ("FL11", (0.3805, 0.3769)),
        ("LED-B1", (0.4560, 0.4078)),
        ("HP1", (0.5330, 0.4150)),
    ],
)
def test_white_points_of_lamps(name, xy):
    # The CIE gives four digits of sums over 5 nm; between 5 nm samples of a lamp other readings differ by this much.
    assert xy_of_xyz(rgb_to_xyz(seen(Named(name)))) == pytest.approx(xy, abs=3e-4)
    assert color.illuminant_xy(name) == pytest.approx(xy, abs=3e-4)


def test_ten_degree_observer():
    xyz = rgb_to_xyz(seen(Named("D65"), observer="CIE 1964 10"))
    assert xy_of_xyz(xyz) == pytest.approx((0.31382, 0.33100), abs=1e-4)


def test_ranges_share_their_bins():
    wide, narrow = sensor_table(300, 780), sensor_table(380, 780)
    assert np.array_equal(wide[:, 80:], narrow)
    assert np.all(wide[:, :60] == 0.0)


def test_d65_is_neutral():
    rgb = seen(Named("D65"))
    assert rgb / rgb.mean() == pytest.approx([1, 1, 1], abs=5e-4)


@given(st.tuples(*[st.floats(0, 1)] * 3))
def test_rgb_lights_render_as_themselves(rgb):
    assert seen(Rgb(rgb)) == pytest.approx(rgb, abs=6e-4)  # sRGB's white (0.3127, 0.3290) is D65 rounded


@given(st.tuples(*[st.floats(0, 1)] * 3))
def test_rgb_reflectances_under_d65_keep_their_colour(rgb):
    light = tabulate(Named("D65"), FIRST, LAST, "emission")
    reflectance = tabulate(Rgb(rgb), FIRST, LAST, "reflectance")
    sensor = sensor_table(FIRST, LAST)
    assert sensor @ (light * reflectance) / (sensor @ light) == pytest.approx(rgb, abs=1e-8)


def test_colorchecker_matches_colour_science():
    colour = pytest.importorskip("colour")
    light = tabulate(Named("D65"), 360, 780, "emission")
    sensor = sensor_table(360, 780)
    white = rgb_to_xyz(sensor @ light)[1]
    patches = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
    for name in ("dark skin", "blue sky", "orange", "cyan"):
        ours = (
            rgb_to_xyz(sensor @ (light * tabulate(Named(f"ColorChecker {name}"), 360, 780, "reflectance")))
            / white
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that it aligns the tables
            theirs = colour.sd_to_XYZ(patches[name], illuminant=colour.SDS_ILLUMINANTS["D65"]) / 100
        assert ours == pytest.approx(theirs, abs=5e-4)


# --- for display --------------------------------------------------------------------------------------------


def test_srgb_curve():
    assert color.encode_srgb([0.0, 0.0031308, 0.18, 1.0, 7.0, -1.0]) == pytest.approx(
        [0.0, 0.040449936, 0.461356, 1.0, 1.0, 0.0], abs=1e-6
    )


@given(st.floats(0, 1))
def test_srgb_curve_and_its_inverse(linear):
    assert color.decode_srgb(color.encode_srgb(linear)) == pytest.approx(linear, abs=1e-7)


def test_filmic_curve_rises_and_ends_at_white():
    values = color.filmic(np.concatenate([[-1.0, 0.0], np.geomspace(1e-6, 1e30, 500)]))
    assert np.all(np.diff(values) >= 0) and values[0] == values[1] == 0.0 and values[-1] == 1.0
    assert color.filmic([0.18, 1.0]) == pytest.approx([0.2669, 0.8038], abs=1e-4)


def test_exposure_counts_stops():
    assert color.expose([0.25, 1.0], 2) == pytest.approx([1.0, 4.0])


@pytest.mark.parametrize("name", ["A", "D50", "FL11"])
def test_adapted_white_is_neutral_and_keeps_its_brightness(name):
    rgb = seen(Named(name))
    adapted = color.adapt_white(rgb, color.xy_of_xyz(rgb_to_xyz(rgb)))
    assert adapted / adapted[0] == pytest.approx([1, 1, 1], abs=1e-9)
    assert rgb_to_xyz(adapted)[1] == pytest.approx(rgb_to_xyz(rgb)[1])


def test_adaptation_to_the_display_white_changes_nothing():
    rgb = np.random.default_rng(1).random((4, 5, 3))
    assert np.allclose(color.adapt_white(rgb, color.WHITE_XY), rgb, atol=1e-12)


def test_bradford_matches_colour_science():
    colour = pytest.importorskip("colour")
    xyz = np.array([0.5, 0.4, 0.2])
    theirs = colour.adaptation.chromatic_adaptation_VonKries(
        xyz, color.xyz_of_xy((0.44757, 0.40745)), color.xyz_of_xy(color.WHITE_XY), transform="Bradford"
    )
    assert rgb_to_xyz(color.adapt_white(XYZ_TO_RGB @ xyz, (0.44757, 0.40745))) == pytest.approx(
        theirs, abs=1e-9
    )


# --- densities of wavelengths -------------------------------------------------------------------------------

LAMP = Lines(((404.66, 1.0), (435.83, 2.0), (546.07, 3.0), (577.0, 1.0), (579.0, 1.0)))


def table(spectrum):
    return tabulate(spectrum, FIRST, LAST, "emission")


@pytest.mark.parametrize(
    "emission",
    [
        np.zeros(400),
        np.ones(400),
        np.eye(400)[0],
        np.eye(400)[166] * 1e300,
        np.full(400, 1e-320),
        table(LAMP),
    ],
)
def test_density_is_positive_and_normalised_for_any_light(emission):
    density = wavelength_density(sensor_table(FIRST, LAST), emission)
    assert density.sum() == pytest.approx(1.0, abs=1e-12)
    assert density.min() >= 0.1 / 400 * (1 - 1e-12)
    nodes = inverse_cdf(density, FIRST)
    assert nodes.shape == (1025,) and np.all(np.diff(nodes) > 0)


def test_density_of_a_blind_sensor_is_uniform():
    density = wavelength_density(sensor_table(300, 350), np.zeros(50))
    assert density == pytest.approx(np.full(50, 1 / 50))


def test_density_follows_each_channel_of_the_light():
    sensor = sensor_table(FIRST, LAST)
    emission = table(Named("D65"))
    responses = RGB_TO_XYZ @ sensor * emission
    expected = 0.3 * (responses / responses.sum(axis=1, keepdims=True)).sum(axis=0) + 0.1 / 400
    assert wavelength_density(sensor, emission) == pytest.approx(expected, rel=1e-9)


def test_nodes_span_the_range():
    nodes = inverse_cdf(wavelength_density(sensor_table(FIRST, LAST), table(LAMP)), FIRST)
    assert (nodes[0], nodes[-1]) == (FIRST, LAST)


def test_nodes_have_the_distribution():
    density = wavelength_density(sensor_table(FIRST, LAST), table(Named("D65")))
    nodes = inverse_cdf(density, FIRST)
    cdf = np.concatenate([[0.0], np.cumsum(density)])
    assert np.interp(nodes, np.arange(FIRST, LAST + 1), cdf) == pytest.approx(
        np.arange(1025) / 1024, abs=1e-6
    )


@given(st.lists(st.floats(1e-6, 1e6), min_size=1, max_size=500), st.sampled_from([512, 1024, 4096]))
def test_any_density_gives_increasing_nodes(density, n_entries):
    nodes = inverse_cdf(np.array(density), 300, n_entries)
    assert np.all(np.diff(nodes) > 0)
    assert nodes[0] == 300 and nodes[-1] == pytest.approx(300 + len(density), abs=1e-4)


def test_entries_do_not_straddle_the_edges_of_lines():
    nodes = inverse_cdf(wavelength_density(sensor_table(FIRST, LAST), table(LAMP)), FIRST)
    for bin_nm in (404, 435, 546):
        assert np.abs(nodes - bin_nm).min() < 1e-4
        assert np.abs(nodes - (bin_nm + 1)).min() < 1e-9


@pytest.mark.parametrize("spectrum", [LAMP, Lines(((589.3, 1.0),)), Named("FL11"), Named("E")])
def test_estimates_with_the_nodes_are_unbiased_and_as_good_as_the_density(spectrum):
    sensor, emission = sensor_table(FIRST, LAST), table(spectrum)
    density = wavelength_density(sensor, emission)
    nodes = inverse_cdf(density, FIRST)
    n_entries, n_samples = 1024, 1 << 18
    u = (np.arange(n_samples) + 0.5) / n_samples * n_entries
    index = u.astype(int)
    width = np.diff(nodes)[index]
    wavelengths = (nodes[index] + (u - index) * width).astype(np.float32)
    xyz = RGB_TO_XYZ @ sensor * emission
    estimates = xyz[:, (wavelengths - np.float32(FIRST)).astype(int)] * width * n_entries
    assert estimates.mean(axis=1) == pytest.approx(xyz.sum(axis=1), rel=2e-3)
    second_moment = (xyz**2 / density).sum(axis=1)
    assert (estimates**2).mean(axis=1) == pytest.approx(second_moment, rel=0.03)


def test_a_density_that_is_zero_somewhere_is_refused():
    with pytest.raises(ValueError, match="positive density"):
        inverse_cdf(np.array([1.0, 0.0]), 380)
