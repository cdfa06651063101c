"""Colour: white points, patches under two lights, and all ways to choose wavelengths against each other.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are about 40.
"""

import math

import numpy as np
import pytest
from rendering import FALSE_ALARM, assert_equals, diffuse, look, render, scene, shape, with_render
from scipy import stats

from artist_py import data
from artist_py.film.color import rgb_to_xyz, sensor_table

VISIBLE = [380, 780]
WHITE_LUMINANCE = 100.0


def sky(spectrum, luminance=WHITE_LUMINANCE):
    """A closed sphere that gives what it contains the luminance of the film's white."""
    emission = {"spectrum": spectrum, "luminance": luminance}
    return shape("sphere", center=[0, 0, 0], radius=8, reverse=True, emission=emission)


# --- white --------------------------------------------------------------------------------------------------------

# CIE 15:2018, table T.3 (A, D65) and ISO/CIE 11664; the standard's own values are rounded to 5 digits.
WHITE_POINTS = {
    "A": (0.44758, 0.40745),
    "D65": (0.31272, 0.32903),
    "D50": (0.34567, 0.35850),
    "E": (1 / 3, 1 / 3),
}
CHROMATICITY_BIAS = 2e-5  # of tables that end at 380 and 780 nm, and of rounding


def white_plane(light, white_luminance=WHITE_LUMINANCE):
    """A plane that reflects everything, under a sky of this light."""
    plane = shape("rectangle", "white", corner=[-1, 0.5, -1], edges=[[2, 0, 0], [0, 0, 2]])
    return scene(
        [sky(light), plane],
        materials={"white": diffuse(1.0)},
        film={"white_luminance": white_luminance, "resolution": [32, 32]},
        render={"wavelength_range": VISIBLE, "max_path_length": 2, "sampler": "sobol"},
    )


@pytest.mark.parametrize("name", WHITE_POINTS)
def test_white_plane_has_the_white_point(name):
    """X - x (X + Y + Z) and Y - y (X + Y + Z) have mean zero over independent pixels."""
    xyz = rgb_to_xyz(render(white_plane(name), 64).film.rgb).reshape(-1, 3)
    total = xyz.sum(axis=1)
    for axis, coordinate in enumerate(WHITE_POINTS[name]):
        excess = (xyz[:, axis] - coordinate * total) / total.mean()
        error = excess.std() / math.sqrt(len(excess))
        assert error < 2e-4
        assert abs(excess.mean()) < stats.norm.isf(FALSE_ALARM / 2) * error + CHROMATICITY_BIAS
    assert_equals(xyz[:, 1].mean(), xyz[:, 1].std() / 32, 1.0, 1e-3, rounding=1e-4)


# --- patches ------------------------------------------------------------------------------------------------------

