"""Textures of the scene graph to rows of a table and one pool of texels."""

from typing import NamedTuple

import numpy as np

from artist_py.core.table import Table
from artist_py.errors import SceneError
from artist_py.scene import tables
from artist_py.scene.messages import show
from artist_py.scene.spectra import check_reflectance, rgb_basis, tabulate
from artist_py.scene.texture_types import Checkerboard, Image
from artist_py.scene.textures import load_image
from artist_py.scene.where import problem


class ImageSummary(NamedTuple):
    """What there is to tell about an image that textures use."""

    path: str
    width: int  # texels
    height: int
    channels: int
    nbytes: int


def is_textured(material):
    """Whether the reflectance of a material varies over its surface."""
    return isinstance(getattr(material, "reflectance", None), Image | Checkerboard)


class TextureCompiler:
    """Collects texture rows; images with the same file and scale share their texels."""

    def __init__(self, spectra):
        self.spectra = spectra
        self.records, self.pool, self.loaded = [], [], {}
        self.images, self.warnings = [], []

    def row(self, texture):
        """Row number of a texture; raises SceneError."""
        row = np.zeros(1, tables.texture_dtype)
        row["repeat_u"], row["repeat_v"] = texture.repeat
        if isinstance(texture, Checkerboard):
            row["kind"] = tables.CHECKERBOARD
            row["spectra"][0, :2] = [
                reflectance_row(self.spectra, color, texture, f"checkerboard.{i}")
                for i, color in enumerate(texture.colors)
            ]
        else:
            self._fill_image(row, texture)
        self.records.append(row)
        return len(self.records) - 1

    def _fill_image(self, row, texture):
        row["kind"], row["is_nearest"] = tables.IMAGE, texture.interpolation == "nearest"
        if (texture.path, texture.scale) not in self.loaded:
            self.loaded[texture.path, texture.scale] = self._load(texture)
        row["offset"], (row["height"], row["width"], channels) = self.loaded[texture.path, texture.scale]
        row["channels"] = channels
        span = self.spectra.first, self.spectra.last
        basis = rgb_basis(*span, "reflectance") if channels == 3 else np.ones((1, span[1] - span[0]))
        row["spectra"][0, :channels] = [self.spectra.row(each) for each in np.clip(basis, 0.0, 1.0)]

    def _load(self, texture):
        """(offset, shape) of an image's texels in the pool, which they join."""
        values, warnings = load_image(texture)
        offset = sum(block.size for block in self.pool)
        self.pool.append(values.ravel())
        height, width, channels = values.shape
        self.images.append(ImageSummary(texture.path, width, height, channels, values.nbytes))
        self.warnings.extend(warnings)
        return offset, values.shape

    def largest_reflectance(self, index):
        """A bound on the reflectance of a texture anywhere, per bin."""
        record = self.records[index][0]
        colors = 2 if record["kind"] == tables.CHECKERBOARD else record["channels"]
        first, *others = (self.spectra.rows[row] for row in record["spectra"][:colors])
        if record["kind"] == tables.CHECKERBOARD:
            return np.maximum(first, *others)
        size = record["width"] * record["height"] * record["channels"]
        texels = np.concatenate(self.pool)[record["offset"] : record["offset"] + size]
        return (texels.max() / 65535.0) ** 2 * sum(others, first)

    def table(self):
        """`tables.Textures`, or `None` where nothing is textured."""
        if not self.records:
            return None
        texels = Table(np.concatenate(self.pool)) if self.pool else None
        return tables.Textures(Table(np.concatenate(self.records)), texels)


def reflectance_row(spectra, spectrum, node, key):
    """Row number of a spectrum that is a reflectance; problems are told at `key` of `node`."""
    table = tabulate(spectrum, spectra.first, spectra.last, "reflectance")
    message = check_reflectance(table, spectra.first)
    if message:
        raise SceneError([problem(node, key, message)])
    return spectra.row(np.clip(table, 0.0, 1.0))


def check_coordinates(graph, placed):
    """Raise SceneError for every mesh that has a textured material and no texture coordinates."""
    problems = [
        problem(
            each.shape,
            "file",
            f"{each.shape.file}: expected texture coordinates all over the mesh, since the material "
            f"{show(each.material)} has a texture",
        )
        for each in placed
        if each.part.kind in (tables.TRIANGLES, tables.SMOOTH_TRIANGLES)
        and each.part.uvs is None
        and is_textured(graph.materials.get(each.material))
    ]
    if problems:
        raise SceneError(list(dict.fromkeys(problems)))
