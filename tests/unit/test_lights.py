"""Emitters without a shape, from the file to their records: numbers, images, media, warnings."""

import math

import numpy as np
import OpenImageIO as oiio
import pytest

from artist_py.errors import SceneError
from artist_py.scene import tables
from artist_py.scene.compile import compile_scene
from artist_py.scene.describe import describe
from artist_py.scene.reader import read_scene, read_scene_text, scene_hash, settings

CAMERA = """
[camera]
type = "pinhole"
position = [0, -4, 0]
look_at = [0, 0, 0]
[materials.white]
type = "diffuse"
[materials.glass]
type = "dielectric"
[[shapes]]
name = "floor"
type = "rectangle"
corner = [-2, -2, -1]
edges = [[4, 0, 0], [0, 4, 0]]
material = "white"
"""
BALL = """
[[shapes]]
type = "sphere"
center = [0, 0, 0]
radius = {radius}
material = "glass"
"""
POINT = """
[[emitters]]
type = "point"
position = [0, 0, 0.1]
spectrum = 1
"""


def compiled(text, overrides=()):
    return compile_scene(read_scene_text(CAMERA + text, overrides=overrides))


def write_image(path, pixels, kind="float"):
    height, width, channels = pixels.shape
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), oiio.ImageSpec(width, height, channels, kind))
    assert output.write_image(np.ascontiguousarray(pixels, np.float32))
    output.close()
    return path


def environment(path):
    return f'[[emitters]]\ntype = "environment"\nimage = "{path}"\n'


def message(text):
    with pytest.raises(SceneError) as caught:
        compiled(text)
    return str(caught.value)


class TestRecords:
    """What kernels read."""

    def test_what_rays_can_hit_comes_last(self):
        sun = '[[emitters]]\ntype = "directional"\ndirection = [0, 0, -1]\nspectrum = 1\nangle = 1\n'
        emitters = compiled(sun + POINT).scene.emitters
        assert emitters.records.array["kind"].tolist() == [tables.POINT_EMITTER, tables.SUN_EMITTER]
        assert emitters.background == 1

    def test_points_are_placed_in_render_space(self):
        scene = compiled(POINT)
        record = scene.scene.emitters.records.array[0]
        assert np.allclose(record["origin"], scene.space.scale * (np.array([0, 0, 0.1]) - scene.space.centre))
        assert record["scale"] == scene.space.scale**2

    def test_names_and_overrides(self):
        graph = read_scene_text(CAMERA + POINT + 'name = "lamp"\n', overrides={"emitters.lamp.intensity": 7})
        assert graph.emitters[0].intensity == 7

    def test_an_included_file_adds_emitters(self, tmp_path):
        (tmp_path / "lamp.toml").write_text(POINT, encoding="utf-8")
        (tmp_path / "scene.toml").write_text('include = ["lamp.toml"]\n' + CAMERA + POINT, encoding="utf-8")
        assert len(read_scene(tmp_path / "scene.toml").emitters) == 2

    def test_emitters_count_for_the_hash_and_images_by_their_bytes(self, tmp_path):
        path = write_image(tmp_path / "sky.exr", np.ones((4, 8, 3)))
        text = CAMERA + environment(path)
        before = scene_hash(read_scene_text(text))
        write_image(path, np.full((4, 8, 3), 2.0))
        assert before != scene_hash(read_scene_text(text)) != scene_hash(read_scene_text(CAMERA + POINT))
        assert settings(read_scene_text(text))

    def test_they_are_described(self):
        rows = dict(describe(compiled(POINT), {})["Lights"])
        assert rows["points"] == "1"


class TestImages:
    """Images that are no environments."""

    def test_missing(self):
        assert message(environment("no_such_sky.exr")).endswith("no_such_sky.exr: there is no such file")

    def test_format(self):
        text = message(environment("sky.png"))
        assert "emitters.0.image: " in text
        assert text.endswith("sky.png: expected an EXR, HDR or PFM image, since others are not linear")

    def test_damaged(self, tmp_path):
        (tmp_path / "sky.exr").write_bytes(b"no image")
        assert "cannot be read as an image" in message(environment(tmp_path / "sky.exr"))

    def test_channels(self, tmp_path):
        path = write_image(tmp_path / "sky.exr", np.ones((2, 4, 2)))
        assert "expected channels R, G and B, found " in message(environment(path))

    def test_not_finite(self, tmp_path):
        pixels = np.ones((2, 4, 3))
        pixels[1, 2, 0] = np.nan
        path = write_image(tmp_path / "sky.exr", pixels)
        assert message(environment(path)).endswith("texel (2, 1) is not finite, and 0 others")

    def test_negative_texels_are_black_and_said_to_be(self, tmp_path):
        pixels = np.ones((2, 4, 3))
        pixels[0, 0] = -1.0
        scene = compiled(environment(write_image(tmp_path / "sky.exr", pixels)))
        assert any("1 texels are negative" in text for text in scene.warnings)
        assert scene.scene.emitters.images.texels.array.min() == 0.0

    def test_one_channel_is_grey(self, tmp_path):
        scene = compiled(environment(write_image(tmp_path / "sky.exr", np.full((2, 4, 1), 3.0))))
        assert (scene.scene.emitters.images.texels.array == 3.0).all()

    def test_black_images_emit_nothing(self, tmp_path):
        scene = compiled(environment(write_image(tmp_path / "sky.exr", np.zeros((2, 4, 3)))))
        assert scene.scene.emitters is None

    def test_stretched(self):
        text = environment("sky.exr") + "transform = [{ scale = 2 }]\n"
        expected = "expected rotations only, since an environment has neither a place nor a size"
        assert message(text).endswith(f"emitters.0.transform: {expected}")

    def test_no_factor_gives_power_to_the_dark(self):
        text = POINT.replace("spectrum = 1", "spectrum = 0\npower = 5")
        assert message(text).endswith(
            "emitters.0.power: the spectrum has no power, and no factor can give it one"
        )


