"""The subcommands other than render, and the help."""

import json
import os
import sys

import click
import numpy as np
import pytest

from artist_py.cli.main import SUBCOMMANDS, command, main
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image
from artist_py.film.reading import read_image


class TestCheck:
    """`artist check`."""

    def test_all_problems_of_all_files(self, folder, edit, capsys):
        """Problems of reading and of loading, of every file."""
        edit("radius = 1", "radius = -1\ncolour = 2", "bad.toml")
        edit("[render]", "[render]\nseed = 666", "no-mesh.toml")
        assert main(["check", "bad.toml", "scene.toml", "no-mesh.toml", "missing.toml"]) == 2
        out = capsys.readouterr().out.splitlines()
        assert "scene.toml: ok" in out
        assert sum(line.startswith("bad.toml:") for line in out) == 2
        assert "mesh.ply: a mesh is missing" in out
        assert "other.ply: so is another" in out
        assert any(line.startswith("missing.toml") for line in out)

    def test_good_scenes(self, folder, capsys):
        """Nothing but ok, and 0."""
        assert main(["check", "scene.toml"]) == 0
        assert capsys.readouterr().out == "scene.toml: ok\n"

    def test_warnings(self, folder, edit, capsys):
        """They are told, and change nothing."""
        edit("[render]", "[render]\nseed = 13", "dark.toml")
        assert main(["check", "dark.toml"]) == 0
        assert capsys.readouterr().out == "dark.toml: warning: it will be black\ndark.toml: ok\n"


class TestInfo:
    """`artist info`."""

    def test_lines(self, folder, capsys):
        """Sections and their rows."""
        assert main(["info", "scene.toml", "--set", "film.filter=box"]) == 0
        assert (
            capsys.readouterr().out == "film:\n  resolution: 8 x 6\n  filter: box\nmemory:\n  film: 1 MiB\n"
        )

    def test_tables(self, folder, capsys, monkeypatch):
        """The same on a terminal."""
        monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
        assert main(["info", "scene.toml"]) == 0
        out = capsys.readouterr().out
        assert "resolution" in out
        assert "8 x 6" in out

    def test_json(self, folder, capsys):
        """The same for programs."""
        assert main(["info", "scene.toml", "--json"]) == 0
        assert json.loads(capsys.readouterr().out) == {
            "film": {"resolution": "8 x 6", "filter": "blackman-harris"},
            "memory": {"film": "1 MiB"},
        }


class TestTonemap:
    """`artist tonemap`."""

    @pytest.fixture
    def image(self, folder):
        """A grey ramp in `a.exr`."""
        write_image("a.exr", FilmImage(rgb=np.linspace(0, 2, 10)[None, :, None] * np.ones(3), iterations=1))
        return folder

    def test_options_change_the_image(self, image):
        """Every option has its effect."""
        images = {}
        for options in ("", "--exposure 1", "--exposure auto", "--operator filmic", "--operator linear", "--bits 16",
                        "--white-point A", "--white-point 0.4,0.4"):  # fmt: skip
            assert main(["tonemap", "a.exr", "a.png", *options.split()]) == 0
            images[options] = read_image("a.png").rgb.tobytes()
        assert len(set(images.values())) == len(images)

    @pytest.mark.parametrize(
        ("arguments", "code", "message"),
        [
            (["missing.exr", "a.png"], 2, "missing.exr: there is no such file"),
            (["a.exr", "a.exr"], 1, "a.exr: tone-mapped images are written as .png"),
            (["a.exr", "no/a.png"], 1, "no/a.png: there is no directory"),
            (["a.exr", "a.png", "--white-point", "D66"], 2, "there is no illuminant 'D66'"),
            (["a.exr", "a.png", "--white-point", "0.9,0.9"], 2, "is not a chromaticity x,y"),
            (["a.exr", "a.png", "--exposure", "inf"], 2, "inf is not finite"),
            (["scene.toml", "a.png"], 2, "scene.toml: cannot be read as an image"),
        ],
    )
    def test_errors(self, image, capsys, arguments, code, message):
        """The message names the file or the option; nothing is written."""
        assert main(["tonemap", *arguments]) == code
        assert message in capsys.readouterr().err
        assert sorted(os.listdir(image)) == ["a.exr", "scene.toml"]


class TestWarm:
    """`artist warm`."""

    def test_typical_and_given_scenes(self, folder, edit, capsys):
        """One small iteration of each; no file is written."""
        assert main(["warm"]) == 0
        assert "typical.toml" in capsys.readouterr().err
        edit("[film]", "[film]\ncrop = [1, 4, 1, 4]")
        assert main(["warm", "scene.toml"]) == 0
        assert "iteration 1 of 1" in capsys.readouterr().err
        assert os.listdir(folder) == ["scene.toml"]


class TestHelp:
    """What users read first."""

    def test_every_option_is_described(self):
        """Each option of each subcommand has a help text, each subcommand a sentence."""
        context = click.Context(command)
        for name in SUBCOMMANDS:
            subcommand = command.get_command(context, name)
            assert subcommand.get_short_help_str(60).endswith(".")
            for parameter in subcommand.params:
                assert isinstance(parameter, click.Argument) or parameter.help, (name, parameter.name)

    def test_help_and_version(self, capsys):
        """The help of the whole gives an example and names all subcommands."""
        assert main(["--help"]) == 0
        out = capsys.readouterr().out
        assert "artist render scene.toml" in out
        assert all(f"  {name} " in out for name in SUBCOMMANDS)
        assert main(["--version"]) == 0
        assert capsys.readouterr().out.startswith("artist, version ")

    def test_unknown_subcommand(self, capsys):
        """The nearest known one is suggested."""
        assert main(["rendr"]) == 2
        assert "Did you mean 'render'?" in capsys.readouterr().err
