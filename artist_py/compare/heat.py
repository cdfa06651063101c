"""Maps of errors as colours: black is low, then violet, red, orange, yellow, and white is high."""

import numpy as np

from artist_py.film.color import decode_srgb

# sRGB code values at equal steps; each is lighter than the one before.
RAMP = np.array(
    [
        (0, 0, 0), (42, 11, 78), (101, 21, 110), (159, 42, 99), (212, 72, 66),
        (245, 125, 21), (250, 193, 39), (252, 255, 200),
    ]
)  # fmt: skip
DECADES = 5  # that a logarithmic map shows below its end


def heat_colors(errors, low, high, *, is_logarithmic):
    """sRGB code values in [0, 1], (h, w, 3), of errors (h, w): black at `low` and below, the lightest at `high`."""
    errors = np.asarray(errors, np.float64)
    if is_logarithmic:
        errors, low, high = (np.log(np.maximum(each, low)) for each in (errors, low, high))
    share = np.clip((errors - low) / max(high - low, 1e-300), 0.0, 1.0)
    steps = np.linspace(0.0, 1.0, len(RAMP))
    return np.stack([np.interp(share, steps, RAMP[:, channel] / 255.0) for channel in range(3)], axis=-1)


def heat_range(errors, metric):
    """`(low, high, is_logarithmic)` that suits a map of `metric`, a round number at the end."""
    fixed = {
        "flip": (0.0, 1.0, False),
        "de2000": (0.0, 20.0, False),
        "z": (0.0, 6.0, False),
        "smape": (0.0, 2.0, False),
    }
    if metric in fixed:
        return fixed[metric]
    peak = float(np.percentile(errors, 99.9))
    high = 10.0 ** np.ceil(np.log10(peak)) if peak > 0.0 else 1.0
    return high * 10.0**-DECADES, high, True


def write_heat(path, errors, metric):
    """Write the map as a PNG; returns its `heat_range`. OutputError if that fails."""
    from artist_py.film.output import write_display
    from artist_py.film.tonemap import ToneMapping

    low, high, is_logarithmic = heat_range(errors, metric)
    colors = heat_colors(errors, low, high, is_logarithmic=is_logarithmic)
    write_display(path, decode_srgb(colors), ToneMapping())
    return low, high, is_logarithmic
