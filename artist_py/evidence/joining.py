"""Several runs of `artist converge` in one table, such as before and after a change."""

import json
from pathlib import Path
from typing import NamedTuple

from artist_py.errors import OptionError
from artist_py.evidence.files import ABLATION_KIND, read_json
from artist_py.evidence.statistics import clock_of, summary
from artist_py.evidence.words import figures

SAME = ("threads", "processor", "processors")  # what seconds depend on besides the renderer


class Cell(NamedTuple):
    """What one run says of an entry at a mark."""

    error: float
    low: float
    high: float
    own: float | None  # relMSE without the reference's; the sMAPE as it is
    iterations_per_second: float
    is_below_reference: bool


class Line(NamedTuple):
    """An entry of a scene at a mark, in all runs; a cell is None where a run does not have it."""

    scene: str
    entry: str
    mark: float
    cells: tuple

    def ratio(self):
        """Error of the last run over that of the first, both without their references'; None if one is not known."""
        first, last = self.cells[0], self.cells[-1]
        if not _are_known(first, last):
            return None
        return last.own / first.own

    def ratio_range(self):
        """`(low, high)` that the repeats allow for the ratio of the errors as measured."""
        first, last = self.cells[0], self.cells[-1]
        return (last.low / first.high, last.high / first.low) if first and last else None

    def speed(self):
        """Iterations per second of the last run over those of the first."""
        first, last = self.cells[0], self.cells[-1]
        return last.iterations_per_second / first.iterations_per_second if first and last else None


def _are_known(*cells):
    return all(cell and cell.own and not cell.is_below_reference for cell in cells)


def read_runs(paths):
    """`({name: Convergence}, notes)` of JSON files; names tell them apart. OptionError for what is no run."""
    paths = [Path(path) for path in paths]
    left_out = [path for path in paths if _is_ablation(path)]
    rest = [path for path in paths if path not in left_out]
    if not rest:
        raise OptionError("no run of artist converge among these files")
    notes = [f"{path}: holds what --ablate measured, and is left out" for path in left_out]
    return {_name(path, rest): read_json(path) for path in rest}, notes


def _is_ablation(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))["kind"] == ABLATION_KIND
    except (OSError, ValueError, TypeError, KeyError):
        return False  # read_json says what is wrong


def _name(path, paths):
    """The name of the folder, where that is enough."""
    folders = [each.resolve().parent.name for each in paths]
    return path.resolve().parent.name if folders.count(path.resolve().parent.name) == 1 else str(path)


def join(runs, metric="relmse"):
    """A list of `Line`, in the order of scenes, entries and marks as they come first."""
    found = {}
    for number, run in enumerate(runs.values()):
        for cell in summary(run):
            place = _scene_of(run), cell["entry"], cell["mark"]
            cells = found.setdefault(place, [None] * len(runs))
            cells[number] = _cell(cell, metric, clock_of(run.axis))
    return [Line(scene, entry, mark, tuple(cells)) for (scene, entry, mark), cells in found.items()]


def _scene_of(run):
    return Path(run.scene).stem


def _cell(cell, metric, clock):
    own = cell["own_relmse"] if metric == "relmse" else cell["smape"]
    return Cell(
        cell[metric],
        cell[f"{metric}_low"],
        cell[f"{metric}_high"],
        own,
        cell["iterations"] / max(cell[clock], 1e-12),
        cell["is_below_reference"],
    )


def warnings(runs):
    """What makes a comparison unfair: other pictures of the same scene, other machines, threads or axes."""
    first_name, first = next(iter(runs.items()))
    for name, run in runs.items():
        for other_name, other in runs.items():
            if other_name == name:
                break
            if _scene_of(run) == _scene_of(other) and run.about["picture"] != other.about["picture"]:
                yield f"{other_name} and {name} have other pictures of {_scene_of(run)}: their errors do not compare"
        different = [key for key in SAME if run.about.get(key) != first.about.get(key)]
        different += ["axis"] if run.axis != first.axis else []
        if different:
            yield f"{first_name} and {name} differ in {', '.join(different)}: their seconds do not compare"


def joined_table(runs, lines, metric="relmse"):
    """`(header, lines)` of texts: errors of all runs, and the last against the first."""
    names = list(runs)
    header = ["scene", "entry", "at", *(f"{metric} {name}" for name in names)]
    if len(names) > 1:
        header += [f"{names[-1]} / {names[0]}", "range", "iterations/s"]
    return header, [_texts(line, len(names) > 1) for line in lines]


def _texts(line, has_ratio):
    texts = [line.scene, line.entry, f"{line.mark:g}", *(_error(cell) for cell in line.cells)]
    if has_ratio:
        ratio, bounds, speed = line.ratio(), line.ratio_range(), line.speed()
        texts += [
            "" if ratio is None else f"{figures(ratio)} x",
            "" if bounds is None else f"{figures(bounds[0])} to {figures(bounds[1])}",
            "" if speed is None else f"{figures(speed)} x",
        ]
    return texts


def _error(cell):
    if cell is None:
        return "-"
    return figures(cell.error) + (" *" if cell.is_below_reference else "")
