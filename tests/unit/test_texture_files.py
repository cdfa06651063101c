"""Textures of scene files: what they may say, what image files hold, and the exact words where something is wrong."""

import os
from pathlib import Path

import numpy as np
import pytest
from texture_files import grey, write_image

from artist_py.errors import SceneError
from artist_py.scene import textures
from artist_py.scene.compile import compile_scene
from artist_py.scene.describe import describe
from artist_py.scene.reader import read_scene_text, scene_hash
from artist_py.scene.spectrum_types import Constant, Rgb
from artist_py.scene.texture_types import Checkerboard, Image
from artist_py.scene.textures import load_image

HALF_STEP = 0.5 / 65535
RGB = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [128, 64, 32]]], np.uint8)
SPECTRUM_KEYS = 'expected "rgb", "illuminant", "blackbody", "gaussian", "lines", "wavelengths" or "file"'
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
SCENE = """[camera]
type = "pinhole"
position = [0, 0, 4]
look_at = [0, 0, 0]
up = [0, 1, 0]
[materials.paint]
type = "diffuse"
reflectance = {reflectance}
[[shapes]]
type = "rectangle"
corner = [0, 0, 0]
edges = [[1, 0, 0], [0, 1, 0]]
material = "paint"
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def read(reflectance, more=""):
    """The scene graph of a rectangle with this reflectance, TOML."""
    return read_scene_text(SCENE.replace("{reflectance}", reflectance) + more)


def compiled(reflectance='{ image = "a.png" }', more=""):
    return compile_scene(read(reflectance, more))


def message_of(reflectance='{ image = "a.png" }', more=""):
    """The words of what is wrong with the scene."""
    with pytest.raises(SceneError) as caught:
        compiled(reflectance, more)
    return str(caught.value)


def roots(path, scale=1.0):
    """Square roots of the reflectances in a file (h, w, channels)."""
    return load_image(Image(path=str(path), scale=scale)).values / 65535.0


def srgb_decoded(encoded):
    """IEC 61966-2-1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


