"""Plastic and Phong's lobe in all methods: each finds their light in other ways, and all bring the same.

A vertex on plastic has a delta lobe and one with a density; which of them a path takes decides how its light can be
found. Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 5.
"""

import math

import numpy as np
import pytest
from rendering import assert_equals, assert_same, diffuse, look, radiance, scene, shape

from artist_py.core.fresnel import fresnel_dielectric

MATERIALS = {
    "floor": {"type": "plastic", "reflectance": 0.5},
    "ball": {"type": "phong", "reflectance": 0.2, "specular": 0.7, "exponent": 60},
    "wall": diffuse(0.6),
    "glass": {"type": "dielectric"},
}
# The lamp is seen in the floor, and lights the wall by way of the floor.
SHAPES = [
    shape("rectangle", "floor", corner=[-2, -2, 0], edges=[[4, 0, 0], [0, 4, 0]]),
    shape("rectangle", "wall", corner=[-2, 2, 0], edges=[[4, 0, 0], [0, 0, 3]]),
    shape("sphere", "ball", center=[-0.7, 0.2, 0.5], radius=0.5),
    shape("sphere", "glass", center=[0.7, 0, 0.4], radius=0.4),
    shape("sphere", center=[0.3, 0.8, 1.6], radius=0.5, emission=2),
]


def image(integrator, iterations, **render):
    compiled = scene(
        SHAPES,
        materials=MATERIALS,
        camera=look([0, -3, 1.5], [0, 0.5, 0.5], 50),
        film={"resolution": [24, 24]},
        render={"integrator": integrator, "max_path_length": 6, **render},
    )
    return radiance(compiled, iterations)


@pytest.fixture(scope="module")
def by_path_tracing():
    return image("pt", 1024, seed=2)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["bpt", "vcm"])
def test_methods_agree_everywhere(method, by_path_tracing):
    """The merges of VCM blur, but have little weight at this radius."""
    assert_same(image(method, 256, merging={"radius": 0.001}), by_path_tracing, 1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["lt", "ppm", "bpm"])
def test_methods_agree_on_the_whole(method, by_path_tracing):
    """Light paths are too rare in dark pixels to tell how far these are off; what merging blurs is a part of 100."""
    measured = image(method, 512, merging={"radius": 0.02})
    error = math.sqrt(measured.variance.sum() + by_path_tracing.variance.sum()) / measured.mean.size
    assert_equals(measured.mean.mean(), error, by_path_tracing.mean.mean(), 1e-2, rounding=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["pt", "lt", "bpt", "ppm", "bpm", "vcm"])
def test_lamp_in_a_coat(method):
    """A lamp mirrored by the coat over a black base: Fresnel's reflectance, which hits alone can find."""
    floor = shape("rectangle", "dark", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]])
    lamp = shape("sphere", center=[0, 2, 2], radius=0.5, emission=2)
    unseen = shape("sphere", "gloss", center=[0, 0, -1], radius=0.1)
    compiled = scene(
        [floor, lamp, unseen],
        materials={"dark": {"type": "plastic", "reflectance": 0}, "gloss": {"type": "phong"}},
        camera=look([0, -2, 2], [0, 0, 0], 0.01),
        render={"integrator": method},
    )
    mirrored, _ = fresnel_dielectric(math.sqrt(0.5), 1.5)
    np.testing.assert_allclose(radiance(compiled, 8).mean, 2 * mirrored, rtol=1e-3)
