"""What a screen shows of a linear image."""

import numpy as np
import OpenImageIO as oiio
import pytest

from artist_py.errors import OptionError, OutputError
from artist_py.film.color import XYZ_TO_RGB, decode_srgb, xyz_of_xy
from artist_py.film.image import FilmImage
from artist_py.film.output import write_display, write_image
from artist_py.film.tonemap import ToneMapping, automatic_exposure, tone_mapped, white_point


def plain_film(values):
    """A film of nothing but colour."""
    return FilmImage(rgb=np.asarray(values, dtype=float), iterations=1)


class TestToneMapping:
    """What a screen shows."""

    @pytest.mark.parametrize(("bits", "dtype"), [(8, np.uint8), (16, np.uint16)])
    def test_png_is_srgb(self, tmp_path, bits, dtype):
        """Decoding gives the linear values back, to half a step."""
        values = np.linspace(0, 1, 3 * 257).reshape(1, 257, 3)
        write_image(tmp_path / "a.png", plain_film(values), tone_mapping=ToneMapping(bits=bits))
        stored = oiio.ImageInput.open(str(tmp_path / "a.png"))
        assert stored.spec().getattribute("oiio:ColorSpace") == "srgb_rec709_scene"
        integers = stored.read_image(np.dtype(dtype).name)
        assert integers.dtype == dtype
        step = 1 / (2**bits - 1)
        assert np.max(np.abs(decode_srgb(integers * step) - values)) < 1.2 * step

    def test_published_values(self):
        """IEC 61966-2-1: linear 0.2140 is code 127.5 of 255; white and beyond is 255, black and below is 0."""
        shown = tone_mapped([[[0.2122, 0.2159, 1.0], [7.0, 0.0, -1.0]]], ToneMapping())
        assert shown.tolist() == [[[127, 128, 255], [255, 0, 0]]]

    def test_exposure_is_in_stops(self):
        """Two stops more is four times the light."""
        rgb = np.random.default_rng(1).random((4, 4, 3)) / 5
        assert np.array_equal(
            tone_mapped(rgb, ToneMapping(exposure=2.0)), tone_mapped(4 * rgb, ToneMapping())
        )

    def test_automatic_exposure(self):
        """The geometric mean becomes middle grey whatever the unit; black pixels do not count; black stays black."""
        rgb = np.array([[[0.5] * 3, [2.0] * 3, [0.0] * 3]])
        assert automatic_exposure(rgb) == pytest.approx(np.log2(0.18))
        assert automatic_exposure(1e-5 * rgb) == pytest.approx(np.log2(0.18e5))
        assert automatic_exposure(np.zeros((2, 2, 3))) == 0
        mapping = ToneMapping(exposure="auto")
        assert np.array_equal(tone_mapped(rgb, mapping), tone_mapped(1000 * rgb, mapping))

    def test_operators_differ_as_they_should(self):
        """Linear leaves values alone; filmic keeps apart what sRGB clips."""
        rgb = np.array([[[0.5] * 3, [1.0] * 3, [2.0] * 3]])
        linear = tone_mapped(rgb, ToneMapping(operator="linear"))[0, :, 0]
        filmic = tone_mapped(rgb, ToneMapping(operator="filmic"))[0, :, 0]
        assert linear.tolist() == [128, 255, 255]
        assert filmic[0] < filmic[1] < filmic[2] < 255

    def test_white_point_becomes_neutral(self):
        """Light of illuminant A, seen by an eye used to it, is grey; D65 is grey as it is."""
        x, y = white_point("A")
        assert (x, y) == pytest.approx((0.44757, 0.40745), abs=2e-5)  # CIE 15:2018
        light = 0.3 * (XYZ_TO_RGB @ xyz_of_xy((x, y)))[None, None]
        shown = tone_mapped(light, ToneMapping(white_point=(x, y)))[0, 0].astype(int)
        assert np.ptp(shown) <= 1
        assert np.ptp(tone_mapped(light, ToneMapping())[0, 0].astype(int)) > 50
        with pytest.raises(OptionError, match="no illuminant 'D66'"):
            white_point("D66")

    def test_special_values(self):
        """NaN is black and infinity is white, and neither spreads."""
        rgb = np.array([[[np.nan] * 3, [np.inf] * 3, [-np.inf] * 3, [0.2] * 3]])
        for mapping in (ToneMapping(), ToneMapping("auto", "filmic", (0.4, 0.4))):
            shown = tone_mapped(rgb, mapping)[0]
            assert shown[0].tolist() == [0, 0, 0]
            assert shown[1].tolist() == [255, 255, 255]
            assert shown[2].tolist() == [0, 0, 0]
            assert 0 < shown[3, 0] < 255

    def test_only_png_is_tone_mapped(self, tmp_path):
        """A linear format is not filled with encoded values."""
        with pytest.raises(OutputError, match="written as .png"):
            write_display(tmp_path / "a.exr", np.zeros((1, 1, 3)), ToneMapping())
