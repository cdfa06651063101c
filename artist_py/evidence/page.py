"""One HTML file that shows a whole comparison, and asks nobody else for anything."""

import base64
import json
import tempfile
from html import escape
from pathlib import Path
from string import Template

import numpy as np

from artist_py.compare.flip import flip_map
from artist_py.compare.heat import DECADES, RAMP, heat_colors, heat_range
from artist_py.compare.metrics import relative_squared_error
from artist_py.errors import OptionError
from artist_py.evidence.plots import COLORS, inline_svg
from artist_py.evidence.statistics import clock_of, slopes, speed_up, summary
from artist_py.evidence.words import (
    band_text,
    figures,
    mean_text,
    memory,
    notes,
    slope_text,
    subtitle,
    time_text,
)
from artist_py.film.color import decode_srgb
from artist_py.film.output import write_display
from artist_py.film.replacing import replacing
from artist_py.film.tonemap import ToneMapping, automatic_exposure

TEMPLATE = Path(__file__).with_name("page.html")
PIXELS_SHOWN = 6_000_000  # of all images together: a page stays below about 20 MB


def write_page(path, convergence, exposure=0.0, flip=flip_map):
    """Write the page; returns warnings. `exposure` in stops, or "auto" by the reference. OutputError, OptionError."""
    pictures = Pictures(convergence, exposure, flip)
    text = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(_fields(convergence, pictures))
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return pictures.warnings