class TestReading:
    """What a scene file may say."""

    def test_images(self):
        text = '{ image = "a.png", scale = 0.5, repeat = [2, 3.5], interpolation = "nearest" }'
        image = read(text).materials["paint"].reflectance
        assert image == Image(path="a.png", scale=0.5, repeat=(2.0, 3.5), interpolation="nearest")
        assert read('{ image = "a.png" }').materials["paint"].reflectance == Image(
            path="a.png", scale=1.0, repeat=(1.0, 1.0), interpolation="bilinear"
        )

    def test_checkerboards(self):
        board = read("{ checkerboard = [0.25, { rgb = [1, 0, 0.5] }] }").materials["paint"].reflectance
        assert board == Checkerboard(colors=(Constant(0.25), Rgb((1.0, 0.0, 0.5))), repeat=(8.0, 8.0))

    @pytest.mark.parametrize("kind", ["diffuse", "oren-nayar", "mirror", 'conductor"\nmetal = "Au'])
    def test_every_material_with_a_reflectance_takes_them(self, kind):
        write_image("a.png", RGB)
        text = SCENE.replace("diffuse", kind).replace("{reflectance}", '{ image = "a.png" }')
        scene = compile_scene(read_scene_text(text))
        assert scene.scene.needs.textures
        assert scene.scene.materials.array["texture"].tolist() == [-1, 0]

    def test_paths_are_relative_to_the_scene(self, tmp_path):
        (tmp_path / "lib").mkdir()
        write_image("lib/a.png", RGB)
        graph = read_scene_text(SCENE.replace("{reflectance}", '{ image = "a.png" }'), file="lib/scene.toml")
        assert compile_scene(graph).texture_images[0].path == str(Path("lib/a.png"))

    @pytest.mark.parametrize(
        ("reflectance", "message"),
        [
            ('{ imge = "a.png" }', 'reflectance.imge: unknown key, did you mean "image"?'),
            ('{ image = "a.png", scle = 2 }', 'reflectance.scle: unknown key, did you mean "scale"?'),
            ("{ image = 3 }", "reflectance.image: expected the path of a file, found 3"),
            (
                '{ image = "a.png", repeat = 2 }',
                "reflectance.repeat: expected [along u, along v], found 2",
            ),
            (
                '{ image = "a.png", repeat = [2, 0] }',
                "reflectance.repeat.1: expected 0 < repeat <= 65536, found 0",
            ),
            ('{ image = "a.png", scale = -1 }', "reflectance.scale: expected scale >= 0, found -1"),
            (
                '{ image = "a.png", interpolation = "cubic" }',
                'reflectance.interpolation: expected "bilinear" or "nearest", found "cubic"',
            ),
            (
                '{ image = "a.png", rgb = [1, 1, 1] }',
                'reflectance: expected only one of "rgb" or "image"',
            ),
            (
                "{ checkerboard = 0.5 }",
                "reflectance.checkerboard: expected two spectra [first, second], found 0.5",
            ),
            (
                "{ checkerboard = [0.5, 1.5] }",
                "reflectance.checkerboard.1: expected 0 <= checkerboard <= 1, found 1.5",
            ),
            (
                '{ checkerboard = [0.5, { image = "a.png" }] }',
                "reflectance.checkerboard.1.image: unknown key, " + SPECTRUM_KEYS,
            ),
        ],
    )
    def test_what_is_refused(self, reflectance, message):
        assert message_of(reflectance) == f"scene.toml:8: materials.paint.{message}"

    def test_values_of_files_in_checkerboards_are_checked(self):
        Path("a.csv").write_text("400 0.5\n700 1.5\n", encoding="utf-8")
        assert message_of('{ checkerboard = [0.5, { file = "a.csv" }] }') == (
            "scene.toml:8: materials.paint.reflectance.checkerboard.1: "
            "expected a reflectance from 0 to 1, found 1.5 at 700 nm"
        )

    def test_emission_takes_no_texture(self):
        more = 'emission = { image = "a.png" }\n'
        assert (
            message_of("0.5", more) == f"scene.toml:14: shapes.0.emission.image: unknown key, {SPECTRUM_KEYS}"
        )


