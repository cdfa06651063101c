"""Measured reradiation matrices from bispectral EXR images: the same as from text, and what is refused."""

import re

import numpy as np
import OpenImageIO as oiio
import pytest
from fluorescence import RANGE
from test_reradiation import MATRIX, dye
from texture_files import write_image

from artist_py.errors import SceneError
from artist_py.scene.reradiation import glow_of
from artist_py.scene.reradiation_files import read_matrix
from artist_py.scene.reradiation_images import read_bispectral_image

NM = (400, 410, 420, 430)
# Rows are emission, as in the text; on the diagonal the reflectance.
VALUES = np.array([line.split(",")[1:] for line in MATRIX.split()[1:]], float)


def named(into, out, style="T.{}nm.{}nm"):
    return style.format(into, out)


def channels(style="T.{}nm.{}nm", diagonal=None):
    """`{name: value}` of the matrix; `diagonal` names channels of reflectances, else they are named as the others."""
    found = {}
    for j, out in enumerate(NM):
        for i, into in enumerate(NM):
            name = diagonal.format(into) if diagonal and i == j else style.format(into, out)
            found[name] = VALUES[j, i]
    return found


def write(path, values, pixels=1, kind="float"):
    """An image whose pixels have these values, one by one if they are arrays."""
    planes = [np.broadcast_to(np.asarray(value, np.float32), (1, pixels)) for value in values.values()]
    return str(write_image(path, np.stack(planes, axis=-1), kind, list(values)))


def upper(values):
    """Without what would be given off at shorter wavelengths: files need not have it."""
    kept = {}
    for name, value in values.items():
        numbers = [float(n.replace(",", ".")) for n in re.findall(r"\d+(?:[.,]\d+)?", name)]
        if numbers[0] <= numbers[-1]:
            kept[name] = value
    return kept


@pytest.mark.parametrize(
    ("style", "diagonal"),
    [
        ("T.{}nm.{}nm", None),
        ("T.{}nm.{}nm", "T.{}nm"),
        ("T.{},0nm.{},000nm", "T.{},0000nm"),
        ("T.{}.0nm.{}.nm", "T.{}nm"),
    ],
)
@pytest.mark.parametrize("anti_stokes", [False, True])
def test_an_image_means_what_the_text_means(style, diagonal, anti_stokes, tmp_path):
    text = tmp_path / "matrix.csv"
    text.write_text(MATRIX, encoding="utf-8")
    image = write(tmp_path / "matrix.EXR", channels(style, diagonal))
    expected, found = (
        glow_of(dye(reradiation={"file": str(path), "anti_stokes": anti_stokes}), *RANGE)
        for path in (text, image)
    )
    np.testing.assert_allclose(found.matrix, expected.matrix, rtol=1e-6)
    np.testing.assert_allclose(found.reflectance, expected.reflectance, rtol=1e-6)
    assert len(found.warnings) == len(expected.warnings) == (1 if anti_stokes else 2)


def test_only_longer_wavelengths_are_needed_and_other_channels_are_left_alone(tmp_path):
    values = {"R": 0.1, "S0.400,0nm": 7.0, **upper(channels(diagonal="T.{}nm")), "T": 1.0, "T.400nm.X": 1.0}
    found = read_bispectral_image(write(tmp_path / "m.exr", values))
    assert found.excitation.tolist() == [400, 410, 420] and found.emission.tolist() == [410, 420, 430]
    np.testing.assert_allclose(found.values[-1], [0.004, 0.005, 0.0], rtol=1e-6)
    assert found.values[0].tolist()[1:] == [0.0, 0.0]
    assert found.reflected.tolist() == list(NM)
    np.testing.assert_allclose(found.reflectance, [0.3, 0.31, 0.32, 0.33], rtol=1e-6)


def test_reflectances_have_wavelengths_of_their_own(tmp_path):
    values = {"T.350nm.500nm": 0.01, "T.350nm.510nm": 0.02, "T.360nm.500nm": 0.03, "T.360nm.510nm": 0.0}
    values |= {f"T.{nm}nm": 0.5 for nm in range(380, 781, 5)}
    path = write(tmp_path / "m.exr", values)
    assert len(read_bispectral_image(path).reflected) == 81
    glow = glow_of(dye(reradiation={"file": path}), *RANGE)
    np.testing.assert_allclose(glow.reflectance, 0.5)
    np.testing.assert_allclose(glow.matrix[507 - 300, 352 - 300], 0.02, rtol=1e-6)


