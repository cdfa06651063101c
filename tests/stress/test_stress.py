"""The command `artist stress`: what is right is reported as right, and what is wrong as wrong, crashes included.

Fixed seeds; a correct program fails by chance with probability 1e-3 in each run of the command.
"""

import dataclasses
import re

import faults
import numpy as np
import pytest

from artist_py.cli.main import main
from artist_py.errors import SceneError
from artist_py.scene.reader import read_scene_text
from artist_py.stress import cases, runner
from artist_py.stress.case import ALL, Case, Radiance, Refusal
from artist_py.stress.cases import gallery
from artist_py.stress.cases.gallery import gallery_case
from artist_py.stress.measure import BATCHES, Measurement, graph_of, scene_text
from artist_py.stress.own import own_case
from artist_py.stress.scenes import furnace

# As tests/furnace/test_closed_rooms.py has them, so that they share their kernels.
SMALL = furnace(aside=None, film={"resolution": [8, 8]})
RIGHT = Case("right", "A furnace.", SMALL, Radiance(1.0), integrators=("pt",))
FLUORESCENT = ["fluorescent_spheres", "fluorescent_room", "black_light", "cascade", "highlighters"]
TOO_BRIGHT = dataclasses.replace(RIGHT, name="too-bright", expect=Radiance(1.2))


@pytest.fixture
def run(monkeypatch, capsys):
    """Runs the command on these cases; `(exit code, standard output)`."""

    def run(*chosen, options=()):
        monkeypatch.setattr(cases, "CASES", chosen)
        code = main(["stress", *options])
        return code, capsys.readouterr().out

    return run


@pytest.fixture
def faulty():
    """A case that does `what` where it should write a file."""
    return lambda what, **more: dataclasses.replace(
        RIGHT, name=what.__name__, files=(("x", what, ()),), **more
    )


def test_right_and_wrong(run, tmp_path):
    """One row each; the page holds both and needs nothing else."""
    page = tmp_path / "report.html"
    code, out = run(RIGHT, TOO_BRIGHT, options=["-o", str(page)])
    assert code == 1
    assert re.search(r"right .* ok \d\.\d se", out)
    assert re.search(r"too-bright, pt: wrong: (1\.0|0\.9)\d* instead of 1\.2", out)
    assert "1 of 2 cells are wrong" in out
    html = page.read_text(encoding="utf-8")
    assert html.count("data:image/png;base64,") == 2
    assert "too-bright" in html
    assert not re.search(r'(src|href)="(?!data:)', html)


def test_an_interrupted_run_reports_what_it_has(run, tmp_path, monkeypatch):
    page = tmp_path / "report.html"

    def one_cell(chosen, *_):
        yield runner.Cell(chosen[0], "pt", Measurement(means=np.ones((BATCHES, 5))))
        raise KeyboardInterrupt

    monkeypatch.setattr(runner, "run_cells", one_cell)
    code, out = run(RIGHT, dataclasses.replace(RIGHT, name="other"), options=["-o", str(page)])
    assert code == 130
    assert re.search(r"right .* ok .*\n.*other .* not run", out)
    assert "all 1 cells are right, 1 were not run" in out
    assert "not run</td>" in page.read_text(encoding="utf-8")


def test_all_right(run):
    """A refusal that is expected is right too."""
    refused = Case(
        "no", "Nothing.", furnace(render={"max_path_length": 0}), Refusal("max_path_length"), ("vcm",)
    )
    code, out = run(RIGHT, refused)
    assert code == 0
    assert "all 2 cells are right" in out


def test_crashes_hangs_and_errors_do_not_end_it(run, faulty, monkeypatch):
    """Each is told, and the next case is run."""
    monkeypatch.setattr(runner, "COMPILE_SECONDS", 30.0)
    code, out = run(faulty(faults.crash), faulty(faults.fail), faulty(faults.hang, seconds=-25.0), RIGHT)
    assert code == 1
    assert "crash, pt: crashed: signal SIGABRT" in out
    assert "fail, pt: error: ZeroDivisionError: on purpose" in out
    assert "hang, pt: hung: no result after" in out
    assert "3 of 4 cells are wrong" in out


