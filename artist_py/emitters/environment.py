"""Environments: the same radiance from everywhere, or that of a latitude-longitude image.

In the image's own axes z is up. Row 0 is at the zenith, the middle column is looked at along y, and columns go to the
right as seen from within. Texels are joined bilinearly. They are drawn in proportion to what their cells emit: a row by
its solid angle times its mean, a texel of it, and then a direction that is uniform over the cell's solid angle, so that
the density is constant in a cell.
"""

import math

from ..core.affine import load_vec3
from ..core.spectra import spectrum_at
from ..core.vector import Vec3, dot, vec3
from ..core.warp import square_to_sphere
from ..jit import function

UNIFORM = 1.0 / (4.0 * math.pi)  # sr^-1


@function
def sample_environment(needed, scene, emitter, u, v):
    """Unit direction towards the environment."""
    if needed is None:
        return vec3(0.0, 0.0, 1.0)
    return _sample(scene.needs.environment_images, scene.emitters.images, emitter, u, v)


@function
def pdf_environment(needed, scene, emitter, towards):
    """Density of `sample_environment`, sr^-1."""
    if needed is None:
        return 0.0
    return _pdf(scene.needs.environment_images, scene.emitters.images, emitter, towards)


@function
def environment_radiance(needed, scene, emitter, towards, wavelengths):
    """Radiance from the direction `towards`, W m^-2 sr^-1 nm^-1 per wavelength."""
    radiance = spectrum_at(scene.spectra, emitter.spectrum, wavelengths)
    if needed is None:
        return radiance * emitter.scale
    if emitter.image < 0:
        return radiance * emitter.scale
    color = bilinear(scene.emitters.images, emitter.image, _in_image(emitter, towards))
    radiance = radiance * color.x + spectrum_at(scene.spectra, emitter.green, wavelengths) * color.y
    radiance = radiance + spectrum_at(scene.spectra, emitter.blue, wavelengths) * color.z
    return radiance * emitter.scale


@function
def _sample(needed, images, emitter, u, v):
    if needed is None:
        return square_to_sphere(u, v)
    if emitter.image < 0:
        return square_to_sphere(u, v)
    local = sample_image(images, emitter.image, u, v)
    x_axis, y_axis, z_axis = load_vec3(emitter.edge0), load_vec3(emitter.edge1), load_vec3(emitter.normal)
    return x_axis * local.x + y_axis * local.y + z_axis * local.z


@function
def _pdf(needed, images, emitter, towards):
    if needed is None:
        return UNIFORM
    if emitter.image < 0:
        return UNIFORM
    return pdf_image(images, emitter.image, _in_image(emitter, towards))


@function
def _in_image(emitter, w):
    """A direction in the axes of the image."""
    return vec3(
        dot(w, load_vec3(emitter.edge0)), dot(w, load_vec3(emitter.edge1)), dot(w, load_vec3(emitter.normal))
    )


@function
def first_above(cumulative, first, count, u):
    """The first index i < count with cumulative[first + i] > u; cumulative sums end at 1."""
    low, high = 0, count - 1
    while low < high:
        middle = (low + high) >> 1
        if float(cumulative[first + middle]) > u:
            high = middle
        else:
            low = middle + 1
    return low


@function
def _step(cumulative, first, index):
    """`(sum before, probability)` of entry `index`."""
    before = cumulative[first + index - 1] if index > 0 else 0.0
    return before, cumulative[first + index] - before


@function
def sample_image(images, index, u, v):
    """Unit direction in the axes of image `index`, with the density `pdf_image`."""
    image = images.records[index]
    row = first_above(images.rows, image.first_row, image.height, v)
    before, share = _step(images.rows, image.first_row, row)
    top, bottom = math.cos(math.pi * row / image.height), math.cos(math.pi * (row + 1) / image.height)
    z = top + (bottom - top) * (v - before) / share
    first = image.first_texel + row * image.width
    column = first_above(images.columns, first, image.width, u)
    before, share = _step(images.columns, first, column)
    angle = 2.0 * math.pi * ((column + (u - before) / share) / image.width - 0.5)
    radius = math.sqrt(max(0.0, 1.0 - z * z))
    return vec3(radius * math.sin(angle), radius * math.cos(angle), z)


@function
def pdf_image(images, index, local):
    """Density of `sample_image` at a unit direction, sr^-1."""
    image = images.records[index]
    x, y = image_position(image, local)
    column, row = min(int(x), image.width - 1), min(int(y), image.height - 1)
    _, row_share = _step(images.rows, image.first_row, row)
    _, share = _step(images.columns, image.first_texel + row * image.width, column)
    height = math.cos(math.pi * row / image.height) - math.cos(math.pi * (row + 1) / image.height)
    return row_share * share * image.width / (2.0 * math.pi * height)


@function
def image_position(image, local):
    """`(x, y)` in texels, from the left and from the top."""
    angle = math.atan2(local.x, local.y)
    theta = math.acos(min(max(local.z, -1.0), 1.0))
    return (angle / (2.0 * math.pi) + 0.5) * image.width, theta / math.pi * image.height


@function
def bilinear(images, index, local) -> Vec3:
    """Linear sRGB in a direction, from the four texels around; columns go round, rows end."""
    image = images.records[index]
    x, y = image_position(image, local)
    left, above = math.floor(x - 0.5), math.floor(y - 0.5)
    across, down = x - 0.5 - left, y - 0.5 - above
    columns = (int(left) + image.width) % image.width, (int(left) + 1) % image.width
    rows = max(int(above), 0), min(int(above) + 1, image.height - 1)
    upper = texel(images, image, columns[0], rows[0]) * (1.0 - across)
    upper = upper + texel(images, image, columns[1], rows[0]) * across
    lower = texel(images, image, columns[0], rows[1]) * (1.0 - across)
    lower = lower + texel(images, image, columns[1], rows[1]) * across
    return upper * (1.0 - down) + lower * down


@function
def texel(images, image, column, row):
    """Linear sRGB of one texel."""
    at = image.first_texel + row * image.width + column
    return vec3(float(images.texels[at, 0]), float(images.texels[at, 1]), float(images.texels[at, 2]))
