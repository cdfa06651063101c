"""Colour: what the sensor sees of a spectrum, linear sRGB and XYZ, white points, and curves for display.

Arrays of colours have shape (..., 3). XYZ is normalised so that a flat spectrum of 1 has Y = 1.
"""

import numpy as np

from artist_py import data

LUMENS_PER_WATT = 683.002  # K_m, CIE S 023

# IEC 61966-2-1: chromaticities of the primaries and of white (D65).
PRIMARIES_XY = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
WHITE_XY = (0.3127, 0.3290)

# Lam 1985, "Bradford": XYZ to the cone responses in which white points are exchanged.
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def xyz_of_xy(xy):
    """XYZ of a chromaticity, Y = 1; float64 (3,)."""
    x, y = xy
    return np.array([x / y, 1.0, (1.0 - x - y) / y])


def _rgb_to_xyz():
    """Columns are the primaries, scaled so that (1, 1, 1) is white; SMPTE RP 177."""
    primaries = np.array([xyz_of_xy(xy) for xy in PRIMARIES_XY]).T
    return primaries * np.linalg.solve(primaries, xyz_of_xy(WHITE_XY))


RGB_TO_XYZ = _rgb_to_xyz()
XYZ_TO_RGB = np.linalg.inv(RGB_TO_XYZ)


def rgb_to_xyz(rgb):
    """XYZ of linear sRGB."""
    return np.asarray(rgb) @ RGB_TO_XYZ.T


def xy_of_xyz(xyz):
    """Chromaticity (x, y); NaN for black."""
    xyz = np.asarray(xyz, np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        return xyz[..., :2] / xyz.sum(axis=-1, keepdims=True)


def illuminant_xy(name):
    """Chromaticity of a CIE illuminant such as "D50", CIE 1931 2 degree observer."""
    nm, *matching = data.table("observer/CIE 1931 2").T
    light = np.interp(nm, *data.table(f"illuminant/{name}").T, left=0.0, right=0.0)
    return xy_of_xyz(matching @ light)


def sensor_table(first_nm, last_nm, observer="CIE 1931 2"):
    """Linear sRGB response per nm to radiance 1, averaged over 1 nm bins; float64 (3, last - first).

    The sum of a row times a tabulated radiance is the colour of that radiance. A flat spectrum of 1 has Y = 1
    over all of 360-830 nm; a shorter table lacks the rest. The 10 degree observer's XYZ goes through the same
    matrix, so that `rgb_to_xyz` gives it back.
    """
    bins = data.observer_bins(observer, first_nm, last_nm) / data.luminous_integral(observer)
    return XYZ_TO_RGB @ bins


def flat_luminance(observer="CIE 1931 2"):
    """Luminance of a flat spectrum of radiance 1 W m^-2 sr^-1 nm^-1, cd m^-2: what Y = 1 means by default."""
    return LUMENS_PER_WATT * data.luminous_integral(observer)


def expose(rgb, stops):
    """Colours multiplied by 2^stops."""
    return np.asarray(rgb) * 2.0**stops


def adapt_white(rgb, white_xy):
    """Linear sRGB in which light of chromaticity `white_xy` has become neutral (r = g = b) at equal Y."""
    cones_from = BRADFORD @ xyz_of_xy(white_xy)
    cones_to = BRADFORD @ xyz_of_xy(WHITE_XY)
    adapt_xyz = np.linalg.solve(BRADFORD, (cones_to / cones_from)[:, None] * BRADFORD)
    return np.asarray(rgb) @ (XYZ_TO_RGB @ adapt_xyz @ RGB_TO_XYZ).T


def filmic(rgb):
    """Linear display values in [0, 1] of scene values, highlights rolled off: 0.18 -> 0.27, 1 -> 0.80.

    K. Narkowicz 2016, ACES filmic tone mapping curve: a rational fit of the ACES reference transforms.
    """
    x = np.maximum(np.asarray(rgb, np.float64), 0.0)
    x = np.minimum(x, 1e6)  # beyond, the squares only lose precision
    return np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0)


def encode_srgb(linear):
    """sRGB code values in [0, 1] of linear values, which are clipped to [0, 1]; IEC 61966-2-1."""
    linear = np.clip(linear, 0.0, 1.0)
    curve = 1.055 * np.power(np.maximum(linear, 0.0031308), 1.0 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve)


def decode_srgb(encoded):
    """Linear values of sRGB code values in [0, 1]; IEC 61966-2-1."""
    encoded = np.clip(encoded, 0.0, 1.0)
    return np.where(encoded <= 0.04045, encoded / 12.92, np.power((encoded + 0.055) / 1.055, 2.4))
