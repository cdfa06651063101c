"""Image files that the tests of textures write."""

import numpy as np
import OpenImageIO as oiio


def write_image(path, pixels, kind="uint8", names=None, **attributes):
    """Write `pixels` (h, w, channels) as they are to a file; attributes are OpenImageIO's, with __ for a colon."""
    pixels = np.ascontiguousarray(pixels)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    if names:
        spec.channelnames = names
    for name, value in attributes.items():
        spec[name.replace("__", ":")] = value
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    assert output.write_image(pixels), output.geterror()
    output.close()
    return path


def grey(values, dtype=np.uint8):
    """Pixels of one channel."""
    return np.asarray(values, dtype)[:, :, None]
