"""Images of techniques: with weights they add up to the image, without they all show the same."""

import numpy as np
import pytest
from rendering import compile_tables, diffuse, look, render, scene, shape
from scipy import stats

from artist_py.cli.main import main
from artist_py.film.color import RGB_TO_XYZ
from artist_py.film.reading import read_image
from artist_py.stress.toml import to_toml

ROUNDING = 2e-6  # of float32 sums, relative to the sum of all sizes
CAMERA = {
    **look([0, -3.4, 0], [0, 0, 0]),
    "type": "thin-lens",
    "aperture_radius": 0.6,
    "focus_distance": 3.0,
}
MATERIALS = {
    "white": diffuse(0.7),
    "red": diffuse({"rgb": [0.6, 0.1, 0.1]}),
    "glass": {"type": "dielectric", "ior": 1.5},
}
INSIDE, BEHIND = [0.3, -0.1, -0.5], [0, 3, 0]  # where the glass sphere is: behind the room nothing finds it
METHODS = {
    "pt": {"wavelengths": "independent"},
    "lt": {"wavelengths": "independent"},
    "bpt": {"wavelengths": "independent", "merging": {"light_paths": 1.5}},
    "ppm": {"wavelengths": "shared", "merging": {"radius": 0.04}},
    "bpm": {"wavelengths": "shared", "merging": {"radius": 0.04}},
    "vcm": {"wavelengths": "shared", "merging": {"radius": 0.04}},
}
FAST = {"pt", "vcm"}  # which have all techniques
KINDS = {
    "pt": {"hit", "nee"},
    "lt": {"hit", "lt", "lens"},
    "bpt": {"hit", "nee", "vc", "lt", "lens"},
    "ppm": {"hit", "vm"},
    "bpm": {"hit", "vm"},
    "vcm": {"hit", "nee", "vc", "lt", "lens", "vm"},
}
# One of each kind, all of them off: so that tests with and without share kernels.
UNLIT = [
    {"type": "environment", "spectrum": 0},
    {"type": "directional", "direction": [0.3, 1, -0.5], "spectrum": 0, "angle": 5.0},
    {"type": "point", "position": [-0.5, -0.2, 0.3], "spectrum": 0},
]
FILMS = {
    "all of it": {"resolution": [20, 16], "filter": "mitchell"},
    "cropped at two borders": {"resolution": [20, 16], "crop": [7, 20, 0, 9], "filter": "mitchell"},
    "large": {"resolution": [64, 48], "crop": [22, 64, 0, 30], "filter": "mitchell"},
    "cropped inside": {"resolution": [20, 16], "crop": [3, 15, 4, 13], "filter": "mitchell"},
}


def room_shapes(sphere):
    """A room that is open towards the camera, with a lamp below the ceiling."""
    walls = [([-1, -1, -1], [2, 0, 0], [0, 2, 0]), ([-1, -1, 1], [0, 2, 0], [2, 0, 0])]
    walls += [([-1, 1, -1], [2, 0, 0], [0, 0, 2]), ([-1, -1, -1], [0, 2, 0], [0, 0, 2])]
    shapes = [shape("rectangle", "white", corner=corner, edges=edges) for corner, *edges in walls]
    lamp = {"corner": [-0.4, -0.4, 0.9], "edges": [[0, 0.8, 0], [0.8, 0, 0]], "emission": 5.0}
    return [
        *shapes,
        shape("rectangle", "red", corner=[1, -1, -1], edges=[[0, 0, 2], [0, 2, 0]]),
        shape("rectangle", "white", **lamp),
        shape("sphere", "glass", center=sphere, radius=0.4),
    ]


def room(integrator, film=FILMS["all of it"], sphere=INSIDE, **more):
    """The `CompiledScene` of the room for a method."""
    settings = {"integrator": integrator, "wavelength_range": [380, 780], "max_path_length": 6}
    return scene(
        room_shapes(sphere),
        materials=MATERIALS,
        camera=CAMERA,
        film=film,
        emitters=UNLIT,
        render={**settings, **METHODS[integrator], **more},
    )


def assert_adds_up(weighted, rgb):
    """The sum over the first axis is `rgb`, but for rounding."""
    # Channels are sums of terms of both signs, hence the largest of the three.
    size = np.abs(weighted).sum(axis=0).max(axis=-1, keepdims=True)
    assert np.all(np.abs(weighted.sum(axis=0) - rgb) <= ROUNDING * size)


