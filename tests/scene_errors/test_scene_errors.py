"""Every broken scene of this folder is refused with exactly the message that stands beside it."""

from pathlib import Path

import pytest

from artist_py.errors import SceneError
from artist_py.scene.compile import validate
from artist_py.scene.reader import read_scene

FOLDER = Path(__file__).parent
SCENES = sorted(path.stem for path in FOLDER.glob("*.toml"))


@pytest.mark.parametrize("name", SCENES)
def test_message(name, monkeypatch):
    monkeypatch.chdir(FOLDER)
    with pytest.raises(SceneError) as caught:
        validate(read_scene(f"{name}.toml"))
    assert str(caught.value) == Path(f"{name}.txt").read_text(encoding="utf-8").rstrip("\n")


def test_there_is_a_message_for_each_scene_and_no_other():
    assert len(SCENES) >= 70
    assert SCENES == sorted(path.stem for path in FOLDER.glob("*.txt"))