class TestImages:
    """From files to reflectances."""

    @pytest.mark.parametrize("name", ["a.png", "a.tif", "a.bmp"])
    def test_eight_bits_are_decoded(self, name):
        codes = np.arange(256).reshape(16, 16)
        pixels = np.dstack([codes] * 3) if name == "a.bmp" else grey(codes)
        found = roots(write_image(name, pixels.astype(np.uint8)))
        expected = np.sqrt(srgb_decoded(codes / 255))
        np.testing.assert_allclose(found, np.broadcast_to(expected[..., None], found.shape), atol=HALF_STEP)
        assert found[0, 0, 0] == 0.0 and found[15, 15, 0] == 1.0

    def test_sixteen_bits_are_decoded(self):
        codes = np.arange(0, 65536, 257).reshape(16, 16) + 99
        codes = np.minimum(codes, 65535)
        found = roots(write_image("a.png", grey(codes, np.uint16), "uint16"))
        np.testing.assert_allclose(found[..., 0], np.sqrt(srgb_decoded(codes / 65535)), atol=HALF_STEP)

    def test_photographs_are_decoded(self):
        """JPEG is lossy: a plain colour comes back within one step of 255."""
        write_image("a.jpg", np.full((16, 16, 3), 128, np.uint8))
        assert np.abs(roots("a.jpg") ** 2 - srgb_decoded(128 / 255)).max() < srgb_decoded(129 / 255) - 0.2158

    @pytest.mark.parametrize(("name", "kind"), [("a.exr", "float"), ("a.exr", "half"), ("a.hdr", "float")])
    def test_floats_are_linear(self, name, kind):
        values = np.array([[[0.0, 0.25, 1.0], [0.5, 0.75, 0.125]]], np.float32)
        found = roots(write_image(name, values, kind)) ** 2
        np.testing.assert_allclose(found, values, atol=5e-5 if name == "a.exr" else 4e-3)

    def test_integers_that_say_so_are_linear(self):
        write_image("a.png", grey([[51, 204]]), oiio__ColorSpace="lin_rec709_scene")
        np.testing.assert_allclose(roots("a.png")[0, :, 0] ** 2, [0.2, 0.8], atol=2 * HALF_STEP)

    def test_rows_and_channels_keep_their_order(self):
        found = roots(write_image("a.png", RGB))
        assert found[0, 0].tolist() == [1, 0, 0]
        assert found[0, 1].tolist() == [0, 1, 0]
        assert found[1, 0].tolist() == [0, 0, 1]

    def test_scale_multiplies_linear_values(self):
        write_image("a.exr", np.array([[[4.0, 2.0, 0.0]]], np.float32), "float")
        np.testing.assert_allclose(roots("a.exr", 0.25)[0, 0] ** 2, [1, 0.5, 0], atol=2 * HALF_STEP)
        write_image("a.png", grey([[128]]))
        expected = 0.5 * srgb_decoded(128 / 255)
        np.testing.assert_allclose(roots("a.png", 0.5)[0, 0] ** 2, expected, atol=HALF_STEP)

    def test_alpha_is_left_out_and_told(self):
        """Colours are not multiplied with it: a clear red is red."""
        pixels = np.array([[[200, 10, 0, 0], [200, 10, 0, 255]]], np.uint8)
        write_image("a.png", pixels, oiio__UnassociatedAlpha=1)
        scene = compiled()
        assert 'a.png: ignored, it has more than colours: "A"' in scene.warnings
        texels = scene.scene.textures.texels.array.reshape(2, 3)
        np.testing.assert_array_equal(texels[0], texels[1])
        np.testing.assert_allclose((texels[0] / 65535) ** 2, srgb_decoded(pixels[0, 0, :3] / 255), atol=2e-5)

    def test_layers_are_left_out_and_told(self):
        values = np.array([[[0.1, 0.9, 0.2, 0.3, 0.4]]], np.float32)
        write_image("a.exr", values, "float", names=["B", "depth.Z", "G", "R", "A"])
        found = load_image(Image(path="a.exr"))
        np.testing.assert_allclose((found.values[0, 0] / 65535.0) ** 2, [0.3, 0.2, 0.1], atol=5e-5)
        assert len(found.warnings) == 1 and '"depth.Z"' in found.warnings[0]

    def test_pictures_that_are_to_be_turned_are_told(self):
        write_image("a.jpg", np.full((8, 8, 3), 100, np.uint8), Orientation=6)
        expected = "a.jpg: taken as it is stored, although it says that it is to be turned"
        assert load_image(Image(path="a.jpg")).warnings == (expected,)


