"""A folder to run the command line in, with a sampler and a compiler of scenes that do next to nothing."""

import importlib.util
import sys
from pathlib import Path

import pytest

FAKE = Path(__file__).with_name("fake_artist.py")
SCENE = """
[camera]
type = "pinhole"
position = [0, -4, 0]
look_at = [0, 0, 0]
[film]
resolution = [8, 6]
[render]
iterations = 5
[materials.white]
type = "diffuse"
[[shapes]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "white"
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty current directory but for `scene.toml`, and no sampler."""
    spec = importlib.util.spec_from_file_location("fake_artist", FAKE)
    fake = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(fake)
    for name, module in fake.modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


@pytest.fixture
def edit(folder):
    """Function that writes a scene, `name`, with `old` replaced by `new`."""

    def write(old, new, name="scene.toml"):
        assert old in SCENE
        (folder / name).write_text(SCENE.replace(old, new))

    return write
