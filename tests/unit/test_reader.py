"""Reading scenes: values, defaults, names, includes, overrides, places, settings and hashes."""

import json
import os
import subprocess
import sys
from dataclasses import FrozenInstanceError
from pathlib import Path

import pytest

from artist_py import data
from artist_py.errors import Problem, SceneError
from artist_py.scene import graph, shape_types, spectrum_types, transforms
from artist_py.scene.fields import Number, keys_of
from artist_py.scene.messages import listing, nearest, show
from artist_py.scene.reader import read_scene, read_scene_text, scene_hash, settings
from artist_py.scene.where import Source, Where, as_toml_1_0, problem

CAMERA = """
[camera]
type = "pinhole"
position = [0, -4, 0]
look_at = [0, 0, 0]
"""
SPHERE = """
[[shapes]]
type = "sphere"
center = [0, 0, 0]
radius = 1
"""


def read(text, overrides=()):
    return read_scene_text(CAMERA + text, overrides=overrides)


def messages(text, overrides=()):
    with pytest.raises(SceneError) as caught:
        read(text, overrides)
    return [str(p) for p in caught.value.problems]


def material(text):
    return read(f"[materials.m]\n{text}").materials["m"]


def light(value):
    return read(f"{SPHERE}emission = {value}\n").shapes[0].emission


class TestValues:
    """What the file says, and what it leaves out."""

    def test_defaults(self):
        scene = read("")
        assert scene.film == graph.Film(
            resolution=(512, 512),
            crop=None,
            filter="blackman-harris",
            filter_radius=1.5,
            white_luminance=72983.4866019817,
        )
        assert scene.camera.up == (0.0, 0.0, 1.0)
        assert scene.camera.field_of_view == 45.0
        assert scene.render == graph.Render(
            iterations=64, max_path_length=12, roulette_length=4, seed=1, hero_count=4
        )
        assert scene.render.merging == graph.Merging(radius=0.003, alpha=0.75, light_paths=1.0)
        assert (scene.shapes, scene.instances, scene.materials, scene.objects, scene.spectra) == (
            (),
            (),
            {},
            {},
            {},
        )

    @pytest.mark.parametrize(("name", "radius"), graph.FILTER_RADIUS.items())
    def test_filter_radius_goes_with_the_filter(self, name, radius):
        assert read(f'[film]\nfilter = "{name}"').film.filter_radius == radius
        assert read(f'[film]\nfilter = "{name}"\nfilter_radius = 3').film.filter_radius == 3.0

    @pytest.mark.parametrize("observer", graph.WHITE_LUMINANCE)
    def test_a_flat_spectrum_of_radiance_1_is_white(self, observer):
        white = read(f'[film]\nobserver = "{observer}"').film.white_luminance
        assert white == pytest.approx(683.002 * data.luminous_integral(observer), rel=1e-12)

    def test_thin_lens_focuses_where_it_looks(self):
        lens = 'type = "thin-lens"\naperture_radius = 0.1'
        scene = read_scene_text(CAMERA.replace('type = "pinhole"', lens))
        assert isinstance(scene.camera, graph.ThinLens)
        assert scene.camera.focus_distance == 4.0

    def test_numbers_become_floats_and_counts_stay_whole(self):
        scene = read(SPHERE + "emission = 1\n")
        assert [type(x) for x in (*scene.shapes[0].center, scene.shapes[0].radius)] == [float] * 4
        assert [type(x) for x in scene.film.resolution] == [int, int]

    def test_merging_radius_is_one_or_the_other(self):
        assert read("[render.merging]\nradius_pixels = 2").render.merging.radius is None

    def test_nodes_cannot_be_changed(self):
        with pytest.raises(FrozenInstanceError):
            read("").film.filter = "box"

    @pytest.mark.parametrize("name", [n for n in graph.MATERIALS if n not in ("conductor", "fluorescent")])
    def test_materials_need_nothing_but_their_type(self, name):
        assert isinstance(material(f'type = "{name}"'), graph.MATERIALS[name])

    def test_material_values(self):
        rough = material('type = "oren-nayar"\nreflectance = 0.25\nroughness = 30\ntwo_sided = false')
        assert rough == graph.OrenNayar(
            reflectance=spectrum_types.Constant(0.25), roughness=30.0, two_sided=False
        )
        assert material('type = "conductor"\nmetal = "Au"').metal == "Au"
        assert material('type = "conductor"\neta = 0.2\nk = 3.0').k == spectrum_types.Constant(3.0)
        assert material('type = "dielectric"\npriority = -3').priority == -3

    @pytest.mark.parametrize(
        ("text", "attributes"),
        [
            (
                'type = "rectangle"\ncorner = [0, 0, 0]\nedges = [[1, 0, 0], [0, 2, 0]]',
                {"edges": ((1, 0, 0), (0, 2, 0))},
            ),
            ('type = "disk"\ncenter = [0, 0, 1]\nnormal = [0, 0, -1]\nradius = 2', {"normal": (0, 0, -1)}),
            ('type = "cylinder"\nbase = [0, 0, 0]\ntop = [0, 0, 1]\nradius = 2', {"caps": True}),
            ('type = "cone"\nbase = [0, 0, 0]\napex = [0, 0, 1]\nradius = 2\ncap = false', {"cap": False}),
            (
                'type = "grooved-sphere"\ncenter = [0, 0, 0]\nradius = 2\ngrooves = 3',
                {"grooves": 3, "axis": (0, 0, 1)},
            ),
            (
                'type = "mesh"\nfile = "a/b.ply"\nsmooth = true',
                {"smooth": True, "file": os.path.join("a", "b.ply")},
            ),
            ('type = "box"\ncenter = [1, 1, 1]\nsize = [2, 4, 6]', {"size": (2, 4, 6)}),
        ],
    )
    def test_shapes(self, text, attributes):
        shape = read(f"[[shapes]]\nemission = 1\nreverse = true\n{text}").shapes[0]
        assert shape.reverse is True
        assert {name: getattr(shape, name) for name in attributes} == attributes

    @pytest.mark.parametrize(
        "text", ["min = [0, -1, -2]\nmax = [2, 3, 4]", "center = [1, 1, 1]\nsize = [2, 4, 6]"]
    )
    def test_box_bounds(self, text):
        box = read(f'[[shapes]]\ntype = "box"\nemission = 1\n{text}').shapes[0]
        assert box.bounds() == ((0, -1, -2), (2, 3, 4))

    def test_objects_and_instances(self):
        scene = read(
            '[materials.m]\ntype = "mirror"\n[[objects.lamp.shapes]]\ntype = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n'
            'material = "m"\n[[instances]]\nobject = "lamp"\nname = "left"\ntransform = [{ translate = [1, 0, 0] }]\n'
        )
        assert scene.objects["lamp"].shapes[0].radius == 1.0
        assert scene.instances[0].object == "lamp"
        assert scene.instances[0].transform == (transforms.Translate(translate=(1.0, 0.0, 0.0)),)

    def test_crop_may_touch_the_border(self):
        assert read("[film]\nresolution = [8, 4]\ncrop = [0, 8, 3, 4]").film.crop == (0, 8, 3, 4)

    def test_none_of_the_keys_lacks_a_converter(self):
        for cls in graph.TYPE_NAMES:
            assert {f.name for f in keys_of(cls).values()} == set(cls.__dataclass_fields__) - {"where"}


