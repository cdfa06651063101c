"""Whole comparisons of a small room, by iterations, so that they come out the same every time."""

import csv
import json
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from room import write_room

import artist_py
from artist_py.compare.metrics import relmse, smape
from artist_py.errors import OptionError
from artist_py.evidence.convergence import Row, compile_entries, converge
from artist_py.evidence.entries import parse_entries
from artist_py.evidence.files import file_name, prepare_folder, read_json, write_csv, write_images, write_json
from artist_py.evidence.reference import Reference
from artist_py.film.reading import read_image

MARKS = [8, 32, 128]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Path tracing with and without early roulette, twice, to 128 iterations."""
    scene = write_room(tmp_path_factory.mktemp("run"))
    entries = parse_entries("pt,pt:roulette_length=1")
    compiled = compile_entries(scene, entries, (), 1)
    exact = artist_py.render(compiled["pt"], iterations=3000, aovs=("variance",)).film
    reference = Reference(exact.rgb, exact.variance, {"file": "exact"})
    return converge(scene, entries, reference, compiled=compiled, marks=MARKS, axis="iterations", repeats=2)


def test_rows(run):
    """Each entry, repeat and mark once, in turns, with seeds of their own; errors are those of the renders."""
    order = [(row.repeat, row.entry, row.mark) for row in run.rows]
    assert order == [(r, e.label, m) for r in (0, 1) for e in run.entries for m in MARKS]
    assert {row.seed for row in run.rows if row.repeat == 1} == {8}
    scene = artist_py.load_scene(run.scene, {"render.seed": 8, "render.roulette_length": 1})
    film = artist_py.render(scene, iterations=8, threads=2).film
    [row] = [row for row in run.rows if (row.repeat, row.entry, row.mark) == (1, "pt:roulette_length=1", 8)]
    assert row.relmse == relmse(film.rgb, run.reference.rgb)
    assert row.smape == smape(film.rgb, run.reference.rgb)
    assert row.own_relmse == pytest.approx(row.relmse - run.reference.relmse)
    assert row.iterations == row.along("iterations") == 8
    assert row.paths == 8 * 120
    assert row.rays > row.paths
    assert row.rejected == 0
    assert row.mean_ratio == pytest.approx(film.rgb.mean() / run.reference.rgb.mean())


def test_errors_fall(run):
    """As one over the iterations, about: sixteen times as many, between a fourth and a sixtieth of the error."""
    for label in ("pt", "pt:roulette_length=1"):
        first, *_, last = (row.own_relmse for row in run.rows_of(label) if row.repeat == 0)
        assert 4 < first / last < 60


def test_own_estimates_agree(run):
    """What the film says of its noise is what the reference shows, within a factor that so few pixels allow."""
    for row in run.rows:
        assert row.mark < MARKS[-1] or 0.3 < row.noise / row.own_relmse < 3


def test_files(run, tmp_path):
    """CSV, JSON and images hold what was measured, and the JSON can be read again."""
    folder = prepare_folder(tmp_path / "out")
    write_csv(folder / "run.csv", run)
    write_json(folder / "run.json", run)
    write_images(folder, run)
    with (folder / "run.csv").open(newline="") as stream:
        header, *lines = csv.reader(stream)
    assert tuple(header) == Row._fields
    assert [line[0] for line in lines] == [row.entry for row in run.rows]
    assert float(lines[3][header.index("relmse")]) == run.rows[3].relmse
    content = json.loads((folder / "run.json").read_text())
    assert len(content["summary"]) == 6
    assert content["entries"][0]["slopes"]["relmse"]["median"] < 0
    assert content["about"]["picture"]["max_path_length"] == 4
    again = read_json(folder / "run.json")
    assert again.rows == run.rows
    assert again.entries == run.entries
    assert again.reference.relmse == run.reference.relmse
    image = read_image(folder / "images" / "pt_roulette_length=1_128.exr")
    assert np.array_equal(image.rgb, run.images["pt:roulette_length=1", 128])
    assert file_name("a:b/c d") == "a_b_c_d"


def test_what_is_no_run(tmp_path):
    """The message names the file."""
    for text in ("", "{}", "[]", '{"kind": "artist converge", "version": 1, "rows": [{}], "entries": []}'):
        (tmp_path / "x.json").write_text(text)
        with pytest.raises(OptionError, match=r"x\.json: is not what artist converge"):
            read_json(tmp_path / "x.json")
    with pytest.raises(OptionError, match="missing.json: cannot be read"):
        read_json(tmp_path / "missing.json")


def test_interrupted(run):
    """What there is stays, and says so."""
    stop, compiled = threading.Event(), compile_entries(run.scene, run.entries, (), 1)
    observer = SimpleNamespace(note=lambda text: " 32 iterations" in text and stop.set())
    observer.compiling = observer.compiled = observer.warning = lambda *_: None
    part = converge(
        run.scene, run.entries, run.reference, compiled=compiled, marks=MARKS, axis="iterations", stop=stop,
        observer=observer,
    )  # fmt: skip
    assert part.is_interrupted
    assert [row.mark for row in part.rows] == [8, 32]
    assert part.rows[0].relmse == run.rows[0].relmse
