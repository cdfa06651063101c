"""Latitude-longitude images of environments: loaded, checked, and the distribution that their texels are drawn from."""

import numpy as np

from artist_py.core.table import Table
from artist_py.errors import OptionError, SceneError
from artist_py.scene import tables
from artist_py.scene.where import problem

LINEAR_FORMATS = (".exr", ".hdr", ".pfm")
CELL = np.array([1.0, 6.0, 1.0]) / 8.0  # mean over a texel's cell of what is linear between texel centres


def load_environment(emitter, warn):
    """Texels of an environment's image, float32 (h, w, 3) linear sRGB; raises SceneError."""
    from artist_py.film.reading import read_image

    def failure(message):
        return SceneError([problem(emitter, "image", message)])

    if not emitter.image.lower().endswith(LINEAR_FORMATS):
        raise failure(f"{emitter.image}: expected an EXR, HDR or PFM image, since others are not linear")
    try:
        stored = read_image(emitter.image)
    except OptionError as error:
        raise failure(str(error)) from None
    texels = stored.rgb
    if texels is None and stored.pixels.shape[2] == 1:
        texels = np.repeat(stored.pixels, 3, axis=2)
    if texels is None:
        raise failure(f"{emitter.image}: expected channels R, G and B, found {', '.join(stored.names)}")
    return _checked(np.array(texels, np.float32), emitter, failure, warn)


def _checked(texels, emitter, failure, warn):
    bad = np.argwhere(~np.isfinite(texels).all(axis=2))
    if len(bad):
        row, column = bad[0]
        raise failure(f"{emitter.image}: texel ({column}, {row}) is not finite, and {len(bad) - 1} others")
    negative = int((texels < 0.0).any(axis=2).sum())
    if negative:
        warn(f"{emitter.image}: {negative} texels are negative somewhere, where they are taken as 0")
    return np.maximum(texels, 0.0)


def cell_means(values):
    """Means over the cells of texels (h, w) that are joined bilinearly; columns go round, rows end."""
    rows = np.pad(values, ((1, 1), (0, 0)), mode="edge")
    rows = CELL[0] * rows[:-2] + CELL[1] * rows[1:-1] + CELL[2] * rows[2:]
    columns = np.pad(rows, ((0, 0), (1, 1)), mode="wrap")
    return CELL[0] * columns[:, :-2] + CELL[1] * columns[:, 1:-1] + CELL[2] * columns[:, 2:]


def solid_angles(height, width):
    """Solid angle of a texel in each row, sr; float64 (h,)."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    return 2.0 * np.pi / width * (edges[:-1] - edges[1:])


class ImageRows:
    """The images of all environments, one after the other."""

    def __init__(self):
        self.records, self.texels, self.columns, self.rows = [], [], [], []
        self.n_texels = self.n_rows = 0

    def add(self, texels, weights):
        """Row number of an image (h, w, 3), whose texels are drawn in proportion to the mean of `weights` (h, w)."""
        height, width = weights.shape
        self.records.append((width, height, self.n_texels, self.n_rows))
        self.n_texels, self.n_rows = self.n_texels + height * width, self.n_rows + height
        means = cell_means(weights)
        self.texels.append(texels.reshape(-1, 3))
        self.columns.append(cumulative(means).ravel())
        self.rows.append(cumulative(means.sum(axis=1) * solid_angles(height, width)))
        return len(self.records) - 1

    def table(self):
        """`tables.EnvironmentImages`, or `None` without images."""
        if not self.records:
            return None
        return tables.EnvironmentImages(
            Table(np.array(self.records, tables.image_dtype)),
            *(Table(np.concatenate(pool)) for pool in (self.texels, self.columns, self.rows)),
        )


def cumulative(weights):
    """Sums along the last axis up to and with each entry, as shares of the whole; a row of zeros counts as flat."""
    weights = np.asarray(weights, float)
    is_dark = ~(weights.sum(axis=-1, keepdims=True) > 0.0)
    sums = np.cumsum(np.where(is_dark, 1.0, weights), axis=-1)
    return sums / sums[..., -1:]
