"""Triangle meshes: loaded from files, or made (the grooved sphere)."""

from pathlib import Path

import numpy as np

from artist_py.errors import Problem, SceneError
from artist_py.scene.grooved_sphere import grooved_sphere
from artist_py.scene.includes import reason
from artist_py.scene.mesh_files import parse_mesh
from artist_py.scene.transforms import COORDINATE_LIMIT
from artist_py.scene.triangles import Mesh, is_flat, smooth_normals, with_flat_normals
from artist_py.scene.where import problem

__all__ = ["Mesh", "grooved_sphere", "load_mesh", "load_shape", "smooth_normals"]


def load_shape(shape, warn):
    """The Mesh of a mesh shape, with the normals it asks for; `warn(text)` gets what is odd about the file."""
    try:
        mesh = load_mesh(shape.file)
    except SceneError as error:
        found = [problem(shape, "file", f"{p.file}: {p.message}") for p in error.problems]
        raise SceneError(found) from None
    for text in mesh.warnings:
        warn(f"{shape.file}: {text}")
    if shape.smooth is False:
        return mesh._replace(normals=None)
    if shape.smooth and mesh.normals is None:
        return mesh._replace(normals=smooth_normals(mesh.vertices, mesh.faces))
    return mesh


def load_mesh(path):
    """The Mesh of a file: all its objects in one, with normals and texture coordinates where it has them.

    Raises SceneError where it cannot be read or is no mesh.
    """
    try:
        scene, odd = parse_mesh(Path(path).read_bytes(), Path(path))
        return _checked(_joined([_placed(scene, node) for node in scene.graph.nodes_geometry]), odd)
    except (OSError, ValueError) as error:
        raise SceneError([Problem(reason(error), str(path))]) from None


def _placed(scene, node):
    """The Mesh of one node of a trimesh scene, in the space of the scene; faces may be missing."""
    transform, name = scene.graph[node]
    geometry = scene.geometry[name]
    faces = np.asarray(getattr(geometry, "faces", np.zeros((0, 3))), np.int64)
    vertices = np.asarray(geometry.vertices, np.float64)
    if vertices.shape[1:] != (3,) or faces.shape[1:] != (3,):
        raise ValueError(
            "expected three coordinates for all vertices, and three corners or more for all faces"
        )
    has_normals = len(faces) and "vertex_normals" in geometry._cache  # noqa: SLF001 - trimesh's way to ask
    normals = np.asarray(geometry.vertex_normals, np.float64) if has_normals else None
    uvs = getattr(getattr(geometry, "visual", None), "uv", None)
    if not np.array_equal(transform, np.eye(4)):
        linear = transform[:3, :3]
        with np.errstate(all="ignore"):
            vertices = vertices @ linear.T + transform[:3, 3]
            if np.linalg.det(linear) < 0:
                faces = faces[:, ::-1]  # glTF 2.0, section 3.7.4: a mirror changes the winding
            if normals is not None:
                normals = normals @ np.linalg.pinv(linear)
    if uvs is not None and np.shape(uvs)[:1] == vertices.shape[:1]:
        return Mesh(vertices, faces, normals, np.asarray(uvs, np.float32)[:, :2])
    return Mesh(vertices, faces, normals)


def _joined(meshes):
    """One Mesh of several: if some have normals, others get flat ones; texture coordinates only if all have some."""
    meshes = [mesh for mesh in meshes if len(mesh.faces)]
    for index, mesh in enumerate(meshes):
        _check_indices(mesh)
        if mesh.normals is None and any(other.normals is not None for other in meshes):
            meshes[index] = with_flat_normals(mesh)
    if not meshes:
        raise ValueError("the file has no faces")
    if len(meshes) == 1:
        return meshes[0]
    has_normals, has_uvs = meshes[0].normals is not None, all(mesh.uvs is not None for mesh in meshes)
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, first, strict=False)]),
        np.concatenate([mesh.normals for mesh in meshes]) if has_normals else None,
        np.concatenate([mesh.uvs for mesh in meshes]) if has_uvs else None,
    )


def _check_indices(mesh):
    is_bad = (mesh.faces < 0) | (mesh.faces >= len(mesh.vertices))
    if is_bad.any():
        face, corner = np.argwhere(is_bad)[0]
        found = mesh.faces[face, corner]
        raise ValueError(f"face {face} has the vertex {found}, expected 0 to {len(mesh.vertices) - 1}")


def _checked(mesh, odd):
    """The mesh in its final types, with `odd` and all else that is odd about it as warnings."""
    with np.errstate(invalid="ignore"):
        is_bad = ~(np.abs(mesh.vertices) <= COORDINATE_LIMIT).all(axis=1)
    if is_bad.any():
        vertex = int(np.argmax(is_bad))
        found = ", ".join(f"{x:.9g}" for x in mesh.vertices[vertex])
        raise ValueError(
            f"vertex {vertex}: expected finite coordinates of size 1e18 at most, found [{found}]"
        )
    n_flat = int(is_flat(mesh.vertices, mesh.faces).sum())
    if n_flat == len(mesh.faces):
        raise ValueError(f"none of the {n_flat} triangles has an area")
    odd = [*odd, f"{n_flat} of {len(mesh.faces)} triangles have no area"] if n_flat else list(odd)
    normals = mesh.normals
    if normals is not None:
        normals, n_replaced = _unit_normals(mesh)
        if n_replaced:
            odd.append(
                f"{n_replaced} of {len(normals)} normals have no direction; those of the faces are taken"
            )
    uvs = mesh.uvs
    if uvs is not None and not np.isfinite(uvs).all():
        odd.append("texture coordinates that are not finite are taken as 0")
        uvs = np.nan_to_num(uvs, nan=0.0, posinf=0.0, neginf=0.0)
    return Mesh(mesh.vertices, np.ascontiguousarray(mesh.faces, np.uint32), normals, uvs, tuple(odd))


def _unit_normals(mesh):
    """The file's normals at length 1, float32, and how many had to be computed since they have no direction."""
    with np.errstate(all="ignore"):
        normals = mesh.normals / np.linalg.norm(mesh.normals, axis=1, keepdims=True)
    is_bad = ~np.isfinite(normals).all(axis=1)
    is_bad[np.setdiff1d(np.arange(len(normals)), mesh.faces)] = False
    normals = normals.astype(np.float32)
    if is_bad.any():
        normals[is_bad] = smooth_normals(mesh.vertices, mesh.faces)[is_bad]
    normals[~np.isfinite(normals).all(axis=1)] = 0, 0, 1  # of vertices that no face has
    return normals, int(is_bad.sum())
