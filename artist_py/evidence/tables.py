"""Tables of texts: a header and lines."""

from artist_py.evidence.statistics import slopes, speed_up, summary
from artist_py.evidence.words import figures, mean_text, slope_text


def convergence_table(convergence):
    """`(header, lines)`: the relMSE of each entry at each mark, then what its end says; * is below the reference."""
    cells, fits, base = summary(convergence), slopes(convergence), convergence.entries[0].label
    marks = sorted({cell["mark"] for cell in cells})
    unit = "" if convergence.axis == "iterations" else " s"
    header = [
        "relMSE after",
        *(f"{mark:g}{unit}" for mark in marks),
        "sMAPE",
        "mean",
        "slope",
        f"speed against {base}",
    ]
    lines = []
    for entry in convergence.entries:
        own = {cell["mark"]: cell for cell in cells if cell["entry"] == entry.label}
        last = own[max(own)] if own else None
        ratio = speed_up(cells, entry.label, base, convergence.axis)
        lines.append(
            [
                entry.label,
                *(_error(own.get(mark), "relmse") for mark in marks),
                _error(last, "smape"),
                mean_text(last),
                slope_text(fits[entry.label]["relmse"]),
                "" if ratio is None else f"{figures(ratio)} x",
            ]
        )
    return header, lines


def _error(cell, metric):
    if cell is None:
        return "-"
    return figures(cell[metric]) + (" *" if cell["is_below_reference"] else "")
