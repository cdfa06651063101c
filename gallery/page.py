"""index.html: all pictures with captions, in one file that asks for nothing but the PNGs beside it."""

import math
from html import escape
from pathlib import Path
from string import Template

TEMPLATE = Path(__file__).with_name("page.html")


def write_page(folder, pictures, records, details, together=()):
    """Write the page of those pictures that have records; a file with the same content is left alone.

    `details` and `together` are those of plan.py.
    """
    shown = [picture for picture in pictures if picture.name in records]
    in_rows = {name for names, _ in together for name in names}
    kinds = {
        kind: "\n".join(
            figure(picture, records[picture.name], details)
            for picture in shown
            if picture.kind == kind and not (kind == "scene" and picture.name in in_rows)
        )
        for kind, figure in FIGURES.items()
    }
    columns = max([len(picture.files) for picture in shown if picture.kind == "equal_time"], default=1)
    count = sum(picture.kind == "scene" for picture in shown)
    text = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        count=count,
        columns=columns,
        equal_time=kinds["equal_time"],
        zooms=kinds["zoom"],
        techniques=kinds["techniques"],
        scenes=kinds["scene"],
        together="\n".join(_together(names, text, shown, records) for names, text in together),
    )
    path = Path(folder) / "index.html"
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _card(picture, record, details):
    """A single picture."""
    file = picture.files[""]
    return (
        f'<figure class="card">{_image(file, record, picture.text or picture.name)}'
        f"<figcaption><strong>{escape(picture.name)}</strong> {escape(picture.text)}"
        f"<small>{_single_facts(record)}</small></figcaption></figure>"
    )


def _together(names, text, shown, records):
    """Pictures of several scenes, side by side."""
    pictures = {picture.name: picture for picture in shown if picture.kind == "scene"}
    cells = "".join(_card(pictures[name], records[name], {}) for name in names if name in pictures)
    return f'<p>{escape(text)}</p><div class="grid">{cells}</div>'


def _row(picture, record, details):
    """All methods at equal time, side by side, and the reference."""
    detail = details.get(picture.scene.stem)
    best = min(record["rows"].values(), key=lambda row: row["relmse"])["relmse"]
    cells = []
    for name in picture.settings["integrators"]:
        row = record["rows"][name]
        facts = _row_facts(row, row["relmse"] == best)
        cells.append(_cell(picture.files[f"-{name}"], record, detail, name, facts))
    reference = record["reference"]
    title = f"reference ({reference['integrator']})"
    cells.append(_cell(picture.files["-reference"], record, detail, title, _facts(reference, "<br>")))
    return (
        f'<section class="card"><h3>{escape(picture.scene.stem)}</h3><p>{escape(picture.text)}</p>'
        f'<div class="row">{"".join(cells)}</div></section>'
    )


def _cell(file, record, detail, title, facts):
    enlarged = _enlarged(file, record["files"][file], detail) if detail else ""
    return (
        f"<figure>{_image(file, record, title)}{enlarged}"
        f"<figcaption><strong>{escape(title)}</strong><small>{facts}</small></figcaption></figure>"
    )


def _enlarged(file, size, detail):
    """A window of a picture: a box with the picture as its background, larger than the box and moved."""
    x0, x1, y0, y1 = detail
    width, height = x1 - x0, y1 - y0
    # The position in per cent is that of equal points of box and picture (CSS Backgrounds and Borders, 3.6).
    x, y = x0 / (1 - width) if width < 1 else 0, y0 / (1 - height) if height < 1 else 0
    ratio = width * size[0] / (height * size[1])
    style = (
        f"background-image:url('{escape(file)}');background-size:{100 / width:.1f}% {100 / height:.1f}%;"
        f"background-position:{100 * x:.1f}% {100 * y:.1f}%;aspect-ratio:{ratio:.4f}"
    )
    return f'<div class="detail" role="img" aria-label="a detail, enlarged" style="{style}"></div>'


def _pair(picture, record, details):
    """What merging and connecting bring, and the pyramid of techniques."""
    merged = f"merging brings {100 * record['merged_share']:.0f} % of the light"
    return (
        f'<section class="card"><h3>{escape(picture.scene.stem)}</h3>'
        f'<p class="faint">{_single_facts(record)}; {merged}</p>'
        f'<div class="pair"><figure>{_image(picture.files["-map"], record, "merging red, connecting blue")}</figure>'
        f'<figure><a href="{escape(picture.files["-pyramid"])}">'
        f"{_image(picture.files['-pyramid'], record, 'every technique with its weight')}</a></figure></div></section>"
    )


FIGURES = {"scene": _card, "zoom": _card, "equal_time": _row, "techniques": _pair}


def _image(file, record, text):
    width, height = record["files"][file]
    return f'<img src="{escape(file)}" width="{width}" height="{height}" loading="lazy" alt="{escape(text)}">'


def _single_facts(record):
    return f"{escape(record['integrator'])}, {_facts(record)}"


def _facts(record, separator=", "):
    own = record["own_relmse"]
    error = "" if own is None else f"{separator}own relMSE {figures(own)}"
    return f"{record['cpu_seconds']:.1f} s, {_iterations(record)}{error}"


def _row_facts(row, is_best):
    error = f"relMSE {figures(row['relmse'])}"
    error = f'<span class="best">{error}</span>' if is_best else error
    # Rows that were rendered before it was measured do not have it.
    symmetric = f"<br>sMAPE {figures(row['smape'])}" if "smape" in row else ""
    return f"{row['cpu_seconds']:.1f} s, {_iterations(row)}<br>{error}{symmetric}"


def _iterations(record):
    count = record["iterations"]
    return f"{count} iteration{'' if count == 1 else 's'}"


def figures(value):
    """A number with two significant figures, without an exponent unless it is very small."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    places = max(0, 1 - math.floor(math.log10(abs(value))))
    return f"{value:.1e}" if places > 6 else f"{value:.{places}f}"
