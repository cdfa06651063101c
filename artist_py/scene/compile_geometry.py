"""Shapes to vertex pools, placements and an Embree scene, in render space."""

import math
from dataclasses import dataclass, field

import numpy as np

from artist_py.core.table import Table
from artist_py.errors import SceneError
from artist_py.geometry.embree import Device, EmbreeScene
from artist_py.geometry.quadric_records import quadric_records
from artist_py.scene import tables
from artist_py.scene.graph import PassThrough
from artist_py.scene.parts import part_of
from artist_py.scene.transforms import matrix
from artist_py.scene.where import problem


@dataclass
class Placed:
    """One shape in one place: `part` in the space it is stored in, `to_render` (4, 4) from there to render space."""

    part: object
    material: str | None
    to_render: np.ndarray
    instance: int | None = None
    emitter: int = tables.NO_EMITTER
    first: int = 0  # of its primitives in their pool

    @property
    def shape(self):
        return self.part.shape


@dataclass
class Space:
    """Render space = `scale` (world - `centre`); `radius` bounds the scene in world units."""

    centre: np.ndarray
    scale: float
    radius: float

    @property
    def from_world(self):
        """The map as a matrix (4, 4)."""
        result = np.eye(4) * self.scale
        result[:3, 3], result[3, 3] = -self.scale * self.centre, 1.0
        return result


@dataclass
class Parts:
    """All shapes by where they stand, before they are placed: `objects` maps a name to (parts, space of the object)."""

    direct: list
    objects: dict
    instances: (
        list  # (graph.Instance, object name, matrix (4, 4) from the object's stored space to the world)
    )
    warnings: list = field(default_factory=list)


def collect_parts(graph):
    """Load and build every shape; all problems of all shapes are reported together."""
    problems, warnings = [], []

    def build(shape, label):
        try:
            return part_of(shape, label, lambda text: warnings.append(f"{label}: {text}"))
        except SceneError as error:
            problems.extend(error.problems)
            return None

    direct = [build(shape, label_of(shape, f"shapes.{i}")) for i, shape in enumerate(graph.shapes)]
    objects = {}
    for name in dict.fromkeys(instance.object for instance in graph.instances):
        shapes = graph.objects[name].shapes
        parts = [
            build(shape, label_of(shape, f"objects.{name}.shapes.{i}")) for i, shape in enumerate(shapes)
        ]
        objects[name] = parts
    if problems:
        raise SceneError(problems)
    instances = [(instance, instance.object, matrix(instance.transform)) for instance in graph.instances]
    return Parts(direct, objects, instances, warnings)


def label_of(shape, key):
    """How messages name a shape: by its name, else by its key."""
    return shape.name or key


def space_of(parts, extra_points):
    """The `Space` of a scene; `extra_points` (the camera) keep an empty scene from having no size."""
    boxes = [part.bounds() for part in parts.direct]
    for _, name, to_world in parts.instances:
        boxes += [_box_under(part.bounds(), to_world) for part in parts.objects[name]]
    return _space_around(np.concatenate(boxes) if boxes else np.asarray(extra_points, float))