def test_a_scene_that_is_refused_but_should_not_be(run):
    bad = dataclasses.replace(RIGHT, scene=furnace(albedo=1.5, emission=1))
    code, out = run(bad)
    assert code == 1
    assert "refused" in out and "0 <= reflectance <= 1" in out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--only", "nothing-like-that"], "nothing-like-that"),
        (["--integrator", "mlt"], "expected one of pt"),
        (["-o", "report.pdf"], "ends in .html"),
    ],
)
def test_bad_options(options, message, capsys):
    assert main(["stress", *options]) == 2
    assert message in capsys.readouterr().err


def test_scenes_of_files(capsys, tmp_path):
    """They are cases of their own, and bad ones are refused as by every other command."""
    scene = tmp_path / "own.toml"
    scene.write_text(scene_text(RIGHT, "vcm", 1))
    assert main(["stress", str(scene), "--list"]) == 0
    assert capsys.readouterr().out == f"{scene}: A scene of your own, in few pixels. Expected: as vcm.\n"
    scene.write_text(scene_text(dataclasses.replace(RIGHT, scene=furnace(albedo=2)), "vcm", 1))
    assert main(["stress", str(scene)]) == 2
    assert "own.toml" in capsys.readouterr().err


def test_own_scenes_are_rendered_small(tmp_path):
    """In their own shape; photon mapping gets more photons."""
    scene = tmp_path / "own.toml"
    film = {"resolution": [640, 400], "crop": [600, 640, 0, 9]}
    scene.write_text(scene_text(dataclasses.replace(RIGHT, scene=furnace(film=film)), "vcm", 1))
    case = own_case(scene)
    pt, ppm = (graph_of(case, integrator, 1, tmp_path) for integrator in ("pt", "ppm"))
    assert pt.film.resolution == ppm.film.resolution == (16, 10)
    assert pt.film.crop == (0, 16, 0, 10)
    assert (pt.render.integrator, ppm.render.integrator) == ("pt", "ppm")
    assert pt.render.seed != ppm.render.seed
    assert (pt.render.merging.light_paths, ppm.render.merging.light_paths) == (4, 64)


def test_scenes_that_are_not_installed_are_said_to_be_left_out(run, tmp_path):
    """Without the folder of scenes nothing is rendered, and nothing is silent."""
    absent = gallery_case("cascade", "Two dyes.", tmp_path)
    code, out = run(RIGHT, absent)
    assert code == 0
    assert f"cascade: left out: {tmp_path / 'cascade.toml'} is not there" in out
    assert "all 1 cells are right" in out
    code, out = run(absent)
    assert code == 1
    assert "left out" in out


def test_scenes_of_the_gallery_are_rendered_small(tmp_path):
    """By all integrators, at all of the sets of wavelengths that they have by default."""
    assert [case.name for case in gallery.CASES] == FLUORESCENT
    for case in gallery.CASES:
        assert case.quick and case.integrators == ALL
        graph = graph_of(case, "vcm", 1, tmp_path)
        assert max(graph.film.resolution) == 16
        assert graph.render.wavelength_sets is None


def test_list(capsys):
    """Everything is in the full list, and most in the quick one."""
    assert main(["stress", "--list", "--full"]) == 0
    full = capsys.readouterr().out
    assert main(["stress", "--list"]) == 0
    quick = capsys.readouterr().out
    assert "triangles-1e7: " in full
    assert "triangles-1e7: " not in quick
    assert len(quick.splitlines()) > 80


def test_cases_are_well_formed(tmp_path):
    """Names are unique, biases have reasons, and of the quick ones only what must be refused is."""
    names = [case.name for case in cases.CASES]
    assert len(set(names)) == len(names)
    for case in cases.CASES:
        assert case.integrators, case.name
        assert case.why or not (getattr(case.expect, "bias", {}) or str(case.expect).startswith("finite")), (
            case.name
        )
        assert set(case.left_out) <= set(ALL), case.name
        if case.quick and not isinstance(case.expect, Refusal):
            graph_of(case, case.integrators[0], 1, tmp_path)


def test_refused_scenes_are_refused_for_the_reason_given():
    """Those that reading alone shows; the others are about files."""
    refused = [case for case in cases.CASES if isinstance(case.expect, Refusal) and not case.files]
    assert len(refused) > 5
    for case in refused:
        with pytest.raises(SceneError, match=case.expect.text):
            read_scene_text(scene_text(case, "vcm", 1), case.name)
