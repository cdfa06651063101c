"""Images for textures: from a file to reflectances, with every fault told at the key that names the file."""

from typing import NamedTuple

import numpy as np

from artist_py.errors import SceneError
from artist_py.film.color import decode_srgb
from artist_py.scene.includes import reason
from artist_py.scene.messages import show
from artist_py.scene.where import problem

MAX_PIXELS = 2**28  # 16384 x 16384
STEPS = 65535
ROUNDING = 1e-6


class Texels(NamedTuple):
    """An image as kernels read it: square roots of reflectances in steps of 1 / STEPS, the top row first.

    Roots keep dark colours about as precise as eyes see them, in half the memory of float32: the relative error of a
    reflectance of 0.01 is at most 1.6e-4, of 0.5 it is 2.2e-5; 0 and 1 are exact.
    """

    values: np.ndarray  # uint16 (h, w, channels): one channel for grey, or three for RGB
    warnings: tuple[str, ...]


def load_image(image):
    """The `Texels` of a `texture_types.Image`; raises SceneError where its file holds no image of reflectances."""
    try:
        return _load(image.path, image.scale)
    except (OSError, ValueError) as error:
        raise SceneError([problem(image, "image", f"{image.path}: {reason(error)}")]) from None


def _load(path, scale):
    with open(path, "rb") as file:  # OpenImageIO has fewer words for what is wrong with a file
        if not file.read(1):
            raise ValueError("the file is empty")
    pixels, spec = _read(path)
    chosen = _colour_channels(spec.channelnames)
    others = [name for i, name in enumerate(spec.channelnames) if i not in chosen]
    odd = [f"{path}: ignored, it has more than colours: {_listed(others)}"] if others else []
    if spec.get_int_attribute("Orientation", 1) != 1:
        odd.append(f"{path}: taken as it is stored, although it says that it is to be turned")
    is_linear = spec.get_string_attribute("oiio:ColorSpace").startswith("lin")
    return Texels(_coded(pixels[..., chosen], is_linear, scale), tuple(odd))


def _read(path):
    """Pixels (h, w, channels) of an image in a file, uint8, uint16 or float32, and OpenImageIO's description of it."""
    import OpenImageIO as oiio

    wanted = oiio.ImageSpec()
    wanted["oiio:UnassociatedAlpha"] = 1  # colours that are not multiplied with the alpha, which is ignored
    stored = oiio.ImageInput.open(path, wanted)
    if not stored:
        oiio.geterror()
        raise ValueError("expected an image, found a file of another kind or a damaged one")
    spec = stored.spec()
    if spec.width * spec.height > MAX_PIXELS:
        raise ValueError(f"expected at most {MAX_PIXELS} pixels, found {spec.width} x {spec.height}")
    kinds = {"uint8": "uint8", "half": "float", "float": "float", "double": "float"}
    pixels = stored.read_image(kinds.get(str(spec.format), "uint16"))
    # A truncated file opens, and only now shows what it lacks.
    if pixels is None or stored.has_error:
        stored.geterror()
        raise ValueError("expected a whole image, found a damaged or an incomplete one")
    return pixels.reshape(spec.height, spec.width, spec.nchannels), spec


def _colour_channels(names):
    """Indices of the channels that are colours: three, or one of grey."""
    if {"R", "G", "B"} <= set(names):
        return [names.index(name) for name in "RGB"]
    if len(names) == 1 or "Y" in names:
        return [names.index("Y") if "Y" in names else 0]
    raise ValueError(f"expected an image in grey or RGB, found the channels {_listed(names)}")


def _listed(names):
    return ", ".join([*map(show, names[:8]), *(["..."] if len(names) > 8 else [])])


def _coded(pixels, is_linear, scale):
    """Pixels as `Texels.values`; raises ValueError where one is no reflectance."""
    if pixels.dtype.kind == "f":
        values, index = pixels * np.float32(scale), ...
    else:
        # Every value that the integers can have, and the pixels as indices into them.
        steps = np.linspace(0.0, 1.0, np.iinfo(pixels.dtype).max + 1)
        values, index = scale * (steps if is_linear else decode_srgb(steps)), pixels
    is_bad = ~((values >= -ROUNDING) & (values <= 1.0 + ROUNDING))[index]  # true for NaN
    if is_bad.any():
        row, column, channel = np.unravel_index(np.argmax(is_bad), is_bad.shape)
        found = values[index][row, column, channel]
        raise ValueError(
            f"expected reflectances from 0 to 1, found {found:.6g} in row {row}, column {column}, both from 0"
        )
    return np.rint(np.sqrt(np.clip(values, 0.0, 1.0)) * STEPS).astype(np.uint16)[index]
