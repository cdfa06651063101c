"""`artist diff`: values, messages, exit codes."""

import os

import numpy as np
import pytest

from artist_py.cli.diff import METRICS
from artist_py.cli.main import main
from artist_py.compare import diff
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image
from artist_py.film.reading import read_image

SHAPE = 12, 16, 3


def write(name, rgb, metadata=None, **more):
    """An image file of a film."""
    write_image(name, FilmImage(rgb=np.asarray(rgb, float), iterations=64, **more), metadata)


@pytest.fixture
def images(folder):
    """`a.exr` and `b.exr`, which have noise and variance, and `grey.exr`, `light.exr`, which have none."""
    rng = np.random.default_rng(1)
    mean = rng.random(SHAPE) + 0.5
    for name in "ab":
        write(f"{name}.exr", mean + 0.01 * rng.standard_normal(SHAPE), variance=np.full(SHAPE, 1e-4))
    write("grey.exr", np.full(SHAPE, 0.5))
    write("light.exr", np.full(SHAPE, 0.6))
    return folder


def bands(values, first=500.0):
    """A spectral image's keyword arguments: one value per band."""
    centres = first + 10.0 * np.arange(len(values))
    return {"spectral": np.ones((*SHAPE[:2], 1)) * values, "band_centres": centres}


class TestValues:
    """What is printed, and the exit code."""

    @pytest.mark.parametrize(
        ("metric", "value"), [("relmse", 0.01 / 0.251), ("smape", 0.2 / 1.1001), ("mse", 0.01)]
    )
    def test_closed_forms(self, images, capsys, metric, value):
        """Grey 0.6 against 0.5, with thresholds on both sides; without one the exit code is 0."""
        arguments = ["diff", "light.exr", "grey.exr", "--metric", metric]
        assert main(arguments) == 0
        assert f"{metric} {value:.5g}"[:-1] in capsys.readouterr().out
        assert main([*arguments, "--threshold", str(1.01 * value)]) == 0
        assert "within" in capsys.readouterr().out
        assert main([*arguments, "--threshold", str(0.99 * value)]) == 1
        assert "different: above" in capsys.readouterr().out

    @pytest.mark.parametrize("metric", METRICS)
    def test_every_metric(self, images, metric):
        """Equal images are within the smallest threshold, and each can make a map."""
        assert main(["diff", "a.exr", "a.exr", "--metric", metric, "--threshold", "0"]) == 0
        assert main(["diff", "a.exr", "b.exr", "--metric", metric, "-o", "map.png"]) == 0
        assert read_image("map.png").rgb.shape == SHAPE

    def test_names_are_those_of_the_library(self):
        """The command's help is not behind."""
        assert METRICS == diff.METRICS

    def test_z(self, images, capsys):
        """Noise is no difference; a value 10 standard errors off is, by default at 0.001."""
        assert main(["diff", "a.exr", "b.exr", "--metric", "z"]) == 0
        out, err = capsys.readouterr()
        assert "may show the same" in out
        assert "values are taken as normal" in err
        image = read_image("b.exr").rgb.copy()
        image[4, 7, 2] += 10 * 0.0142
        write("c.exr", image, variance=np.full(SHAPE, 1e-4))
        assert main(["diff", "a.exr", "c.exr", "--metric", "z"]) == 1
        assert "worst pixel x 7, y 4" in capsys.readouterr().out

    def test_z_of_equal_effort_forgives_skewed_values(self, images, capsys):
        """|z| = 5.6 of 576 values is an alarm for normal values, and none for 64 samples of what may be skewed."""
        image = np.ones(SHAPE)
        write("c.exr", image, variance=np.full(SHAPE, 0.5e-4))
        image[0, 0, 0] += 5.6e-2
        for metadata, code in ((None, 1), ({"artist:integrator": "pt"}, 0)):
            for name, rgb in (("c", np.ones(SHAPE)), ("d", image)):
                write(f"{name}.exr", rgb, metadata, variance=np.full(SHAPE, 0.5e-4))
            assert main(["diff", "c.exr", "d.exr", "--metric", "z"]) == code
            assert ("taken as normal" in capsys.readouterr().err) == (metadata is None)

    def test_quiet(self, images, capsys):
        """Only the exit code."""
        assert main(["diff", "light.exr", "grey.exr", "--threshold", "0", "-q", "-o", "m.png"]) == 1
        assert capsys.readouterr() == ("", "")


