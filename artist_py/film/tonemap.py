"""From linear radiance to what a screen shows: exposure, white point, curve, and integers."""

from typing import NamedTuple

import numpy as np

from artist_py import data
from artist_py.errors import OptionError
from artist_py.film.color import RGB_TO_XYZ, WHITE_XY, adapt_white, encode_srgb, expose, filmic, illuminant_xy

MIDDLE_GREY = 0.18
BRIGHTEST = 1e30  # an infinite value stays the brightest without making neighbours of it NaN


class ToneMapping(NamedTuple):
    """How an image becomes visible."""

    exposure: float | str = 0.0  # stops, or "auto"
    operator: str = (
        "srgb"  # srgb: clip; filmic: roll highlights off; linear: clip, and leave out sRGB's encoding
    )
    white_point: tuple[float, float] = WHITE_XY  # chromaticity that becomes white
    bits: int = 8  # per channel: 8 or 16


def tone_mapped(rgb, mapping):
    """Integers for a PNG, (h, w, 3) uint8 or uint16, of linear sRGB values; NaN becomes black."""
    rgb = np.nan_to_num(np.asarray(rgb, dtype=float), nan=0.0, posinf=BRIGHTEST, neginf=0.0)
    if tuple(mapping.white_point) != WHITE_XY:
        rgb = adapt_white(rgb, mapping.white_point)
    stops = automatic_exposure(rgb) if mapping.exposure == "auto" else mapping.exposure
    exposed = np.clip(expose(rgb, stops), 0.0, BRIGHTEST)
    if mapping.operator == "filmic":
        exposed = filmic(exposed)
    shown = np.clip(exposed, 0.0, 1.0) if mapping.operator == "linear" else encode_srgb(exposed)
    largest = 2**mapping.bits - 1
    return np.floor(largest * shown + 0.5).astype(np.uint8 if mapping.bits == 8 else np.uint16)


def automatic_exposure(rgb):
    """Stops that bring the geometric mean luminance to 0.18; 0 for a black image.

    Reinhard, Stark, Shirley and Ferwerda 2002, eq. 1, over the pixels that are not black instead of with a small
    offset, so that it does not depend on the unit of radiance.
    """
    luminance = rgb @ RGB_TO_XYZ[1]
    lit = luminance[(luminance > 0) & (luminance < BRIGHTEST)]
    return float(np.log2(MIDDLE_GREY) - np.mean(np.log2(lit))) if lit.size else 0.0


def white_point(name):
    """Chromaticity (x, y) of the CIE illuminant `name`, 2 degree observer; OptionError if there is none."""
    known = data.names("illuminant")
    if name == "D65":
        return WHITE_XY
    if name not in known:
        raise OptionError(f"there is no illuminant {name!r}; known: {', '.join(known)}")
    return tuple(illuminant_xy(name).tolist())
