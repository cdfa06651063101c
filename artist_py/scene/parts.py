"""From a shape of the scene graph to primitives in the shape's own space: faces on a pool of corners, or quadrics."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from artist_py.scene import shape_types, tables
from artist_py.scene.transforms import matrix

# Corners of a box by their coordinate (0 low, 1 high), four per face, counter-clockwise from outside.
# u runs along the first edge and v along the last: upright on the four sides where z is up.
BOX_FACES = (
    ((0, 1, 0), (0, 0, 0), (0, 0, 1), (0, 1, 1)),
    ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
    ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
    ((1, 1, 0), (0, 1, 0), (0, 1, 1), (1, 1, 1)),
    ((0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 0)),
    ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
)


@dataclass
class Part:
    """One shape, ready to be placed.

    Faces: `vertices` (n, 3) float64, `faces` uint32 (m, 3) or (m, 4), optional `normals` and `uvs` per vertex.
    Quadrics: `maps` float64 (m, 4, 4) from each canonical frame, `kinds` (m,).
    """

    shape: Any
    label: str
    kind: int
    vertices: Any = None
    faces: Any = None
    normals: Any = None
    uvs: Any = None
    maps: Any = None
    kinds: Any = None
    is_mirrored: bool = False  # the transform has turned right hands into left ones

    @property
    def count(self):
        """Number of primitives."""
        return len(self.faces) if self.faces is not None else len(self.maps)

    def moved(self, transform):
        """The part under an affine map (4, 4)."""
        if not np.isfinite(transform).all():
            raise ValueError("transform is not finite")
        mirrored = self.is_mirrored != (np.linalg.det(transform[:3, :3]) < 0)
        if self.maps is not None:
            return Part(self.shape, self.label, self.kind, maps=transform @ self.maps, kinds=self.kinds)
        vertices = self.vertices @ transform[:3, :3].T + transform[:3, 3]
        normals = self.normals
        if normals is not None:
            normals = normals @ np.linalg.inv(transform[:3, :3])
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        return Part(
            self.shape, self.label, self.kind, vertices, self.faces, normals, self.uvs, is_mirrored=mirrored
        )

    def bounds(self):
        """Corners (low, high) of the bounding box, float64 (2, 3)."""
        if self.maps is None:
            used = self.vertices[np.unique(self.faces)]
            return np.array([used.min(axis=0), used.max(axis=0)])
        # Every canonical shape lies within |x|, |y|, |z| <= 1.
        centres, reach = self.maps[:, :3, 3], np.abs(self.maps[:, :3, :3]).sum(axis=2)
        return np.array([(centres - reach).min(axis=0), (centres + reach).max(axis=0)])


def part_of(shape, label, warn):
    """The `Part` of a shape, under the shape's own transform; `warn(text)` receives what is odd about its mesh."""
    part = _BUILDERS[type(shape)](shape, label, warn)
    return part.moved(matrix(shape.transform)) if shape.transform else part


def _sphere(shape, label, warn):
    return _quadrics(shape, label, [(tables.SPHERE, _frame(shape.center, np.eye(3) * shape.radius))])


def _disk(shape, label, warn):
    x, y, z = _axes(shape.normal)
    axes = np.stack([x * shape.radius, y * shape.radius, z * shape.radius], axis=1)
    return _quadrics(shape, label, [(tables.DISK, _frame(shape.center, axes))])


def _cylinder(shape, label, warn):
    base, top = np.array(shape.base), np.array(shape.top)
    x, y, z = _axes(top - base)
    side = np.stack([x * shape.radius, y * shape.radius, top - base], axis=1)
    items = [(tables.CYLINDER, _frame(base, side))]
    if shape.caps:
        items += [(tables.DISK, _frame(top, np.stack([x, y, z], axis=1) * shape.radius))]
        items += [(tables.DISK, _frame(base, np.stack([y, x, -z], axis=1) * shape.radius))]
    return _quadrics(shape, label, items)


def _cone(shape, label, warn):
    base, apex = np.array(shape.base), np.array(shape.apex)
    x, y, z = _axes(apex - base)
    items = [(tables.CONE, _frame(base, np.stack([x * shape.radius, y * shape.radius, apex - base], axis=1)))]
    if shape.cap:
        items += [(tables.DISK, _frame(base, np.stack([y, x, -z], axis=1) * shape.radius))]
    return _quadrics(shape, label, items)


def _rectangle(shape, label, warn):
    corner, (edge0, edge1) = np.array(shape.corner), np.array(shape.edges)
    corners = np.array([corner, corner + edge0, corner + edge0 + edge1, corner + edge1])
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    return Part(shape, label, tables.PARALLELOGRAMS, corners, np.arange(4, dtype=np.uint32)[None], uvs=uvs)


def _box(shape, label, warn):
    low, high = (np.array(corner) for corner in shape.bounds())
    vertices = low + np.array(BOX_FACES, float).reshape(-1, 3) * (high - low)
    faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 4)
    return Part(shape, label, tables.PARALLELOGRAMS, vertices, faces)


def _mesh(shape, label, warn):
    from artist_py.scene.meshes import load_shape

    return _triangles(shape, label, load_shape(shape, warn))


def _grooved_sphere(shape, label, warn):
    from artist_py.scene.grooved_sphere import grooved_sphere, unrolled

    mesh = unrolled(grooved_sphere(shape.segments, shape.depth, shape.grooves), shape.segments)
    axes = np.stack(_axes(shape.axis), axis=1) * shape.radius
    return _triangles(shape, label, mesh).moved(_frame(shape.center, axes))


def _triangles(shape, label, mesh):
    kind = tables.TRIANGLES if mesh.normals is None else tables.SMOOTH_TRIANGLES
    return Part(shape, label, kind, mesh.vertices, mesh.faces, mesh.normals, mesh.uvs)


def _quadrics(shape, label, items):
    kinds, maps = zip(*items, strict=True)
    return Part(shape, label, tables.QUADRICS, maps=np.array(maps), kinds=np.array(kinds))


def _frame(origin, axes):
    """Affine map (4, 4) with these columns and this origin."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = axes, origin
    return result


def _axes(direction):
    """Three orthonormal axes, the last along `direction`; exact where `direction` is an axis."""
    z = np.asarray(direction, float)
    z = z / np.linalg.norm(z)
    helper = np.eye(3)[np.argmin(np.abs(z))]
    x = np.cross(helper, z)
    x /= np.linalg.norm(x)
    return x, np.cross(z, x), z


_BUILDERS = {
    shape_types.Sphere: _sphere,
    shape_types.Rectangle: _rectangle,
    shape_types.Box: _box,
    shape_types.Disk: _disk,
    shape_types.Cylinder: _cylinder,
    shape_types.Cone: _cone,
    shape_types.Mesh: _mesh,
    shape_types.GroovedSphere: _grooved_sphere,
}