class TestSpectra:
    """Images with spectral channels."""

    def test_each_band_counts(self, folder, capsys):
        """Equal colours and one band that differs."""
        write("a.exr", np.ones(SHAPE), **bands([1.0, 1.0, 1.0]))
        write("b.exr", np.ones(SHAPE), **bands([1.0, 1.5, 1.0]))
        assert main(["diff", "b.exr", "a.exr", "--threshold", "0.2"]) == 1
        out = capsys.readouterr().out
        assert "relmse 0.24975" in out
        assert "510 nm: 0.24975" in out
        assert "500 nm: 0\n" in out
        assert "RGB together: 0" in out

    def test_other_bands(self, folder, capsys):
        """What only one has is named and left out."""
        write("a.exr", np.ones(SHAPE), **bands([1.0, 1.0, 1.0]))
        write("b.exr", np.ones(SHAPE), **bands([1.0, 1.0], first=510.0))
        write("c.exr", np.ones(SHAPE))
        assert main(["diff", "a.exr", "b.exr", "--threshold", "0"]) == 0
        assert "1 spectral channels of a.exr are not in b.exr" in capsys.readouterr().err
        assert main(["diff", "a.exr", "c.exr", "--threshold", "0"]) == 0
        assert "c.exr has no spectral channels: only colours are compared" in capsys.readouterr().err


class TestNotFinite:
    """Pixels that are not numbers."""

    def test_one_nan(self, images, capsys):
        """It is named, left out of the value, and above every threshold."""
        image = np.full(SHAPE, 0.5)
        image[3, 2, 0] = np.nan
        write("nan.exr", image)
        for metric in ("relmse", "smape", "mse", "flip", "de2000"):
            arguments = ["diff", "nan.exr", "grey.exr", "--metric", metric]
            assert main(arguments) == 0
            out, err = capsys.readouterr()
            assert "nan.exr: 1 of 192 pixels are not finite, the first at x 2, y 3" in err
            if metric != "flip":
                assert f"{metric} 0;" in out
            assert main([*arguments, "--threshold", "1e9"]) == 1
            capsys.readouterr()

    def test_infinite_variance(self, images):
        """A pixel of unknown variance is no proof of anything."""
        variance = np.full(SHAPE, 1e-4)
        variance[0, 0] = np.inf
        write("c.exr", read_image("b.exr").rgb, variance=variance)
        assert main(["diff", "a.exr", "c.exr", "--metric", "z"]) == 1


class TestErrors:
    """What cannot be compared."""

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["a.exr", "small.exr"], "a.exr is 16 x 12 pixels, small.exr is 4 x 3 pixels"),
            (
                ["a.exr", "crop.exr"],
                "different parts of their images: a.exr from x 0, y 0, crop.exr from x 5, y 6",
            ),
            (["a.exr", "a.png"], "a.png is tone-mapped and a.exr is linear"),
            (["grey.exr", "a.exr", "--metric", "z"], "grey.exr: has no variance.R"),
            (["a.exr", "missing.exr"], "missing.exr: there is no such file"),
            (["scene.toml", "a.exr"], "scene.toml: cannot be read as an image"),
            (["a.exr", "b.exr", "--metric", "ssim"], "'ssim' is not one of"),
            (["a.exr", "b.exr", "-o", "map.exr"], "written as .png"),
            (["a.exr", "b.exr", "--threshold", "-1"], "-1.0 is not in the range x>=0"),
            (["a.exr", "b.exr", "-o", "no/map.png"], "no/map.png: there is no directory"),
        ],
    )
    def test_messages(self, images, capsys, arguments, message):
        """The message names what is wrong, the exit code is not that of a difference that was measured."""
        write("small.exr", np.ones((3, 4, 3)))
        write("crop.exr", np.ones(SHAPE), resolution=(100, 100), crop=(5, 21, 6, 18))
        write("a.png", np.ones(SHAPE))
        before = sorted(os.listdir())
        assert main(["diff", *arguments]) == (1 if "no/map.png" in arguments else 2)
        assert message in capsys.readouterr().err
        assert sorted(os.listdir()) == before

    def test_display_images(self, images):
        """Two PNGs are compared as light."""
        write("a.png", np.full(SHAPE, 0.25))
        write("b.png", np.full(SHAPE, 0.5))
        assert main(["diff", "a.png", "b.png", "--metric", "mse", "--threshold", "0.064"]) == 0
        assert main(["diff", "a.png", "b.png", "--metric", "mse", "--threshold", "0.061"]) == 1
        assert main(["diff", "a.png", "b.png", "--metric", "flip", "--threshold", "0.01"]) == 1
