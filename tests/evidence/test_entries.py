"""What `--integrators` may say, and what makes two renders the same picture."""

import pytest
from room import write_room

import artist_py
from artist_py.errors import OptionError, SceneError
from artist_py.evidence.convergence import compile_entries
from artist_py.evidence.entries import Entry, compile_entry, parse_entries, picture_hash, with_seed


class TestParsing:
    """The list."""

    def test_names_and_settings(self):
        """Keys without a dot are those of [render]; labels are what the user wrote."""
        assert parse_entries("pt, vcm:merging.alpha=0.9:hero_count=8") == [
            Entry("pt", "pt", ()),
            Entry(
                "vcm:merging.alpha=0.9:hero_count=8",
                "vcm",
                (("merging.alpha", "0.9"), ("render.hero_count", "8")),
            ),
        ]

    def test_values_with_separators(self):
        """Brackets and quotes keep them."""
        [one, other] = parse_entries('pt:film.crop=[0, 4, 0, 4]:materials.a.metal="a:b,c",bpt')
        assert one.settings == (("film.crop", "[0, 4, 0, 4]"), ("materials.a.metal", '"a:b,c"'))
        assert other.label == "bpt"

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("pt,pt", "'pt' is there twice"),
            ("pt:hero_count", "is not NAME:KEY=VALUE"),
            ("pt:=8", "is not NAME:KEY=VALUE"),
            ("pt,", "does not begin with the name of an integrator"),
            (":hero_count=8", "does not begin with the name"),
        ],
    )
    def test_errors(self, text, message):
        """The message quotes what is wrong."""
        with pytest.raises(OptionError, match=message):
            parse_entries(text)


class TestPictures:
    """Renders that converge to the same image."""

    def test_compiled_with_its_settings(self, tmp_path):
        """An entry's settings beat those of all, which beat the file."""
        scene = write_room(tmp_path)
        compiled = compile_entry(scene, parse_entries("bpt:hero_count=8")[0], [("render.hero_count", "1")])
        assert compiled.graph.render.integrator == "bpt"
        assert compiled.graph.render.hero_count == 8
        assert with_seed(compiled, 99).graph.render.seed == 99
        with pytest.raises(SceneError, match="vcmm"):
            compile_entry(scene, parse_entries("vcmm")[0])

    def test_hash(self, tmp_path):
        """Integrator, seed and wavelengths per path do not matter; scene, size, path length and wavelengths do."""
        scene = write_room(tmp_path)

        def hash_of(**settings):
            overrides = {key.replace("__", "."): value for key, value in settings.items()}
            return picture_hash(artist_py.load_scene(scene, overrides))

        expected = hash_of()
        same = ({"render__integrator": "bpt"}, {"render__seed": 9}, {"render__hero_count": 1},
                {"render__wavelengths": "shared"}, {"render__wavelength_range": [380, 780]})  # fmt: skip
        assert {hash_of(**each) for each in same} == {expected}
        other = ({"render__max_path_length": 5}, {"film__resolution": [12, 11]}, {"film__crop": [0, 4, 0, 4]},
                 {"render__wavelength_range": [400, 700]}, {"materials__wall__reflectance": 0.6})  # fmt: skip
        assert len({expected, *(hash_of(**each) for each in other)}) == 1 + len(other)

    def test_entries_that_show_other_pictures(self, tmp_path):
        """One reference cannot judge both, and the message says why."""
        scene = write_room(tmp_path)
        with pytest.raises(
            OptionError, match="'pt:max_path_length=2' and 'pt' render other pictures .max_path_length"
        ):
            compile_entries(scene, parse_entries("pt,pt:max_path_length=2"), (), 1)
