"""Materials and spectra of the scene graph to rows of tables."""

import math

import numpy as np

from artist_py.errors import SceneError
from artist_py.scene import graph as scene_graph
from artist_py.scene import tables
from artist_py.scene.compile_textures import TextureCompiler, is_textured, reflectance_row
from artist_py.scene.optics import diffuse_transmittance, ior_table, is_dispersive, metal_table
from artist_py.scene.reradiation import glow_of
from artist_py.scene.spectra import ROUNDING, tabulate
from artist_py.scene.where import problem

SHARPEST = 1e4  # sr^-1: lobes of a higher density are connected but not merged at (theory 4.6)
MAX_MEDIA = 127  # slots of transport/media.py have eight bits

KINDS = {
    scene_graph.Diffuse: tables.DIFFUSE,
    scene_graph.OrenNayar: tables.OREN_NAYAR,
    scene_graph.Phong: tables.PHONG,
    scene_graph.Plastic: tables.PLASTIC,
    scene_graph.Fluorescent: tables.DIFFUSE,  # with a row of `Fluorescence`; under a coat PLASTIC
    scene_graph.Mirror: tables.MIRROR,
    scene_graph.Conductor: tables.CONDUCTOR,
    scene_graph.Dielectric: tables.DIELECTRIC,
    scene_graph.ThinDielectric: tables.THIN_DIELECTRIC,
    scene_graph.PassThrough: tables.PASS_THROUGH,
}
NEED_NAMES = {
    tables.DIFFUSE: "diffuse",
    tables.OREN_NAYAR: "oren_nayar",
    tables.PHONG: "phong",
    tables.PLASTIC: "plastic",
    tables.MIRROR: "mirror",
    tables.CONDUCTOR: "conductor",
    tables.DIELECTRIC: "dielectric",
    tables.THIN_DIELECTRIC: "thin_dielectric",
    tables.PASS_THROUGH: "pass_through",
}


class SpectrumRows:
    """The scene's spectra as rows of 1 nm bins over [first, last) nm; equal ones of a kind share a row."""

    def __init__(self, first, last):
        self.first, self.last = first, last
        self.rows, self.index, self.ior_rows, self.light_rows = [], {}, [], []

    def row(self, table, is_light=False):
        """Row number of a table (bins,)."""
        table = np.ascontiguousarray(table, np.float64)
        key = table.tobytes(), is_light
        if key not in self.index:
            self.index[key] = len(self.rows)
            self.rows.append(table)
        return self.index[key]

    def light_row(self, table):
        """Row number of what is emitted, which no property of a material shares (`CompiledScene.light_rows`)."""
        row = self.row(table, is_light=True)
        self.light_rows.append(row)
        return row

    def ior_row(self, table):
        """Row number of a refractive index: between bin centres it is read linearly, not by bin."""
        row = self.row(table)
        self.ior_rows.append(row)
        return row

    def dense(self):
        """All rows, float32 (rows, bins)."""
        return np.array(self.rows, np.float32)


class MaterialCompiler:
    """Fills material and medium rows; `rows` maps names (None: the black absorber) to row numbers."""

    def __init__(self, graph, used, spectra):
        self.spectra, self.textures, self.problems = spectra, TextureCompiler(spectra), []
        names = [name for name in graph.materials if name in used]
        self.rows = {None: 0, **{name: i + 1 for i, name in enumerate(names)}}
        self.table = np.zeros(len(names) + 1, tables.material_dtype)
        self.media = [(0, -1, 1.0)]
        self.glows, self.warnings = [], []  # `Glow` by row of `Fluorescence`
        self.table["kind"][0], self.table["texture"], self.table["fluorescence"] = tables.ABSORBER, -1, -1
        for name in names:
            self._fill(self.table[self.rows[name]], graph.materials[name])
        if self.problems:
            raise SceneError(self.problems)

    def _fill(self, row, material):
        row["kind"] = KINDS[type(material)]
        row["two_sided"] = getattr(material, "two_sided", True)
        try:
            if is_textured(material):
                row["texture"] = self.textures.row(material.reflectance)
            elif getattr(material, "reflectance", None) is not None:
                row["reflectance"] = reflectance_row(
                    self.spectra, material.reflectance, material, "reflectance"
                )
            if fill := self.FILLERS.get(type(material)):
                fill(self, row, material)
        except SceneError as error:
            self.problems.extend(error.problems)

    def _fill_oren_nayar(self, row, material):
        row["roughness"] = math.radians(material.roughness)

    def _fill_plastic(self, row, material):
        self._coat(row, material.ior)

    def _coat(self, row, ior):
        row["ior"], row["transmittance"] = ior, diffuse_transmittance(ior)

    def _fill_phong(self, row, material):
        row["exponent"] = material.exponent
        row["is_sharp"] = (material.exponent + 1.0) / (2.0 * math.pi) > SHARPEST
        row["specular"] = reflectance_row(self.spectra, material.specular, material, "specular")
        total = self._largest_reflectance(row) + self.spectra.rows[row["specular"]]
        worst = int(np.argmax(total))
        if total[worst] > 1.0 + ROUNDING:
            found = f"found {total[worst]:.6g} at {self.spectra.first + worst} nm"
            raise SceneError(
                [problem(material, "specular", f"expected reflectance + specular <= 1, {found}")]
            )

    def _fill_fluorescent(self, row, material):
        glow = glow_of(material, self.spectra.first, self.spectra.last)
        row["reflectance"], row["fluorescence"] = self.spectra.row(glow.reflectance), len(self.glows)
        if material.coat_ior is not None:
            row["kind"] = tables.PLASTIC
            self._coat(row, material.coat_ior)
        self.glows.append(glow)
        self.warnings += glow.warnings

    def _largest_reflectance(self, row):
        """The most that a material reflects anywhere, per bin."""
        if row["texture"] >= 0:
            return self.textures.largest_reflectance(row["texture"])
        return self.spectra.rows[row["reflectance"]]

    def _fill_conductor(self, row, material):
        span = self.spectra.first, self.spectra.last
        if material.metal is not None:
            eta, k = metal_table(material.metal, *span, material)
        else:
            eta, k = (tabulate(value, *span, "reflectance") for value in (material.eta, material.k))
        row["eta"], row["absorption"] = self.spectra.row(eta), self.spectra.row(k)

    def _fill_ior(self, row, material):
        table = ior_table(material.ior, self.spectra.first, self.spectra.last)
        row["ior"], row["eta"] = table[len(table) // 2], -1
        if is_dispersive(table):
            row["is_dispersive"], row["eta"] = 1, self.spectra.ior_row(table)
        if isinstance(material, scene_graph.Dielectric):
            if len(self.media) > MAX_MEDIA:
                raise SceneError(
                    [problem(material, "type", f"expected at most {MAX_MEDIA} dielectric materials")]
                )
            row["medium"] = len(self.media)
            self.media.append((material.priority, row["eta"], row["ior"]))

    FILLERS = {  # noqa: RUF012 - not changed
        scene_graph.OrenNayar: _fill_oren_nayar,
        scene_graph.Phong: _fill_phong,
        scene_graph.Plastic: _fill_plastic,
        scene_graph.Fluorescent: _fill_fluorescent,
        scene_graph.Conductor: _fill_conductor,
        scene_graph.Dielectric: _fill_ior,
        scene_graph.ThinDielectric: _fill_ior,
    }

    def media_table(self):
        """Medium rows (medium_dtype)."""
        return np.array(self.media, tables.medium_dtype)
