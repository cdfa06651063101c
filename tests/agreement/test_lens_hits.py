"""Light that hits the lens finds what nothing else can: the blurred image of a point in a mirror, in closed form.

Fixed seeds; a correct program fails a comparison by chance with probability 1e-4.
"""

import math

import numpy as np
import pytest
from rendering import GREEN, MONOCHROME, assert_mean, compile_tables, diffuse, look, radiance, render

SIZE, RADIUS, FOCUS, BEHIND = (
    24,
    0.5,
    2.0,
    3.0,
)  # the mirror image stands `BEHIND` the lens plane, on the axis
VIEW = 40.0  # degrees
REFLECTANCE, INTENSITY = 0.7, 2.0


def seen_in_mirror(integrator, **settings):
    """A point beside the lens, and its image in a mirror that fills the view; nothing else reflects to the lens.

    The mirror is that of the plane y = 1, in which the point at y = -1 is seen at y = 3.
    """
    table = {
        "film": {"resolution": [SIZE, SIZE], "filter": "box"},
        "camera": {
            **look([0, 0, 0], [0, 1, 0], VIEW),
            "type": "thin-lens",
            "aperture_radius": RADIUS,
            "focus_distance": FOCUS,
        },
        "render": {
            "integrator": integrator, "sampler": "independent", "wavelength_range": MONOCHROME, **settings
        },
        "materials": {"mirror": {"type": "mirror", "reflectance": REFLECTANCE}, "dark": diffuse(0.0)},
        "shapes": [
            {"type": "disk", "material": "mirror", "center": [0, 1, 0], "normal": [0, -1, 0], "radius": 2},
            # Behind everything; with it there is a surface that methods with connections look for.
            {"type": "disk", "material": "dark", "center": [0, -2, 0], "normal": [0, 1, 0], "radius": 2},
        ],
        "emitters": [{"type": "point", "position": [0, -1, 0], "spectrum": 1, "intensity": INTENSITY}],
    }  # fmt: skip
    return compile_tables(table)


def expected_mean():
    """Mean over the pixels, all of which is on the film: flux times (1.23), integrated over the lens.

    At the distance s from its middle I cos^3 / D^2 dA arrives, and counts 1 / (A_px A_l cos^4): D^2 is the mirror
    image's distance along the axis, and 1 / cos = sqrt(1 + s^2 / D^2).
    """
    integral = 2.0 / 3.0 * math.pi * BEHIND**2 * ((1.0 + (RADIUS / BEHIND) ** 2) ** 1.5 - 1.0)
    film_area = (2.0 * math.tan(math.radians(VIEW / 2.0))) ** 2
    return REFLECTANCE * INTENSITY * integral / (BEHIND**2 * math.pi * RADIUS**2 * film_area)


@pytest.mark.parametrize("integrator", ["lt", pytest.param("bpt", marks=pytest.mark.slow)])
def test_a_point_in_a_mirror(integrator):
    image = radiance(seen_in_mirror(integrator), 400, techniques=True)  # by the kernel of the test below
    assert_mean(image, expected_mean(), 0.03)
    # The disk of confusion: in the focus plane the light of the lens has come within R |D - F| / D of the axis.
    blur = RADIUS * (BEHIND - FOCUS) / BEHIND
    pixel = 2.0 * math.tan(math.radians(VIEW / 2.0)) / SIZE * FOCUS
    y, x = (np.indices((SIZE, SIZE)) - (SIZE - 1) / 2) * pixel
    distance = np.hypot(x, y)
    assert np.all(image.mean[distance > blur + pixel] == 0.0)
    assert np.all(image.mean[distance < blur - pixel] > 0.0)


@pytest.mark.slow
def test_the_path_tracer_does_not_find_it():
    assert not radiance(seen_in_mirror("pt"), 4).mean.any()


def test_nothing_else_finds_it():
    """Of the techniques of light tracing, lens hits see all."""
    images = render(seen_in_mirror("lt"), 16, techniques=True).techniques
    lit = [each.name for each, image in zip(images.techniques, images.weighted, strict=True) if image.any()]
    assert lit == ["lens"]
    assert images.weighted.sum(axis=0)[..., GREEN].mean() > 0.0


def test_a_point_is_not_seen_itself():
    """Of emitters without a surface only what they light is seen, by no method."""
    facing = seen_in_mirror("lt", max_path_length=1)
    assert not radiance(facing, 16, techniques=True).mean.any()
