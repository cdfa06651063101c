"""Metrics against closed forms, and FLIP on what its evaluator does not survive."""

import math
import subprocess
import sys

import numpy as np
import pytest

from artist_py.compare import flip, metrics
from artist_py.compare.color_difference import color_difference
from artist_py.compare.heat import RAMP, heat_colors, heat_range
from artist_py.compare.optional import load_optional
from artist_py.errors import OptionError

N = 200_000


@pytest.fixture
def image():
    """A smooth gradient."""
    return np.linspace(0.2, 0.8, 32)[None, :, None] * np.ones((24, 1, 3))


class TestClosedForms:
    """Images whose error can be written down."""

    def test_grey_images(self):
        """Every value 0.6 instead of 0.5."""
        reference, image = np.full((4, 5, 3), 0.5), np.full((4, 5, 3), 0.6)
        assert metrics.squared_error(image, reference).mean() == pytest.approx(0.01)
        assert metrics.relmse(image, reference) == pytest.approx(0.01 / 0.251)
        assert metrics.smape(image, reference) == pytest.approx(0.2 / 1.1001)

    def test_black_and_negative(self):
        """Black is bounded, and what is outside the gamut neither cancels nor divides by zero."""
        black, image = np.zeros((2, 2, 3)), np.full((2, 2, 3), 0.1)
        assert metrics.relmse(image, black) == pytest.approx(0.01 / 0.001)
        assert metrics.smape(image, black) == pytest.approx(0.2 / 0.1001)
        assert metrics.smape(-image, image) == pytest.approx(0.4 / 0.2001)
        assert metrics.smape(black - 0.00005, black) == pytest.approx(0.0001 / 0.00015)

    def test_float32_is_not_summed_as_such(self):
        """A small difference on a large value survives."""
        reference = np.full((100, 100, 3), 1e6, np.float32)
        image = reference + np.float32(1.0)
        assert metrics.squared_error(image, reference).mean() == 1.0

    def test_error_of_a_variance(self):
        """What noise of a known variance expects; a deviation of 5 standard errors has probability 6e-7."""
        rng = np.random.default_rng(1)
        mean, sigma = 0.7, 0.05
        image = mean + sigma * rng.standard_normal(N)
        expected = metrics.relmse_of_variance(np.full(N, sigma**2), np.full(N, mean))
        assert expected == pytest.approx(sigma**2 / (mean**2 + 0.001))
        assert metrics.relmse(image, np.full(N, mean)) == pytest.approx(expected, rel=5 * math.sqrt(2 / N))
        expected = metrics.smape_of_variance(np.full(N, sigma**2), np.full(N, mean))
        spread = math.sqrt(math.pi / 2 - 1)  # of |x| over its mean
        # The mean of the image in the denominator changes it by sigma^2 / mean^2 / 4, 0.1 %.
        assert metrics.smape(image, np.full(N, mean)) == pytest.approx(
            expected, rel=5 * spread / math.sqrt(N) + 2e-3
        )


class TestColors:
    """CIEDE2000."""

    def test_black_and_white(self):
        """L* 0 against 100 without chroma: S_L is 1 at their mean, 50."""
        white, black = np.ones((1, 2, 3)), np.zeros((1, 2, 3))
        assert color_difference(white, black) == pytest.approx(100.0, abs=0.01)
        assert np.all(color_difference(white, white) == 0.0)

    def test_outside_the_gamut(self):
        """A saturated colour is compared as it is, and the result is finite."""
        cyan, other = np.array([[[-0.2, 0.5, 0.5]]]), np.array([[[0.0, 0.5, 0.5]]])
        assert 5.0 < color_difference(cyan, other)[0, 0] < 30.0


class TestFlip:
    """FLIP in a child process."""

    def test_equal(self, image):
        """No error."""
        assert flip.flip_map(image, image).mean() == 0.0

    def test_where_and_how_much(self, image):
        """The error is where the change is, in [0, 1], and grows with it."""
        errors = []
        for factor in (1.2, 2.0):
            other = image.copy()
            other[8:16, 8:16] *= factor
            errors.append(flip.flip_map(other, image))
        small, large = errors
        assert large.shape == (24, 32)
        assert 0.0 < small.mean() < large.mean() < 1.0
        assert large[8:16, 8:16].mean() > 5 * large[:, 24:].mean()

    def test_code_values(self, image):
        """Display images have no exposure."""
        assert 0.0 < flip.flip_map(0.9 * image, image, is_display=True).mean() < 1.0

    @pytest.mark.parametrize(
        ("a", "b"), [(0.5, 0.0), (0.0, 0.5), (math.nan, 0.5), (math.inf, 0.5), (0.5, math.nan)]
    )
    def test_what_the_evaluator_does_not_survive(self, a, b):
        """Black references, and values that are not finite, which it takes for equal."""
        assert flip.flip_map(np.full((16, 16, 3), a), np.full((16, 16, 3), b)).mean() > 0.1

    def test_both_black(self):
        """Nothing to see, nothing wrong."""
        assert flip.flip_map(np.zeros((8, 8, 3)), np.full((8, 8, 3), math.nan)).max() == 0.0

    def test_a_child_that_fails(self, image, monkeypatch):
        """It ends its own process, and not ours."""
        monkeypatch.setattr(flip, "CHILD", "import sys; sys.exit(3)")
        with pytest.raises(OptionError, match="gave up"):
            flip.flip_map(image, 0.5 * image)


class TestHeat:
    """Errors as colours."""

    def test_ends_and_order(self):
        """From black to the lightest, ever lighter."""
        colors = heat_colors(np.geomspace(1e-6, 10, 200)[None], 1e-5, 1.0, is_logarithmic=True)
        assert np.all(colors[0, 0] == 0)
        assert np.allclose(colors[0, -1], RAMP[-1] / 255)
        luminance = colors[0] @ [0.2, 0.7, 0.1]
        assert np.all(np.diff(luminance) >= 0)

    def test_ranges(self):
        """Powers of ten about the errors; something even for none."""
        assert heat_range(np.full((3, 3), 0.03), "relmse") == (pytest.approx(1e-6), pytest.approx(0.1), True)
        assert heat_range(np.zeros((3, 3)), "mse")[1] == 1.0
        assert heat_range(np.zeros((3, 3)), "flip") == (0.0, 1.0, False)


class TestOptional:
    """Libraries that reports need."""

    def test_absent(self):
        """The message says what for, and how to get it."""
        with pytest.raises(
            OptionError, match=r"plots: no_such_module is not installed.*pip install 'artist-py\[report\]'"
        ):
            load_optional("no_such_module.part", "plots")

    def test_no_flip(self, monkeypatch):
        """The same for the evaluator, before anything is started."""
        monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
        with pytest.raises(OptionError, match="flip-evaluator"):
            flip.flip_map(np.ones((8, 8, 3)), np.zeros((8, 8, 3)))

    def test_metrics_load_nothing_heavy(self):
        """Neither plots nor colour nor kernels."""
        code = (
            "import sys, artist_py.compare.diff, artist_py.compare.pair; "
            "print({'colour', 'matplotlib', 'flip_evaluator', 'numba'} & set(sys.modules))"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout.strip() == "set()"
