"""What a camera draws at random: points of the aperture, and points of the film around a pixel.

Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared, Sidak over its cases) for
densities, and 6e-5 for the signed weights of Mitchell's filter (5 sigma in each of 100 cells).
"""

import math

import numpy as np
import pytest
from chi_squared import DISK, ChiSquaredTest, Domain, constant, triangle_from_unit, triangle_to_unit

from artist_py.cameras.lens import sample_aperture
from artist_py.cameras.perspective import sample_film
from artist_py.core.table import Table
from artist_py.film.filters import FILTERS, evaluate_filter
from artist_py.jit import kernel
from artist_py.scene.compile_camera import compile_filter
from artist_py.scene.graph import Film
from artist_py.scene.tables import Lens

PIXEL = 3, 7


@kernel
def aperture_rows(lens, numbers, out):
    for i in range(numbers.shape[0]):
        out[i, 0], out[i, 1] = sample_aperture(lens, numbers[i, 0], numbers[i, 1])


@kernel
def film_rows(pixel_filter, x, y, numbers, out):
    for i in range(numbers.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = sample_film(pixel_filter, x, y, numbers[i, 0], numbers[i, 1])


# --- apertures ----------------------------------------------------------------------------------------------------


def polygon(blades, rotation):
    """A regular polygon with corners on the unit circle, the first one at `rotation`: its triangles side by side."""
    corner = rotation + 2 * np.pi * np.arange(blades + 1) / blades
    corners = np.column_stack([np.cos(corner), np.sin(corner)])

    def from_unit(unit):
        scaled = unit[:, 0] * blades
        blade = np.minimum(scaled.astype(int), blades - 1)
        b = triangle_from_unit(np.column_stack([unit[:, 1], scaled - blade]))
        return b[:, :1] * corners[blade] + b[:, 1:] * corners[blade + 1]

    def to_unit(points):
        turn = (np.arctan2(points[:, 1], points[:, 0]) - rotation) / (2 * np.pi) % 1.0
        blade = np.minimum((turn * blades).astype(int), blades - 1)
        edges = np.stack([corners[blade], corners[blade + 1]], axis=1)
        b = np.linalg.solve(edges.transpose(0, 2, 1), points[:, :, None])[:, :, 0]
        unit = triangle_to_unit(np.maximum(b, 0.0))
        return np.column_stack([(blade + unit[:, 1]) / blades, unit[:, 0]])

    return Domain(from_unit, to_unit, constant(area_of(blades)))


def area_of(blades):
    return 0.5 * blades * math.sin(2 * math.pi / blades) if blades else math.pi


def aperture_case(blades, degrees):
    lens = Lens(0.3, 2.0, blades, math.radians(degrees))

    def sample(numbers):
        out = np.empty((len(numbers), 2))
        aperture_rows(lens, Table(numbers), Table(out))
        return out

    domain = polygon(blades, lens.rotation) if blades else DISK
    bins = (6 * blades, 8) if blades else (10, 20)
    return ChiSquaredTest(sample, lambda p: np.full(len(p), 1 / area_of(blades)), domain, bins=bins)


# --- film ---------------------------------------------------------------------------------------------------------


def compiled_filter(name):
    return compile_filter(Film(filter=name, filter_radius=None))


def square(radius):
    """Offsets from the centre of PIXEL, up to `radius` to all sides."""
    centre = np.array(PIXEL) + 0.5
    return Domain(
        lambda unit: centre + radius * (2 * unit - 1),
        lambda points: ((points - centre) / radius + 1) / 2,
        constant(4 * radius**2),
    )


def film_points(name, numbers):
    """Film points and weights, rows (x, y, weight)."""
    out = np.empty((len(numbers), 3))
    film_rows(compiled_filter(name), *PIXEL, Table(numbers), Table(out))
    return out


def axis_values(name, radius, offsets):
    """|f| along one axis, normalised by fine quadrature."""
    fine = (np.arange(200_000) + 0.5) / 100_000 * radius - radius
    return np.abs(evaluate_filter(name, radius, offsets)) / (
        np.abs(evaluate_filter(name, radius, fine)).mean() * 2 * radius
    )


def film_case(name):
    radius = Film(filter=name, filter_radius=None).filter_radius

    def density(points):
        offsets = points - np.array(PIXEL) - 0.5
        return axis_values(name, radius, offsets[:, 0]) * axis_values(name, radius, offsets[:, 1])

    # Wide bins: within the 1024 cells of its table, a filter is replaced by its mean.
    return ChiSquaredTest(
        lambda u: film_points(name, u)[:, :2], density, square(radius), bins=(8, 8), order=100
    )


CASES = {
    "round": aperture_case(0, 0),
    "three blades": aperture_case(3, 20),
    "five blades": aperture_case(5, -100),
    "eight blades": aperture_case(8, 0),
    **{name: film_case(name) for name in FILTERS},
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_points_follow_their_density(case):
    case.assert_passes(len(CASES))


def test_weights_make_up_for_negative_lobes():
    """Mitchell: the sum of weights in each of 10 x 10 cells is the integral of the filter there, sign included."""
    numbers = np.random.default_rng(3).random((400_000, 2))
    x, y, weight = film_points("mitchell", numbers).T
    radius, cells = 2.0, 10
    edges = np.linspace(-radius, radius, cells + 1)
    fine = (np.arange(cells * 200) + 0.5) / (cells * 200) * 2 * radius - radius
    values = evaluate_filter("mitchell", radius, fine)
    share = values.reshape(cells, 200).sum(axis=1) / values.sum()
    bins = [edges + PIXEL[0] + 0.5, edges + PIXEL[1] + 0.5]
    sums, _, _ = np.histogram2d(x, y, bins=bins, weights=weight)
    squares, _, _ = np.histogram2d(x, y, bins=bins, weights=weight**2)
    assert squares.min() > 0 and (sums < 0).sum() > 20
    deviation = sums / len(x) - np.outer(share, share)
    assert np.abs(deviation / (np.sqrt(squares) / len(x))).max() < 5
    assert weight.mean() == pytest.approx(1, abs=5 * weight.std() / math.sqrt(len(weight)))


@pytest.mark.parametrize("name", [name for name in FILTERS if name != "mitchell"])
def test_weights_are_one_without_negative_lobes(name):
    assert compiled_filter(name).weights is None
    assert (film_points(name, np.random.default_rng(4).random((100, 2)))[:, 2] == 1.0).all()
