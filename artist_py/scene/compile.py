"""From the scene graph to the tables that kernels read, and the plan of what this scene needs and leaves out."""

import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from artist_py.core.table import Table
from artist_py.core.vector import vec3
from artist_py.errors import Problem, SceneError
from artist_py.film.color import flat_luminance, sensor_table
from artist_py.film.wavelengths import inverse_cdf, wavelength_density
from artist_py.scene import tables
from artist_py.scene.compile_camera import camera_matrices, compile_camera, compile_filter
from artist_py.scene.compile_emitters import EmitterCompiler
from artist_py.scene.compile_fluorescence import (
    FluorescentScene,
    fluorescent_scene,
    fluoresces,
    with_fluorescent_wavelengths,
)
from artist_py.scene.compile_geometry import GeometryCompiler, collect_parts, space_of
from artist_py.scene.compile_lights import method_warnings
from artist_py.scene.compile_materials import NEED_NAMES, MaterialCompiler, SpectrumRows
from artist_py.scene.compile_sets import SETS, loss_with, with_enough_sets
from artist_py.scene.compile_shifting import shifts, with_shifting
from artist_py.scene.compile_textures import check_coordinates
from artist_py.transport.initial_media import media_at

VISIBLE = 380, 780  # nm
EXTENDED = 300, 780  # nm, where materials fluoresce: ultraviolet becomes visible
EMITTER_NEEDS = {
    tables.TRIANGLE_EMITTER: "triangle_emitters",
    tables.PARALLELOGRAM_EMITTER: "parallelogram_emitters",
    tables.SPHERE_EMITTER: "sphere_emitters",
    tables.QUADRIC_EMITTER: "quadric_emitters",
    tables.POINT_EMITTER: "point_emitters",
    tables.SPOT_EMITTER: "spot_emitters",
    tables.DIRECTIONAL_EMITTER: "distant_emitters",
    tables.SUN_EMITTER: "distant_emitters",
    tables.ENVIRONMENT_EMITTER: "environments",
}
WITH_LOBES = {
    tables.OREN_NAYAR, tables.PHONG, tables.PLASTIC, tables.DIELECTRIC, tables.THIN_DIELECTRIC,
}  # fmt: skip
MANY_DIELECTRICS = 2000  # with more of them it is taken for granted that some touch


@dataclass
class CompiledScene:
    """A scene ready to be rendered; `scene`, `camera` and `pixel_filter` are what kernels read."""

    graph: Any
    scene: tables.Scene
    camera: tables.Camera
    pixel_filter: tables.Filter
    nodes: np.ndarray  # inverse distribution of wavelengths, nm
    fluorescence: FluorescentScene | None  # of scenes where something fluoresces
    wavelength_range: tuple
    spectra: np.ndarray  # float32 (rows, bins), the dense table whatever the wavelength mode
    ior_rows: list
    light_rows: list  # what is emitted
    space: Any
    matrices: tuple
    embree: Any  # keeps the BVH alive
    warnings: list
    texture_images: list  # `ImageSummary` of each that textures use
    reasons: dict = field(default_factory=dict)
    seconds: float = 0.0

    @property
    def has_sets(self):
        """Whether paths have several sets of wavelengths: something fluoresces, and they do not shift instead."""
        return (
            self.fluorescence is not None and self.scene.excitation is None and self.scene.reemission is None
        )


def compile_scene(graph, threads=None):
    """Load, tabulate and build everything; raises `SceneError` with all problems that are found on the way."""
    import os

    begun = time.perf_counter()
    if graph.camera is None:
        raise SceneError([Problem("missing, expected a camera", _file_of(graph), None, "camera")])
    parts = collect_parts(graph)
    space = space_of(parts, [graph.camera.position, graph.camera.look_at])
    geometry = GeometryCompiler(graph, parts, space, threads or len(os.sched_getaffinity(0)))
    is_fluorescent = fluoresces(graph, {placed.material for placed in geometry.placed})
    if is_fluorescent:
        graph = with_fluorescent_wavelengths(graph)
    first, last = graph.render.wavelength_range or (EXTENDED if is_fluorescent else VISIBLE)
    spectra = SpectrumRows(first, last)
    observer = graph.film.observer
    sensor = sensor_table(first, last, observer) * (flat_luminance(observer) / graph.film.white_luminance)
    sensor_rows = [spectra.row(row) for row in sensor]
    emitters, materials = _lights_and_materials(graph, geometry, spectra)
    embree = geometry.build_embree()
    placements = geometry.placements(materials.rows)
    media = materials.media_table() if _dielectrics_touch(geometry, placements, materials.table) else None
    emitter_table = emitters.table()
    fluorescent = fluorescent_scene(
        materials.glows, sensor, emitters.light, first, graph.render.wavelength_sets or SETS
    )
    if fluorescent is not None:
        glowing = materials.table["fluorescence"] >= 0
        materials.table["glow"][glowing] = fluorescent.shares[materials.table["fluorescence"][glowing]]
    needs = _needs(graph, geometry, materials, emitter_table, media)
    dense = spectra.dense()
    assert sensor_rows == [0, 1, 2]  # noqa: S101 - an observer's three responses differ
    scene = tables.Scene(
        tables.Geometry(
            embree.address,
            geometry.n_direct,
            Table(placements),
            Table(geometry.vertices),
            Table(geometry.triangles),
            Table(geometry.parallelogram_records()),
            Table(geometry.quadrics) if needs.quadrics or needs.quadric_emitters else None,
            geometry.instances(),
        ),
        Table(materials.table),
        tables.Spectra(None, Table(dense), float(first)),
        emitter_table,
        Table(media) if media is not None else None,
        materials.textures.table(),
        needs,
    )
    camera = compile_camera(graph.camera, graph.film, space)
    scene, camera = _with_camera_media(scene, camera, materials)
    if scene.needs.media and scene.emitters is not None:
        emitters.place_in_media(scene)
    geometry.warnings += method_warnings(graph.render.integrator, scene) + _darkness(
        emitters.light, first, last
    )
    nodes = inverse_cdf(wavelength_density(sensor, emitters.light), first)
    if is_fluorescent and shifts(graph.render):
        scene, nodes = with_shifting(graph.render, scene, fluorescent, first), fluorescent.set_nodes[0]
    elif is_fluorescent:
        loss_at = loss_with(graph, scene, camera, fluorescent, emitters.light, dense)
        graph, fluorescent = with_enough_sets(graph, fluorescent, loss_at, geometry.warnings.append)
    return CompiledScene(
        graph,
        scene,
        camera,
        compile_filter(graph.film),
        nodes,
        fluorescent,
        (first, last),
        dense,
        spectra.ior_rows,
        spectra.light_rows,
        space,
        camera_matrices(graph.camera, graph.film),
        embree,
        geometry.warnings + materials.textures.warnings + materials.warnings,
        materials.textures.images,
        seconds=time.perf_counter() - begun,
    )