def _space_around(corners):
    """The `Space` that has the points (n, 3) around its origin, at distances of up to 1 or 2."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    centre, radius = 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))
    if not radius > 0.0:
        radius = max(1.0, float(np.abs(centre).max()))
    scale = 2.0 ** -math.floor(math.log2(radius))
    return Space(centre, scale, radius)


def _box_under(box, transform):
    """Bounding box (2, 3) of a box under an affine map."""
    centre, half = box.mean(axis=0), 0.5 * (box[1] - box[0])
    centre = transform[:3, :3] @ centre + transform[:3, 3]
    reach = np.abs(transform[:3, :3]) @ half
    return np.array([centre - reach, centre + reach])


class GeometryCompiler:
    """Fills the pools; every array is in the space that Embree sees it in."""

    def __init__(self, graph, parts, space, threads):
        self.graph, self.space = graph, space
        self.device = Device(threads)
        self.placed, self.warnings = [], list(parts.warnings)
        self.instance_rows = []
        for part in parts.direct:
            moved = part.moved(space.from_world)
            self.placed.append(Placed(moved, part.shape.material, np.eye(4)))
        self.n_direct = len(self.placed)
        self._place_instances(parts)
        self._build_pools()

    def _place_instances(self, parts):
        self.object_parts, own = {}, {}
        for name, items in parts.objects.items():
            # An object is stored in a space of its own like the scene's: for the precision of float32, and because
            # Embree takes what is smaller than 1e-18 as nothing.
            boxes = np.concatenate([part.bounds() for part in items])
            stored = _space_around(boxes).from_world
            self.object_parts[name] = [part.moved(stored) for part in items]
            own[name] = np.linalg.inv(stored)
        for i, (instance, name, to_world) in enumerate(parts.instances):
            to_render = self.space.from_world @ to_world @ own[name]
            self.instance_rows.append((to_render, len(self.placed)))
            for part in self.object_parts[name]:
                self.placed.append(Placed(part, instance.material or part.shape.material, to_render, i))

    def _build_pools(self):
        """Concatenate what all distinct parts bring; instances of one object share it."""
        vertices, triangles, parallelograms, quadrics = [], [], [], []
        n_vertices, first = 0, {}
        counts = {"triangles": 0, "parallelograms": 0, "quadrics": 0}
        for placed in self.placed:
            part = placed.part
            if id(part) not in first:
                if part.kind == tables.QUADRICS:
                    pool, items = "quadrics", records_of_quadrics(part)
                    quadrics.append(items)
                else:
                    is_quad = part.kind == tables.PARALLELOGRAMS
                    pool, items = (
                        ("parallelograms" if is_quad else "triangles"),
                        part.faces + np.uint32(n_vertices),
                    )
                    (parallelograms if is_quad else triangles).append(items)
                    vertices.append(vertex_records(part))
                    n_vertices += len(part.vertices)
                first[id(part)] = counts[pool]
                counts[pool] += len(items)
            placed.first = first[id(part)]
        self.vertices = _joined(vertices, np.zeros(0, tables.vertex_dtype))
        self.triangles = _joined(triangles, np.zeros((0, 3), np.uint32))
        self.parallelograms = _joined(parallelograms, np.zeros((0, 4), np.uint32))
        self.quadrics = _joined(quadrics, np.zeros(0, tables.quadric_dtype))

    def add_quadric(self, record):
        """Row of a further quadric, for an emitter under an instance."""
        self.quadrics = np.concatenate([self.quadrics, record])
        return len(self.quadrics) - 1

    def pool_of(self, placed):
        """The slice of its pool that holds the shape's primitives."""
        end = placed.first + placed.part.count
        if placed.part.kind == tables.QUADRICS:
            return self.quadrics[placed.first : end]
        if placed.part.kind == tables.PARALLELOGRAMS:
            return self.parallelograms[placed.first : end]
        return self.triangles[placed.first : end]

    def build_embree(self):
        """The committed top scene."""
        top = EmbreeScene(self.device)
        for index in range(self.n_direct):
            self._attach(top, index, self.placed[index])
        scenes = {}
        for i, instance in enumerate(self.graph.instances):
            to_render, first_placement = self.instance_rows[i]
            key = (instance.object, instance.material)
            if key not in scenes:
                scene = EmbreeScene(self.device)
                for k in range(len(self.object_parts[instance.object])):
                    self._attach(scene, k, self.placed[first_placement + k])
                scenes[key] = scene.commit(f"objects.{instance.object}")
            top.add_instance(self.n_direct + i, scenes[key], to_render[:3], instance.name or f"instances.{i}")
        return top.commit()

    def _attach(self, scene, geometry_id, placed):
        blocks = not isinstance(self.graph.materials.get(placed.material), PassThrough)
        items, name = self.pool_of(placed), placed.part.label
        if placed.part.kind == tables.QUADRICS:
            from artist_py.geometry.quadric_callbacks import quadric_callbacks

            scene.add_quadrics(geometry_id, items, quadric_callbacks(), name, blocks)
        else:
            scene.add_faces(geometry_id, self.vertices, items, name, blocks)

    def placements(self, material_rows):
        """Placement rows (placement_dtype)."""
        rows = np.zeros(len(self.placed), tables.placement_dtype)
        for row, placed in zip(rows, self.placed, strict=True):
            flip = placed.part.is_mirrored != placed.shape.reverse
            if placed.part.kind in (tables.QUADRICS, tables.SMOOTH_TRIANGLES):
                flip = placed.shape.reverse
            material = material_rows[placed.material]
            row["kind"], row["material"] = placed.part.kind, material
            row["emitter"], row["first"] = placed.emitter, placed.first
            row["flip"] = -1.0 if flip else 1.0
        return rows

    def parallelogram_records(self):
        """Parallelogram rows (parallelogram_dtype)."""
        rows = np.zeros(len(self.parallelograms), tables.parallelogram_dtype)
        corners = self.vertices["position"].astype(float)[self.parallelograms]
        rows["corner"] = corners[:, 0]
        rows["edge0"], rows["edge1"] = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
        normal = np.cross(rows["edge0"], rows["edge1"])
        rows["normal"] = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        rows["extent"] = np.abs(rows["edge0"]).max(axis=1) + np.abs(rows["edge1"]).max(axis=1)
        return rows

    def instances(self):
        """Instance rows (a `Table` of instance_dtype), or `None`."""
        if not self.instance_rows:
            return None
        rows = np.zeros(len(self.instance_rows), tables.instance_dtype)
        for row, (to_render, first_placement) in zip(rows, self.instance_rows, strict=True):
            row["object_to_world"], row["world_to_object"] = to_render[:3], np.linalg.inv(to_render)[:3]
            row["first_placement"] = first_placement
        return Table(rows)

    def bounds(self, placed):
        """Bounding box (2, 3) of a placed shape in render space."""
        return _box_under(placed.part.bounds(), placed.to_render)


def _joined(arrays, empty):
    return np.ascontiguousarray(np.concatenate(arrays)) if arrays else empty


def records_of_quadrics(part):
    """Quadric rows (quadric_dtype) of a part."""
    try:
        return quadric_records(part.kinds, part.maps[:, :3])
    except np.linalg.LinAlgError:
        raise SceneError([problem(part.shape, None, "is flat: its transform leaves it no volume")]) from None


def vertex_records(part):
    """Vertex rows (vertex_dtype) of a part."""
    rows = np.zeros(len(part.vertices), tables.vertex_dtype)
    with np.errstate(over="ignore"):
        rows["position"] = part.vertices
    if not np.isfinite(rows["position"]).all():
        raise SceneError([problem(part.shape, None, "has vertices that are not finite, or too far away")])
    if part.normals is not None:
        rows["normal"] = part.normals
    if part.uvs is not None:
        rows["uv"] = part.uvs
    return rows
