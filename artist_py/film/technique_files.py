"""Images of techniques to files: one EXR per path length, pictures, and contact sheets."""

import os
from dataclasses import replace

from artist_py.errors import OutputError
from artist_py.film.contact_sheet import contact_sheet
from artist_py.film.output import write_channels, write_display
from artist_py.film.tonemap import ToneMapping

SUMMARY = "pictures.exr"
STALE = "length_*.exr"


def check_techniques(directory):
    """Raise OutputError if the directory could not be made, or is none."""
    parent = directory if directory.exists() else directory.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise OutputError(f"{directory}: cannot be made a directory for the images of techniques")


def write_techniques(directory, images, film, metadata, mapping=None):
    """Write `TechniqueImages` of the render `film`, and what they show, to files in `directory`.

    `length_03.exr` has the layers `nee.weighted`, `nee.unweighted`, `vc_s2_t2.weighted`, ... and in R G B their
    weighted sum; the sum over all lengths is the rendered image. `mapping` is the exposure of what is to be looked at.
    """
    mapping = mapping or ToneMapping()
    try:
        directory.mkdir(exist_ok=True)
        _forget(directory, {_length_file(length) for length in images.lengths})
    except OSError as error:
        raise OutputError(f"{directory}: cannot be written: {error.strerror}") from error
    plain = replace(film, spectral=None)
    for length in images.lengths:
        channels = length_channels(images, length)
        write_channels(directory / _length_file(length), plain, channels, metadata)
    pictures = images.pictures()
    channels = [*_channels("", images.sum())]
    for name, picture in pictures.items():
        channels += _channels(f"{name}.", picture)
        write_display(directory / f"{name}.png", picture, mapping)
    write_channels(directory / SUMMARY, plain, channels, metadata)
    for name in ("weighted", "unweighted"):
        sheet = contact_sheet(images, name == "weighted", mapping)
        write_display(directory / f"{name}.png", sheet, ToneMapping())


def _length_file(length):
    return "length_more.exr" if length is None else f"length_{length:02}.exr"


def _forget(directory, kept):
    """Remove what an earlier render with other path lengths has left: the files would no longer add up."""
    for path in directory.glob(STALE):
        if path.name not in kept:
            path.unlink()


def _channels(prefix, image):
    return [(prefix + channel, image[..., i]) for i, channel in enumerate("RGB")]


def length_channels(images, length):
    """`(name, plane)` of all images of a path length, their weighted sum first."""
    rows = images.rows(length)
    channels = _channels("", images.weighted[rows].sum(axis=0))
    for row in rows:
        name = images.techniques[row].name
        channels += _channels(f"{name}.weighted.", images.weighted[row])
        channels += _channels(f"{name}.unweighted.", images.unweighted[row])
    return channels
