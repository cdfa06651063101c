"""Scenes that give a black picture say so."""

import pytest

from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.stress.scenes import VIEW, furnace, scene
from artist_py.stress.toml import to_toml

DARK = {
    "nothing": scene([], VIEW, aside=None),
    "no light": furnace(emission=0.0),
    "ultraviolet": furnace(
        emission={"spectrum": {"lines": [[301, 1]]}}, render={"wavelength_range": [380, 780]}
    ),
}


def warnings_of(tables):
    return compile_scene(read_scene_text(to_toml(tables))).warnings


@pytest.mark.parametrize("tables", DARK.values(), ids=DARK)
def test_dark_scenes(tables):
    first, last = tables["render"]["wavelength_range"]
    assert warnings_of(tables) == [f"nothing emits light from {first} to {last} nm: the image will be black"]


def test_lit_scenes():
    assert warnings_of(furnace()) == []
    line = {"spectrum": {"lines": [[379.9, 1], [380.1, 1e-9]]}}
    assert warnings_of(furnace(emission=line, render={"wavelength_range": [380, 780]})) == []