class TestSpectra:
    """Every form of a spectrum and of a refractive index."""

    @pytest.mark.parametrize(
        ("text", "spectrum"),
        [
            ("0.5", spectrum_types.Constant(0.5)),
            ('"D65"', spectrum_types.Named("D65")),
            ('{ illuminant = "A", scale = 2 }', spectrum_types.Named("A", 2.0)),
            ("{ rgb = [1, 0.5, 0] }", spectrum_types.Rgb((1.0, 0.5, 0.0))),
            ("{ blackbody = 5000 }", spectrum_types.Blackbody(5000.0)),
            ("{ gaussian = [550, 20], peak = 3 }", spectrum_types.Gaussian((550.0, 20.0), 3.0)),
            ("{ lines = [[546.1, 1], [577, 2]] }", spectrum_types.Lines(((546.1, 1.0), (577.0, 2.0)), 0.1)),
            (
                "{ wavelengths = [400, 500], values = [0, 1], scale = 0.5 }",
                spectrum_types.Sampled((400.0, 500.0), (0.0, 1.0), 0.5),
            ),
            ('{ file = "x.csv", column = 2 }', spectrum_types.File("x.csv", 2)),
        ],
    )
    def test_forms(self, text, spectrum):
        assert light(text).spectrum == spectrum

    @pytest.mark.parametrize(
        ("text", "index"),
        [
            ("1.33", spectrum_types.Constant(1.33)),
            ('"n-bk7"', None),
            ('"N-BK7"', spectrum_types.Named("N-BK7")),
            ("{ cauchy = [1.5, 0.004] }", spectrum_types.Cauchy((1.5, 0.004))),
            (
                "{ sellmeier = [[1.04, 0.006], [0.2, 0.02]] }",
                spectrum_types.Sellmeier(((1.04, 0.006), (0.2, 0.02))),
            ),
            (
                "{ wavelengths = [400, 700], values = [1.6, 1.5] }",
                spectrum_types.Sampled((400, 700), (1.6, 1.5)),
            ),
        ],
    )
    def test_refractive_indices(self, text, index):
        if index is None:  # names are as the catalogue writes them
            assert messages(f'[materials.m]\ntype = "dielectric"\nior = {text}')[0].endswith(
                'did you mean "N-BK7"?'
            )
        else:
            assert material(f'type = "dielectric"\nior = {text}').ior == index

    def test_emission_is_a_spectrum_or_a_table(self):
        assert (
            light('"D65"')
            == light('{ spectrum = "D65" }')
            == shape_types.Emission(spectrum=spectrum_types.Named("D65"))
        )
        assert light('{ spectrum = "D65", luminance = 5000, sides = "both" }').luminance == 5000.0

    def test_names_of_the_scene(self):
        text = '[spectra]\nred = { rgb = [1, 0, 0] }\nalso = "red"\n'
        text += '[materials.m]\ntype = "diffuse"\nreflectance = "also"\n'
        scene = read(text)
        assert scene.materials["m"].reflectance == scene.spectra["red"]
        assert scene.spectra["also"] == scene.spectra["red"]

    def test_a_broken_spectrum_is_reported_once_where_it_is(self):
        text = "[spectra]\nred = { rgb = [1, 0] }\n" + "".join(
            f'[materials.m{i}]\ntype = "diffuse"\nreflectance = "red"\n' for i in range(3)
        )
        assert messages(text) == ["scene.toml:7: spectra.red.rgb: expected [red, green, blue], found [1, 0]"]


