"""What is not needed, forced in: the picture stays, only the code is more."""

import json

import pytest
from room import write_room

from artist_py.errors import OptionError
from artist_py.evidence import ablation as module
from artist_py.evidence.ablation import ablate, ablation_table, compile_pair, print_compile_seconds
from artist_py.evidence.entries import Entry, parse_entries
from artist_py.evidence.files import write_ablation

PT, BPT = parse_entries("pt,bpt")
NEEDS_ALL = (
    ('type = "pinhole"', 'type = "thin-lens"\naperture_radius = 0.1'),
    (
        '[[shapes]]\ntype = "box"',
        '[[emitters]]\ntype = "environment"\nspectrum = 1\n[[shapes]]\ntype = "box"',
    ),
    ('type = "diffuse"\nreflectance = 0.5', 'type = "dielectric"\nior = "N-BK7"'),
)


@pytest.fixture
def room(tmp_path):
    """Path of the scene file."""
    return write_room(tmp_path)


class TestForcing:
    """What is changed, and what is not."""

    def test_dispersion(self, room):
        """The code is there, and no material disperses."""
        without, with_ = compile_pair(room, PT, (), "dispersion")
        assert (without.scene.needs.dispersion, with_.scene.needs.dispersion) == (None, True)
        assert with_.scene.needs._replace(dispersion=None) == without.scene.needs
        assert with_.scene.materials is without.scene.materials

    def test_lens(self, room):
        """A lens whose aperture is next to nothing, on the same camera."""
        without, with_ = compile_pair(room, PT, (), "lens")
        assert without.camera.lens is None
        assert with_.camera.lens is not None
        assert with_.graph.camera.aperture_radius == pytest.approx(1e-7 * 1.95)
        assert with_.graph.camera.position == without.graph.camera.position

    def test_environment(self, room):
        """Surroundings that are next to never chosen."""
        without, with_ = compile_pair(room, PT, (), "environment")
        assert (without.scene.needs.environments, with_.scene.needs.environments) == (None, True)
        chances = with_.scene.emitters.records.array["pdf_select"]
        assert 0 < chances.min() < 1e-9  # which are shares of the power, too

    def test_merging(self, room):
        """Of bidirectional path tracing only, with equal wavelengths."""
        assert compile_pair(room, PT, (), "merging") is None
        without, with_ = compile_pair(room, BPT, (), "merging")
        assert (without.graph.render.integrator, with_.graph.render.integrator) == ("bpt", "vcm")
        assert without.graph.render.wavelengths == with_.graph.render.wavelengths == "shared"

    def test_what_is_needed(self, tmp_path):
        """Cannot be forced in."""
        room = write_room(tmp_path, "all.toml", *NEEDS_ALL)
        assert [compile_pair(room, PT, (), feature) for feature in module.FEATURES] == [None] * 4
        with pytest.raises(OptionError, match="needs all that could be forced"):
            ablate(room, [PT], (), seconds=0.1)


class TestMeasuring:
    """Times and images."""

    def test_the_picture_stays(self, room, monkeypatch, tmp_path):
        """With a lens forced in, the image is the same but for rounding; the table and the files say what was found."""
        monkeypatch.setattr(module, "FEATURES", ("lens", "merging"))
        [cost] = ablate(room, [PT], (), seconds=0.3, with_compile_times=False)
        assert (cost.entry, cost.feature) == ("pt", "lens")
        assert cost.difference < 0.01 * cost.noise
        assert cost.ratio_low <= cost.ratio <= cost.ratio_high
        assert cost.coverage > 0.95
        assert cost.cpu_without > 0
        header, [line] = ablation_table([cost])
        assert len(header) == len(line)
        write_ablation(tmp_path, room, {}, [cost])
        content = json.loads((tmp_path / "ablation.json").read_text())
        assert content["costs"][0]["ratio"] == cost.ratio
        assert (tmp_path / "ablation.csv").read_text().startswith("entry,feature,cpu_without")

    def test_compile_seconds_of_a_child(self, room, monkeypatch, capsys):
        """The child prints them, the parent reads them, and says what went wrong."""
        task = json.dumps([str(room), ["pt", "pt", []], [["render.seed", 3]], "lens", 0])
        print_compile_seconds(task)
        assert float(capsys.readouterr().out) >= 0
        entry = Entry("pt", "pt", (("render.seed", "4"),))
        monkeypatch.setattr(module, "CHILD", "import sys, json; print(len(json.loads(sys.argv[1])) / 2)")
        assert module._compile_seconds(room, entry, [("render.hero_count", 4)], "lens", 1) == 2.5
        monkeypatch.setattr(module, "CHILD", "import sys; sys.exit('no memory')")
        with pytest.raises(OptionError, match="compiling ended with 1: no memory"):
            module._compile_seconds(room, entry, [], "lens", 1)
