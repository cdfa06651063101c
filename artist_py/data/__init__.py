"""Package data: measured and standardised tables, read once and cached; written by scripts/bake_tables.py."""

from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent


@cache
def table(name):
    """One baked table, e.g. "illuminant/D65"; float64 (samples, 1 + columns), first column nm, read-only."""
    import numpy as np

    with np.load(FOLDER / "spectra.npz") as tables:
        values = tables[name]
    values.setflags(write=False)
    return values


@cache
def names(kind):
    """Names of the baked tables of one kind: "observer", "illuminant", "reflectance" or "basis"."""
    import numpy as np

    with np.load(FOLDER / "spectra.npz") as tables:
        return tuple(name.removeprefix(kind + "/") for name in tables.files if name.startswith(kind + "/"))


@cache
def observer_bins(observer, first_nm, last_nm):
    """Averages of xbar, ybar and zbar over 1 nm bins, zero outside 360-830 nm; float64 (3, bins), read-only.

    CIE 1931 2 degree and CIE 1964 10 degree observers at 1 nm, linear in between.
    """
    import numpy as np

    knots = table(f"observer/{observer}")
    bins = np.zeros((3, last_nm - first_nm))
    known_nm = knots[:-1, 0].astype(int)
    inside = (known_nm >= first_nm) & (known_nm < last_nm)
    averages = 0.5 * (knots[:-1, 1:] + knots[1:, 1:])
    bins[:, known_nm[inside] - first_nm] = averages[inside].T
    bins.setflags(write=False)
    return bins


@cache
def luminous_integral(observer):
    """Integral of ybar over its whole range, nm: what a flat spectrum of 1 is divided by to have Y = 1."""
    return float(observer_bins(observer, 300, 830)[1].sum())
