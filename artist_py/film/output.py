"""Images to files: whole or not at all, and the same bytes for the same image."""

import os
from pathlib import Path

import numpy as np

from artist_py.errors import OutputError
from artist_py.film.channels import film_channels
from artist_py.film.exr import FIXED_TIME, exr_pixels, exr_spec
from artist_py.film.replacing import check_replaceable, replacing
from artist_py.film.tonemap import ToneMapping, tone_mapped
from artist_py.version import __version__

EXTENSIONS = (".exr", ".png")
VERIFIED_ROWS = 64
PNG_END = b"IEND\xaeB`\x82"  # type and checksum of the last chunk; PNG specification, 11.2.5
NOT_STORED = "the file was not stored completely; is the disk full?"


def write_image(path, film, metadata=None, tone_mapping=None):
    """Write `film` to `path`: everything in it, linear float32, as `.exr`; its colours, tone-mapped, as `.png`.

    `metadata` maps names of EXR attributes to text, numbers or JSON values. When it fails, with OutputError, whatever
    stood at `path` still stands there.
    """
    if image_extension(path) == ".png":
        write_display(path, film.rgb, tone_mapping or ToneMapping())
        return
    write_channels(path, film, film_channels(film), metadata)


def write_channels(path, film, channels, metadata=None):
    """Write `(name, plane)` of each channel, planes (height, width), as an EXR of the render `film`.

    Metadata and errors as in `write_image`.
    """
    names, pixels = exr_pixels(channels)
    _write(path, "openexr", exr_spec(film, names, metadata or {}), pixels)


def write_display(path, rgb, tone_mapping):
    """Write linear sRGB values (h, w, 3) as the PNG that `tone_mapping` makes of them. Errors as in `write_image`."""
    import OpenImageIO as oiio

    if image_extension(path) != ".png":
        raise OutputError(f"{path}: tone-mapped images are written as .png")
    pixels = tone_mapped(rgb, tone_mapping)
    height, width, n_channels = pixels.shape
    spec = oiio.ImageSpec(width, height, n_channels, pixels.dtype.name)
    spec.attribute("DateTime", FIXED_TIME)
    spec.attribute("Software", f"artist {__version__}")
    is_linear = tone_mapping.operator == "linear"
    spec.attribute("oiio:ColorSpace", "lin_rec709_scene" if is_linear else "srgb_rec709_scene")
    _write(path, "png", spec, pixels)


def check_output(path):
    """Raise OutputError if an image could not be written to `path`: better known before the render than after."""
    image_extension(path)
    check_replaceable(path)


def image_extension(path):
    """`.exr` or `.png`; OutputError for everything else."""
    extension = Path(path).suffix.lower()
    if extension not in EXTENSIONS:
        found = f"unknown extension {extension!r}" if extension else "no extension"
        raise OutputError(f"{path}: {found}; images are written as {' or '.join(EXTENSIONS)}")
    return extension


def _write(path, image_format, spec, pixels):
    with replacing(path) as temporary:
        problem = _encode(os.fspath(temporary), image_format, spec, pixels)
        if problem:
            raise OutputError(f"{path}: cannot be written: {problem}")


def _encode(file, image_format, spec, pixels):
    """What went wrong, or None."""
    import OpenImageIO as oiio

    output = oiio.ImageOutput.create(image_format)
    if not output.open(file, spec):
        return output.geterror()
    written = output.write_image(np.ascontiguousarray(pixels))
    problem = output.geterror()
    if not (output.close() and written):
        return problem or output.geterror() or NOT_STORED
    if image_format == "png" and not Path(file).read_bytes().endswith(PNG_END):
        return NOT_STORED
    return _missing(file, spec.channelnames, pixels)


def _missing(file, names, pixels):
    # The last kilobytes are written while the file is closed, and OpenImageIO 3.2 reports no failure there: a full disk
    # leaves a truncated file and no error. So what was written is read back.
    import OpenImageIO as oiio

    stored = oiio.ImageInput.open(file)
    if not stored:
        return f"{NOT_STORED} ({oiio.geterror()})"
    spec = stored.spec()
    order = [spec.channelnames.index(name) for name in names]
    for first in range(0, spec.height, VERIFIED_ROWS):
        end = min(first + VERIFIED_ROWS, spec.height)
        rows = stored.read_scanlines(spec.y + first, spec.y + end, 0, 0, spec.nchannels, pixels.dtype.name)
        if rows is None or not np.array_equal(rows[..., order], pixels[first:end], equal_nan=True):
            return f"{NOT_STORED} ({stored.geterror()})"
    return None