class Pictures:
    """The images of a page, by name, as data URLs; and what is said below them."""

    def __init__(self, convergence, exposure, flip):
        self.convergence, self.warnings, self.flip = convergence, [], {}
        reference = convergence.reference.rgb
        stops = automatic_exposure(reference) if exposure == "auto" else exposure
        self.mapping = ToneMapping(exposure=stops)
        self.urls, self.captions = {"ref": self._shown(reference)}, {}
        self.marks = self._marks_that_fit()
        self.errors = self._errors()
        self.range = heat_range(np.concatenate([each.ravel() for each in self.errors.values()]), "relmse")
        for number, entry in enumerate(convergence.entries):
            self._add_images(number, entry.label)
            self._add_maps(number, entry.label, flip)

    def last_mark(self, label):
        """The last mark that an entry has an image of; None if there is none."""
        return max((mark for name, mark in self.convergence.images if name == label), default=None)

    def _marks_that_fit(self):
        """The last marks, as many as fit into the page."""
        run = self.convergence
        per_mark = run.reference.rgb[..., 0].size * len(run.entries)
        marks = sorted({mark for _, mark in run.images})
        return marks[-max(1, PIXELS_SHOWN // max(per_mark, 1)) :]

    def _errors(self):
        """Relative squared error of each pixel at the last mark, by entry."""
        run, errors = self.convergence, {}
        for entry in run.entries:
            mark = self.last_mark(entry.label)
            if mark is not None:
                image = run.images[entry.label, mark]
                errors[entry.label] = relative_squared_error(image, run.reference.rgb).mean(axis=2)
        return errors

    def _add_images(self, number, label):
        for row in self.convergence.rows_of(label):
            if row.repeat == 0 and row.mark in self.marks:
                place = f"{number}/{row.mark:g}"
                self.urls[f"image/{place}"] = self._shown(self.convergence.images[label, row.mark])
                seconds = time_text(row, self.convergence.axis)
                self.captions[place] = f"{seconds}, {row.iterations} iterations, relMSE {figures(row.relmse)}"

    def _add_maps(self, number, label, flip):
        if label not in self.errors:
            return
        low, high, is_logarithmic = self.range
        colors = heat_colors(self.errors[label], low, high, is_logarithmic=is_logarithmic)
        self.urls[f"error/{number}"] = _png(decode_srgb(colors), ToneMapping())
        mark = self.last_mark(label)
        self.captions[str(number)] = self.captions[f"{number}/{mark:g}"]
        errors = self._flip(self.convergence.images[label, mark], flip)
        if errors is not None:
            self.flip[label] = float(errors.mean())
            self.captions[str(number)] += f", FLIP {figures(self.flip[label])}"
            colors = heat_colors(errors, 0.0, 1.0, is_logarithmic=False)
            self.urls[f"flip/{number}"] = _png(decode_srgb(colors), ToneMapping())

    def _flip(self, image, flip):
        """FLIP over the exposures that it chooses by the reference; None, and a warning, without an evaluator."""
        try:
            return flip(image, self.convergence.reference.rgb)
        except OptionError as error:
            if str(error) not in self.warnings:
                self.warnings.append(str(error))
            return None

    def _shown(self, rgb):
        return _png(rgb, self.mapping)


def _png(rgb, mapping):
    """A PNG as a data URL."""
    with tempfile.TemporaryDirectory(prefix="artist-page-") as folder:
        path = Path(folder) / "image.png"
        write_display(path, np.asarray(rgb, float), mapping)
        return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")


def _fields(convergence, pictures):
    name = Path(convergence.scene).stem
    low, high, _ = pictures.range
    layers = [["image", "images"], ["error", "relative squared error, at the end"]]
    if pictures.flip:
        layers.append(["flip", "FLIP, at the end"])
    height, width = convergence.reference.rgb.shape[:2]
    data = {
        "entries": [entry.label for entry in convergence.entries],
        "marks": [float(f"{mark:g}") for mark in pictures.marks],
        "unit": "" if convergence.axis == "iterations" else " s",
        "layers": layers,
        "width": width,
        "height": height,
        "pictures": pictures.urls,
        "captions": pictures.captions,
    }
    return {
        "title": escape(f"{name}: error against time"),
        "heading": escape(name),
        "subtitle": escape(subtitle(convergence)),
        "notes": "".join(f"<p>{escape(note)}</p>" for note in notes(convergence)),
        "plot": inline_svg(convergence),
        "reading": escape(band_text(convergence)),
        "last_table": _last_table(convergence, pictures),
        "full_table": _full_table(convergence),
        "maps": _maps(convergence, pictures),
        "maps_note": escape(_maps_note(pictures)),
        "flip_scale": '<span style="margin-left:24px">FLIP</span><span>0</span><span class="ramp"></span><span>1</span>'
        if pictures.flip
        else "",
        "ramp": ", ".join(f"rgb({r}, {g}, {b})" for r, g, b in RAMP.tolist()),
        "heat_low": figures(low),
        "heat_high": figures(high),
        "data": json.dumps(data).replace("<", "\\u003c"),
    }


def _maps_note(pictures):
    text = (
        f"Of the first repeat, at the last time. The error map covers {DECADES} decades; both scales are the same for "
        "all."
    )
    return text if pictures.flip else f"{text} FLIP was not measured: {'; '.join(pictures.warnings)}."


def _maps(convergence, pictures):
    figures_ = []
    for number, entry in enumerate(convergence.entries):
        for kind, words in (("image", ""), ("error", "relative squared error"), ("flip", "FLIP")):
            mark = pictures.last_mark(entry.label)
            name = f"image/{number}/{mark:g}" if kind == "image" and mark is not None else f"{kind}/{number}"
            if name in pictures.urls:
                caption = f"{entry.label}: {words or pictures.captions[str(number)]}"
                figures_.append(
                    f'<figure><img data-picture="{name}" alt="{escape(caption)}"><figcaption>{escape(caption)}'
                    "</figcaption></figure>"
                )
            else:
                figures_.append("<span></span>")
    return "".join(figures_)


def _table(header, lines):
    """HTML of a table; cells are HTML."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in line) + "</tr>" for line in lines)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _key(convergence, label):
    index = [entry.label for entry in convergence.entries].index(label)
    return f'<span class="key" style="background:{COLORS[index % len(COLORS)]}"></span>{escape(label)}'


def _last_table(convergence, pictures):
    cells, fits = summary(convergence), slopes(convergence)
    base = convergence.entries[0].label
    clock = clock_of(convergence.axis)
    seconds = "CPU seconds" if clock == "cpu_seconds" else "seconds"
    header = ["", seconds, "iterations", "relMSE", "sMAPE", "FLIP", "mean", "slope", f"speed against {base}",
              "Mrays/s", "memory"]  # fmt: skip
    lines = []
    for entry in convergence.entries:
        own = [cell for cell in cells if cell["entry"] == entry.label]
        if own:
            cell, flip = own[-1], pictures.flip.get(entry.label)
            ratio = speed_up(cells, entry.label, base, convergence.axis)
            lines.append([
                _key(convergence, entry.label),
                figures(cell[clock]),
                figures(cell["iterations"]),
                _error(cell, "relmse"),
                _error(cell, "smape"),
                "" if flip is None else figures(flip),
                _mean(cell),
                escape(slope_text(fits[entry.label]["relmse"])),
                "" if ratio is None else f"{figures(ratio)} x",
                figures(cell["rays"] / cell[clock] / 1e6),
                memory(cell["render_memory_bytes"]),
            ])  # fmt: skip
    return _table(header, lines)


def _error(cell, metric):
    star = " *" if cell["is_below_reference"] else ""
    text = f"{figures(cell[metric])}{star}"
    if cell["repeats"] > 1:
        text += f" <small>{figures(cell[f'{metric}_low'])} to {figures(cell[f'{metric}_high'])}</small>"
    return text


def _mean(cell):
    text = mean_text(cell)
    if text and cell["repeats"] > 1:
        text += " <small>{:.4f} to {:.4f}</small>".format(*cell["mean_ratio"][1:])
    return text


def _full_table(convergence):
    header = ["", "to reach", "seconds", "CPU seconds", "iterations", "relMSE", "without the reference's", "sMAPE",
              "million rays", "memory"]  # fmt: skip
    lines = [
        [
            _key(convergence, cell["entry"]),
            figures(cell["mark"]),
            figures(cell["wall_seconds"]),
            figures(cell["cpu_seconds"]),
            figures(cell["iterations"]),
            _error(cell, "relmse"),
            "" if cell["own_relmse"] is None else figures(cell["own_relmse"]),
            _error(cell, "smape"),
            figures(cell["rays"] / 1e6),
            memory(cell["render_memory_bytes"]),
        ]
        for cell in summary(convergence)
    ]
    return _table(header, lines)
