"""Points of light that lie exactly on a surface: it hides them from one side, and not from both."""

import math

import numpy as np
import pytest

import artist_py
from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.stress.scenes import look, scene, shape
from artist_py.stress.toml import to_toml

FLOOR = shape("rectangle", "white", corner=[-0.5, -0.5, 0], edges=[[1, 0, 0], [0, 1, 0]])


def radiances(tables, iterations, **render):
    """Radiance per pixel (h, w) of a monochrome scene."""
    tables["render"].update(render)
    compiled = compile_scene(read_scene_text(to_toml(tables)), 1)
    film = artist_py.render(compiled, iterations=iterations, threads=1).film
    assert film.rejected_count == 0
    return film.rgb[..., 1] / compiled.spectra[1].sum(dtype=float)


@pytest.mark.parametrize("height", [0.0, 1e-9, 1e-3])
def test_point_on_floor_lights_what_is_above(height):
    """I cos / d^2 on a wall that stands on the floor, seen as a/pi of it."""
    wall = shape("rectangle", "grey", corner=[-0.5, 0.5, 0], edges=[[1, 0, 0], [0, 0, 1]])
    tables = scene(
        [FLOOR, wall],
        look([0.2, -0.4, 0.3], [0, 0.5, 0.4], 1e-3),
        emitters=[{"type": "point", "position": [0.1, 0.2, height], "spectrum": 1}],
        aside=None,
        render={"max_path_length": 2},
    )
    distance = math.hypot(0.1, 0.3, 0.4 - height)
    assert np.allclose(radiances(tables, 4), 0.5 / math.pi * 0.3 / distance**3, rtol=1e-3)