def test_pixels_are_averaged_and_differences_told(tmp_path):
    values = channels()
    same = read_bispectral_image(write(tmp_path / "same.exr", values, pixels=6))
    assert not any("pixels differ" in text for text in same.warnings)
    values["T.400nm.430nm"] = [0.001, 0.004, 0.007]
    found = read_bispectral_image(write(tmp_path / "m.exr", values, pixels=3))
    np.testing.assert_allclose(found.values[3, 0], 0.004, rtol=1e-6)
    assert any(
        text.endswith("its 3 pixels differ, and are taken as one sample: their mean")
        for text in found.warnings
    )


def test_images_may_have_thousands_of_channels(tmp_path):
    nm = range(300, 800, 10)
    values = {named(into, out): 1e-4 for into in nm for out in nm if into < out}
    assert len(values) > 1024
    before = oiio.get_int_attribute("limits:channels")
    found = read_bispectral_image(write(tmp_path / "m.exr", values))
    assert found.values.shape == (49, 49) and np.count_nonzero(found.values) == len(values)
    assert oiio.get_int_attribute("limits:channels") == before


def without(*names):
    return {name: value for name, value in channels().items() if name not in names}


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"R": 0.0, "G": 0.0, "B": 0.0}, ": expected channels such as T.400nm.520nm, found R, G, B"),
        (
            {"T.400nm": 0.3, "T.410nm": 0.3},
            ": expected channels such as T.400nm.520nm, found T.400nm, T.410nm",
        ),
        (
            without("T.410nm.430nm"),
            ": expected a channel for each pair of its wavelengths, found no T.410nm.430nm",
        ),
        (
            {f"T.{nm}nm.{nm + 70}nm": 0.1 for nm in (350, 360, 370)},
            ": expected a channel for each pair of its wavelengths, found no T.350nm.430nm, nor 5 others",
        ),
        (
            {**channels(), "T.400,0nm.410nm": 0.1},
            ": channels T.400,0nm.410nm and T.400nm.410nm are of the same wavelengths",
        ),
        (
            {"T.400nm.500nm": 0.1, "T.400nm.510nm": 0.1},
            ": expected two or more wavelengths of excitation and of emission, found 1 and 2",
        ),
        (
            {**channels(), "T.400nm.430nm": -0.1},
            ": T.400nm.430nm: expected values of at least 0, but for noise, found -0.1",
        ),
        ({**channels(), "T.400nm.430nm": np.nan}, ": T.400nm.430nm: expected finite values"),
    ],
)
def test_what_is_refused(values, message, tmp_path):
    path = write(tmp_path / "m.exr", values)
    with pytest.raises(SceneError) as caught:
        read_bispectral_image(path)
    assert str(caught.value).removeprefix(path)[: len(message)] == message


def test_a_matrix_that_gains_power_is_refused(tmp_path):
    values = {**channels(), "T.400nm.430nm": 0.09}
    with pytest.raises(
        SceneError, match=r"reradiation: expected reflectance \+ what is given off <= 1, found 1\.2"
    ):
        glow_of(dye(reradiation={"file": write(tmp_path / "m.exr", values)}), *RANGE)


def test_files_that_cannot_be_read_are_refused(tmp_path):
    whole = write(tmp_path / "whole.exr", {name: np.arange(4000.0) for name in channels()}, pixels=4000)
    damaged, text = tmp_path / "damaged.exr", tmp_path / "text.exr"
    damaged.write_bytes((tmp_path / "whole.exr").read_bytes()[:5000])
    text.write_text(MATRIX, encoding="utf-8")
    for path in (damaged, text, tmp_path / "none.exr"):
        with pytest.raises(SceneError) as caught:
            read_bispectral_image(str(path))
        assert str(caught.value).startswith(f"{path}: ")
    assert read_bispectral_image(whole).values.shape == (4, 4)


def test_text_is_read_as_before(tmp_path):
    path = tmp_path / "matrix.csv"
    path.write_text(MATRIX, encoding="utf-8")
    found = read_matrix(path)
    expected = np.maximum(VALUES, 0.0)
    np.testing.assert_array_equal(found.reflectance, np.diag(expected))
    np.testing.assert_array_equal(found.values, expected - np.diag(np.diag(expected)))
