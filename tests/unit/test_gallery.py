"""`make gallery` renders what has changed and nothing else, and its page needs nothing but the files beside it."""

import re
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from artist_py.errors import OptionError

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from gallery.page import write_page  # noqa: E402
from gallery.painting import reduce_colours  # noqa: E402
from gallery.plan import Manifest, all_pictures, details, opening_comment, together, update  # noqa: E402

LIST = """
[scene]
longest_side = 400
cpu_seconds = 1
[scene.special.room]
cpu_seconds = 2
[equal_time]
integrators = ["pt", "vcm"]
reference = "vcm"
[[equal_time.pictures]]
scene = "room"
detail = [0.2, 0.4, 0.5, 0.7]
text = "A < B"
[zoom]
integrator = "vcm"
[[zoom.pictures]]
scene = "room"
name = "room-corner"
window = [0, 0.5, 0, 0.5]
[techniques]
iterations = 4
[[techniques.pictures]]
scene = "room"
[[together.rows]]
scenes = ["ball", "room"]
text = "A ball, a room"
"""
ROOM = """# A room.
# With a floor.
#
# More of it.
include = ["parts/walls.toml"]
[film]
resolution = [8, 4]
[materials.floor]
reflectance = { image = "tile.png" }
"""
ALL = ["room-equal-time", "ball", "room", "room-techniques", "room-corner"]


@pytest.fixture
def gallery(tmp_path):
    """A list, two scenes with their files, and `build(force=())`: the names of what it has rendered."""
    scenes, folder = tmp_path / "scenes", tmp_path / "gallery"
    (scenes / "parts").mkdir(parents=True)
    folder.mkdir()
    (tmp_path / "list.toml").write_text(LIST)
    (scenes / "room.toml").write_text(ROOM)
    (scenes / "ball.toml").write_text("# A ball.\n[film]\nresolution = [4, 4]\n")
    (scenes / "parts" / "walls.toml").write_text("[materials.wall]\nreflectance = 0.5\n")
    (scenes / "tile.png").write_bytes(b"tile")

    def build(force=(), fails=()):
        painted = []

        def paint(picture):
            if picture.name in fails:
                raise OptionError("no light")
            for file in picture.files.values():
                (folder / file).write_bytes(b"png")
            painted.append(picture.name)
            return facts_of(picture)

        pictures, manifest = all_pictures(tmp_path / "list.toml", scenes), Manifest(folder)
        manifest.forget_others(pictures)
        failed = update(pictures, manifest, paint, lambda text: None, force)
        rows = together(tmp_path / "list.toml")
        write_page(folder, pictures, manifest.records, details(tmp_path / "list.toml"), rows)
        build.failed = failed
        return painted

    return SimpleNamespace(list=tmp_path / "list.toml", scenes=scenes, folder=folder, build=build)


def facts_of(picture):
    """What a painter returns."""
    took = {"cpu_seconds": 1.0, "iterations": 3, "own_relmse": 0.012}
    rows = {name: {**took, "relmse": 0.5, "smape": 0.37} for name in picture.settings.get("integrators", ())}
    files = {file: [8, 4] for file in picture.files.values()}
    reference = {"integrator": "vcm", **took}
    return {
        "files": files, "rows": rows, "reference": reference, "integrator": "vcm", "merged_share": 0.2, **took,
    }  # fmt: skip


