"""Contact sheets of techniques: a row per path length, a column per technique, as a pyramid (Veach 1997, fig. 10.5)."""

import math
from typing import Any, NamedTuple

import numpy as np

from artist_py.film.color import RGB_TO_XYZ, expose
from artist_py.film.tonemap import automatic_exposure

WIDTH = 136  # of an image on the sheet, pixels
GAP = 8  # around it, pixels
LINE = 16  # height of a line of text, pixels
FONT = 12  # its size, pixels
BACKGROUND, TEXT = 0.012, (0.6, 0.6, 0.6)
BRIGHT = 98  # percentile of the sum of a row that becomes white


class Cell(NamedTuple):
    """An image on the sheet, linear RGB (h, w, 3), and the text below it."""

    image: Any
    text: str


class Row(NamedTuple):
    """All of one path length."""

    total: Cell
    connections: list
    merges: list
    stops: float  # its exposure


def contact_sheet(images, is_weighted, mapping):
    """`TechniqueImages`, with their weights or without, on a sheet: linear RGB in [0, 1], (height, width, 3).

    To the left of each row stands the weighted sum, exposed so that it fills the range; the techniques have the same
    exposure. With weights, the text gives each one's share of the luminance of the row.
    """
    base = automatic_exposure(images.sum()) if mapping.exposure == "auto" else mapping.exposure
    rows = [_row(images, length, is_weighted, base) for length in images.lengths]
    height = round(WIDTH * images.weighted.shape[1] / images.weighted.shape[2])
    n_connections = max(len(row.connections) for row in rows)
    n_merges = max(len(row.merges) for row in rows)
    columns = 1.3 + n_connections + (0.3 + n_merges if n_merges else 0.0)
    step = height + LINE + GAP
    shape = (step * len(rows) + GAP, math.ceil(columns * (WIDTH + GAP)) + GAP, 3)
    sheet, texts = np.full(shape, BACKGROUND, np.float32), []
    for number, row in enumerate(rows):
        # Pyramids: the rows of each half stand centred below each other.
        first = 1.3 + 0.5 * (n_connections - len(row.connections))
        first_merge = 1.6 + n_connections + 0.5 * (n_merges - len(row.merges))
        columns = [0.0, *(first + i for i in range(len(row.connections)))]
        columns += [first_merge + i for i in range(len(row.merges))]
        for column, cell in zip(columns, [row.total, *row.connections, *row.merges], strict=True):
            x, y = GAP + round(column * (WIDTH + GAP)), GAP + number * step
            sheet[y : y + height, x : x + WIDTH] = _thumbnail(cell.image, row.stops, WIDTH, height)
            texts.append((x, y + height + FONT, cell.text))
    return _with_texts(sheet, texts)


def _row(images, length, is_weighted, base):
    rows = images.rows(length)
    total = images.weighted[rows].sum(axis=0)
    stops = _row_stops(total, base)
    luminance = float((total @ RGB_TO_XYZ[1]).mean())
    cells = {True: [], False: []}  # merges or not
    for row in rows:
        technique = images.techniques[row]
        text = technique.title
        if is_weighted and luminance > 0:
            share = float((images.weighted[row] @ RGB_TO_XYZ[1]).mean()) / luminance
            text += f"  {_percent(share)}"
        image = (images.weighted if is_weighted else images.unweighted)[row]
        cells[technique.kind == "vm"].append(Cell(image, text))
    name = "longer" if length is None else f"length {length}"
    return Row(Cell(total, f"{name}  {stops - base:+.0f} stops"), cells[False], cells[True], stops)


def _percent(share):
    percent = 100.0 * share
    if 0 < percent < 0.1:
        return "<0.1%"
    return f"{percent:.1f}%" if percent < 10 else f"{percent:.0f}%"


def _row_stops(total, base):
    """Exposure, whole stops from `base`, that makes the brightest pixels but a few nearly white."""
    bright = float(np.percentile(total.max(axis=2), BRIGHT))
    if bright <= 0.0:
        bright = float(total.max())
    return base if bright <= 0.0 else base + math.floor(-math.log2(bright) - base)


def _thumbnail(image, stops, width, height):
    """The image at another size. It is clipped before, so that a bright pixel does not outshine its neighbours."""
    import OpenImageIO as oiio

    shown = np.clip(expose(np.nan_to_num(image), stops), 0.0, 1.0)
    buffer = oiio.ImageBuf(np.ascontiguousarray(shown, np.float32))
    resized = oiio.ImageBufAlgo.resize(
        buffer, filtername="box", roi=oiio.ROI(0, width, 0, height, 0, 1, 0, 3)
    )
    return resized.get_pixels("float").reshape(height, width, 3)


def _with_texts(sheet, texts):
    """The sheet with each `(x, y, text)`, y being that of the base line."""
    import OpenImageIO as oiio

    buffer = oiio.ImageBuf(sheet)
    for x, y, text in texts:
        oiio.ImageBufAlgo.render_text(buffer, x, y, text, FONT, "", TEXT)
    return buffer.get_pixels("float").reshape(sheet.shape)