class TestSums:
    """With weights."""

    @pytest.mark.parametrize(
        "integrator", [pytest.param(name, marks=() if name in FAST else pytest.mark.slow) for name in METHODS]
    )
    def test_they_are_the_image(self, integrator):
        result = render(room(integrator), 3, techniques=True)
        images = result.techniques
        assert_adds_up(images.weighted, result.film.rgb)
        lit = {
            each.kind for each, image in zip(images.techniques, images.weighted, strict=True) if image.any()
        }
        assert lit == KINDS[integrator]
        assert images.rejected_count == 0

    @pytest.mark.parametrize("film", FILMS)
    def test_crops_borders_and_filters(self, film):
        result = render(room("vcm", FILMS[film]), 2, techniques=True)
        assert result.film.rgb.any()
        assert_adds_up(result.techniques.weighted, result.film.rgb)

    @pytest.mark.parametrize("integrator", ["pt", "vcm"])
    def test_emitters_without_a_surface(self, integrator):
        emitters = [
            {"type": "environment", "spectrum": 0.3},
            {"type": "directional", "direction": [0.3, 1, -0.5], "spectrum": 1.0, "angle": 5.0},
            {"type": "point", "position": [-0.5, -0.2, 0.3], "spectrum": 0.2},
        ]
        compiled = compile_tables(room_tables(integrator, FILMS["all of it"], emitters=emitters))
        result = render(compiled, 3, techniques=True)
        assert result.techniques.weighted[0].any()  # the environment, seen from outside
        assert_adds_up(result.techniques.weighted, result.film.rgb)

    def test_longer_paths_share_images(self):
        apart = render(room("vcm"), 2, techniques=True)
        together = render(room("vcm"), 2, techniques=True, technique_length=3)
        assert apart.techniques.lengths == [1, 2, 3, 4, 5, 6]
        assert together.techniques.lengths == [1, 2, 3, None]
        assert_adds_up(together.techniques.weighted, together.film.rgb)
        longer = together.techniques.weighted[together.techniques.rows(None)].sum(axis=0)
        expected = sum(apart.techniques.weighted[apart.techniques.rows(k)].sum(axis=0) for k in (4, 5, 6))
        np.testing.assert_allclose(longer, expected, rtol=1e-4, atol=1e-6)

    def test_they_do_not_depend_on_threads(self):
        one, two = (render(room("vcm"), 2, techniques=True, threads=n).techniques for n in (1, 2))
        assert np.array_equal(one.weighted, two.weighted)
        assert np.array_equal(one.unweighted, two.unweighted)

    @pytest.mark.parametrize("integrator", ["pt", pytest.param("vcm", marks=pytest.mark.slow)])
    def test_the_image_is_the_same_without(self, integrator):
        with_them, without = (render(room(integrator), 2, techniques=wanted) for wanted in (True, False))
        assert without.techniques is None
        # The same sums; other code may round them differently.
        np.testing.assert_allclose(with_them.film.rgb, without.film.rgb, rtol=1e-4, atol=1e-6)


class TestUnweighted:
    """Without."""

    RENDERS = 8

    @pytest.fixture(scope="class")
    @staticmethod
    def luminances():
        """`{(length, name): mean luminance of each of some independent renders}`; no glass in the way."""
        found = {}
        for seed in range(TestUnweighted.RENDERS):
            compiled = room("vcm", FILMS["large"], BEHIND, seed=seed)
            images = render(compiled, 24, techniques=True, technique_length=3).techniques
            for technique, image in zip(images.techniques, images.unweighted, strict=True):
                luminance = (image @ RGB_TO_XYZ[1]).mean()
                found.setdefault((technique.length, technique.name), []).append(luminance)
        return {key: np.array(values) for key, values in found.items()}

    @pytest.mark.parametrize(
        ("length", "name"),
        [(2, "hit"), (2, "lt"), (2, "lens"), (2, "vm_m1"), (3, "hit"), (3, "vc_s2_t2"), (3, "lt"), (3, "lens"),
         (3, "vm_m1"), (3, "vm_m2")],
    )  # fmt: skip
    def test_every_technique_shows_the_same(self, luminances, length, name):
        expected, found = luminances[length, "nee"], luminances[length, name]
        difference = found.mean() - expected.mean()
        error = np.sqrt((expected.var(ddof=1) + found.var(ddof=1)) / self.RENDERS)
        bias = 0.05 if name.startswith("vm") else 0.0  # of merging near edges
        assert error < (0.08 if name == "lens" else 0.04) * expected.mean()  # light seldom hits the lens
        assert abs(difference) < stats.t.isf(5e-5, self.RENDERS - 1) * error + bias * expected.mean()


def room_tables(integrator, film, **more):
    """The room as the tables of a scene file."""
    return {
        "film": film,
        "camera": CAMERA,
        "render": {
            "integrator": integrator, "sampler": "independent", "max_path_length": 5, **METHODS[integrator]
        },
        "materials": MATERIALS,
        "shapes": room_shapes(INSIDE),
        "emitters": UNLIT,
        **more,
    }  # fmt: skip


def test_files(tmp_path):
    file, output = tmp_path / "room.toml", tmp_path / "image.exr"
    file.write_text(to_toml(room_tables("vcm", FILMS["cropped inside"])))
    stale = tmp_path / "image.techniques" / "length_05.exr"
    stale.parent.mkdir()
    stale.write_text("of an earlier render")
    options = ["--iterations", "2", "--techniques", "--technique-length", "4", "-q"]
    assert main(["render", str(file), "-o", str(output), *options]) == 0
    image = read_image(output)
    assert not stale.exists()
    names = [f"length_{length}.exr" for length in ("01", "02", "03", "04", "more")]
    lengths = [read_image(stale.parent / name) for name in names]
    assert all(each.window == image.window for each in lengths)
    np.testing.assert_allclose(sum(each.rgb for each in lengths), image.rgb, rtol=1e-4, atol=1e-6)
    layers = ["hit", "nee", "vc_s2_t2", "lt", "lens", "vm_m1", "vm_m2"]
    total = sum(lengths[2].layer(f"{layer}.weighted") for layer in layers)
    np.testing.assert_allclose(total, lengths[2].rgb, rtol=1e-4, atol=1e-6)
    assert len(lengths[2].names) == 3 * (1 + 2 * len(layers))
    pictures = read_image(stale.parent / "pictures.exr")
    merging, connection = pictures.layer("merging"), pictures.layer("connection")
    np.testing.assert_allclose(merging + connection, image.rgb, rtol=1e-4, atol=1e-6)
    shown = {path.name for path in stale.parent.glob("*.png")}
    assert shown == {
        "merging.png", "connection.png", "path_tracing.png", "false_colour.png", "weighted.png", "unweighted.png"
    }  # fmt: skip
