"""Textured surfaces in light of known radiance: which point of a shape has which point of the texture, and how bright.

The pictures are told by the albedo at the first hit, which has no noise. Where light is compared, a correct program
fails by chance with probability 1e-4 each; there are 17 comparisons of that kind.
"""

import math
from typing import NamedTuple

import numpy as np
import OpenImageIO as oiio
import pytest
from rendering import (
    GREEN,
    Image,
    assert_mean,
    assert_sample_mean,
    assert_uniform,
    diffuse,
    look,
    radiance,
    render,
    scene,
    shape,
)
from scipy import ndimage

from artist_py.film.color import decode_srgb

SKY = shape("sphere", center=[0, 0, 0], radius=30, reverse=True, emission=1)
CODES = np.array([[230, 180], [130, 80]], np.uint8)  # the picture: four plain quadrants
QUADRANTS = decode_srgb(CODES / 255)
FULL_VIEW = math.degrees(2 * math.atan(1 / 4))  # of a square from -1 to 1, seen from 4 away
SQUARE = {"corner": [-1, -1, 0], "edges": [[2, 0, 0], [0, 2, 0]]}
FRONT = look([0, 0, 4], [0, 0, 0], FULL_VIEW)
OBJ = """v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the picture of four quadrants, one of noise, and a square mesh with and without normals."""
    path = tmp_path_factory.mktemp("textures")
    noise = np.random.default_rng(1).integers(0, 256, (8, 8), dtype=np.uint8)
    for name, pixels in (("quadrants.png", CODES), ("noise.png", noise)):
        output = oiio.ImageOutput.create(str(path / name))
        output.open(str(path / name), oiio.ImageSpec(*pixels.shape[::-1], 1, "uint8"))
        output.write_image(np.ascontiguousarray(pixels[..., None]))
        output.close()
    (path / "flat.obj").write_text(OBJ, encoding="utf-8")
    smooth = OBJ.replace("/1 ", "/1/1 ").replace("/2 ", "/2/1 ").replace("/3 ", "/3/1 ")
    (path / "smooth.obj").write_text(
        smooth.replace("/3\n", "/3/1\n").replace("/4\n", "/4/1\n"), encoding="utf-8"
    )
    return path


def picture(folder, name="quadrants.png", **keys):
    """A diffuse material's table."""
    return diffuse({"image": str(folder / name), "interpolation": "nearest", **keys})


def unseen(folder):
    """One of each kind, far behind the camera's back, so that all these scenes share their kernels."""
    files = [shape("mesh", "picture", file=str(folder / f"{name}.obj")) for name in ("flat", "smooth")]
    shapes = [
        *files,
        shape("rectangle", "board", **SQUARE),
        shape("sphere", "board", center=[0, 0, 0], radius=1),
        shape("sphere", "plain", center=[0, 0, 0], radius=1),
        shape("sphere", "mirror", center=[0, 0, 0], radius=1),
    ]
    return [
        {**each, "transform": [{"scale": 0.1}, {"translate": [20, 0, 3 * i]}]}
        for i, each in enumerate(shapes)
    ]


def scene_of(
    folder, shapes=(), camera=FRONT, size=16, materials=(), objects=(), instances=(), sky=SKY, **render
):
    far = {"far": [shape("rectangle", "plain", corner=[20, 0, -9], edges=[[0.1, 0, 0], [0, 0.1, 0]])]}
    return scene(
        [sky, *shapes, *unseen(folder)],
        materials={
            "picture": picture(folder),
            "board": diffuse({"checkerboard": [0.2, 0.8]}),
            "plain": diffuse(0.5),
            "mirror": {"type": "mirror"},
            **dict(materials),
        },
        objects={**far, **dict(objects)},
        instances=[{"object": "far"}, *instances],
        camera=camera,
        film={"resolution": [size, size]},
        render={"max_path_length": 2, **render},
    )


def first_hits(compiled):
    """(albedo (h, w), position (h, w, 3))."""
    aovs = render(compiled, 1, aovs=("albedo", "position")).film.aovs
    return aovs["albedo"][..., GREEN], aovs["position"]


