"""Reads measured reradiation matrices from bispectral EXR images.

The layout is that of Fichet, Pacanowski and Wilkie 2021, An OpenEXR Layout for Spectral Images, section 3.3: channel
T.400nm.520nm holds what is given off at 520 nm for light that arrives at 400 nm, T.400nm what is reflected at 400 nm;
decimal marks are commas. Wavelengths are in nm here. Channels of other names are not looked at.
"""

import re
from itertools import product

import numpy as np

from artist_py.errors import OptionError, Problem, SceneError
from artist_py.scene.reradiation_files import MeasuredMatrix, without_noise

NUMBER = r"(\d+(?:[.,]\d*)?)nm"
CHANNEL = re.compile(rf"T\.{NUMBER}(?:\.{NUMBER})?")
MOST_CHANNELS = 1 << 18  # every pair of 500 wavelengths; OpenImageIO's own limit is 1024
SHOWN_NAMES = 5


def read_bispectral_image(path):
    """The `MeasuredMatrix` of an image, the mean of its pixels; raises SceneError."""
    names, pixels = _read(path)
    pairs = _pairs(path, names)
    channels = list(pairs.values())
    used = pixels[:, channels]
    if bad := np.flatnonzero(~np.isfinite(used).all(axis=0)).tolist():
        raise _failure(path, "expected finite values", names[channels[bad[0]]])
    emission, excitation = _grid(path, pairs)
    clean, warnings = without_noise(path, used.mean(axis=0), lambda i: {"key": names[channels[i]]})
    values = dict(zip(pairs, clean, strict=True))
    if np.ptp(used, axis=0).any():
        warnings.append(f"{path}: its {len(pixels)} pixels differ, and are taken as one sample: their mean")
    matrix = np.array([[values.get((into, out), 0.0) for into in excitation] for out in emission])
    matrix[emission[:, None] == excitation[None, :]] = 0.0
    elastic = sorted(into for into, out in pairs if into == out)
    reflectance = np.array([values[nm, nm] for nm in elastic])
    return MeasuredMatrix(emission, excitation, matrix, np.array(elastic), reflectance, warnings)


def _failure(path, message, channel=None):
    return SceneError([Problem(message, str(path), key=channel)])


def _read(path):
    """Names of channels, and float64 (pixels, channels)."""
    import OpenImageIO as oiio

    from artist_py.film.reading import read_image

    before = oiio.get_int_attribute("limits:channels")
    oiio.attribute("limits:channels", max(before, MOST_CHANNELS))
    try:
        stored = read_image(path)
    except OptionError as error:
        raise _failure(path, str(error).removeprefix(f"{path}: ")) from None
    finally:
        oiio.attribute("limits:channels", before)
    return stored.names, stored.pixels.reshape(-1, len(stored.names)).astype(float)


def _pairs(path, names):
    """{(wavelength that arrives, wavelength that leaves): index of its channel}."""
    pairs = {}
    for index, name in enumerate(names):
        if match := CHANNEL.fullmatch(name):
            into, out = (float(nm.replace(",", ".")) for nm in (match[1], match[2] or match[1]))
            if (into, out) in pairs:
                first = names[pairs[into, out]]
                raise _failure(path, f"channels {first} and {name} are of the same wavelengths")
            pairs[into, out] = index
    if not any(into != out for into, out in pairs):
        found = ", ".join(names[:SHOWN_NAMES]) + (", .." if len(names) > SHOWN_NAMES else "")
        raise _failure(path, f"expected channels such as T.400nm.520nm, found {found}")
    return pairs


def _grid(path, pairs):
    """Wavelengths of emission and of excitation; SceneError unless there is a channel for all of them."""
    between = [pair for pair in pairs if pair[0] != pair[1]]
    excitation, emission = (sorted(set(side)) for side in zip(*between, strict=True))
    missing = [(a, b) for a, b in product(excitation, emission) if a < b and (a, b) not in pairs]
    if missing:
        (into, out), others = missing[0], len(missing) - 1
        name = f"T.{into:g}nm.{out:g}nm" + (f", nor {others} others" if others else "")
        raise _failure(path, f"expected a channel for each pair of its wavelengths, found no {name}")
    if len(excitation) < 2 or len(emission) < 2:
        expected = "expected two or more wavelengths of excitation and of emission"
        raise _failure(path, f"{expected}, found {len(excitation)} and {len(emission)}")
    return np.array(emission), np.array(excitation)