class TestPlaces:
    """Files and lines of problems."""

    def test_the_graph_knows_where_it_came_from(self):
        scene = read('[materials.m]\ntype = "diffuse"\n\nreflectance = 0.5\n')
        found = problem(scene.materials["m"], "reflectance", "is 1.2 at 530 nm")
        assert found == Problem("is 1.2 at 530 nm", "scene.toml", 9, "materials.m.reflectance")
        assert problem(scene.materials["m"].reflectance, None, "x").line == 9
        assert problem(scene.materials["m"], None, "x").line == 6
        assert problem(scene.materials["m"], "two_sided", "x").line == 6  # a default has no line of its own

    def test_nodes_made_in_python_have_no_place(self):
        assert str(problem(graph.Diffuse(), "reflectance", "is odd")) == "reflectance: is odd"

    def test_problems_are_sorted_by_line(self):
        found = messages(
            '[render]\nseed = -1\niterations = 0\n[film]\nfilter = "bx"\n[[shapes]]\ntype = "ball"\n'
        )
        assert [text.split(": ")[0] for text in found] == [f"scene.toml:{n}" for n in (7, 8, 10, 12)]

    def test_keys_are_told_as_toml_writes_them(self):
        assert messages('[materials."my\\nglass"]\ntype = 1\n')[0].startswith(
            'scene.toml:7: materials."my\\nglass".type: expected'
        )

    def test_line_ends_of_windows(self):
        text = (CAMERA + "[render]\nseed = -1\n").replace("\n", "\r\n")
        with pytest.raises(SceneError) as caught:
            read_scene_text(text)
        assert caught.value.problems[0].line == 7

    @pytest.mark.parametrize(
        ("keys", "line"),
        [
            (("a",), 1),
            (("a", "b"), 2),
            (("a", "c", 1), 5),
            (("a", "c", 9), 3),
            (("lists", 0), 8),
            (("lists", 1), 9),
            (("lists", 1, "r"), 10),
            (("lists", 1, "missing"), 9),
            (("objects", "x y", "shapes", 0), 11),
            (("objects", "x y", "shapes", 0, "inner", "q"), 13),
            (("nothing",), None),
        ],
    )
    def test_line_of_a_path(self, keys, line):
        text = (
            'a = {  # TOML 1.1: { " ] }\n  b = 1,\n  c = [\n    1,\n    2,\n  ],  # x\n}\n'
            '[[lists]]\n[[ lists ]]\nr = 1\n[[objects."x y".shapes]]\n'
            '[objects."x y".shapes.inner]\nq = """\n[[lists]]"""\n'
        )
        assert Where(Source("f", text, {}), keys).problem("").line == line

    def test_blanking_keeps_every_position(self):
        text = "a = { b = \"}#,\", # }\n c = '{', }\nd = 1, # kept\n"
        blanked = as_toml_1_0(text)
        assert len(blanked) == len(text)
        assert blanked == "a = { b = \"}#,\",      c = '{'  }\nd = 1, # kept\n"

    def test_text_that_only_toml_1_1_knows_still_has_messages(self):
        assert (
            messages('[render]\nseed = -1\n[[shapes]]\nname = "\\e"\n')[0]
            == "scene.toml: render.seed: expected seed >= 0, found -1"
        )


