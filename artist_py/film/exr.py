"""OpenEXR: what is in the header, and how pixels are laid out."""

import json

import numpy as np

from artist_py.film.color import PRIMARIES_XY, WHITE_XY
from artist_py.version import __version__

# OpenImageIO stamps the time of writing unless told otherwise; equal renders are to be equal files.
FIXED_TIME = "1970:01:01 00:00:00"
CHROMATICITIES = tuple(coordinate for xy in (*PRIMARIES_XY, WHITE_XY) for coordinate in xy)
EMISSIVE_UNITS = "W.m^-2.sr^-1.nm^-1"
INT32 = range(-(2**31), 2**31)


def exr_pixels(channels):
    """Names of `(name, plane)` channels and their values, (height, width, n_channels) float32."""
    names = tuple(name for name, _ in channels)
    return names, np.stack([plane.astype(np.float32) for _, plane in channels], axis=-1)


def exr_spec(film, names, metadata):
    """OpenImageIO's specification: data window, channels, and every attribute of the header."""
    import OpenImageIO as oiio

    height, width = film.rgb.shape[:2]
    spec = oiio.ImageSpec(width, height, len(names), "float")
    spec.channelnames = names
    spec.x, spec.y, spec.full_width, spec.full_height = film.window
    spec.attribute("compression", "zip")
    spec.attribute("DateTime", FIXED_TIME)
    spec.attribute("Software", f"artist {__version__}")
    spec.attribute("chromaticities", "float[8]", CHROMATICITIES)
    spec.attribute("samplesPerPixel", film.iterations)
    spec.attribute("artist:iterations", film.iterations)
    if film.spectral is not None:
        spec.attribute("spectralLayoutVersion", "1.0")
        spec.attribute("emissiveUnits", EMISSIVE_UNITS)
    for name, matrix in (("worldToCamera", film.world_to_camera), ("worldToNDC", film.world_to_ndc)):
        if matrix is not None:
            # OpenEXR's matrices act on row vectors.
            spec.attribute(name, "matrix", tuple(np.asarray(matrix, dtype=float).T.ravel()))
    for name, value in metadata.items():
        set_attribute(spec, name, value)
    return spec


def set_attribute(spec, name, value):
    """Set one attribute: text, float and 32-bit integers as such; larger integers as text; the rest as JSON."""
    if isinstance(value, str | float) or (isinstance(value, int) and value in INT32):
        spec.attribute(name, value)
    elif isinstance(value, int):
        spec.attribute(name, str(value))
    else:
        spec.attribute(name, json.dumps(value, ensure_ascii=False, sort_keys=True))
