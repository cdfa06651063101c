"""`artist converge`: options, files, messages. Times are as short as can be, and nothing depends on them."""

import json
import os
import signal
import sys
from pathlib import Path

import pytest
from room import write_room

from artist_py.cli.main import main
from artist_py.evidence import ablation, reference
from artist_py.film.reading import read_image

SHORT = ["--times", "0.02,0.04", "--make-reference", "0.05", "--threads", "1"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with `room.toml`, where references are cached too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(reference, "cache_root", lambda: tmp_path / "cache")
    write_room(tmp_path)
    return tmp_path


def converge(*arguments):
    """The exit code."""
    return main(["converge", "room.toml", "-o", "out", *SHORT, *arguments])


def test_files(here, capsys):
    """What is written, and that settings of all and of one reach the renders."""
    options = (
        "--integrators pt,pt:hero_count=1 --repeat 2 --set render.seed=5 --size 8x6 --reference-integrator pt"
    )
    assert converge(*options.split()) == 0
    assert set(os.listdir("out")) == {
        "convergence.csv", "convergence.json", "images", "index.html", "plot.png", "plot.svg", "reference.exr"
    }  # fmt: skip
    content = json.loads(Path("out/convergence.json").read_text())
    assert {row["entry"] for row in content["rows"]} == {"pt", "pt:hero_count=1"}
    assert {row["seed"] for row in content["rows"]} == {5, 6}
    assert (content["about"]["width"], content["about"]["height"]) == (8, 6)
    assert content["reference"]["integrators"] == ["pt"]
    assert content["reference"]["relmse"] > 0
    assert read_image("out/reference.exr").layer("variance").shape == (6, 8, 3)
    out, err = capsys.readouterr()
    assert "relMSE after" in out
    assert "Reference: pt" in out
    assert "pt:hero_count=1, repeat 2 of 2" in err
    assert "reference by pt: 100%" in err


def test_without_matplotlib(here, monkeypatch, capsys):
    """What is measured is kept and printed; the warning says what is missing and how to get it."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert converge("--integrators", "pt", "--repeat", "1", "--reference-integrator", "pt") == 0
    assert "warning: plots: matplotlib is not installed" in capsys.readouterr().err
    assert Path("out/convergence.json").exists()
    assert not Path("out/plot.png").exists()


def test_ablate(here, monkeypatch, capsys):
    """A lens forced in, by iterations that take turns; no reference is made for it."""
    monkeypatch.setattr(ablation, "FEATURES", ("lens",))
    assert converge("--ablate", "--skip-compile-times", "--integrators", "pt") == 0
    assert "forced in" in capsys.readouterr().out
    assert {"ablation.csv", "ablation.json"} < set(os.listdir("out"))
    assert not Path("out/reference.exr").exists()


def test_interrupted(here, monkeypatch, capsys):
    """A signal while the reference is made: 130, and nothing is made of too little."""
    monkeypatch.setattr(reference, "render_batches", lambda *_: os.kill(os.getpid(), signal.SIGINT))
    assert converge("--integrators", "pt") == 130
    assert "the reference by bpt was interrupted" in capsys.readouterr().err


def test_given_reference(here):
    """It is used, nothing is rendered for one, and its error goes along."""
    assert converge("--integrators", "pt", "--repeat", "1", "--reference-integrator", "pt") == 0
    made = json.loads(Path("out/convergence.json").read_text())["reference"]
    Path("out/reference.exr").rename("mine.exr")
    arguments = [
        "converge",
        "room.toml",
        "-o",
        "b",
        "--times",
        "0.02",
        "--repeat",
        "1",
        "--integrators",
        "pt",
    ]
    assert main([*arguments, "--reference", "mine.exr", "-q"]) == 0
    given = json.loads(Path("b/convergence.json").read_text())["reference"]
    assert given["file"] == "mine.exr"
    assert given["relmse"] == pytest.approx(made["relmse"], rel=1e-4)
    assert not Path("b/reference.exr").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--integrators", "pt,vcmm"], "render.integrator"),
        (["--integrators", "pt:hero_count"], "is not NAME:KEY=VALUE"),
        (["--integrators", "pt:hero_cuont=4"], 'did you mean "hero_count"?'),
        (["--integrators", "pt,pt:max_path_length=2"], "render other pictures (max_path_length differs)"),
        (["--times", "1,soon"], "'soon' is not a duration"),
        (["--reference", "a.exr"], "--reference and --make-reference exclude each other"),
        (["--repeat", "0"], "0 is not in the range x>=1"),
        (["-o", "room.toml/out"], "room.toml/out: cannot be made"),
    ],
)
def test_bad_options(here, capsys, arguments, message):
    """The message says what is wrong, before anything is rendered."""
    assert converge(*arguments) in {1, 2}
    assert message in capsys.readouterr().err
    assert not Path("out/convergence.json").exists()