PATCHES = [name for name in data.names("reflectance") if name.startswith("ColorChecker ")]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("light", ["A", "D65"])
def test_colour_checker(light):
    """24 measured patches: the difference CIEDE2000 to colour-science's integration is below 0.5 for each.

    Noise alone makes 0.05; 0.5 is what a careful eye sees.
    """
    colour = pytest.importorskip("colour")
    chart, across, down = [], 6, 4
    for i in range(24):
        corner = [i % across - 3, 3, 1 - i // across]
        chart.append(shape("rectangle", f"m{i}", corner=corner, edges=[[1, 0, 0], [0, 0, 1]]))
    field = 2 * math.degrees(math.atan(2 / 3))
    compiled = scene(
        [sky(light), *chart],
        materials={f"m{i}": diffuse(name) for i, name in enumerate(PATCHES)},
        camera=look([0, 0, 0], [0, 1, 0], field),
        film={"white_luminance": WHITE_LUMINANCE, "resolution": [across * 8, down * 8]},
        render={"wavelength_range": VISIBLE, "max_path_length": 2, "sampler": "sobol"},
    )
    rgb = render(compiled, 256).film.rgb
    blocks = rgb.reshape(down, 8, across, 8, 3).mean(axis=(1, 3)).reshape(-1, 3)
    noise = rgb.reshape(down, 8, across, 8, 3).std(axis=(1, 3)).max() / 8
    assert noise < 3e-3
    white = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"][light]
    measured = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
    illuminant = colour.SDS_ILLUMINANTS[light]
    for name, xyz in zip(PATCHES, rgb_to_xyz(blocks), strict=True):
        patch = measured[_name_in_colour(name, measured)]
        expected = colour.sd_to_XYZ(patch, illuminant=illuminant) / 100
        difference = colour.delta_E(
            colour.XYZ_to_Lab(xyz, white), colour.XYZ_to_Lab(expected, white), method="CIE 2000"
        )
        assert difference < 0.5, (name, difference)


def _name_in_colour(name, measured):
    """The package leaves out what stands in brackets."""
    short = name.removeprefix("ColorChecker ")
    return next(full for full in measured if full.split(" (")[0] == short)


# --- ways to choose wavelengths -----------------------------------------------------------------------------------

LIGHTS = {"smooth": "D65", "lines": {"lines": [[435.8, 2], [546.1, 3], [611, 4], [700, 5]]}}
MODES = [
    (1, "independent"),
    (4, "independent"),
    (8, "independent"),
    (1, "shared"),
    (4, "shared"),
    (8, "shared"),
]
SEEDS = range(1, 17)


def still_life(spectrum, hero_count, wavelengths):
    """Dispersive glass, gold and two paints under a lamp that is not white."""
    shapes = [
        shape("rectangle", "orange", corner=[-2, -2, 0], edges=[[4, 0, 0], [0, 4, 0]]),
        shape("rectangle", "blue", corner=[-2, 2, 0], edges=[[4, 0, 0], [0, 0, 4]]),
        shape("sphere", "flint", center=[-0.5, 0, 0.5], radius=0.5),
        shape("sphere", "gold", center=[0.6, 0.2, 0.5], radius=0.5),
        shape("sphere", center=[0.5, -1, 2.5], radius=0.6, emission={"spectrum": spectrum, "luminance": 100}),
    ]
    materials = {
        "orange": diffuse("ColorChecker orange"),
        "blue": diffuse("ColorChecker blue"),
        "flint": {"type": "dielectric", "ior": "N-SF11"},
        "gold": {"type": "conductor", "metal": "Au"},
    }
    return scene(
        shapes,
        materials=materials,
        camera=look([0, -4, 1.5], [0, 0, 0.7], 40),
        film={"white_luminance": 10, "resolution": [24, 24]},
        render={
            "wavelength_range": VISIBLE,
            "hero_count": hero_count,
            "wavelengths": wavelengths,
            "max_path_length": 6,
        },
    )


def other_modes():
    """All but 4 independent wavelengths; a mode is a kernel, and each number and each way is in one that is fast."""
    slow = {(1, "shared"), (4, "shared"), (8, "independent")}
    return [
        pytest.param(mode, id=str(mode), marks=pytest.mark.slow if mode in slow else ())
        for mode in MODES
        if mode != (4, "independent")
    ]


@pytest.fixture(scope="module")
def blocks():
    """Means over 4 x 4 blocks of the still life, (seeds, 16, 3), by light and mode."""
    kept = {}

    def blocks_of(light, mode):
        if (light, mode) not in kept:
            compiled = still_life(LIGHTS[light], *mode)
            images = [render(with_render(compiled, seed=seed), 16).film.rgb for seed in SEEDS]
            parts = np.array(images).reshape(len(SEEDS), 4, 6, 4, 6, 3).mean(axis=(2, 4))
            kept[light, mode] = parts.reshape(len(SEEDS), 16, 3)
        return kept[light, mode]

    return blocks_of


@pytest.mark.parametrize("mode", other_modes())
@pytest.mark.parametrize("light", LIGHTS)
def test_modes_agree(blocks, light, mode):
    """Blocks of the image by Welch's t-test between seeds, and the mean image, against 4 independent wavelengths."""
    reference, other = blocks(light, (4, "independent")), blocks(light, mode)
    p = stats.ttest_ind(reference, other, axis=0, equal_var=False).pvalue
    assert p.min() > FALSE_ALARM / p.size
    means = reference.mean(axis=1), other.mean(axis=1)
    assert stats.ttest_ind(*means, axis=0, equal_var=False).pvalue.min() > FALSE_ALARM / 3
    error = np.hypot(*(mean.std(axis=0) for mean in means)) / math.sqrt(len(SEEDS))
    assert (error < 0.08 * means[0].mean(axis=0)).all(), error / means[0].mean(axis=0)


# --- bands --------------------------------------------------------------------------------------------------------


def test_bands_are_the_spectrum_and_integrate_to_the_image():
    """Of a coloured plane under D65: each band within its noise, and their sum over the sensor within 0.3 %."""
    plane = shape("rectangle", "orange", corner=[-1, 0.5, -1], edges=[[2, 0, 0], [0, 0, 2]])
    compiled = scene(
        [sky("D65", 1000), plane],
        materials={"orange": diffuse("ColorChecker orange")},
        film={"resolution": [32, 32]},
        render={"wavelength_range": VISIBLE, "max_path_length": 2, "sampler": "sobol"},
    )
    film = render(compiled, 64, spectral=True).film
    bands = film.spectral.reshape(-1, 40)
    emitter = compiled.scene.emitters.records[0]
    rows = compiled.spectra.astype(float)
    reflectance = rows[compiled.scene.materials[1].reflectance]
    exact = (rows[emitter.spectrum] * emitter.scale * reflectance).reshape(40, 10).mean(axis=1)
    error = bands.std(axis=0) / 32
    assert (error < 0.05 * exact).all()
    assert (np.abs(bands.mean(axis=0) - exact) < stats.norm.isf(0.5 * FALSE_ALARM / 40) * error).all()
    sensor = sensor_table(*VISIBLE).reshape(3, 40, 10).mean(axis=2) * 10
    assert np.allclose(sensor @ bands.mean(axis=0), film.rgb.mean(axis=(0, 1)), rtol=3e-3)
    assert np.allclose(film.band_centres, np.arange(385, 780, 10))


def test_white_luminance_scales_the_image():
    """Twice the luminance that is called white, half the image; exactly, since 2 is a power of two."""
    images = [render(white_plane("D65", white), 4).film.rgb for white in (100.0, 200.0)]
    assert images[0].max() > 0.5
    assert np.array_equal(images[0], 2 * images[1])
