"""Reading images, and what are none."""

import re

import numpy as np
import OpenImageIO as oiio
import pytest

from artist_py.errors import OptionError
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image
from artist_py.film.reading import read_image


@pytest.fixture
def film():
    """A film of nothing but noise."""
    return FilmImage(rgb=np.random.default_rng(3).random((30, 40, 3)), iterations=1)


class TestReading:
    """Images that are no images."""

    def test_truncated(self, tmp_path, film):
        """A file that was cut off is an error, at whatever byte."""
        for extension in ("exr", "png"):
            path = tmp_path / f"a.{extension}"
            write_image(path, film)
            whole = path.read_bytes()
            for n_bytes in (0, 3, 100, len(whole) // 2, len(whole) - 1000):
                path.write_bytes(whole[:n_bytes])
                with pytest.raises(OptionError, match=re.escape(str(path))):
                    read_image(path)

    @pytest.mark.parametrize("name", ["missing.exr", "folder.exr", "", "\udcff.exr"])
    def test_missing(self, tmp_path, monkeypatch, name):
        """What is not a file is named."""
        (tmp_path / "folder.exr").mkdir()
        monkeypatch.chdir(tmp_path)
        with pytest.raises(OptionError, match="no such file"):
            read_image(name)

    def test_not_an_image(self, tmp_path):
        """Text is not an image, whatever it is called."""
        (tmp_path / "a.exr").write_text("[film]\n")
        with pytest.raises(OptionError, match="cannot be read as an image"):
            read_image(tmp_path / "a.exr")

    def test_no_colour(self, tmp_path, film):
        """A file without R, G and B has no colour, rather than some other channels in its place."""
        spec = oiio.ImageSpec(2, 2, 1, "float")
        spec.channelnames = ("depth.Z",)
        output = oiio.ImageOutput.create("openexr")
        output.open(str(tmp_path / "a.exr"), spec)
        output.write_image(np.ones((2, 2, 1), np.float32))
        output.close()
        assert read_image(tmp_path / "a.exr").rgb is None
