"""Cameras against geometry: where rays go, what is sharp, how large blur is, and what filters do to an edge.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are about 60.
"""

import math

import numpy as np
import pytest
from rendering import (
    FALSE_ALARM,
    assert_same,
    assert_sample_mean,
    diffuse,
    look,
    radiance,
    scene,
    shape,
    with_render,
)
from scipy import stats

from artist_py.cameras.perspective import camera_ray
from artist_py.film.filters import FILTERS, evaluate_filter

WHITE = {"white": diffuse(0.8)}
LAMP = shape("rectangle", corner=[-1, 2, -1], edges=[[2, 0, 0], [0, 0, 2]], emission=1)
VIEWS = {
    "along y": look([0, 0, 0], [0, 1, 0], 45),
    "tilted": look([1, -2, 3], [0.2, 0.5, -0.3], 70, up=[0.1, 0.9, 0.3]),
    "down": look([0, 0, 5], [0, 0, 0], 20),
    "wide": look([0.5, 0, 0], [0, 0, 0], 150),
}
LENS = {"type": "thin-lens", "aperture_radius": 0.25, "focus_distance": 3}


def lens_camera(**more):
    return {**look([0, 0, 0], [0, 1, 0], 45), **LENS, **more}


# --- rays ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("resolution", [(64, 64), (100, 40), (30, 90)])
@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_rays_through_the_film(view, resolution):
    """In all corners and between: tan(fov / 2) reaches the edges of the shorter side; row 0 is on top."""
    width, height = resolution
    compiled = scene([LAMP], camera=view, film={"resolution": resolution})
    forward = np.subtract(view["look_at"], view["position"])
    forward = forward / np.linalg.norm(forward)
    up = np.array(view["up"], float)
    up -= forward * (up @ forward)
    up /= np.linalg.norm(up)
    right = np.cross(forward, up)
    reach = math.tan(math.radians(view["field_of_view"] / 2)) / min(width, height)
    for x, y in [(0, 0), (width, 0), (0, height), (width, height), (width / 2, height / 2), (3.25, 7.5)]:
        expected = forward + reach * ((2 * x - width) * right + (height - 2 * y) * up)
        origin, _, direction = camera_ray(compiled.camera, x, y, 0.5, 0.5)
        position = origin.values / compiled.space.scale + compiled.space.centre
        assert np.allclose(direction.values, expected / np.linalg.norm(expected), atol=1e-14)
        assert np.allclose(position, view["position"], atol=1e-13)
        seen = compiled.matrices[1] @ [*(np.array(view["position"]) + 7 * expected), 1]
        assert np.allclose(seen[:2] / seen[3], [x / width, y / height], atol=1e-12)


@pytest.mark.parametrize("blades", [0, 5])
def test_rays_through_the_lens(blades):
    """All rays of one film point meet in the plane of focus, and pass the lens within its radius."""
    camera = lens_camera(blades=blades, blade_rotation=10)
    compiled = scene([LAMP], camera=camera)
    pinhole = scene([LAMP], camera=look([0, 0, 0], [0, 1, 0], 45))
    rng = np.random.default_rng(1)
    for x, y in [(0, 0), (8, 8), (13.5, 2.25)]:
        *_, middle = camera_ray(pinhole.camera, x, y, 0, 0)
        focus = 3 * middle.values / middle.values[1]
        offsets = []
        for u, v in rng.random((50, 2)):
            origin, _, direction = camera_ray(compiled.camera, x, y, u, v)
            start = origin.values / compiled.space.scale + compiled.space.centre
            along = (focus[1] - start[1]) / direction.values[1]
            assert np.allclose(start + along * direction.values, focus, atol=1e-13)
            offsets.append(start)
        offsets = np.array(offsets)
        assert np.abs(offsets[:, 1]).max() < 1e-14
        assert 0.15 < np.hypot(offsets[:, 0], offsets[:, 2]).max() <= 0.25


# --- blur ---------------------------------------------------------------------------------------------------------


def blurs(distance, camera, seeds=range(1, 13)):
    """Mean squared distance, pixels^2, from the centre of the image of a small lamp on the axis; one per seed."""
    size = 0.02 * distance
    lamp = shape(
        "rectangle", corner=[-size / 2, distance, -size / 2], edges=[[size, 0, 0], [0, 0, size]], emission=1
    )
    # What is far and hardly reflects makes the scene large, and has a material as other scenes have that share kernels.
    far = shape("rectangle", "white", corner=[0, 40, 0], edges=[[1, 0, 0], [0, 0, 1]], emission=0)
    camera_path = {"max_path_length": 1}
    compiled = scene(
        [lamp, far], materials=WHITE, camera=camera, film={"resolution": [64, 64]}, render=camera_path
    )
    images = np.array([radiance(with_render(compiled, seed=seed), 48).mean for seed in seeds])
    offset = np.arange(64) - 31.5
    squares = offset[:, None] ** 2 + offset**2
    return (images * squares).sum(axis=(1, 2)) / images.sum(axis=(1, 2))


