"""Everything that emits to emitter records, and the probabilities of choosing them."""

import math

import numpy as np

from artist_py.core.alias_table import build_alias_table
from artist_py.core.table import Table
from artist_py.core.vector import vec3
from artist_py.emitters.emission import sample_emission
from artist_py.errors import SceneError
from artist_py.geometry.quadric_records import quadric_area, quadric_records
from artist_py.geometry.surface import offset_position
from artist_py.scene import tables
from artist_py.scene.compile_lights import LightCompiler
from artist_py.scene.scales import POWER_RANGE, ratio
from artist_py.scene.spectra import integrate, luminance, tabulate
from artist_py.scene.where import problem
from artist_py.transport.initial_media import media_at

SIMILARITY_TOLERANCE = 1e-9
ANYWHERE = vec3(0.36, 0.48, 0.8)  # along no axis, so that a ray is unlikely to follow an edge


class EmitterCompiler:
    """Collects the emitters of all placed shapes, then those without a shape."""

    def __init__(self, geometry, spectra, lights=()):
        self.geometry, self.spectra = geometry, spectra
        self.records, self.powers, self.count = [], [], 0
        self.light = np.zeros(
            spectra.last - spectra.first
        )  # power per nm of all emitters, W / nm in render units
        self.problems = []
        for placed in geometry.placed:
            if placed.shape.emission is not None:
                self._add(placed)
        self.lights = LightCompiler(lights, geometry.space, spectra, geometry.warnings.append)
        self.light += self.lights.light
        self.problems += self.lights.problems
        if self.problems:
            raise SceneError(self.problems)

    def _add(self, placed):
        emission = placed.shape.emission
        rows = self._rows(placed)
        total = float(rows["area"].sum())
        if not total > 0.0:
            self.problems.append(problem(placed.shape, "emission", "the shape emits but has no area"))
            return
        try:
            table = tabulate(emission.spectrum, self.spectra.first, self.spectra.last, "emission")
            scale = self._scale(emission, total / self.geometry.space.scale**2)
        except SceneError as error:
            self.problems.extend(error.problems)
            return
        rows["scale"], rows["two_sided"] = scale, emission.sides == "both"
        rows["visible"], rows["image"] = emission.visible, -1
        rows["spectrum"] = self.spectra.light_row(table)
        placed.emitter = self.count
        self.count += len(rows)
        sides = 2 if emission.sides == "both" else 1
        self.records.append(rows)
        self.powers.append(math.pi * sides * scale * integrate(table) * rows["area"])
        self.light += math.pi * sides * scale * table * total

    def _scale(self, emission, area):
        """Factor on the spectrum; `area` in world units."""
        if emission.luminance is not None:
            full = tabulate(emission.spectrum, *POWER_RANGE, "emission")
            unit = luminance(full, POWER_RANGE[0])
            return ratio(emission, "luminance", emission.luminance, unit)
        if emission.power is not None:
            full = tabulate(emission.spectrum, *POWER_RANGE, "emission")
            sides = 2 if emission.sides == "both" else 1
            return ratio(emission, "power", emission.power, math.pi * sides * area * integrate(full))
        return 1.0 if emission.radiance is None else emission.radiance

    def _rows(self, placed):
        """Emitter rows of a placed shape, in render space, one per primitive."""
        rows = np.zeros(placed.part.count, tables.emitter_dtype)
        flip = -1.0 if placed.shape.reverse else 1.0
        if placed.part.kind == tables.QUADRICS:
            self._fill_quadrics(rows, placed, flip)
        else:
            self._fill_faces(rows, placed, flip)
        return rows

    def _fill_faces(self, rows, placed, flip):
        corners = self.geometry.pool_of(placed)
        is_quad = placed.part.kind == tables.PARALLELOGRAMS
        rows["kind"] = tables.PARALLELOGRAM_EMITTER if is_quad else tables.TRIANGLE_EMITTER
        linear, shift = placed.to_render[:3, :3], placed.to_render[:3, 3]
        # From the float32 corners that Embree has, so that sampled points lie on what rays hit.
        points = self.geometry.vertices["position"].astype(float)[corners] @ linear.T + shift
        origin, second, last = points[:, 0], points[:, 1], points[:, 3 if is_quad else 2]
        rows["origin"], rows["edge0"], rows["edge1"] = origin, second - origin, last - origin
        normal = np.cross(rows["edge0"], rows["edge1"])
        size = np.linalg.norm(normal, axis=1)
        rows["area"] = size if is_quad else 0.5 * size
        normal /= np.maximum(size, 1e-300)[:, None]
        rows["normal"] = normal * self._orientation(placed, normal, corners, flip)[:, None]

    def _orientation(self, placed, normal, corners, flip):
        """+1 or -1 per face: the front as `surface_at` finds it."""
        is_turned = np.linalg.det(placed.to_render[:3, :3]) < 0
        if placed.part.kind == tables.SMOOTH_TRIANGLES:
            vertex_normals = self.geometry.vertices["normal"].astype(float)[corners].sum(axis=1)
            vertex_normals = vertex_normals @ np.linalg.inv(placed.to_render[:3, :3])
            return np.where((vertex_normals * normal).sum(axis=1) < 0, -flip, flip)
        return np.full(len(normal), -flip if placed.part.is_mirrored != is_turned else flip)

    def _fill_quadrics(self, rows, placed, flip):
        for i, row in enumerate(rows):
            record = self.geometry.pool_of(placed)[i : i + 1].copy()
            index = placed.first + i
            if placed.instance is not None:
                to_render = placed.to_render @ np.vstack([record["object_to_world"][0], [0, 0, 0, 1]])
                record = quadric_records(record["kind"], to_render[None, :3])
                index = self.geometry.add_quadric(record)
            row["quadric"], row["flip"] = index, flip
            row["kind"], row["area"] = tables.QUADRIC_EMITTER, quadric_area(record.view(np.recarray)[0])
            radius = _uniform_scale(record["object_to_world"][0][:, :3])
            if record["kind"][0] == tables.SPHERE and radius is not None:
                row["kind"], row["radius"] = tables.SPHERE_EMITTER, radius
                row["origin"] = record["object_to_world"][0][:, 3]

    def table(self):
        """`tables.Emitters`, or `None` where nothing emits at the scene's wavelengths."""
        powers = np.concatenate([*self.powers, self.lights.powers])
        if not powers.sum() > 0.0:
            return None
        records = np.concatenate([*self.records, self.lights.rows])
        alias, records["pdf_select"] = build_alias_table(powers)
        n_background = self.lights.n_background
        background = len(records) - n_background if n_background else None
        alias = Table(alias) if len(records) > 1 else None
        return tables.Emitters(Table(records), alias, background, self.lights.images.table())

    def place_in_media(self, scene):
        """Write the dielectrics that each emitter stands in to its record; those of a shape share the first one's."""
        records = scene.emitters.records.array
        for placed in self.geometry.placed:
            if placed.emitter >= 0:
                first = records[placed.emitter]
                media = media_at(scene, *_outwards(scene, first))
                records["media"][placed.emitter : placed.emitter + placed.part.count] = media
        for row in records[self.count :]:
            if row["kind"] <= tables.SPOT_EMITTER:
                row["media"] = media_at(scene, vec3(*row["origin"]), ANYWHERE)


def _outwards(scene, emitter):
    """A point of an emitting shape, just off its front, and the direction away from it."""
    start = sample_emission(scene, emitter, 0.3, 0.4, 0.25, 0.4)
    return offset_position(start.position, start.normal, start.extent, start.direction), start.direction


def _uniform_scale(linear):
    """The factor of a similarity, or `None` for other maps."""
    gram = linear.T @ linear
    factor = np.trace(gram) / 3.0
    return (
        math.sqrt(factor)
        if np.allclose(gram, factor * np.eye(3), rtol=0, atol=SIMILARITY_TOLERANCE * factor)
        else None
    )
