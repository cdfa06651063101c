"""Plots of error against time, logarithmic on both axes."""

import io
import re

import numpy as np

from artist_py.compare.optional import load_optional
from artist_py.evidence.statistics import slopes, summary
from artist_py.film.replacing import replacing

# Okabe and Ito 2008: told apart by most people who do not see all colours, and in grey by their markers.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
WIDTH = 9.5  # of the figure, inches
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">")
LINES = ("-", "--", ":")
INK, PAPER = "#1b1d21", "#ffffff"
METRICS = {"relmse": "relMSE", "smape": "sMAPE"}
AXES = {"wall": "seconds", "cpu": "CPU seconds, all threads", "iterations": "iterations"}
POWERS = {"relmse": -1.0, "smape": -0.5}  # of plain Monte Carlo
RC = {
    "font.size": 10,
    "svg.fonttype": "path",  # so that a page needs no fonts
    "svg.hashsalt": "artist",
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
}
PLACES = {"wall": "wall_seconds", "cpu": "cpu_seconds", "iterations": "iterations"}


def style_of(index):
    """`(color, marker, line style)` of the curve number `index`."""
    return (
        COLORS[index % len(COLORS)],
        MARKERS[index % len(MARKERS)],
        LINES[index // len(COLORS) % len(LINES)],
    )


def write_plots(folder, convergence):
    """Write plot.png and plot.svg. OptionError without matplotlib, OutputError if they cannot be written."""
    for name, options in (("plot.png", {"dpi": 150}), ("plot.svg", {"metadata": {"Date": None}})):
        with replacing(folder / name) as temporary:
            _save(convergence, temporary, name.rpartition(".")[2], facecolor=PAPER, **options)


def inline_svg(convergence):
    """The plot as an <svg> element for a page: transparent, and with text in the page's own colour."""
    stream = io.StringIO()
    _save(convergence, stream, "svg", transparent=True, metadata={"Date": None})
    text = stream.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", text[text.index("<svg") :], flags=re.DOTALL)
    text = re.sub(
        r'<svg ([^>]*?)width="[^"]*"', r"<svg \1", re.sub(r'(<svg [^>]*?)height="[^"]*"', r"\1", text)
    )
    return text.replace(INK, "currentColor")


def _save(convergence, target, kind, **options):
    matplotlib = load_optional("matplotlib", "plots")
    with matplotlib.rc_context(RC):
        draw(convergence).savefig(target, format=kind, **options)


def draw(convergence):
    """The matplotlib figure: relMSE and sMAPE side by side, one legend below."""
    figure_class = load_optional("matplotlib.figure", "plots").Figure
    fits = slopes(convergence)
    columns = _legend_columns([_label(entry, fits) for entry in convergence.entries])
    rows_of_legend = -(-len(convergence.entries) // columns)
    figure = figure_class(figsize=(WIDTH, 4.3 + 0.25 * rows_of_legend), layout="constrained")
    panels = figure.subplots(1, 2)
    for panel, metric in zip(panels, METRICS, strict=True):
        _panel(panel, convergence, metric)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False, fontsize=9)
    return figure


def _legend_columns(labels):
    """As many columns, up to three, as there is room for: a handle and gaps, and a character of 9 points on average."""
    longest = max(len(label) for label in labels)
    return max(1, min(3, len(labels), int(WIDTH / (0.6 + 0.07 * longest))))


def _panel(panel, convergence, metric):
    cells, fits, axis = summary(convergence), slopes(convergence), convergence.axis
    for index, entry in enumerate(convergence.entries):
        own = [cell for cell in cells if cell["entry"] == entry.label]
        if own:
            _curve(panel, own, convergence.rows_of(entry.label), axis, metric, index, _label(entry, fits))
    panel.set(xscale="log", yscale="log", xlabel=AXES[axis], ylabel=METRICS[metric])
    panel.grid(which="major", alpha=0.25, linewidth=0.6)
    panel.grid(which="minor", alpha=0.1, linewidth=0.4)
    _ticks(panel.xaxis)
    _ticks(panel.yaxis)
    _guide(panel, metric)
    _reference_line(panel, getattr(convergence.reference, metric))


def _label(entry, fits):
    slope = fits[entry.label]["relmse"]
    return entry.label if slope is None else f"{entry.label}  (relMSE ~ t^{slope.median:.2f})"


def _curve(panel, cells, rows, axis, metric, index, label):
    color, marker, line = style_of(index)
    x = [cell[PLACES[axis]] for cell in cells]
    y = [cell[metric] for cell in cells]
    low, high = ([cell[f"{metric}_{end}"] for cell in cells] for end in ("low", "high"))
    panel.fill_between(x, low, high, color=color, alpha=0.18, linewidth=0)
    panel.plot(x, y, color=color, linestyle=line, linewidth=1.6)
    # What is below the reference's own error is hollow.
    panel.plot([], [], color=color, linestyle=line, marker=marker, markersize=5, label=label)
    for x_i, y_i, cell in zip(x, y, cells, strict=True):
        face = "none" if cell["is_below_reference"] else color
        panel.plot([x_i], [y_i], color=color, marker=marker, markersize=5, markerfacecolor=face)
    if len({row.repeat for row in rows}) > 1:
        panel.plot(
            [row.along(axis) for row in rows],
            [getattr(row, metric) for row in rows],
            linestyle="none",
            marker=".",
            markersize=2.5,
            alpha=0.6,
            color=color,
        )


def _ticks(axis):
    """1, 2, 5, 10 in plain figures, rather than powers of ten."""
    ticker = load_optional("matplotlib.ticker", "plots")
    axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _place: f"{value:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def _guide(panel, metric):
    """A line that falls as plain Monte Carlo does, across the middle of the panel, behind all."""
    (left, right), (low, high) = panel.get_xlim(), panel.get_ylim()
    x = np.array([left, right])
    power = POWERS[metric]
    y = np.sqrt(low * high) * (x / np.sqrt(left * right)) ** power
    panel.plot(x, y, color=INK, linewidth=0.7, linestyle=(0, (6, 4)), alpha=0.35, zorder=0)
    name = "1/t" if power == -1.0 else r"1/$\sqrt{t}$"
    # Named near its upper end, wherever that is.
    top = min(y[0], high) * (low / high) ** 0.04
    panel.text(
        np.sqrt(left * right) * (top / np.sqrt(low * high)) ** (1.0 / power),
        top,
        f" {name}",
        alpha=0.6,
        fontsize=8,
    )
    panel.set(xlim=(left, right), ylim=(low, high))


def _reference_line(panel, error):
    """Where the reference's own error is, if that is within reach."""
    low, high = panel.get_ylim()
    if not error:
        return
    if error < low and low / error < 30:
        low = 0.7 * error
        panel.set_ylim(low, high)
    if low < error < high:
        panel.axhline(error, color=INK, linewidth=0.9, linestyle=":", alpha=0.8)
        panel.annotate(
            "error of the reference",
            (0.01, error),
            xycoords=("axes fraction", "data"),
            xytext=(0, 2),
            textcoords="offset points",
            fontsize=8,
            alpha=0.8,
        )
