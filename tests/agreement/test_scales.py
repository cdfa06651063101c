"""Scenes of any size and anywhere: the same image, bit by bit where scale and offset are exact in binary.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 14.
"""

import math

import numpy as np
import pytest
from rendering import assert_same, diffuse, look, radiance, render, scene, shape

SIZE = 24
MATERIALS = {"white": diffuse(0.75), "glass": {"type": "dielectric", "ior": 1.5}}


def still_life(scale=1.0, offset=(0.0, 0.0, 0.0), seed=1, lens=False):
    """A lamp, a ball of glass, a cone and an instance in a box, scaled, and then moved by `offset`."""

    def place(*p):
        return [scale * x + o for x, o in zip(p, offset, strict=True)]

    def size(*v):
        return [scale * x for x in v]

    shapes = [
        shape("box", "white", min=place(-1, -1, -1), max=place(1, 1, 1), reverse=True),
        shape("sphere", "glass", center=place(-0.375, 0.25, -0.5), radius=0.375 * scale),
        shape("cone", "white", base=place(0.5, 0, -1), apex=place(0.375, 0.125, 0), radius=0.25 * scale),
        shape(
            "rectangle",
            corner=place(-0.25, -0.25, 0.875),
            edges=[size(0, 0.5, 0), size(0.5, 0, 0)],
            emission=5,
        ),
        # Dark, in a corner: so that this scene and that of small things share their kernels.
        shape(
            "disk", center=place(-0.875, 0.9375, 0.875), normal=[0, -1, 0], radius=0.0625 * scale, emission=0
        ),
    ]
    objects = {"block": [shape("box", "white", min=size(-0.25, -0.25, 0), max=size(0.25, 0.25, 0.5))]}
    instances = [
        {"object": "block", "transform": [{"rotate": [0, 0, 1, 30]}, {"translate": place(0.25, 0.5, -0.75)}]}
    ]
    camera = look(place(0, -0.9375, 0), place(0, 0, -0.125), 90)
    if lens:
        camera |= {"type": "thin-lens", "aperture_radius": 0.0625 * scale, "focus_distance": scale}
    return scene(
        shapes,
        materials=MATERIALS,
        objects=objects,
        instances=instances,
        camera=camera,
        film={"resolution": [SIZE, SIZE]},
        render={"max_path_length": 8, "seed": seed},
    )


@pytest.fixture(scope="module")
def original():
    return radiance(still_life(), 128)


@pytest.mark.parametrize("power", [-50, -20, -3, 10, 50])
def test_powers_of_two_change_no_bit(power):
    """Render space is scaled by one itself."""
    images = [render(still_life(scale), 4).film.rgb for scale in (1.0, 2.0**power)]
    assert np.array_equal(*images)


def test_powers_of_two_with_a_lens():
    images = [render(still_life(scale, lens=True), 4).film.rgb for scale in (1.0, 2.0**-12)]
    assert np.array_equal(*images)


def test_exact_offsets_change_no_bit():
    """By a number that leaves all coordinates exact in float64."""
    images = [
        render(still_life(offset=offset), 4).film.rgb
        for offset in ((0, 0, 0), (2.0**17, -(2.0**15), 2.0**12))
    ]
    assert np.array_equal(*images)


@pytest.mark.parametrize(
    ("scale", "offset"),
    [
        (1e-5, (0, 0, 0)),
        (1e3, (0, 0, 0)),
        (1e6, (0, 0, 0)),
        (1e12, (0, 0, 0)),
        (1.0, (1e5, 1e5, -1e5)),
        (1e-3, (33.3, 0, 77.7)),
        (1e3, (-1e8, 2e8, 0)),
    ],
)
def test_any_scale_and_offset(original, scale, offset):
    """Pixel by pixel, with random numbers of its own."""
    other = radiance(still_life(scale, offset, seed=2), 128)
    assert_same(original, other, 0.02)


@pytest.mark.parametrize("count", [1, 1000])
def test_small_things_in_large_scenes(count):
    """A lamp and a plate of 1/1000 of a scene's size light each other as they do alone."""
    plate = shape("rectangle", "white", corner=[-0.05, -0.05, 0], edges=[[0.1, 0, 0], [0, 0.1, 0]])
    lamp = shape("disk", center=[0, 0, 0.05], normal=[0, 0, -1], radius=0.05, emission=1)
    wall = shape("sphere", "white", center=[0, 0, 0], radius=0.2 * count, reverse=True)
    # Below the plate: what the still life has.
    below = [
        shape("sphere", "glass", center=[0, 0, -0.1], radius=0.01),
        shape("rectangle", corner=[0.02, 0, -0.1], edges=[[0.01, 0, 0], [0, 0.01, 0]], emission=0),
    ]
    compiled = scene(
        [plate, lamp, wall, *below],
        materials=MATERIALS,
        objects={"block": [shape("box", "white", min=[0, 0.02, -0.1], max=[0.01, 0.03, -0.09])]},
        instances=[{"object": "block"}],
        camera=look([0.15, 0, 0.02], [0, 0, 0], 0.01),
        render={"max_path_length": 2, "sampler": "sobol"},
    )
    values = radiance(compiled, 256).mean
    # E = pi R^2 / (R^2 + h^2), seen as 0.75 E / pi.
    error = values.std() / math.sqrt(values.size)
    assert error < 2e-3
    assert abs(values.mean() - 0.75 * 0.5) < 3.9 * error + 1e-5