class TestOrientation:
    """The top row of the picture is at v = 1, the left column at u = 0."""

    def assert_upright(self, compiled):
        albedo, _ = first_hits(compiled)
        np.testing.assert_allclose(albedo, np.kron(QUADRANTS, np.ones((8, 8))), rtol=1e-4)

    def test_rectangles(self, folder):
        self.assert_upright(scene_of(folder, [shape("rectangle", "picture", **SQUARE)]))

    @pytest.mark.parametrize("name", ["flat", "smooth"])
    def test_meshes(self, folder, name):
        self.assert_upright(scene_of(folder, [shape("mesh", "picture", file=str(folder / f"{name}.obj"))]))

    def test_instances(self, folder):
        moves = [{"scale": 0.1}, {"rotate": [0, 0, 1, 90]}, {"translate": [-3, 2, 1]}]
        back = [{"translate": [3, -2, -1]}, {"rotate": [0, 0, 1, -90]}, {"scale": 10}]
        objects = {"plate": [shape("rectangle", "plain", **SQUARE, transform=moves)]}
        instances = [{"object": "plate", "transform": back, "material": "picture"}]
        self.assert_upright(scene_of(folder, objects=objects, instances=instances))

    @pytest.mark.parametrize("axis", range(3))
    @pytest.mark.parametrize("sign", [1, -1])
    def test_boxes_from_all_sides(self, folder, axis, sign):
        eye = 5.0 * sign * np.eye(3)[axis]
        up = [0, 0, 1] if axis < 2 else [0, sign, 0]
        box = shape("box", "picture", min=[-1, -1, -1], max=[1, 1, 1])
        camera = {**look(eye.tolist(), [0, 0, 0], FULL_VIEW), "up": up}
        self.assert_upright(scene_of(folder, [box], camera))

    def test_the_back_is_mirrored(self, folder):
        compiled = scene_of(
            folder, [shape("rectangle", "picture", **SQUARE)], look([0, 0, -4], [0, 0, 0], FULL_VIEW)
        )
        albedo, _ = first_hits(compiled)
        np.testing.assert_allclose(albedo, np.kron(QUADRANTS[:, ::-1], np.ones((8, 8))), rtol=1e-4)


def turn(x, y):
    """Angle from x over y in full turns, in [0, 1)."""
    return np.arctan2(y, x) / (2 * np.pi) % 1.0


class Round(NamedTuple):
    """A shape without corners, and its (u, v) at points (n, 3)."""

    shape: dict
    uv: object


ROUND = {
    "sphere": Round(
        shape("sphere", center=[0, 0, 0], radius=1),
        lambda p: (turn(p[:, 0], p[:, 1]), np.arccos(-p[:, 2] / np.linalg.norm(p, axis=1)) / np.pi),
    ),
    "disk": Round(
        shape("disk", center=[0, 0, 0], normal=[0, 0, 1], radius=1),
        lambda p: (turn(-p[:, 1], p[:, 0]), np.hypot(p[:, 0], p[:, 1])),
    ),
    "cylinder": Round(
        shape("cylinder", base=[0, 0, -1], top=[0, 0, 0.7], radius=0.8, caps=False),
        lambda p: (turn(-p[:, 1], p[:, 0]), (p[:, 2] + 1) / 1.7),
    ),
    "cone": Round(
        shape("cone", base=[0, 0, -1], apex=[0, 0, 1], radius=0.9, cap=False),
        lambda p: (turn(-p[:, 1], p[:, 0]), (p[:, 2] + 1) / 2),
    ),
    "grooved sphere": Round(
        shape("grooved-sphere", center=[0, 0, 0], radius=1, depth=0.1, grooves=3),
        lambda p: (turn(-p[:, 1], p[:, 0]), np.arccos(-p[:, 2] / np.linalg.norm(p, axis=1)) / np.pi),
    ),
}


