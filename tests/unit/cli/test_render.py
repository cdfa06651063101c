"""`artist render`: options, files, messages, exit codes."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from artist_py.cli.main import main
from artist_py.errors import OutputError
from artist_py.film.reading import read_image


def statistics(path="scene.json"):
    """The JSON file."""
    return json.loads(Path(path).read_text(encoding="utf-8"))


class TestRender:
    """`artist render`."""

    def test_defaults(self, folder):
        """The image and its statistics are named as the scene, in the current directory."""
        assert main(["render", "scene.toml"]) == 0
        assert sorted(os.listdir(folder)) == ["scene.exr", "scene.json", "scene.toml"]
        image = read_image("scene.exr")
        assert np.all(image.rgb == 5)
        assert image.rgb.shape == (6, 8, 3)
        assert image.metadata["artist:integrator"] == "pt"
        assert len(image.metadata["artist:sceneHash"]) == 64
        assert image.metadata["whiteLuminance"] > 70_000
        assert json.loads(image.metadata["artist:settings"])["render"]["iterations"] == 5
        assert "renderTimeSeconds" not in image.metadata
        written = statistics()
        assert written["complete"] is True
        assert written["iterations"] == 5
        settings = written["statistics"]["settings"]
        assert settings == {
            "iterations": 5,
            "time_seconds": None,
            "error": None,
            "threads": len(os.sched_getaffinity(0)),
            "save_every_seconds": None,
            "spectral": False,
            "aovs": [],
            "max_memory_bytes": None,
            "techniques": False,
            "technique_length": 8,
            "compile_apart": True,
        }

    def test_options_reach_scene_and_sampler(self, folder):
        """Every option is heard by whom it concerns."""
        options = (
            "--integrator pt --iterations 7 --size 20x10 --crop 1,4,2,7 --threads 3 --seed 99 --wavelengths shared "
            "--hero-count 8 --spectral --aov depth,material --aov depth --set render.max_path_length=3 "
            "--set film.filter=box --save-every 1m --max-memory 2GiB "
            "--techniques --technique-length 5"
        )
        assert main(["render", "scene.toml", "-o", "a.exr", "-o", "a.png", *options.split()]) == 0
        image = read_image("a.exr")
        assert image.window == (1, 2, 20, 10)
        assert set(image.names) == {"R", "G", "B", "depth.Z", "material.ID", "S0.550,000000nm"}
        effective = json.loads(image.metadata["artist:settings"])
        assert effective["render"]["seed"] == image.metadata["artist:seed"] == 99
        assert effective["render"]["wavelengths"] == "shared"
        assert effective["render"]["hero_count"] == 8
        assert effective["render"]["max_path_length"] == 3
        assert effective["film"]["filter"] == "box"
        given = statistics("a.json")["statistics"]
        assert given["compile_threads"] == given["settings"]["threads"] == 3
        assert given["settings"]["iterations"] == 7
        assert given["settings"]["save_every_seconds"] == 60
        assert given["settings"]["max_memory_bytes"] == 2 * 2**30
        assert given["settings"]["aovs"] == ["depth", "material"]
        assert given["settings"]["techniques"] is True
        assert given["settings"]["technique_length"] == 5
        assert read_image("a.png").rgb.shape == (5, 3, 3)

    @pytest.mark.parametrize(
        ("in_file", "options", "budget"),
        [
            ("", [], (5, None, None)),
            ("time = 30", [], (None, 30, None)),
            ("error = 0.1", [], (None, None, 0.1)),
            ("time = 30\nerror = 0.1", [], (None, 30, 0.1)),
            ("time = 30", ["--iterations", "2"], (2, None, None)),
            ("", ["--time", "1h30m"], (None, 5400, None)),
            ("time = 30", ["--error", "0.5"], (None, None, 0.5)),
        ],
    )
    def test_when_it_ends(self, folder, edit, in_file, options, budget):
        """The command line beats the file, where time and error beat iterations; the metadata say what counts."""
        edit("iterations = 5", f"iterations = 5\n{in_file}")
        assert main(["render", "scene.toml", *options]) == 0
        settings = statistics()["statistics"]["settings"]
        assert (settings["iterations"], settings["time_seconds"], settings["error"]) == budget
        effective = json.loads(read_image("scene.exr").metadata["artist:settings"])["render"]
        assert (effective["iterations"], effective["time"], effective["error"]) == budget

    def test_equal_renders_are_equal_files(self, folder):
        """Neither run time nor threads get into the image, unless they are asked for."""
        assert main(["render", "scene.toml", "-o", "a.exr", "--threads", "1"]) == 0
        assert main(["render", "scene.toml", "-o", "b.exr", "--threads", "2"]) == 0
        assert Path("a.exr").read_bytes() == Path("b.exr").read_bytes()
        assert main(["render", "scene.toml", "-o", "c.exr", "--timing-metadata"]) == 0
        assert read_image("c.exr").metadata["renderTimeSeconds"] == 4.5

    def test_png_options(self, folder):
        """Exposure and bits concern the PNG."""
        assert main(["render", "scene.toml", "-o", "a.png", "--exposure", "auto", "--bits", "16"]) == 0
        assert read_image("a.png").rgb[0, 0, 0] == pytest.approx(0.4613, abs=1e-3)  # sRGB code of 0.18

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (
                ["scene.toml", "--iterations", "3", "--time", "3s"],
                "--iterations and --time exclude each other",
            ),
            (["scene.toml", "--size", "20"], "'20' is not WxH, such as 640x480"),
            (["scene.toml", "--size", "0x10"], "film.resolution"),
            (["scene.toml", "--crop", "1,2,3"], "is not x0,x1,y0,y1"),
            (["scene.toml", "--crop", "0,9,0,6"], "film.crop"),
            (["scene.toml", "--time", "soon"], "'soon' is not a duration, such as 30s, 2m or 1h30m"),
            (["scene.toml", "--error", "nan"], "nan is not finite"),
            (["scene.toml", "--error", "0"], "0.0 is not in the range x>0"),
            (["scene.toml", "--max-memory", "much"], "'much' is not an amount of memory"),
            (["scene.toml", "--aov", "depth,norml"], 'there is no output "norml", did you mean "normal"?'),
            (["scene.toml", "--aov", "depth", "-o", "a.png"], "--aov needs an --output that ends in .exr"),
            (["scene.toml", "--spectral", "-o", "a.png"], "--spectral needs an --output that ends in .exr"),
            (["scene.toml", "--set", "render.seed"], "'render.seed' is not key=value"),
            (["scene.toml", "--set", "render.sed=1"], 'did you mean "seed"?'),
            (["scene.toml", "--iterations", "x"], "'x' is not a valid integer"),
            (["scene.toml", "--integrater", "pt"], "Did you mean '--integrator'?"),
            (["scene.toml", "--integrator", "vcmm"], "render.integrator"),
            (["scene.toml", "-o", "a.exr", "-o", "./a.exr"], "names the same file twice"),
            (["missing.toml"], "missing.toml"),
            ([], "Missing argument 'SCENE'"),
        ],
    )
    def test_bad_options(self, folder, capsys, arguments, message):
        """The message says what was expected, the exit code is 2, and no file is made."""
        assert main(["render", *arguments]) == 2
        assert message in capsys.readouterr().err
        assert os.listdir(folder) == ["scene.toml"]

    @pytest.mark.parametrize("output", ["missing/a.exr", "a.jpg", "a"])
    def test_outputs_are_checked_before_the_render(self, folder, monkeypatch, capsys, output):
        """Nobody waits hours for a file that cannot be written."""
        monkeypatch.setenv("FAKE_ERROR", "AssertionError")
        assert main(["render", "scene.toml", "-o", output]) == 1
        assert capsys.readouterr().err.startswith(f"{output}: ")
        (folder / "scene.json").mkdir()
        assert main(["render", "scene.toml"]) == 1
        assert "scene.json: is a directory" in capsys.readouterr().err

    def test_bad_scene(self, folder, edit, capsys):
        """All problems, each with its line."""
        edit("radius = 1", "radius = -1\ncolour = 2")
        assert main(["render", "scene.toml"]) == 2
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 2
        assert all(line.startswith("scene.toml:1") for line in lines)

    def test_what_it_says(self, folder, capsys):
        """Progress goes to the error stream; --quiet leaves the warnings."""
        assert main(["render", "scene.toml", "--set", "render.seed=13"]) == 0
        out, err = capsys.readouterr()
        assert out == ""
        assert err.splitlines() == [
            "warning: this is a fake",
            "compiling a fake: about 3 s, once; later runs find it in the cache",
            "compiled in 3.1 s",
            f"rendering: threads {len(os.sched_getaffinity(0))}",
            "iteration 1 of 5, 20.0%, 2.00 M paths/s, noise 0.1 relMSE, 0.5 s, 2.0 s left",
            "warning: 2000 contributions were not finite and were dropped; the .json says where",
            err.splitlines()[-1],
        ]
        assert err.splitlines()[-1] == "5 iterations in 4.5 s; wrote scene.exr, scene.json"
        assert statistics()["rejected"] == [{"x": 1, "y": 2, "iteration": 0}]
        assert statistics()["rejected_count"] == 2000
        assert main(["render", "scene.toml", "--quiet"]) == 0
        assert capsys.readouterr() == ("", "warning: this is a fake\n")

    def test_internal_errors(self, folder, monkeypatch, capsys):
        """A line for users, a traceback for those who ask."""
        monkeypatch.setenv("FAKE_ERROR", "ZeroDivisionError")
        assert main(["render", "scene.toml"]) == 1
        err = capsys.readouterr().err
        assert err.startswith("internal error: ZeroDivisionError: said so\n")
        assert "ARTIST_DEBUG=1" in err
        assert "Traceback" not in err
        monkeypatch.setenv("ARTIST_DEBUG", "1")
        assert main(["render", "scene.toml"]) == 1
        assert "Traceback" in capsys.readouterr().err
        monkeypatch.setenv("FAKE_ERROR", "MemoryError")
        assert main(["render", "scene.toml"]) == 1
        assert capsys.readouterr().err.endswith("out of memory\n")
        monkeypatch.setenv("FAKE_ERROR", "KeyboardInterrupt")
        assert main(["render", "scene.toml"]) == 130
        assert os.listdir(folder) == ["scene.toml"]

    def test_a_snapshot_that_fails_does_not_end_the_render(self, folder, monkeypatch, capsys):
        """The disk may be full now and not later."""
        failures = iter([True, True])

        def write(path, *_arguments):
            if next(failures, False):
                raise OutputError(f"{path}: cannot be written: disk full")
            Path(path).touch()

        monkeypatch.setattr("artist_py.film.output.write_image", write)
        assert main(["render", "scene.toml", "--save-every", "1s"]) == 0
        assert capsys.readouterr().err.count("not written: scene.exr: cannot be written: disk full") == 2
        assert Path("scene.exr").exists()