def replace(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_everything_once_and_then_nothing(gallery):
    assert gallery.build() == ALL
    before = {path: path.stat().st_mtime_ns for path in gallery.folder.iterdir()}
    assert gallery.build() == []
    assert before == {path: path.stat().st_mtime_ns for path in gallery.folder.iterdir()}


def test_what_a_scene_shows_counts(gallery):
    gallery.build()
    replace(gallery.scenes / "room.toml", "[8, 4]", "[16, 8]")
    assert gallery.build() == [name for name in ALL if name != "ball"]


def test_comments_and_captions_do_not_count(gallery):
    gallery.build()
    replace(gallery.scenes / "room.toml", "With a floor", "With walls")
    replace(gallery.list, "A < B", "A > B")
    replace(gallery.list, "[0.2, 0.4, 0.5, 0.7]", "[0.1, 0.4, 0.5, 0.8]")
    assert gallery.build() == []
    page = (gallery.folder / "index.html").read_text()
    assert "A room. With walls." in page and "A &gt; B" in page


def test_captions_say_both_errors(gallery):
    gallery.build()
    assert (gallery.folder / "index.html").read_text().count("relMSE 0.50</span><br>sMAPE 0.37") == 2


def test_scenes_side_by_side_are_not_shown_twice(gallery):
    gallery.build()
    page = (gallery.folder / "index.html").read_text()
    row, rest = page.split('<h2 id="together">')[1].split('<h2 id="scenes">')
    assert "A ball, a room" in row and row.index("ball.png") < row.index("room.png")
    assert page.count('src="ball.png"') == 1 and "<img" not in rest


def test_a_palette_makes_a_png_smaller_and_keeps_what_it_shows(tmp_path):
    """Of 16 levels of each channel, 16 apart, 4 remain: they are off by 8 or 24, by 16 in the mean."""
    path = tmp_path / "noise.png"
    pixels = np.random.default_rng(1).integers(0, 16, (64, 64, 3)).astype(np.uint8) * 16
    Image.fromarray(pixels).save(path)
    before = path.stat().st_size
    reduce_colours(path, 64)
    with Image.open(path) as image:
        assert image.mode == "P" and len(image.getcolors()) <= 64
        shown = np.asarray(image.convert("RGB"))
    assert path.stat().st_size < 0.7 * before
    assert np.abs(shown.astype(int) - pixels).mean() < 20


@pytest.mark.parametrize("file", ["parts/walls.toml", "tile.png"])
def test_files_that_a_scene_uses_count(gallery, file):
    gallery.build()
    path = gallery.scenes / file
    path.write_bytes(path.read_bytes().replace(b"0.5", b"0.6").replace(b"tile", b"tiles"))
    assert gallery.build() == [name for name in ALL if name != "ball"]


@pytest.mark.parametrize(
    ("old", "new", "painted"),
    [
        ("iterations = 4", "iterations = 5", ["room-techniques"]),
        ("cpu_seconds = 2", "cpu_seconds = 3", ["room"]),
        ("cpu_seconds = 1", "cpu_seconds = 4", ["ball"]),
        ("window = [0,", "window = [0.1,", ["room-corner"]),
        ('["pt", "vcm"]', '["pt"]', ["room-equal-time"]),
    ],
)
def test_settings_count_where_they_apply(gallery, old, new, painted):
    gallery.build()
    replace(gallery.list, old, new)
    assert gallery.build() == painted


def test_a_lost_file_is_rendered_again(gallery):
    gallery.build()
    (gallery.folder / "room-techniques-map.png").unlink()
    assert gallery.build() == ["room-techniques"]


def test_what_was_asked_for_again(gallery):
    gallery.build()
    assert gallery.build(force=["ball"]) == ["ball"]


def test_a_failure_leaves_the_others_and_is_tried_again(gallery):
    assert gallery.build(fails=["room-corner"]) == [name for name in ALL if name != "room-corner"]
    assert gallery.build.failed == {"room-corner": "no light"}
    assert gallery.build() == ["room-corner"]


def test_an_edit_during_the_render_is_rendered_again(gallery):
    """The digest is that of what was rendered, not of what stands there afterwards."""
    pictures, manifest = all_pictures(gallery.list, gallery.scenes), Manifest(gallery.folder)

    def paint(picture):
        if picture.name == "ball":
            replace(gallery.scenes / "ball.toml", "[4, 4]", "[2, 2]")
        return facts_of(picture)

    update(pictures, manifest, paint, lambda text: None)
    assert manifest.records["ball"]["digest"] != pictures[ALL.index("ball")].digest


def test_a_scene_that_is_gone_takes_its_files_along(gallery):
    gallery.build()
    assert (gallery.folder / "ball.png").exists()
    (gallery.scenes / "ball.toml").unlink()
    assert gallery.build() == []
    assert not (gallery.folder / "ball.png").exists()
    assert "ball" not in (gallery.folder / "manifest.json").read_text()
    assert "ball.png" not in (gallery.folder / "index.html").read_text()


def test_settings_of_an_unknown_scene(gallery):
    replace(gallery.list, "special.room", "special.rom")
    with pytest.raises(OptionError, match="there is no scene rom"):
        gallery.build()


# --- the gallery of this repository


def test_the_list_names_every_scene_once_and_no_file_twice():
    pictures = all_pictures(ROOT / "gallery" / "pictures.toml", ROOT / "scenes")
    shown = [each.scene.stem for each in pictures if each.kind == "scene"]
    assert shown == sorted(path.stem for path in (ROOT / "scenes").glob("*.toml"))
    files = [file for each in pictures for file in each.files.values()]
    assert len(files) == len(set(files)) and len({each.name for each in pictures}) == len(pictures)
    assert all(each.scene.is_file() and (each.kind == "techniques" or each.text) for each in pictures)
    assert {name for names, _ in together(ROOT / "gallery" / "pictures.toml") for name in names} <= set(shown)


def test_windows_lie_in_their_pictures():
    windows = [*details(ROOT / "gallery" / "pictures.toml").values()]
    pictures = all_pictures(ROOT / "gallery" / "pictures.toml", ROOT / "scenes")
    windows += [each.settings["window"] for each in pictures if each.kind == "zoom"]
    assert all(0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1 for x0, x1, y0, y1 in windows)


def test_the_page_shows_every_picture_and_asks_for_nothing_else():
    folder = ROOT / "gallery"
    page = (folder / "index.html").read_text(encoding="utf-8")
    asked = {*re.findall(r'(?:src|href)="([^"#]+)"', page), *re.findall(r"url\('([^']*)'\)", page)}
    files = {file for record in Manifest(folder).records.values() for file in record["files"]}
    assert asked - {"data:,"} == files
    assert all((folder / file).read_bytes().startswith(b"\x89PNG") for file in files)
    assert "<script" not in page and "http" not in page


def test_opening_comment(gallery):
    assert opening_comment(gallery.scenes / "room.toml") == "A room. With a floor."
