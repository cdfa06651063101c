"""`artist compare`: several runs in one table."""

import csv
from pathlib import Path

import pytest

from artist_py.cli.main import main
from artist_py.evidence.convergence import Convergence, Row
from artist_py.evidence.entries import Entry
from artist_py.evidence.files import write_ablation, write_json
from artist_py.evidence.joining import join, read_runs
from artist_py.evidence.reference import Reference

ABOUT = {"picture": {"scene": "abc"}, "threads": 2, "processor": "x", "processors": 2}


def row(entry, repeat, mark, relmse, own, iterations, below=False):
    """A row with the figures that matter here."""
    return Row(
        entry,
        repeat,
        repeat,
        mark,
        mark,
        2 * mark,
        iterations,
        1,
        1,
        1,
        1,
        1,
        relmse,
        own,
        0.5,
        None,
        below,
        0,
    )


def write(folder, *rows, scene="scenes/room.toml", **about):
    """A run in `folder`/convergence.json."""
    Path(folder).mkdir(exist_ok=True)
    entries = [Entry(name, name, ()) for name in dict.fromkeys(row.entry for row in rows)]
    run = Convergence(
        scene, entries, "wall", [1.0, 2.0], Reference(None, None, {}, 0.01, 0.1), ABOUT | about, list(rows)
    )
    write_json(Path(folder) / "convergence.json", run)
    return f"{folder}/convergence.json"


@pytest.fixture
def runs(tmp_path, monkeypatch):
    """Paths of a run before a change and one after it, which is twice as fast."""
    monkeypatch.chdir(tmp_path)
    before = write(
        "before",
        *(
            row("pt", i, m, (0.4 + 0.02 * i) / m + 0.01, (0.4 + 0.02 * i) / m, 10 * m)
            for i in range(3)
            for m in (1, 2)
        ),
        row("bpt", 0, 1.0, 0.011, 0.001, 5, below=True),
    )
    after = write(
        "after",
        *(
            row("pt", i, m, (0.2 + 0.01 * i) / m + 0.01, (0.2 + 0.01 * i) / m, 20 * m)
            for i in range(3)
            for m in (1, 2)
        ),
        row("bpt", 0, 1.0, 0.02, 0.01, 5),
        row("vcm", 0, 1.0, 0.3, 0.29, 5),
    )
    return before, after


def table(capsys):
    """Lines of the printed table, as lists of words."""
    return [line.split() for line in capsys.readouterr().out.splitlines()]


def test_before_and_after(runs, capsys):
    """Errors of both, their ratio without the reference's part, its range, and the ratio of speeds."""
    assert main(["compare", *runs, "-o", "table.csv"]) == 0
    lines = table(capsys)
    assert lines[1] == ["room", "pt", "1", "0.43", "0.22", "0.5", "x", "0.467", "to", "0.561", "2", "x"]
    with open("table.csv", newline="") as stream:
        header, first, *_ = csv.reader(stream)
    assert header[3:6] == ["relmse before", "relmse after", "after / before"]
    assert first[:6] == ["room", "pt", "1", "0.43", "0.22", "0.5 x"]


def test_what_only_one_has_or_is_below(runs, capsys):
    """No ratio of what is not known."""
    main(["compare", *runs])
    lines = {(line[1], line[2]): line for line in table(capsys)[1:]}
    assert lines["bpt", "1"][3:6] == ["0.011", "*", "0.02"]
    assert lines["bpt", "1"][6:8] == ["1.82", "to"]
    assert lines["vcm", "1"] == ["room", "vcm", "1", "-", "0.3"]


def test_one_run(runs, capsys):
    """Its own table."""
    assert main(["compare", runs[0], "--metric", "smape"]) == 0
    lines = table(capsys)
    assert lines[0] == ["scene", "entry", "at", "smape", "before"]
    assert lines[1] == ["room", "pt", "1", "0.5"]


def test_warnings(runs, capsys):
    """Runs that do not compare, and what is no run of its own."""
    other = write("other", row("pt", 0, 1.0, 0.1, 0.1, 5), picture={"scene": "def"}, threads=1)
    write_ablation(Path("other"), "room.toml", {}, [row("pt", 0, 1.0, 0.1, 0.1, 5)])
    assert main(["compare", runs[0], other, "other/ablation.json"]) == 0
    err = capsys.readouterr().err
    assert "before and other have other pictures of room: their errors do not compare" in err
    assert "before and other differ in threads: their seconds do not compare" in err
    assert "other/ablation.json: holds what --ablate measured" in err


def test_names(runs):
    """Folders, or whole paths where those are the same."""
    assert list(read_runs(runs)[0]) == ["before", "after"]
    Path("x").mkdir()
    again = write("x/before", row("pt", 0, 1.0, 0.1, 0.1, 5))
    found, _ = read_runs([runs[0], again])
    assert list(found) == [runs[0], again]
    assert len(join(found)) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "a.json: cannot be read"),
        ("{}", "a.json: is not what artist converge writes"),
        ("x", "a.json: is not"),
    ],
)
def test_errors(tmp_path, monkeypatch, capsys, text, message):
    """The message names the file; the exit code is 2."""
    monkeypatch.chdir(tmp_path)
    if text is not None:
        Path("a.json").write_text(text)
    assert main(["compare", "a.json"]) == 2
    assert message in capsys.readouterr().err