class TestIncludes:
    """Scenes of several files."""

    def test_sections_are_joined(self, tmp_path):
        (tmp_path / "lib").mkdir()
        (tmp_path / "lib" / "parts.toml").write_text(
            'include = ["more.toml"]\n[materials.white]\ntype = "diffuse"\nreflectance = { file = "w.csv" }\n'
            + SPHERE
            + 'material = "black"\n'
        )
        (tmp_path / "lib" / "more.toml").write_text(
            '[materials.black]\ntype = "diffuse"\n[film]\nfilter = "box"\n'
        )
        main = tmp_path / "main.toml"
        main.write_text(
            'include = ["lib/parts.toml", "lib/more.toml"]\n' + CAMERA + SPHERE + 'material = "white"\n'
        )
        scene = read_scene(main)
        assert list(scene.materials) == ["white", "black"]
        assert [shape.material for shape in scene.shapes] == ["white", "black"]
        assert scene.film.filter == "box"
        assert scene.materials["white"].reflectance.path == str(tmp_path / "lib" / "w.csv")

    def test_the_camera_may_be_in_an_included_file(self, tmp_path):
        (tmp_path / "camera.toml").write_text(CAMERA)
        (tmp_path / "main.toml").write_text('include = ["camera.toml"]\n')
        assert read_scene(tmp_path / "main.toml").camera.position == (0.0, -4.0, 0.0)

    def test_mistakes_are_reported_for_all_files(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("part.toml").write_text('[materials.a]\ntype = "difuse"\n')
        Path("main.toml").write_text('include = ["part.toml"]\n' + CAMERA + SPHERE + 'material = "b"\n')
        with pytest.raises(SceneError) as caught:
            read_scene("main.toml")
        assert [(p.file, p.line) for p in caught.value.problems] == [("main.toml", 12), ("part.toml", 2)]


class TestUnreadable:
    """Files that are none."""

    def failure(self, path):
        with pytest.raises(SceneError) as caught:
            read_scene(path)
        return str(caught.value)

    def test_missing(self):
        assert self.failure("nowhere/scene.toml") == "nowhere/scene.toml: no such file"

    def test_folder(self, tmp_path):
        assert self.failure(tmp_path) == f"{tmp_path}: expected a file, found a directory"

    def test_no_permission(self, tmp_path, monkeypatch):
        def refuse(path):
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(Path, "read_bytes", refuse)
        assert self.failure(tmp_path / "a.toml") == f"{tmp_path / 'a.toml'}: permission denied"

    def test_not_utf_8(self, tmp_path):
        path = tmp_path / "a.toml"
        path.write_bytes(b"[film]\n# caf\xe9\n")
        assert self.failure(path) == f"{path}:2: expected UTF-8, found the byte 0xe9"

    def test_an_odd_path(self):
        assert "null" in self.failure("a\0b")

    def test_empty_file(self, tmp_path):
        path = tmp_path / "a.toml"
        path.write_text("")
        assert self.failure(path) == f"{path}: camera: missing, expected a table"

    def test_byte_order_mark(self, tmp_path):
        path = tmp_path / "a.toml"
        path.write_bytes(b"\xef\xbb\xbf" + CAMERA.encode())
        assert read_scene(path).camera.field_of_view == 45.0

    def test_nested_too_deeply(self):
        assert messages(f"x = {'[' * 5000}{']' * 5000}") == ["scene.toml: not TOML: nested too deeply"]


class TestOverrides:
    """`--set`."""

    SCENE = (
        SPHERE
        + 'emission = 1\nname = "sun"\n'
        + SPHERE
        + 'material = "m"\n[materials.m]\ntype = "oren-nayar"\nroughness = 99\n'
    )

    @pytest.mark.parametrize(
        ("key", "value", "found"),
        [
            ("render.merging.alpha", "0.9", lambda s: s.render.merging.alpha == 0.9),
            ("render.seed", 7, lambda s: s.render.seed == 7),
            ("render.sampler", "independent", lambda s: s.render.sampler == "independent"),
            ("render.sampler", '"independent"', lambda s: s.render.sampler == "independent"),
            ("film", "{ resolution = [4, 2] }", lambda s: s.film.resolution == (4, 2)),
            ("film.resolution", (4, 2), lambda s: s.film.resolution == (4, 2)),
            ("film.resolution", "[4, 2]", lambda s: s.film.resolution == (4, 2)),
            ("shapes.0.radius", "2", lambda s: s.shapes[0].radius == 2.0),
            ("shapes.sun.radius", "2", lambda s: s.shapes[0].radius == 2.0),
            ("shapes.1.center.2", "5", lambda s: s.shapes[1].center == (0.0, 0.0, 5.0)),
            (
                "shapes.sun.emission",
                '{ spectrum = "D65", luminance = 3 }',
                lambda s: s.shapes[0].emission.luminance == 3,
            ),
            ("materials.m.two_sided", "false", lambda s: s.materials["m"].two_sided is False),
            ('materials."odd name"', '{ type = "mirror" }', lambda s: "odd name" in s.materials),
        ],
    )
    def test_values(self, key, value, found):
        assert found(read(self.SCENE, {"materials.m.roughness": "20", key: value}))

    def test_a_mapping_or_pairs(self):
        assert read("", {"render.seed": "2"}) == read("", [("render.seed", "2")])

    @pytest.mark.parametrize(
        ("key", "value", "text"),
        [
            ("render.seed", "-1", "--set: render.seed: expected seed >= 0, found -1"),
            ("render.sed", "1", '--set: render.sed: unknown key, did you mean "seed"?'),
            ("render.seed", "1 2", '--set: render.seed: expected a value as in TOML, found "1 2"'),
            ("render.seed", "1\nx = 2", '--set: render.seed: expected a value as in TOML, found "1\\nx = 2"'),
            ("render.seed.x", "1", "--set: render.seed.x: render.seed is 3 and has no keys"),
            ("shapes.2.radius", "1", "--set: shapes.2: no such element, shapes has 2"),
            ("shapes.son.radius", "1", '--set: shapes.son: no such element, did you mean "sun"?'),
            ("shapes.0.center.3", "1", "--set: shapes.0.center.3: no such element, shapes.0.center has 3"),
            (
                "shapes.0.emission",
                '{ spectrum = "D66" }',
                '--set: shapes.0.emission.spectrum: unknown spectrum "D66", did you mean "D65"?',
            ),
            ("include", '["x.toml"]', "--set: include: cannot be set, since files are included first"),
            ("render..seed", "1", '--set: expected a dotted key such as render.seed, found "render..seed"'),
            ("", "1", '--set: expected a dotted key such as render.seed, found ""'),
        ],
    )
    def test_mistakes(self, key, value, text):
        assert messages("[render]\nseed = 3\n" + self.SCENE, {"materials.m.roughness": 20, key: value}) == [
            text
        ]

    def test_shapes_count_through_all_files(self, tmp_path):
        (tmp_path / "part.toml").write_text(SPHERE + 'emission = 1\nname = "far"\n')
        (tmp_path / "main.toml").write_text('include = ["part.toml"]\n' + CAMERA + SPHERE + "emission = 1\n")
        for key in ("shapes.1.radius", "shapes.far.radius"):
            assert [s.radius for s in read_scene(tmp_path / "main.toml", {key: 9}).shapes] == [1.0, 9.0]

    def test_materials_are_changed_where_they_are(self, tmp_path):
        (tmp_path / "part.toml").write_text('[materials.m]\ntype = "oren-nayar"\n')
        (tmp_path / "main.toml").write_text('include = ["part.toml"]\n' + CAMERA)
        assert (
            read_scene(tmp_path / "main.toml", {"materials.m.roughness": 9}).materials["m"].roughness == 9.0
        )

    def test_paths_start_in_the_current_folder(self, tmp_path):
        (tmp_path / "main.toml").write_text(CAMERA + SPHERE + 'emission = { file = "a.csv" }\n')
        scene = read_scene(tmp_path / "main.toml", {"shapes.0.emission": '{ file = "b.csv" }'})
        assert scene.shapes[0].emission.spectrum.path == "b.csv"


class TestIdentity:
    """Settings and hashes."""

    def test_settings_are_json_with_every_default(self):
        found = settings(read("[render]\nseed = 5\n"))
        assert json.loads(json.dumps(found)) == found
        assert found["film"]["filter_radius"] == 1.5
        assert found["camera"] == {
            "type": "pinhole",
            "position": [0.0, -4.0, 0.0],
            "look_at": [0.0, 0.0, 0.0],
            "up": [0.0, 0.0, 1.0],
            "field_of_view": 45.0,
        }
        assert found["render"]["seed"] == 5
        assert found["render"]["merging"]["alpha"] == 0.75
        assert found["render"]["time"] is None

    def test_the_hash_is_that_of_the_content(self):
        base = SPHERE + "emission = 1\n"
        assert scene_hash(read(base)) == scene_hash(read("# a comment\n" + base.replace("= 1", "=  1.0")))
        assert len(scene_hash(read(base))) == 64

    @pytest.mark.parametrize(
        ("key", "value"),
        [
            ("shapes.0.radius", 2),
            ("film.resolution", (8, 8)),
            ("camera.up", (1, 0, 0)),
            ("shapes.0.emission", "2"),
        ],
    )
    def test_the_hash_changes_with_the_scene(self, key, value):
        base = SPHERE + "emission = 1\n"
        assert scene_hash(read(base)) != scene_hash(read(base, {key: value}))

    def test_the_hash_does_not_depend_on_how_it_is_rendered(self):
        assert scene_hash(read("")) == scene_hash(read("", {"render.seed": 2, "render.iterations": 9}))

    def test_files_count_by_their_bytes(self, tmp_path):
        hashes = []
        for folder, content in (("a", "1 2\n"), ("b", "1 2\n"), ("c", "1 3\n")):
            (tmp_path / folder).mkdir()
            (tmp_path / folder / "s.csv").write_text(content)
            path = tmp_path / folder / "scene.toml"
            path.write_text(CAMERA + SPHERE + 'emission = { file = "s.csv" }\n')
            hashes.append(scene_hash(read_scene(path)))
        assert hashes[0] == hashes[1] != hashes[2]

    def test_a_missing_file_is_a_problem_of_its_key(self):
        scene = read('[[shapes]]\ntype = "mesh"\nfile = "no.ply"\nemission = 1\n')
        with pytest.raises(SceneError) as caught:
            scene_hash(scene)
        assert str(caught.value) == "scene.toml:8: shapes.0.file: no.ply: no such file"


class TestWords:
    """The words of messages."""

    @pytest.mark.parametrize(
        ("value", "text"),
        [
            (1.0, "1"),
            (0.1, "0.1"),
            (True, "true"),
            ("a\nb", '"a\\nb"'),
            ([1, "x", [2.5]], '[1, "x", [2.5]]'),
            ({"a": 1}, "{ a = 1 }"),
            ({}, "{}"),
            ("\x1b[1m", '"\\u001b[1m"'),
            (2**200, "a number of more than 128 bits"),
            ([[[[1]]]], "[[[an array]]]"),
        ],
    )
    def test_show(self, value, text):
        assert show(value) == text

    def test_show_is_never_long(self):
        for value in (
            "x" * 999,
            list(range(999)),
            {str(i): i for i in range(999)},
            1e300,
            [["y" * 99] * 99] * 99,
        ):
            assert len(show(value)) <= 80

    def test_listing(self):
        assert listing(["a", "b", "c"]) == '"a", "b" or "c"'
        assert listing(["a"]) == '"a"'
        assert listing(range(99)).endswith("19, ...")

    def test_nearest_minds_no_case(self):
        assert nearest("d65", ["A", "D65"]) == ', did you mean "D65"?'
        assert nearest("zzz", ["A", "D65"]) == ', expected "A" or "D65"'
        assert nearest("zzz", []) == ""

    @pytest.mark.parametrize(
        ("number", "text"),
        [
            (Number(at_least=0, at_most=1), "0 <= x <= 1"),
            (Number(above=0), "x > 0"),
            (Number(at_least=3), "x >= 3"),
            (Number(below=1), "x < 1"),
            (Number(at_most=1.5), "x <= 1.5"),
            (Number(above=0, below=180), "0 < x < 180"),
        ],
    )
    def test_ranges(self, number, text):
        assert number.range(Where(None, ("a", "x", 2))) == text


def test_reading_does_not_load_numpy():
    heavy = ("numpy", "trimesh", "spanned_toml")
    code = f"import sys, artist_py.scene.reader; sys.exit(any(name in sys.modules for name in {heavy}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
