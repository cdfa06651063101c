"""A prism of dense flint, seen through: where each wavelength comes from, and how much of it.

The prediction traces film points through two faces with Snell's law and Fresnel's equations, written here once more.
Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 7.
"""

import math

import numpy as np
import pytest
from rendering import FALSE_ALARM, look, render, scene, shape, with_render
from scipy import stats

SF11 = [[1.73759695, 0.013188707], [0.313747346, 0.0623068142], [1.89878101, 155.23629]]  # Schott's catalogue
APEX = math.radians(60)
LASERS = (450, 550, 650)
COLUMNS, ROWS = 128, 8
FIELD = 1.0  # degrees for 8 rows


def index(nm):
    """Sellmeier's equation."""
    square = (nm * 1e-3) ** 2
    return math.sqrt(1 + sum(b * square / (square - c) for b, c in SF11))


def turned(v, angle):
    """`v` turned about the z axis, counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0])


class Bench:
    """A prism that the axis of view passes at minimum deviation for 550 nm, and a slit behind it."""

    def __init__(self):
        n = index(550.5)
        inside, outside = APEX / 2, math.asin(n * math.sin(APEX / 2))
        axis = np.array([0.0, 1.0, 0.0])
        self.front = np.array([0.0, 1.0, 0.0])
        self.front_normal = -turned(axis, outside)
        within = turned(axis, outside - inside)
        self.back = self.front + 0.5 * within
        self.back_normal = turned(within, -inside)
        self.out = turned(within, outside - inside)
        self.slit = self.back + 4.0 * self.out
        self.across = turned(self.out, -math.pi / 2)
        self.half_width = 0.03

    def face(self, point, normal, size, material=None, **more):
        """A rectangle around a point; its normal is the outer one."""
        along = np.cross([0, 0, 1], normal)
        corner = point - 0.5 * size * along - [0, 0, 2]
        return shape("rectangle", material, corner=corner, edges=[size * along, [0, 0, 4]], **more)

    def scene(self, emission, **render):
        """The bench in front of the camera; paths reach the slit by two refractions, and not otherwise."""
        shapes = [
            self.face(self.front, self.front_normal, 1.2, "flint"),
            self.face(self.back, self.back_normal, 1.2, "flint"),
            self.face(self.slit, -self.out, 2 * self.half_width, emission=emission),
        ]
        return scene(
            shapes,
            materials={"flint": {"type": "dielectric", "ior": {"sellmeier": SF11}}},
            camera=look([0, 0, 0], [0, 1, 0], FIELD),
            film={"resolution": [COLUMNS, ROWS]},
            render={"max_path_length": 3, **render},
        )

    def columns(self, nm, fine=400):
        """Radiance of a slit of 1, averaged over each column of pixels."""
        x, y = (np.arange(COLUMNS * fine) + 0.5) / fine, (np.arange(ROWS) + 0.5)[:, None]
        reach = math.tan(math.radians(FIELD / 2)) / ROWS
        rays = np.stack(np.broadcast_arrays(reach * (2 * x - COLUMNS), 1.0, reach * (ROWS - 2 * y)), axis=-1)
        rays = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
        origin = np.zeros(3)
        n = index(nm)
        share = 1.0
        for point, normal, eta in ((self.front, self.front_normal, n), (self.back, -self.back_normal, 1 / n)):
            origin = origin + rays * (((point - origin) @ normal) / (rays @ normal))[..., None]
            rays, transmitted = refracted(rays, normal, eta)
            share = share * transmitted
        distance = ((self.slit - origin) @ self.out) / (rays @ self.out)
        aside = (origin + rays * distance[..., None] - self.slit) @ self.across
        seen = np.where(np.abs(aside) < self.half_width, share, 0.0)
        return seen.reshape(ROWS, COLUMNS, fine).mean(axis=(0, 2))


def refracted(d, normal, eta):
    """Directions beyond an interface, and the transmitted share, for unit d against the normal (Born and Wolf 1.5)."""
    cos_i = -(d @ normal)
    cos_t = np.sqrt(1 - (1 - cos_i**2) / eta**2)
    r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    return d / eta + (cos_i / eta - cos_t)[..., None] * normal, 1 - 0.5 * (r_s**2 + r_p**2)


BENCH = Bench()


def test_minimum_deviation():
    """The bench itself: n = sin((apex + deviation) / 2) / sin(apex / 2), and less deviation is impossible."""
    deviation = math.acos(BENCH.out[1])
    n = index(550.5)
    assert math.sin((APEX + deviation) / 2) / math.sin(APEX / 2) == pytest.approx(n, rel=1e-12)
    for tilt in (-0.05, 0.05):
        ray = turned(np.array([0.0, 1.0, 0.0]), tilt)
        once, _ = refracted(ray[None], BENCH.front_normal, n)
        twice, _ = refracted(once, -BENCH.back_normal, 1 / n)
        assert math.acos(float(twice[0] @ ray)) > deviation + 1e-4


@pytest.mark.parametrize("nm", LASERS)
def test_one_laser(nm):
    """Column by column, at one wavelength: position, width and brightness of the slit's image."""
    compiled = BENCH.scene(1.0, wavelength_range=[nm, nm + 1])
    response = compiled.spectra[:3].sum(axis=1, dtype=float)
    channel = int(np.argmax(np.abs(response)))
    film = render(compiled, 256, aovs=("variance",)).film
    mean = film.rgb[..., channel].mean(axis=0) / response[channel]
    variance = film.variance[..., channel].sum(axis=0) / (ROWS * response[channel]) ** 2
    expected = BENCH.columns(nm + 0.5)
    lit = expected > 0
    assert 4 < np.count_nonzero(lit) < 30
    assert (mean[~lit] == 0).all()
    z = (mean - expected)[lit] / np.sqrt(variance[lit] + 1e-8)
    assert np.sqrt(variance[lit]).max() < 0.02
    assert stats.chi2.sf((z**2).sum(), z.size) > FALSE_ALARM


@pytest.mark.parametrize("wavelengths", ["independent", pytest.param("shared", marks=pytest.mark.slow)])
def test_three_lasers_at_once(wavelengths):
    """All in one image: each band shows its slit where it belongs, nothing elsewhere; noise is that between seeds."""
    emission = {"lines": [[nm + 0.5, 1] for nm in LASERS], "width": 1}
    settings = {"wavelength_range": [380, 780], "wavelengths": wavelengths}
    compiled = BENCH.scene(emission, **settings)
    scenes = [with_render(compiled, seed=seed) for seed in range(1, 11)]
    images = np.array([render(each, 64, spectral=True).film.spectral.mean(axis=0) for each in scenes])
    # (seeds, columns, bands of 10 nm)
    bands = [(nm - 380) // 10 for nm in LASERS]
    assert (np.delete(images, bands, axis=2) == 0).all()
    for nm, band in zip(LASERS, bands, strict=True):
        expected = BENCH.columns(nm + 0.5) / 10  # averaged over the band
        values = images[:, :, band]
        lit = expected > 0
        assert (values[:, ~lit] == 0).all()
        total = values.sum(axis=1)
        p = stats.ttest_1samp(total, expected.sum()).pvalue
        assert p > FALSE_ALARM and total.std() / math.sqrt(10) < 0.06 * expected.sum()
        centre = (values * np.arange(COLUMNS)).sum(axis=1) / total
        middle = (expected * np.arange(COLUMNS)).sum() / expected.sum()
        assert abs(centre.mean() - middle) < 0.3