class TestMedia:
    """The dielectrics that emitters stand in."""

    def test_a_point_in_nested_glass(self):
        scene = compiled(BALL.format(radius=0.5) + BALL.format(radius=0.3) + POINT).scene
        assert scene.needs.media
        assert scene.emitters.records.array["media"].tolist() == [0x0101]

    def test_a_point_outside(self):
        text = BALL.format(radius=0.05) + BALL.format(radius=0.03) + POINT
        assert compiled(text).scene.emitters.records.array["media"].tolist() == [0]

    def test_a_shape_in_glass(self):
        lamp = '[[shapes]]\ntype = "box"\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]\nemission = 1\n'
        scene = compiled(BALL.format(radius=0.5) + BALL.format(radius=0.4) + lamp).scene
        assert scene.emitters.records.array["media"].tolist() == [0x0101] * 6

    def test_light_leaves_nested_glass(self):
        """An index of refraction of 1 everywhere: light must arrive as if nothing were there."""
        import artist_py

        view = {"camera.position": [0, -3, 0.5], "camera.look_at": [0, -0.5, -1], "film.resolution": [8, 8]}
        view |= {"camera.field_of_view": 10}  # past the balls
        view |= {
            "render.wavelength_range": [550, 551],
            "materials.glass.ior": 1.0,
            "render.max_path_length": 8,
        }
        view |= {"render.integrator": "lt", "render.sampler": "independent"}
        balls = BALL.format(radius=0.5) + BALL.format(radius=0.3)
        inside = artist_py.render(compiled(balls + POINT, view), iterations=256).film.rgb[..., 1]
        outside = artist_py.render(compiled(POINT, view), iterations=256).film.rgb[..., 1]
        assert inside.mean() == pytest.approx(outside.mean(), rel=0.01)


class TestWarnings:
    """What an integrator cannot find is said."""

    @pytest.mark.parametrize(
        ("integrator", "count"), [("pt", 1), ("lt", 1), ("bpt", 1), ("vcm", 0), ("ppm", 0)]
    )
    def test_points_and_glass(self, integrator, count):
        scene = compiled(BALL.format(radius=0.05) + POINT, {"render.integrator": integrator})
        found = [text for text in scene.warnings if "cannot find light of point emitters" in text]
        assert len(found) == count

    def test_what_is_said(self):
        text = (
            '"pt" cannot find light of point emitters by way of smooth glass, metal or mirrors (caustics); '
            '"bpt" finds those seen directly, "vcm", "ppm" and "bpm" all'
        )
        assert compiled(BALL.format(radius=0.05) + POINT).warnings == [text]

    def test_no_glass_or_no_points(self):
        assert compiled(POINT).warnings == []
        sky = '[[emitters]]\ntype = "environment"\nspectrum = 1\n'
        assert compiled(BALL.format(radius=0.05) + sky).warnings == []
        assert compiled(BALL.format(radius=0.05) + POINT + "intensity = 0\n" + sky).warnings == []


def test_a_mesh_of_ten_thousand_triangles_is_one_light_among_others(tmp_path):
    """Chosen in proportion to power, by one number, whatever their count."""
    n = 71
    grid = np.stack(np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1), indexing="ij"), 2)
    corners = np.column_stack([grid.reshape(-1, 2), np.full((n + 1) ** 2, 2.0)])
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (
        index[:-1, :-1].ravel(),
        index[1:, :-1].ravel(),
        index[1:, 1:].ravel(),
        index[:-1, 1:].ravel(),
    )
    faces = np.concatenate([np.column_stack([a, c, b]), np.column_stack([a, d, c])])
    lines = ["ply", "format ascii 1.0", f"element vertex {len(corners)}"]
    lines += [f"property float {axis}" for axis in "xyz"] + [f"element face {len(faces)}"]
    lines += ["property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(repr, row)) for row in corners.tolist()] + [
        f"3 {i} {j} {k}" for i, j, k in faces.tolist()
    ]
    (tmp_path / "panel.ply").write_text("\n".join(lines) + "\n", encoding="ascii")
    mesh = f'[[shapes]]\ntype = "mesh"\nfile = "{tmp_path / "panel.ply"}"\nemission = 0.5\n'
    sky = '[[emitters]]\ntype = "environment"\nspectrum = 0.01\n'
    scene = compiled(mesh + POINT + sky)
    chances = scene.scene.emitters.records.array["pdf_select"]
    assert len(chances) == 2 * n * n + 2 > 10_000
    scale = scene.space.scale
    disk = math.pi * (scene.space.radius * scale) ** 2
    powers = np.array([0.5 * math.pi * 4 * scale**2, 4 * math.pi * scale**2, 0.01 * 4 * math.pi * disk])
    found = np.array([chances[:-2].sum(), *chances[-2:]])
    assert np.allclose(found, powers / powers.sum(), rtol=1e-4)
