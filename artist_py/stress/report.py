"""The matrix as one HTML page that needs no other file."""

import base64
import struct
import zlib
from html import escape
from string import Template

import numpy as np

from artist_py.stress.case import Radiance

LARGEST = 64  # pixels along a side that a picture is shown with

PAGE = Template("""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>artist stress</title>
<meta name="viewport" content="width=device-width">
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 110em; padding: 0 1em; color: #222;
  background: #fff }
table { border-collapse: collapse; width: 100% }
th, td { text-align: left; vertical-align: top; padding: .35em .6em; border-bottom: 1px solid #ddd }
thead th { position: sticky; top: 0; background: #fff }
td.cell { white-space: nowrap; font-variant-numeric: tabular-nums; font-size: 13px }
.ok { background: #e9f5e9 } .wrong { background: #f9d6d5 } .noisy { background: #fdf1cf } .out { color: #888 }
td:first-child { min-width: 17em } td:nth-child(2) { max-width: 12em; overflow-wrap: anywhere }
small { color: #666 }
img { image-rendering: pixelated; width: 32px; height: 32px; object-fit: fill; display: block }
</style></head><body>
<h1>artist stress</h1>
<p>$summary, $seconds s.</p>
<p>A cell shows its picture, the mean over what is expected (the mean itself where that is 0), the largest deviation of
the image or one of its quarters in standard errors (se), iterations and seconds. Pictures: middle grey is what is
expected; where nothing is, their own mean.</p>
$faults
<table><thead><tr><th>case</th><th>expected</th>$heads</tr></thead><tbody>
$rows
</tbody></table></body></html>
""")


def page(matrix, seconds):
    """The HTML text."""
    heads = "".join(f"<th>{escape(name)}</th>" for name in matrix.integrators)
    rows = "\n".join(_row(matrix, case) for case in matrix.cases)
    return PAGE.substitute(
        summary=escape(matrix.summary),
        seconds=f"{seconds:.0f}",
        faults=_faults(matrix),
        heads=heads,
        rows=rows,
    )


def _faults(matrix):
    items = [
        f"<li><b>{escape(case.name)}</b>, {escape(name)}: {escape(verdict.status)}: {escape(verdict.text)}</li>"
        for case, name, verdict in matrix.faults()
    ]
    return f"<h2>Faults</h2><ul>{''.join(items)}</ul>" if items else ""


def _row(matrix, case):
    why = f"<br><small>{escape(case.why)}</small>" if case.why else ""
    cells = "".join(_cell(matrix, case, name) for name in matrix.integrators)
    return (
        f"<tr><td><b>{escape(case.name)}</b><br>{escape(case.shows)}{why}</td><td>{escape(str(case.expect))}</td>"
        f"{cells}</tr>"
    )


def _cell(matrix, case, integrator):
    cell = matrix.cells.get((case.name, integrator))
    if cell is None:
        status, _ = matrix.text(case, integrator)
        return f'<td class="cell out" title="{escape(case.left_out.get(integrator, ""), quote=True)}">{status}</td>'
    verdict = matrix.verdict(cell)
    kind = {"ok": "ok", "too noisy": "noisy"}.get(verdict.status, "wrong")
    lines = [escape(verdict.status)]
    if verdict.z is not None:
        expected = 0 if case.expect == Radiance(0) else 1
        lines.append(f"{expected + verdict.deviation:.4f} &plusmn; {verdict.error:.4f}")
        lines.append(f"{verdict.z:.1f} se")
    if cell.found is not None:
        count = f"{cell.found.iterations} it, " if cell.found.iterations else ""
        lines.append(f"<small>{count}{cell.found.seconds:.1f} s</small>")
    title = escape(verdict.text, quote=True)
    return f'<td class="cell {kind}" title="{title}">{_picture(case, cell.found)}{"<br>".join(lines)}</td>'


def _picture(case, found):
    if found is None or found.picture is None:
        return ""
    picture = found.picture[_middle(found.picture.shape[0]), :][:, _middle(found.picture.shape[1])]
    expected = case.expect.value if isinstance(case.expect, Radiance) else float(np.nanmean(picture))
    grey = np.nan_to_num(0.5 * picture / (expected or 1.0), nan=1.0, posinf=1.0, neginf=0.0)
    data = base64.b64encode(grey_png(grey)).decode()
    return f'<img alt="" src="data:image/png;base64,{data}">'


def _middle(size):
    """The slice of at most `LARGEST` pixels in the middle of `size`."""
    first = max(size - LARGEST, 0) // 2
    return slice(first, first + LARGEST)


def grey_png(values):
    """A PNG (8 bits, encoded with a gamma of 2.2) of values (h, w) from 0 to 1."""
    codes = np.round(255.0 * np.clip(values, 0.0, 1.0) ** (1 / 2.2)).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in codes)
    header = struct.pack(">IIBBBBB", codes.shape[1], codes.shape[0], 8, 0, 0, 0, 0)
    chunks = (b"IHDR", header), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(map(_chunk, *zip(*chunks, strict=True)))


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