class TestBroken:
    """Every fault has a file, a line, a key and words."""

    def assert_message(self, words, reflectance='{ image = "a.png" }', path="a.png"):
        expected = f"scene.toml:8: materials.paint.reflectance.image: {path}: {words}"
        assert message_of(reflectance) == expected

    def test_missing(self):
        self.assert_message("no such file")

    def test_a_folder(self):
        os.mkdir("a.png")
        self.assert_message("expected a file, found a directory")

    def test_a_file_in_a_file(self):
        Path("x").touch()
        self.assert_message("not a directory", '{ image = "x/a.png" }', "x/a.png")

    def test_empty(self):
        Path("a.png").touch()
        self.assert_message("the file is empty")

    def test_nobody_may_read_it(self):
        write_image("a.png", RGB)
        os.chmod("a.png", 0)
        if os.access("a.png", os.R_OK):
            pytest.skip("this user may read everything")
        self.assert_message("permission denied")

    @pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.exr", "a.hdr", "a.txt", "a"])
    def test_not_an_image(self, name):
        Path(name).write_text("a picture says more than these words\n" * 30, encoding="utf-8")
        words = "expected an image, found a file of another kind or a damaged one"
        self.assert_message(words, f'{{ image = "{name}" }}', name)

    @pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.exr", "a.hdr", "a.tif"])
    def test_truncated(self, name):
        pixels = np.random.default_rng(1).random((64, 48, 3), np.float32)
        if name in {"a.exr", "a.hdr"}:
            write_image(name, pixels, "float")
        else:
            write_image(name, (255 * pixels).astype(np.uint8))
        data = Path(name).read_bytes()
        Path(name).write_bytes(data[: len(data) // 2])
        words = "expected a whole image, found a damaged or an incomplete one"
        self.assert_message(words, f'{{ image = "{name}" }}', name)

    def test_damaged(self):
        write_image("a.png", np.random.default_rng(1).integers(0, 255, (64, 48, 3)).astype(np.uint8))
        data = bytearray(Path("a.png").read_bytes())
        data[2000:2100] = bytes(100)
        Path("a.png").write_bytes(data)
        self.assert_message("expected a whole image, found a damaged or an incomplete one")

    def test_without_pixels(self):
        Path("a.pgm").write_bytes(b"P5\n0 0\n255\n")
        words = "expected an image, found a file of another kind or a damaged one"
        self.assert_message(words, '{ image = "a.pgm" }', "a.pgm")

    def test_too_large(self, monkeypatch):
        write_image("a.png", np.zeros((30, 40, 3), np.uint8))
        monkeypatch.setattr(textures, "MAX_PIXELS", 40 * 30)
        assert compiled().texture_images[0].width == 40
        monkeypatch.setattr(textures, "MAX_PIXELS", 40 * 30 - 1)
        self.assert_message("expected at most 1199 pixels, found 40 x 30")

    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -0.25, 1.5])
    def test_no_reflectance(self, value):
        pixels = np.full((3, 4, 3), 0.5, np.float32)
        pixels[2, 1, 1] = value
        write_image("a.exr", pixels, "float")
        words = f"expected reflectances from 0 to 1, found {value:g} in row 2, column 1, both from 0"
        self.assert_message(words, '{ image = "a.exr" }', "a.exr")

    def test_scaled_beyond_one(self):
        write_image("a.png", grey([[0, 0, 10], [10, 255, 10]]))
        words = "expected reflectances from 0 to 1, found 1.25 in row 1, column 1, both from 0"
        self.assert_message(words, '{ image = "a.png", scale = 1.25 }')

    def test_other_channels(self):
        write_image("a.exr", np.full((2, 2, 2), 0.5, np.float32), "float", names=["U", "V"])
        words = 'expected an image in grey or RGB, found the channels "U", "V"'
        self.assert_message(words, '{ image = "a.exr" }', "a.exr")

    def test_all_problems_are_told_at_once(self):
        Path("b.png").touch()
        more = '[materials.b]\ntype = "mirror"\nreflectance = { image = "b.png" }\n[[shapes]]\n'
        more += 'type = "sphere"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "b"\n'
        assert message_of(more=more).splitlines() == [
            "scene.toml:8: materials.paint.reflectance.image: a.png: no such file",
            "scene.toml:16: materials.b.reflectance.image: b.png: the file is empty",
        ]

    def test_materials_that_no_shape_has_are_not_loaded(self):
        more = '[materials.b]\ntype = "mirror"\nreflectance = { image = "b.png" }\n'
        assert compiled("0.5", more).scene.textures is None


