"""Two image files that are to be compared: what both hold, and what only one does."""

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from artist_py.errors import OptionError
from artist_py.film.color import decode_srgb
from artist_py.film.reading import read_image

BAND = re.compile(r"S0\.(\d+),(\d+)nm")


class Picture(NamedTuple):
    """What there is to compare of one image; linear, but for the code values of one that is tone-mapped."""

    path: str
    rgb: Any  # (h, w, 3) float32, or None
    bands: dict  # wavelength as the channel's name says, nm -> (h, w) float32
    variance: Any  # of the mean RGB, (h, w, 3), or None
    is_display: bool  # sRGB code values
    window: tuple  # x0, y0, full width, full height
    samples: tuple  # integrator and iterations, as far as the file says


class Pair(NamedTuple):
    """Two images of the same size."""

    image: Picture
    reference: Picture
    wavelengths: tuple  # nm, of the bands that both have
    notes: tuple  # what is left out of a comparison, for the user
    bad: Any  # (h, w) bool: pixels that are not finite in one of them


def read_picture(path):
    """The `Picture` in a file; OptionError if there is nothing to compare."""
    stored = read_image(path)
    bands = {
        float(f"{match[1]}.{match[2]}"): stored.pixels[..., i]
        for i, name in enumerate(stored.names)
        if (match := BAND.fullmatch(name))
    }
    if stored.rgb is None and not bands:
        raise OptionError(f"{path}: has neither channels R, G and B nor spectral ones")
    variance = stored.layer("variance")
    is_display = Path(path).suffix.lower() != ".exr"
    samples = tuple(stored.metadata.get(f"artist:{name}") for name in ("integrator", "iterations"))
    return Picture(
        str(path), stored.rgb, bands, variance if variance.size else None, is_display, stored.window, samples
    )


def read_pair(image, reference):
    """The `Pair` in two files; OptionError where they cannot be compared."""
    a, b = read_picture(image), read_picture(reference)
    if _size(a) != _size(b):
        sizes = (f"{each.path} is {_size(each)[1]} x {_size(each)[0]} pixels" for each in (a, b))
        raise OptionError(", ".join(sizes) + ": only images of one size can be compared")
    if a.window != b.window:
        windows = (f"{each.path} from x {each.window[0]}, y {each.window[1]}" for each in (a, b))
        raise OptionError(f"they are different parts of their images: {', '.join(windows)}")
    if a.is_display != b.is_display:
        shown, linear = (a, b) if a.is_display else (b, a)
        raise OptionError(f"{shown.path} is tone-mapped and {linear.path} is linear: compare like with like")
    if (a.rgb is None or b.rgb is None) and not set(a.bands) & set(b.bands):
        raise OptionError(f"{a.path} and {b.path} have no channels in common")
    wavelengths = tuple(sorted(set(a.bands) & set(b.bands)))
    return Pair(a, b, wavelengths, tuple(_notes(a, b)), _bad(a, wavelengths) | _bad(b, wavelengths))


def linear_rgb(picture):
    """Linear RGB of a picture, (h, w, 3)."""
    return decode_srgb(picture.rgb) if picture.is_display else picture.rgb


def _size(picture):
    return (next(iter(picture.bands.values())) if picture.rgb is None else picture.rgb).shape[:2]


def _notes(a, b):
    for one, other in ((a, b), (b, a)):
        if one.rgb is None:
            yield f"{one.path} has no channels R, G and B: only spectral ones are compared"
        alone = set(one.bands) - set(other.bands)
        if alone and not other.bands:
            yield f"{other.path} has no spectral channels: only colours are compared"
        elif alone:
            yield f"{len(alone)} spectral channels of {one.path} are not in {other.path} and are left out"
    for one in (a, b):
        bad = _bad(one, one.bands)
        if bad.any():
            y, x = np.argwhere(bad)[0]
            yield (
                f"{one.path}: {np.count_nonzero(bad)} of {bad.size} pixels are not finite, the first at x {x}, y {y}; "
                "they are left out, and count as a difference"
            )


def _bad(picture, wavelengths):
    bad = np.zeros(_size(picture), bool)
    if picture.rgb is not None:
        bad |= ~np.isfinite(picture.rgb).all(axis=2)
    for wavelength in wavelengths:
        bad |= ~np.isfinite(picture.bands[wavelength])
    return bad
