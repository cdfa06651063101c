"""Materials that choose between lobes get a random number for it, also where nothing else in the scene needs one.

A fixed seed; a correct program fails one comparison by chance with probability 1e-4; there are 4.
"""

import math

import pytest
from rendering import assert_uniform, look, radiance, scene, shape

from artist_py.bsdf.oren_nayar import mean_albedo, multiple_reflectance, single_albedo, slope_ratio

LAMP = shape("sphere", center=[0, 0, 0], radius=4, reverse=True, emission=1)


@pytest.mark.parametrize("degrees", [40, 80])
@pytest.mark.parametrize("roughness", [30, 90])
def test_oren_nayar_alone_under_one_lamp(degrees, roughness):
    angle, rho = math.radians(degrees), 0.9
    compiled = scene(
        [LAMP, shape("rectangle", "plate", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]])],
        materials={"plate": {"type": "oren-nayar", "reflectance": rho, "roughness": roughness}},
        camera=look([0, -2 * math.sin(angle), 2 * math.cos(angle)], [0, 0, 0], 1e-3),
        render={"max_path_length": 2},
    )
    r = slope_ratio(math.radians(roughness))
    once = single_albedo(math.cos(angle), r)
    expected = rho * once + multiple_reflectance(rho, mean_albedo(r)) * (1 - once)
    assert_uniform(radiance(compiled, 256), expected, 3e-3)
