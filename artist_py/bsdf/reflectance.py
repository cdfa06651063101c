"""The reflectance of a material at a point of a surface: one spectrum everywhere, or a texture's.

A texture lies on the surface coordinates (u, v), `repeat` times over the unit square and on beyond it. The top row
of an image lies at v = 1. The value of an image's channel at a point multiplies the channel's spectrum: for RGB
those are three that add up to one, so that a colour within [0, 1] is a reflectance within [0, 1] (Mallett and
Yuksel 2019); grey has the spectrum 1.
"""

import numpy as np

from ..core.spectra import black, spectrum_at
from ..jit import function
from ..scene.tables import CHECKERBOARD, CONDUCTOR

# Texels are the square roots of their values in steps of 1 / 65535.
TEXEL_SCALE = 1.0 / 65535.0**2


@function
def reflectance_at(textures, material, spectra, wavelengths, u, v):
    """Reflectance of the material at (u, v) per wavelength, in [0, 1]; zero, and nothing read, where it has none."""
    if not has_reflectance(material):
        return black(wavelengths)
    return _reflectance(textures, material, spectra, wavelengths, u, v)


@function
def has_reflectance(material):
    """Whether the material's scattering is multiplied by a reflectance; the kinds are numbered so."""
    return material.kind <= CONDUCTOR


@function
def _reflectance(textures, material, spectra, wavelengths, u, v):
    if textures is None:
        return spectrum_at(spectra, material.reflectance, wavelengths)
    if material.texture < 0:
        return spectrum_at(spectra, material.reflectance, wavelengths)
    return textured_reflectance(textures, textures.records[material.texture], spectra, wavelengths, u, v)


@function
def textured_reflectance(textures, texture, spectra, wavelengths, u, v):
    """Reflectance of a texture at (u, v) per wavelength, in [0, 1]."""
    if texture.kind == CHECKERBOARD:
        return spectrum_at(spectra, texture.spectra[checker(texture, u, v)], wavelengths)
    return image_reflectance(textures.texels, texture, spectra, wavelengths, u, v)


@function
def checker(texture, u, v):
    """Which of the two spectra the square at (u, v) has: 0 for the one next to (0, 0)."""
    square = np.floor(u * texture.repeat_u) + np.floor(v * texture.repeat_v)
    return 0 if square == 2.0 * np.floor(0.5 * square) else 1


@function
def image_reflectance(texels, texture, spectra, wavelengths, u, v):
    """Sum of the channels' values times their spectra."""
    reflectance = black(wavelengths)
    if texels is None:
        return reflectance
    u, v = u * texture.repeat_u, v * texture.repeat_v
    x, y = (u - np.floor(u)) * texture.width, (1.0 - (v - np.floor(v))) * texture.height
    for channel in range(texture.channels):
        value = image_value(texels, texture, x, y, channel)
        reflectance = reflectance + spectrum_at(spectra, texture.spectra[channel], wavelengths) * value
    return reflectance


@function
def image_value(texels, texture, x, y, channel):
    """Linear value of a channel at (x, y), counted in texels from the top left corner of the image, in [0, 1].

    Texel (i, j) covers [i, i + 1) x [j, j + 1); bilinear values are exact at the centres.
    """
    if texture.is_nearest:
        column, row = min(int(x), texture.width - 1), min(int(y), texture.height - 1)
        return texel(texels, texture, column, row, channel)
    x0, y0 = np.floor(x - 0.5), np.floor(y - 0.5)
    s, t = x - 0.5 - x0, y - 0.5 - y0
    left, right = wrapped(int(x0), texture.width), wrapped(int(x0) + 1, texture.width)
    top, bottom = wrapped(int(y0), texture.height), wrapped(int(y0) + 1, texture.height)
    above = texel(texels, texture, left, top, channel) * (1.0 - s)
    above += texel(texels, texture, right, top, channel) * s
    below = texel(texels, texture, left, bottom, channel) * (1.0 - s)
    below += texel(texels, texture, right, bottom, channel) * s
    return above * (1.0 - t) + below * t


@function
def wrapped(index, count):
    """`index`, at most one step outside, moved to the other end of [0, count)."""
    if index < 0:
        return index + count
    return index - count if index >= count else index


@function
def texel(texels, texture, column, row, channel):
    """Linear value of a channel of one texel, in [0, 1]."""
    index = texture.offset + (row * texture.width + column) * texture.channels + channel
    root = float(texels[index])
    return root * root * TEXEL_SCALE