@pytest.mark.parametrize("name", ROUND)
@pytest.mark.parametrize("eye", [[2.5, 1, 2], [-2, 2.5, -1.5], [0.3, -3, 2.5]])
def test_places_on_round_shapes(folder, name, eye):
    compiled = scene_of(
        folder, [{**ROUND[name].shape, "material": "picture"}], look(eye, [0, 0, 0], 36), size=48
    )
    albedo, position = first_hits(compiled)
    # Pixels on an edge of the shape see what lies behind, and those on the border of two quadrants both of them.
    jump = ndimage.maximum_filter(position, (3, 3, 1)) - ndimage.minimum_filter(position, (3, 3, 1))
    is_whole = (jump.max(axis=2) < 0.4) & (np.linalg.norm(position, axis=2) < 2)
    u, v = ROUND[name].uv(position[is_whole])
    is_inside = (np.abs(u % 0.5 - 0.25) < 0.15) & (np.abs(v % 0.5 - 0.25) < 0.15)
    expected = QUADRANTS[(v < 0.5).astype(int), (u >= 0.5).astype(int)]
    assert is_inside.sum() > 100
    np.testing.assert_allclose(albedo[is_whole][is_inside], expected[is_inside], rtol=1e-4)


class TestLight:
    """Radiance of textured surfaces."""

    def test_a_checkerboard_under_a_white_sky_reflects_its_mean(self, folder):
        """Flat, so that every square shows the sky times its own reflectance."""
        compiled = scene_of(folder, [shape("rectangle", "board", **SQUARE)])
        image = radiance(compiled, 256)
        assert_mean(image, 0.5, 2e-3)
        albedo, _ = first_hits(compiled)
        assert set(np.rint(1e4 * albedo).ravel()) == {2000, 8000}
        for value in (0.2, 0.8):
            chosen = np.isclose(albedo, value)
            assert chosen.sum() == 128
            assert_uniform(Image(image.mean[chosen], image.variance[chosen]), value, 2e-3)

    @pytest.mark.parametrize("interpolation", ["bilinear", "nearest"])
    def test_a_picture_under_a_white_sky_reflects_its_mean(self, folder, interpolation):
        """Every texel has the same share of the square, also where its neighbours run over the border."""
        noise = picture(folder, "noise.png", interpolation=interpolation, repeat=[2, 1])
        compiled = scene_of(folder, [shape("rectangle", "noise", **SQUARE)], materials={"noise": noise})
        codes = oiio.ImageBuf(str(folder / "noise.png")).get_pixels("uint8")
        assert_mean(radiance(compiled, 256), decode_srgb(codes / 255).mean(), 2e-3)

    @pytest.mark.parametrize(
        "integrator",
        ["pt", *(pytest.param(name, marks=pytest.mark.slow) for name in ("lt", "bpt", "ppm", "bpm", "vcm"))],
    )
    def test_a_room_with_a_checkerboard_knows_its_mean(self, folder, integrator):
        """In a sphere all points get the same light: from walls that emit 1, E = pi / (1 - 0.5).

        Each row of squares takes turns all around, so that the mean reflectance is 0.5. Merging is as exact as the
        rest, since it takes the reflectance where the eye looks.
        """
        room = shape("sphere", "board", center=[0, 0, 0], radius=2, reverse=True, emission=1)
        settings = {"camera": look([0.5, -0.3, 0.2], [0.3, 1, 0.5], 90), "sky": room, "max_path_length": 60}
        # Pixels share photons: only renders with other seeds are independent.
        scenes = [scene_of(folder, **settings, integrator=integrator, seed=seed) for seed in range(1, 9)]
        means = [radiance(compiled, 32).mean for compiled in scenes]
        albedo, _ = first_hits(scene_of(folder, **settings))
        for value in (0.2, 0.8):
            chosen = np.isclose(albedo, value)
            assert chosen.sum() > 30
            assert_sample_mean([mean[chosen].mean() for mean in means], 1 + value / (1 - 0.5), 2e-2)

    def test_mirrors_show_the_sky_times_the_picture(self, folder):
        """Every path brings the same: there is no noise."""
        glossy = {**picture(folder), "type": "mirror"}
        compiled = scene_of(folder, [shape("rectangle", "glossy", **SQUARE)], materials={"glossy": glossy})
        image = radiance(compiled, 1)
        np.testing.assert_allclose(image.mean, np.kron(QUADRANTS, np.ones((8, 8))), rtol=1e-4)
