"""What a run of `artist converge` leaves behind: CSV, JSON and images."""

import csv
import json
from pathlib import Path

import numpy as np

from artist_py.errors import OptionError, OutputError
from artist_py.evidence.convergence import VERSION, Convergence, Row
from artist_py.evidence.entries import Entry
from artist_py.evidence.reference import Reference
from artist_py.evidence.statistics import slopes, summary
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image
from artist_py.film.replacing import replacing
from artist_py.film.sidecar import write_sidecar

KIND = "artist converge"
ABLATION_KIND = "artist converge --ablate"


def prepare_folder(path):
    """Make a folder for results, with its subfolder; OutputError if that cannot be."""
    path = Path(path)
    try:
        (path / "images").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: cannot be made: {error.strerror}") from error
    return path


def write_csv(path, convergence):
    """One line per look at a render."""
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(Row._fields)
        writer.writerows(convergence.rows)


def write_json(path, convergence):
    """Everything but images."""
    content = {
        "kind": KIND,
        "version": VERSION,
        "scene": convergence.scene,
        "about": convergence.about,
        "axis": convergence.axis,
        "marks": convergence.marks,
        "is_interrupted": convergence.is_interrupted,
        "reference": convergence.reference.summary(),
        "entries": [
            {
                "label": entry.label,
                "integrator": entry.integrator,
                "settings": dict(entry.settings),
                "compile_seconds": convergence.compile_seconds.get(entry.label),
                "slopes": _plain_slopes(slopes(convergence)[entry.label]),
            }
            for entry in convergence.entries
        ],
        "summary": summary(convergence),
        "rows": [row._asdict() for row in convergence.rows],
    }
    write_sidecar(path, content)


def _plain_slopes(metrics):
    return {name: slope and slope._asdict() for name, slope in metrics.items()}


def read_json(path):
    """The `Convergence` in a file, without images and without the reference's; OptionError if it holds none."""
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise OptionError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError:
        content = None
    if not isinstance(content, dict) or (content.get("kind"), content.get("version")) != (KIND, VERSION):
        raise OptionError(f"{path}: is not what artist converge writes (version {VERSION})")
    try:
        return _convergence(content)
    except (TypeError, KeyError, AttributeError) as error:
        raise OptionError(f"{path}: is not what artist converge writes: {error}") from None


def _convergence(content):
    rows = [Row(**row) for row in content["rows"]]
    entries = [
        Entry(each["label"], each["integrator"], tuple(each["settings"].items()))
        for each in content["entries"]
    ]
    known = content["reference"]
    reference = Reference(None, None, known, known["relmse"], known["smape"])
    return Convergence(
        content["scene"],
        entries,
        content["axis"],
        content["marks"],
        reference,
        content["about"],
        rows,
        {each["label"]: each["compile_seconds"] for each in content["entries"]},
        is_interrupted=content["is_interrupted"],
    )


def write_ablation(folder, scene, about, costs):
    """Write ablation.csv and ablation.json."""
    with (
        replacing(folder / "ablation.csv") as temporary,
        temporary.open("w", newline="", encoding="utf-8") as stream,
    ):
        writer = csv.writer(stream)
        writer.writerow(costs[0]._fields)
        writer.writerows(costs)
    content = {"kind": ABLATION_KIND, "version": VERSION, "scene": str(scene), "about": about}
    write_sidecar(folder / "ablation.json", {**content, "costs": [cost._asdict() for cost in costs]})


def write_images(folder, convergence):
    """The first repeat of each entry at each mark, and the reference, as EXRs."""
    for (label, mark), rgb in convergence.images.items():
        write_image(
            folder / "images" / f"{file_name(label)}_{mark:g}.exr", FilmImage(np.asarray(rgb, float), 1)
        )


def file_name(label):
    """`label` as part of a file's name."""
    return "".join(character if character.isalnum() or character in "-._=" else "_" for character in label)