class TestMeshes:
    """A textured mesh must have texture coordinates."""

    MESH = '[[shapes]]\ntype = "mesh"\nname = "kite"\nfile = "a.obj"\nmaterial = "paint"\n'

    def test_without_texture_coordinates(self):
        write_image("a.png", RGB)
        Path("a.obj").write_text(OBJ + "f 1 2 3\n", encoding="utf-8")
        assert message_of(more=self.MESH) == (
            "scene.toml:17: shapes.1.file: a.obj: expected texture coordinates all over the mesh, "
            'since the material "paint" has a texture'
        )

    def test_some_objects_without_texture_coordinates(self):
        write_image("a.png", RGB)
        objects = "o a\nvt 0 0\nf 1/1 2/1 3/1\no b\nf 3 2 1\n"
        Path("a.obj").write_text(OBJ + objects, encoding="utf-8")
        assert "expected texture coordinates all over the mesh" in message_of(more=self.MESH)

    def test_told_once_for_all_instances(self):
        write_image("a.png", RGB)
        Path("a.obj").write_text(OBJ + "f 1 2 3\n", encoding="utf-8")
        more = self.MESH.replace("[[shapes]]", "[[objects.o.shapes]]").replace('"paint"', '"plain"')
        more += '[materials.plain]\ntype = "diffuse"\n[[instances]]\nobject = "o"\n'
        assert compiled(more=more).scene.textures is not None
        for i in range(3):
            more += f'[[instances]]\nobject = "o"\nmaterial = "paint"\ntransform = [{{ scale = {i + 2} }}]\n'
        assert message_of(more=more) == (
            "scene.toml:17: objects.o.shapes.0.file: a.obj: expected texture coordinates all over the mesh, "
            'since the material "paint" has a texture'
        )

    def test_with_texture_coordinates(self):
        write_image("a.png", RGB)
        Path("a.obj").write_text(OBJ + "vt 0 0\nvt 2 0\nvt 0 -1\nf 1/1 2/2 3/3\n", encoding="utf-8")
        vertices = compiled(more=self.MESH).scene.geometry.vertices.array[4:]
        found = {tuple(v) for v in vertices["uv"].tolist()}
        assert found == {(0, 0), (2, 0), (0, -1)}


class TestScene:
    """Tables, words and identity of a scene with textures."""

    def test_images_are_loaded_once(self):
        write_image("a.png", RGB)
        more = "".join(
            f'[materials.m{i}]\ntype = "diffuse"\nreflectance = {{ image = "a.png", {key} }}\n'
            f'[[shapes]]\ntype = "sphere"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "m{i}"\n'
            for i, key in enumerate(("repeat = [2, 2]", 'interpolation = "nearest"', "scale = 0.5"))
        )
        scene = compiled(more=more)
        records, texels = scene.scene.textures.records.array, scene.scene.textures.texels
        assert records["offset"].tolist() == [0, 0, 0, 12]
        assert len(texels) == 24 and texels.dtype == np.uint16
        assert records["is_nearest"].tolist() == [0, 0, 1, 0]
        assert scene.scene.materials.array["texture"].tolist() == [-1, 0, 1, 2, 3]
        assert [image.nbytes for image in scene.texture_images] == [24, 24]

    def test_checkerboards_have_no_texels(self):
        scene = compiled("{ checkerboard = [0.2, 0.8] }")
        assert scene.scene.textures.texels is None
        rows = scene.scene.textures.records.array["spectra"][0]
        np.testing.assert_allclose(scene.spectra[rows[:2], 0], [0.2, 0.8], rtol=1e-6)

    def test_scenes_without_textures_have_no_table(self):
        scene = compiled("0.5")
        assert scene.scene.textures is None
        assert scene.scene.needs.textures is None

    def test_they_are_described(self):
        write_image("a.png", np.zeros((300, 200, 3), np.uint8))
        more = '[materials.b]\ntype = "mirror"\nreflectance = { checkerboard = [0, 1] }\n[[shapes]]\n'
        more += 'type = "sphere"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "b"\n'
        sections = describe(compiled(more=more), {})
        assert sections["Textures"] == [("a.png", "200 x 300, RGB, 351.6 KiB"), ("checkerboards", "1")]
        assert "textures" in dict(sections["Needed"])
        assert "Textures" not in describe(compiled("0.5"), {})

    def test_the_hash_is_of_the_files_bytes(self):
        write_image("a.png", RGB)
        first = scene_hash(read('{ image = "a.png" }'))
        write_image("b.png", RGB)
        assert scene_hash(read('{ image = "b.png" }')) == first
        assert scene_hash(read('{ image = "b.png", repeat = [2, 1] }')) != first
        write_image("a.png", RGB[::-1])
        assert scene_hash(read('{ image = "a.png" }')) != first