def _file_of(graph):
    return graph.where.source.file if graph.where else None


def _darkness(light, first, last):
    return [] if light.any() else [f"nothing emits light from {first} to {last} nm: the image will be black"]


def validate(graph):
    """Find every problem that only loading shows, without rendering anything; the warnings there are."""
    return compile_scene(graph).warnings


def _lights_and_materials(graph, geometry, spectra):
    """Both compiled, their problems reported together."""
    problems, result = [], []
    used = {placed.material for placed in geometry.placed}
    for build in (
        lambda: EmitterCompiler(geometry, spectra, graph.emitters),
        lambda: MaterialCompiler(graph, used, spectra),
        lambda: check_coordinates(graph, geometry.placed),
    ):
        try:
            result.append(build())
        except SceneError as error:
            problems.extend(error.problems)
    if problems:
        raise SceneError(problems)
    return result[:2]


def _dielectrics_touch(geometry, placements, materials):
    """Whether the bounding boxes of two shapes of glass touch, so that a path can be in two media at once."""
    is_glass = materials["kind"][placements["material"]] == tables.DIELECTRIC
    placed = [each for each, glass in zip(geometry.placed, is_glass, strict=True) if glass]
    if len(placed) > MANY_DIELECTRICS:
        return True
    if len(placed) < 2:
        return False
    boxes = np.array([geometry.bounds(each) for each in placed])
    low, high = boxes[:, 0], boxes[:, 1]
    touch = ((low[:, None] <= high[None]) & (low[None] <= high[:, None])).all(axis=2)
    return bool(np.triu(touch, 1).any())


def _needs(graph, geometry, materials, emitters, media):
    kinds = {placed.part.kind for placed in geometry.placed}
    used = set(materials.table["kind"]) - {tables.ABSORBER}
    present = {NEED_NAMES[kind] for kind in used}
    lights = emitters.records.array if emitters else np.zeros(0, tables.emitter_dtype)
    present |= {EMITTER_NEEDS[kind] for kind in set(lights["kind"])}
    conditions = {
        "surfaceless_emitters": bool((lights["kind"] >= tables.POINT_EMITTER).any()),
        "environment_images": bool((lights["image"] >= 0).any()),
        "hidden_emitters": bool((lights["visible"] == 0).any()),
        "lobes": bool(used & WITH_LOBES),
        "sharp": bool(materials.table["is_sharp"].any()),
        "dispersion": bool(materials.table["is_dispersive"].any()),
        "media": media is not None,
        "triangles": bool(kinds & {tables.TRIANGLES, tables.SMOOTH_TRIANGLES}),
        "smooth_triangles": tables.SMOOTH_TRIANGLES in kinds,
        "parallelograms": tables.PARALLELOGRAMS in kinds,
        "quadrics": tables.QUADRICS in kinds,
        "instances": bool(graph.instances),
        "one_sided": bool((materials.table["two_sided"][1:] == 0).any()),
        "textures": bool((materials.table["texture"] >= 0).any()),
        "fluorescence": bool(materials.glows),
        "coated_dyes": any(glow.is_coated for glow in materials.glows),
        "shared_wavelengths": graph.render.wavelengths == "shared",
    }
    present |= {name for name, condition in conditions.items() if condition}
    return tables.Needs(**dict.fromkeys(present, True))


def _with_camera_media(scene, camera, materials):
    """Scene and camera, where the camera may stand inside glass."""
    if scene.needs.dielectric is None:
        return scene, camera
    media = Table(materials.media_table())
    inside = media_at(scene._replace(media=media), camera.position, vec3(*camera.forward.values))
    if inside:
        scene = scene._replace(media=media, needs=scene.needs._replace(media=True))
    return scene, camera._replace(media=inside)