@pytest.mark.parametrize("distance", [1.5, 20.0])
def test_circle_of_confusion(distance):
    """Radius: that of the lens times |1 / z - 1 / focus|, on the film at distance 1; on average half of its square.

    The lamp's own square, and the pixel's, add a sixth of their squared sides each.
    """
    pixel = 2 * math.tan(math.radians(22.5)) / 64
    radius = 0.25 * abs(1 / distance - 1 / 3) / pixel
    expected = radius**2 / 2 + (0.02 / pixel) ** 2 / 6 + 1 / 6
    assert_sample_mean(blurs(distance, lens_camera()), expected, 0.03, 1e-3)


def test_what_is_in_focus_is_sharp():
    """The lamp's image is 1.5 pixels wide: it lies in the four pixels around the centre, and in no other."""
    assert blurs(3.0, lens_camera(), [1]).tolist() == [0.5]


def test_bladed_blur_is_smaller():
    """A square aperture with the same circumscribed circle: a third of the radius squared instead of half."""
    pixel = 2 * math.tan(math.radians(22.5)) / 64
    radius = 0.25 * abs(1 / 1.5 - 1 / 3) / pixel
    expected = radius**2 / 3 + (0.02 / pixel) ** 2 / 6 + 1 / 6
    camera = lens_camera(blades=4, blade_rotation=30)
    assert_sample_mean(blurs(1.5, camera), expected, 0.03, 1e-3)


# --- distance -----------------------------------------------------------------------------------------------------

STAGE = [
    shape("rectangle", "white", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]]),
    shape("rectangle", "grey", corner=[-0.5, -0.6, 1e-3], edges=[[0.9, 0.2, 0], [-0.1, 0.4, 0]]),
    shape("rectangle", corner=[1.2, -0.5, 0.2], edges=[[0, 0.5, 0], [0, 0, 0.6]], emission=3, reverse=True),
]


def seen_from(distance):
    """The same square of the stage from any height above it."""
    fov = 2 * math.degrees(math.atan(0.9 / distance))
    return scene(
        STAGE,
        materials={**WHITE, "grey": diffuse(0.2)},
        camera=look([0, 0, distance], [0, 0, 0], fov),
        film={"resolution": [32, 32]},
        render={"seed": int(distance), "max_path_length": 3},
    )


@pytest.mark.parametrize("radii", [1e4, 1e6])
def test_far_cameras_see_the_same(radii):
    """What is flat looks alike from everywhere straight above it."""
    near, far = (radiance(seen_from(distance), 256) for distance in (4, 1.5 * radii))
    assert_same(near, far, 4e-3)


# --- filters ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILTERS)
def test_image_of_an_edge(name):
    """Column by column the integral of the filter; beside an edge, Mitchell's lobes go below zero."""
    size, edge = 16, 7.65
    wall = shape("rectangle", corner=[0, 10, -9], edges=[[9, 0, 0], [0, 0, 18]], emission=1)
    far = shape("rectangle", "white", corner=[-9, 10, -9], edges=[[1, 0, 0], [0, 0, 1]], emission=0)
    # So that the lamp's edge at x = 0 lies `edge` pixels from the left.
    pixel = 2 * math.tan(math.radians(15)) / size
    shift = 10 * pixel * (size / 2 - edge)
    compiled = scene(
        [wall, far],
        materials=WHITE,
        camera=look([shift, 0, 0], [shift, 10, 0], 30),
        film={"resolution": [size, size], "filter": name},
        render={"sampler": "sobol", "max_path_length": 1},
    )
    image = radiance(compiled, 512).mean
    radius = compiled.graph.film.filter_radius
    fine = (np.arange(100_000) + 0.5) / 50_000 * radius - radius
    values = evaluate_filter(name, radius, fine)
    cumulative = np.concatenate([[0], np.cumsum(values) / values.sum()])
    grid = np.linspace(-radius, radius, len(cumulative))
    offset = edge - (np.arange(size) + 0.5)
    expected = 1 - np.interp(offset, grid, cumulative)
    mean = image.mean(axis=0)
    error = image.std(axis=0, ddof=1) / math.sqrt(size)
    allowed = stats.t.isf(0.5 * FALSE_ALARM / size, size - 1) * error + 5e-4
    assert error.max() < 0.003
    assert (np.abs(mean - expected) < allowed).all(), np.round(mean - expected, 4)
    if name == "mitchell":
        assert mean.min() < -0.01
