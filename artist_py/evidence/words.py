"""What reports say in words and figures, on the page and in the terminal."""

from artist_py.evidence.statistics import median_interval

AXIS_WORDS = {
    "wall": "wall-clock seconds",
    "cpu": "CPU seconds of all threads",
    "iterations": "iterations",
}


def figures(value):
    """`value` with three significant figures, without an exponent where that is short."""
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        text = f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
        return f"{float(text):g}" if "e" in text else text
    return f"{value:.2e}"


def duration(seconds):
    """Seconds for people."""
    if seconds < 60:
        return f"{figures(seconds)} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} m {rest:02d} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02d} m"


def time_text(row, axis):
    """When a row was looked at, by the clock of `axis`."""
    return f"{duration(row.cpu_seconds)} CPU" if axis == "cpu" else duration(row.wall_seconds)


def memory(n_bytes):
    """MiB."""
    return f"{n_bytes / 2**20:.0f} MiB"


def slope_text(interval):
    """The median of slopes and their range."""
    if interval is None:
        return ""
    if interval.low == interval.high:
        return f"{interval.median:.2f}"
    return f"{interval.median:.2f} ({interval.low:.2f} to {interval.high:.2f})"


def mean_text(cell):
    """The image's mean over the reference's, of an entry's last look, in a table."""
    ratio = cell and cell.get("mean_ratio")
    return f"{ratio[0]:.4f}" if ratio else ""


def subtitle(convergence):
    """What was rendered, and where."""
    about = convergence.about
    threads = about["threads"]
    return (
        f"{convergence.scene}, {about['width']} x {about['height']} pixels, paths of up to "
        f"{about['picture']['max_path_length']} edges; {threads} thread{'s' if threads > 1 else ''} of "
        f"{about['processor']}; {about['software']}; time in {AXIS_WORDS[convergence.axis]}"
    )


def notes(convergence):
    """Sentences about the reference, and about what was not finished."""
    yield reference_text(convergence.reference)
    if convergence.is_interrupted:
        yield "The run was interrupted: not every render is there."
    rejected = sum(row.rejected for row in convergence.rows)
    if rejected:
        yield f"{rejected} contributions were not finite and were dropped."


def reference_text(reference):
    """How the reference was made, and how good it is."""
    origin = reference.origin
    if "integrators" in origin:
        names = " and ".join(origin["integrators"])
        text = (
            f"Reference: {names}, {duration(origin['seconds'])}, {sum(origin['batches'])} independent batches"
        )
        text += "" if origin["is_unbiased"] else "; it is not free of bias, which only vanishes with time"
        text += ", which agree" if len(origin["integrators"]) > 1 else ""
    else:
        text = f"Reference: {origin.get('file', 'given')}"
    if reference.relmse is None:
        return f"{text}; its own error is not known, and so no row can be marked as below it."
    return f"{text}; its own relMSE {figures(reference.relmse)}, sMAPE {figures(reference.smape)}."


def band_text(convergence):
    """What the lines and bands of the plot are."""
    repeats = len({row.repeat for row in convergence.rows})
    hollow = "Hollow points: below the reference's own error. Dashed: what falls as plain Monte Carlo does."
    if repeats < 2:
        return f"Lines: single renders, so nothing is known of their spread. {hollow}"
    coverage = median_interval(range(repeats)).coverage
    return (
        f"Lines: medians of {repeats} renders with seeds of their own; dots: single renders; bands: order statistics "
        f"that hold the true median with a probability of {coverage:.0%} each. {hollow}"
    )
