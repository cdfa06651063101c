"""Images from files."""

import os
from typing import Any, NamedTuple

import numpy as np

from artist_py.errors import OptionError


class StoredImage(NamedTuple):
    """An image as it was stored: channel values in file order, and the header."""

    names: tuple  # channel names
    pixels: Any  # (h, w, n_channels) float32; integer formats are scaled to [0, 1]
    metadata: dict  # attribute name -> value
    window: tuple  # x0, y0, full width, full height; pixels

    @property
    def rgb(self):
        """Colour, (h, w, 3) float32; None if the file has no R, G and B."""
        if not set("RGB") <= set(self.names):
            return None
        return self.pixels[..., [self.names.index(name) for name in "RGB"]]

    def layer(self, name):
        """Channels `name.*` in the file's order, (h, w, c) float32."""
        return self.pixels[..., [i for i, channel in enumerate(self.names) if channel.startswith(f"{name}.")]]


def read_image(path):
    """The image in `path` as a StoredImage; OptionError naming `path` if there is none, or only part of one."""
    import OpenImageIO as oiio

    path = os.fspath(path)
    if not os.path.isfile(path):
        raise OptionError(f"{path}: there is no such file")
    try:
        stored = oiio.ImageInput.open(path)
    except (TypeError, UnicodeError) as error:
        raise OptionError(f"{path!r}: the name is not valid UTF-8") from error
    if not stored:
        raise OptionError(f"{path}: cannot be read as an image: {oiio.geterror()}")
    spec = stored.spec()
    # A truncated file opens, and only here shows what it lacks.
    pixels = stored.read_image("float")
    if pixels is None:
        raise OptionError(f"{path}: is damaged or incomplete: {stored.geterror()}")
    metadata = {attribute.name: attribute.value for attribute in spec.extra_attribs}
    window = (spec.x, spec.y, spec.full_width, spec.full_height)
    shape = (spec.height, spec.width, spec.nchannels)
    return StoredImage(tuple(spec.channelnames), np.asarray(pixels).reshape(shape), metadata, window)
