"""Meshes: what files hold is kept exactly, what is broken is refused, and the grooved sphere is as its formula says."""

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from artist_py.errors import SceneError
from artist_py.scene import shape_types
from artist_py.scene.grooved_sphere import unrolled
from artist_py.scene.meshes import grooved_sphere, load_mesh, load_shape, smooth_normals
from artist_py.scene.reader import read_scene_text

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]], float)


def ply_header(
    n_vertices, n_faces, properties="", encoding="ascii", face="property list uchar int vertex_indices"
):
    """The header of a PLY file with `properties` after x y z."""
    lines = [
        f"ply\nformat {encoding} 1.0\ncomment made by hand\nelement vertex {n_vertices}",
        *(f"property float {name}" for name in ("x", "y", "z", *properties.split())),
        f"element face {n_faces}\n{face}\nend_header\n",
    ]
    return "\n".join(lines)


def ply_text(vertices, faces, properties=""):
    """An ASCII PLY file; vertices have as many numbers as there are properties."""
    rows = [" ".join(map(str, vertex)) for vertex in vertices]
    rows += [" ".join(map(str, (len(face), *face))) for face in faces]
    return (ply_header(len(vertices), len(faces), properties) + "\n".join(rows) + "\n").encode()


def ply_binary(vertices, faces, order="<", count="B", index="i"):
    """A binary PLY file of polygons."""
    names = {"B": "uchar", "H": "ushort", "I": "uint", "i": "int", "h": "short"}
    encoding = "binary_little_endian" if order == "<" else "binary_big_endian"
    face = f"property list {names[count]} {names[index]} vertex_indices"
    header = ply_header(len(vertices), len(faces), "", encoding, face).encode()
    body = np.asarray(vertices, order + "f4").tobytes()
    body += b"".join(struct.pack(f"{order}{count}{len(f)}{index}", len(f), *f) for f in faces)
    return header + body


def gltf(nodes, normals=None, indices=((0, 1, 2),)):
    """A glTF file of one mesh of CORNERS, placed by `nodes`."""
    arrays = [np.asarray(indices, "<u2").ravel(), CORNERS.astype("<f4")]
    if normals is not None:
        arrays.append(np.asarray(normals, "<f4"))
    views, offset, blob = [], 0, b""
    for array in arrays:
        data = array.tobytes() + b"\0" * (-array.nbytes % 4)
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": array.nbytes})
        blob, offset = blob + data, offset + len(data)
    accessors = [{"bufferView": 0, "componentType": 5123, "count": arrays[0].size, "type": "SCALAR"}]
    accessors += [
        {"bufferView": i, "componentType": 5126, "count": 5, "type": "VEC3"} for i in range(1, len(arrays))
    ]
    attributes = {"POSITION": 1} | ({"NORMAL": 2} if normals is not None else {})
    uri = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(nodes)))}],
            "nodes": [{"mesh": 0, **node} for node in nodes],
            "meshes": [{"primitives": [{"attributes": attributes, "indices": 0}]}],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": len(blob), "uri": uri}],
        }
    ).encode()


@pytest.fixture
def mesh_of(tmp_path):
    """A function (name, bytes) -> Mesh."""

    def load(name, data):
        (tmp_path / name).write_bytes(data)
        return load_mesh(tmp_path / name)

    return load


@pytest.fixture
def failure_of(mesh_of, tmp_path):
    """A function (name, bytes) -> what is said about the file."""

    def load(name, data):
        with pytest.raises(SceneError) as caught:
            mesh_of(name, data)
        assert caught.value.problems[0].file == str(tmp_path / name)
        return caught.value.problems[0].message

    return load


class TestPly:
    """Text and binary."""

    @pytest.mark.parametrize("order", ["<", ">"])
    def test_binary_triangles_are_kept_as_they_are(self, mesh_of, order):
        vertices = np.concatenate([CORNERS, CORNERS[:1]])  # a double that must not be merged
        mesh = mesh_of("a.ply", ply_binary(vertices, [(0, 1, 2), (5, 2, 3)], order))
        assert np.array_equal(mesh.vertices, vertices)
        assert mesh.faces.tolist() == [[0, 1, 2], [5, 2, 3]]
        assert (mesh.vertices.dtype, mesh.faces.dtype, mesh.normals, mesh.uvs) == (
            np.float64,
            np.uint32,
            None,
            None,
        )
        assert mesh.warnings == ()

    def test_vertices_without_faces_stay(self, mesh_of):
        assert len(mesh_of("a.ply", ply_text(CORNERS, [(1, 2, 3)])).vertices) == 5

    @pytest.mark.parametrize("make", [ply_text, ply_binary])
    @pytest.mark.parametrize(
        ("faces", "triangles"),
        [
            ([(0, 1, 2, 3)], {(0, 1, 2), (2, 3, 0)}),
            ([(0, 1, 2, 3), (0, 1, 4)], {(0, 1, 2), (2, 3, 0), (0, 1, 4)}),
            ([(0, 1, 2, 3, 4)], {(0, 1, 2), (0, 2, 3), (0, 3, 4)}),
            (
                [(0, 1, 4), (0, 1, 2, 3), (4, 3, 2, 1, 0)],
                {(0, 1, 4), (0, 1, 2), (2, 3, 0), (4, 3, 2), (4, 2, 1), (4, 1, 0)},
            ),
            # As long as three faces of the first one's size:
            (
                [(0, 1, 2, 3), (0, 1, 4), (0, 1, 2, 3, 4)],
                {(0, 1, 2), (2, 3, 0), (0, 1, 4), (0, 2, 3), (0, 3, 4)},
            ),
        ],
    )
    def test_polygons_become_triangles(self, mesh_of, make, faces, triangles):
        found = mesh_of("a.ply", make(CORNERS, faces)).faces.tolist()
        assert {self.turned(face) for face in found} == {self.turned(face) for face in triangles}
        assert len(found) == sum(len(face) - 2 for face in faces)

    @staticmethod
    def turned(face):
        """The face from its smallest corner on, in the same sense."""
        start = face.index(min(face))
        return tuple(face[start:]) + tuple(face[:start])

    @pytest.mark.parametrize("order", ["<", ">"])
    @pytest.mark.parametrize(("count", "index"), [("B", "I"), ("H", "h"), ("I", "i")])
    def test_polygons_of_all_number_types(self, mesh_of, order, count, index):
        mesh = mesh_of("a.ply", ply_binary(CORNERS, [(0, 1, 2, 3), (0, 1, 4)], order, count, index))
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4]]

    def test_normals_and_texture_coordinates_of_vertices(self, mesh_of):
        normals = np.array([[0, 0, 1], [0, 0.6, 0.8], [1, 0, 0], [0, 1, 0], [-1, 0, 0]])
        uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.25]])
        data = ply_text(np.hstack([CORNERS, normals, uvs]), [(0, 1, 2), (2, 3, 4)], "nx ny nz s t")
        mesh = mesh_of("a.ply", data)
        assert np.array_equal(mesh.vertices, CORNERS)
        assert np.allclose(mesh.normals, normals, atol=1e-7)
        assert np.array_equal(mesh.uvs, uvs)
        assert (mesh.normals.dtype, mesh.uvs.dtype) == (np.float32, np.float32)

    def test_normals_get_length_one(self, mesh_of):
        data = ply_text(np.hstack([CORNERS, CORNERS + np.array([0, 0, 3])]), [(0, 1, 2)], "nx ny nz")
        normals = mesh_of("a.ply", data).normals
        assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
        assert np.allclose(normals[1], np.array([1, 0, 3]) / 10**0.5)

    def test_normals_without_direction_are_told(self, mesh_of):
        normals = [[0, 0, 1], [0, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 0]]
        mesh = mesh_of("a.ply", ply_text(np.hstack([CORNERS, normals]), [(0, 1, 2), (0, 2, 3)], "nx ny nz"))
        assert mesh.normals.tolist() == [[0, 0, 1]] * 5
        assert mesh.warnings == ("1 of 5 normals have no direction; those of the faces are taken",)

    def test_texture_coordinates_of_faces_are_told(self, mesh_of):
        face = "property list uchar int vertex_indices\nproperty list uchar float texcoord"
        data = ply_header(5, 2, face=face) + "\n".join(" ".join(map(str, v)) for v in CORNERS)
        mesh = mesh_of("a.ply", (data + 2 * "\n3 0 1 2 6 0 0 1 0 1 1").encode())
        assert mesh.uvs is None
        assert mesh.warnings == ("texture coordinates per face are not read, only those per vertex",)

    def test_a_large_file_is_kept_as_it_is(self, mesh_of):
        sphere = grooved_sphere(548, 0.1, 3)
        data = trimesh.Trimesh(sphere.vertices, sphere.faces, process=False).export(file_type="ply")
        loaded = mesh_of("a.ply", data)
        assert np.array_equal(loaded.faces, sphere.faces)
        assert np.array_equal(loaded.vertices, sphere.vertices.astype(np.float32))


class TestObj:
    """Quads, groups, indices of normals and texture coordinates."""

    VERTICES = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)

    def obj(self, faces, extra=""):
        return (self.VERTICES + extra + faces).encode()

    def corners(self, mesh, values):
        """Values at the corners of all faces, as a set of triples."""
        return {tuple(map(tuple, values[face].tolist())) for face in mesh.faces}

    def test_groups_and_materials_become_one(self, mesh_of):
        mesh = mesh_of(
            "a.obj", self.obj("o a\ng x\nf 1 2 3\ng y\nusemtl red\nf 1 3 4\nusemtl blue\no b\nf 1 2 5\n")
        )
        expected = {
            tuple(map(tuple, CORNERS[list(face)].tolist())) for face in ((0, 1, 2), (0, 2, 3), (0, 1, 4))
        }
        assert self.corners(mesh, mesh.vertices) == expected

    def test_normals_stay_with_their_corners(self, mesh_of):
        extra = "vn 0 0 1\nvn 1 0 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
        mesh = mesh_of("a.obj", self.obj("f 1/1/1 2/2/1 3/3/1\nf 1/1/2 2/2/2 5/3/2\n", extra))
        by_face = {tuple(mesh.vertices[f[2]]): mesh.normals[f].tolist() for f in mesh.faces}
        assert by_face == {(1, 1, 0): [[0, 0, 1]] * 3, (0, 0, 1): [[1, 0, 0]] * 3}
        assert self.corners(mesh, mesh.uvs) == {((0, 0), (1, 0), (1, 1))}

    def test_faces_of_several_sizes(self, mesh_of):
        assert len(mesh_of("a.obj", self.obj("f 1 2 3 4\nf 1 2 5\nf 1 2 3 4 5\n")).faces) == 6

    def test_relative_indices_after_all_vertices(self, mesh_of):
        mesh = mesh_of("a.obj", self.obj("f -5 -4 -3\n"))
        assert mesh.vertices[mesh.faces[0]].tolist() == CORNERS[:3].tolist()

    def test_missing_normals_are_told(self, mesh_of):
        mesh = mesh_of("a.obj", self.obj("f 1//1 2//1 3//1\nf 1 2 5\n", "vn 0 0 1\n"))
        assert mesh.normals is None
        assert mesh.warnings == ("normals are not read where some corners of an object have none",)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("f 1 2 9\n", "a face has a corner that is not in the file"),
            ("f 1 2 0\n", 'line 6: expected indices from 1 on, found "f 1 2 0"'),
            ("f 0/1 2 3\n", 'line 6: expected indices from 1 on, found "f 0/1 2 3"'),
            ("v 0 nan 1\nf 1 2 3\n", 'line 6: expected finite coordinates, found "v 0 nan 1"'),
            (
                "f -1 -2 -3\nv 9 9 9\n",
                'line 6: expected relative indices after the last vertex only, found "f -1 -2 -3"',
            ),
            ("", "the file has no faces"),
        ],
    )
    def test_what_is_refused(self, failure_of, text, message):
        assert failure_of("a.obj", self.obj(text)) == message

    @pytest.mark.parametrize("text", ["f 10 20 30\n", "f 100/10 20 3\n"])
    def test_zeros_within_numbers_are_none(self, failure_of, text):
        assert "from 1 on" not in failure_of("a.obj", self.obj(text))


class TestGltf:
    """Nodes are flattened with their transforms."""

    def test_nodes_become_one(self, mesh_of):
        mesh = mesh_of("a.gltf", gltf([{}, {"translation": [5, 0, 0], "scale": [2, 2, 2]}]))
        corners = sorted(mesh.vertices[face].tolist() for face in mesh.faces)
        assert corners == sorted([CORNERS[:3].tolist(), (CORNERS[:3] * 2 + [5, 0, 0]).tolist()])

    def test_normals_turn_with_their_node(self, mesh_of):
        turned = {"rotation": [0, 0.5**0.5, 0, 0.5**0.5], "scale": [1, 1, 4]}  # z to x
        mesh = mesh_of("a.gltf", gltf([turned], [[0, 0.6, 0.8]] * 5))
        expected = np.array([0.2, 0.6, 0]) / np.hypot(0.2, 0.6)
        assert np.allclose(mesh.normals, expected, atol=1e-6)

    def test_a_mirror_keeps_the_front_in_front(self, mesh_of):
        mesh = mesh_of("a.gltf", gltf([{"scale": [-1, 1, 1]}], [[0, 0, 1]] * 5))
        a, b, c = mesh.vertices[mesh.faces[0]]
        assert np.cross(b - a, c - a)[2] > 0
        assert mesh.normals[0].tolist() == [0, 0, 1]

    def test_glb(self, mesh_of):
        data = trimesh.Trimesh(CORNERS, [[0, 1, 2], [0, 2, 3]], process=False).export(file_type="glb")
        mesh = mesh_of("a.glb", data)
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert np.array_equal(mesh.vertices, CORNERS)

    def test_parts_without_normals_get_flat_ones(self, mesh_of):
        scene = trimesh.Scene()
        smooth = trimesh.Trimesh(CORNERS, [[0, 1, 2]], vertex_normals=[[1, 0, 0]] * 5, process=False)
        scene.add_geometry(smooth, geom_name="smooth")
        flat = trimesh.Trimesh(CORNERS + 2, [[0, 1, 2], [0, 1, 4]], process=False)
        scene.add_geometry(flat, geom_name="flat")
        mesh = mesh_of("a.glb", trimesh.exchange.gltf.export_glb(scene, include_normals=None))
        found = {
            tuple(mesh.vertices[face].mean(axis=0).round(3)): mesh.normals[face].tolist()
            for face in mesh.faces
        }
        assert found[0.667, 0.333, 0] == [[1, 0, 0]] * 3
        assert found[2.667, 2.333, 2] == [[0, 0, 1]] * 3
        assert found[2.333, 2, 2.333] == [[0, -1, 0]] * 3


class TestRefused:
    """Files that are no mesh, with the reason."""

    def test_missing(self, tmp_path):
        with pytest.raises(SceneError, match=r"no\.ply: no such file"):
            load_mesh(tmp_path / "no.ply")

    def test_folder(self, tmp_path):
        (tmp_path / "folder.ply").mkdir()
        with pytest.raises(SceneError, match="expected a file, found a directory"):
            load_mesh(tmp_path / "folder.ply")

    def test_no_permission(self, tmp_path, monkeypatch):
        def refuse(path):
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(Path, "read_bytes", refuse)
        with pytest.raises(SceneError, match=r"a\.ply: permission denied"):
            load_mesh(tmp_path / "a.ply")

    @pytest.mark.parametrize(
        ("name", "data", "message"),
        [
            ("a.ply", b"", "the file is empty"),
            ("a.xyz", b"1 2 3", 'unknown mesh format ".xyz", expected .ply, .obj, .gltf, .glb'),
            ("mesh", b"1 2 3", 'unknown mesh format "", expected .ply, .obj, .gltf, .glb'),
            ("a.ply", ply_text(CORNERS, []), "the file has no faces"),
            ("a.ply", ply_text(CORNERS, [(0, 1, 2), (0, 1, 5)]), "face 1 has the vertex 5, expected 0 to 4"),
            (
                "a.ply",
                ply_text(CORNERS, [(0, 1, 2), (0, -1, 2)]),
                "face 1 has the vertex -1, expected 0 to 4",
            ),
            (
                "a.ply",
                ply_binary(CORNERS, [(0, 1, 2)]).replace(b"face 1", b"face 900000000000"),
                "expected 900000000000 faces, found 13 bytes",
            ),
            (
                "a.ply",
                ply_text(CORNERS[:, :2], [(0, 1, 2)]).replace(b"property float z\n", b""),
                "expected a whole PLY file, found KeyError: 'z'",
            ),
            (
                "a.obj",
                b"v 1 2\nv 2 3\nv 0 0\nf 1 2 3\n",
                "expected three coordinates for all vertices, and three corners or more for all faces",
            ),
            ("a.ply", ply_text(CORNERS, [(0, 1, 1)]), "none of the 1 triangles has an area"),
            (
                "a.ply",
                ply_binary(CORNERS, [(0, 1, 2), (0, 1)]),
                "expected faces with 3 corners or more, found face 1 with 2",
            ),
            ("a.ply", ply_binary(CORNERS, [(0, 1, 2), (0, 1, 2, 3)])[:-1], "expected 2 faces, found 1"),
            ("a.ply", ply_binary(CORNERS, [(0, 1, 2)])[:-1], "expected 1 faces, found 0"),
            (
                "a.ply",
                ply_text(CORNERS, [(0, 1, 2)] * 3).rpartition(b"3 0")[0],
                "expected 3 of the element face, found 2",
            ),
        ],
    )
    def test_reason(self, failure_of, name, data, message):
        assert failure_of(name, data) == message

    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e30])
    def test_vertices_that_are_not_finite(self, failure_of, bad):
        vertices = CORNERS.copy()
        vertices[3, 1] = bad
        message = failure_of("a.ply", ply_binary(vertices, [(0, 1, 2)]))
        assert message.startswith("vertex 3: expected finite coordinates of size 1e18 at most, found [0, ")

    @pytest.mark.parametrize("length", [0, 3, 11, 12, 40, 200, 700])
    def test_every_cut_of_a_glb_is_told(self, failure_of, length):
        data = trimesh.Trimesh(CORNERS, [[0, 1, 2]], process=False).export(file_type="glb")
        assert length < len(data)
        message = failure_of("a.glb", data[:length])
        assert message == "the file is empty" or message.startswith("expected a whole GLB file, found ")

    @pytest.mark.parametrize("suffix", ["ply", "obj", "gltf", "glb"])
    def test_noise_is_told(self, failure_of, suffix):
        for seed in range(20):
            noise = np.random.default_rng(seed).bytes(500)
            assert failure_of(f"a.{suffix}", noise)

    def test_flat_triangles_are_counted(self, mesh_of):
        mesh = mesh_of("a.ply", ply_text(CORNERS, [(0, 1, 2), (0, 1, 1), (2, 2, 2)]))
        assert mesh.warnings == ("2 of 3 triangles have no area",)
        assert len(mesh.faces) == 3

    def test_slivers_are_no_flat_triangles(self, mesh_of):
        vertices = [[0, 0, 0], [1, 0, 0], [0.5, 1e-6, 0]]
        assert mesh_of("a.ply", ply_text(vertices, [(0, 1, 2)])).warnings == ()


class TestShape:
    """The key `smooth`, and where problems are said to be."""

    def shape(self, tmp_path, smooth, normals=True):
        properties = "nx ny nz" if normals else ""
        vertices = np.hstack([CORNERS, [[1, 0, 0]] * 5]) if normals else CORNERS
        (tmp_path / "a.ply").write_bytes(ply_text(vertices, [(0, 1, 2), (0, 1, 4), (3, 3, 3)], properties))
        return shape_types.Mesh(file=str(tmp_path / "a.ply"), smooth=smooth)

    @pytest.mark.parametrize(
        ("smooth", "normals", "first"),
        [
            (None, True, [1, 0, 0]),
            (None, False, None),
            (True, True, [1, 0, 0]),
            (True, False, [0, -(0.5**0.5), 0.5**0.5]),
            (False, True, None),
            (False, False, None),
        ],
    )
    def test_smooth(self, tmp_path, smooth, normals, first):
        mesh = load_shape(self.shape(tmp_path, smooth, normals), lambda text: None)
        if first is None:
            assert mesh.normals is None
        else:
            assert np.allclose(mesh.normals[1], first, atol=0.4 if smooth and not normals else 0)

    def test_warnings_reach_the_caller(self, tmp_path):
        told = []
        load_shape(self.shape(tmp_path, None), told.append)
        assert told == [f"{tmp_path / 'a.ply'}: 1 of 3 triangles have no area"]

    def test_problems_are_at_the_key(self):
        text = 'camera = { type = "pinhole", position = [0, 0, 1], look_at = [1, 0, 0] }\n'
        scene = read_scene_text(text + '[[shapes]]\ntype = "mesh"\nemission = 1\nfile = "no.ply"\n')
        with pytest.raises(SceneError) as caught:
            load_shape(scene.shapes[0], print)
        assert str(caught.value) == "scene.toml:5: shapes.0.file: no.ply: no such file"


class TestSmoothNormals:
    """Weighted by angle, over vertices in one place."""

    def test_a_cube_of_any_triangulation(self):
        box = trimesh.creation.box()
        expected = box.vertices / np.linalg.norm(box.vertices, axis=1, keepdims=True)
        assert np.allclose(smooth_normals(box.vertices, box.faces), expected, atol=1e-6)

    def test_vertices_in_one_place_count_as_one(self):
        box = trimesh.creation.box()
        vertices = box.vertices[box.faces].reshape(-1, 3)
        normals = smooth_normals(vertices, np.arange(len(vertices)).reshape(-1, 3))
        assert np.allclose(normals, vertices / np.linalg.norm(vertices, axis=1, keepdims=True), atol=1e-6)

    def test_back_to_back_faces_still_have_a_direction(self):
        normals = smooth_normals(CORNERS[:3], np.array([[0, 1, 2], [0, 2, 1]]))
        assert np.abs(normals).tolist() == [[0, 0, 1]] * 3

    def test_unused_vertices(self):
        assert smooth_normals(CORNERS, np.array([[0, 1, 2]]))[4].tolist() == [0, 0, 1]


class TestGroovedSphere:
    """r = 1 - depth (1 - cos(2 grooves t)) / 2."""

    @pytest.mark.parametrize(
        ("segments", "depth", "grooves"), [(8, 0.0, 0), (9, 0.3, 1), (64, 0.1, 5), (128, 0.99, 20)]
    )
    def test_it_is_closed(self, segments, depth, grooves):
        mesh = grooved_sphere(segments, depth, grooves)
        solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        assert solid.is_watertight
        assert solid.is_winding_consistent
        assert solid.volume > 0
        assert solid.area_faces.min() > 0
        assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
        assert solid.euler_number == 2

    def test_vertices_lie_on_the_surface(self):
        vertices = grooved_sphere(64, 0.25, 6).vertices
        radius = np.linalg.norm(vertices, axis=1)
        polar = np.arccos(vertices[:, 2] / radius)
        assert np.allclose(radius, 1 - 0.25 * (1 - np.cos(12 * polar)) / 2, atol=1e-12)
        assert np.isclose(radius.min(), 0.75)
        assert np.isclose(radius.max(), 1.0)
        assert vertices[0].tolist() == [0, 0, 1]
        assert vertices[-1].tolist() == [0, 0, -1]

    def test_there_are_as_many_grooves_as_asked_for(self):
        mesh = grooved_sphere(16, 0.25, 7)
        meridian = np.linalg.norm(mesh.vertices[1:-1].reshape(-1, 16, 3)[:, 0], axis=1)
        is_lowest = (meridian[1:-1] < meridian[:-2]) & (meridian[1:-1] <= meridian[2:])
        assert is_lowest.sum() == 7

    def test_normals_are_the_derivative(self):
        mesh = grooved_sphere(32, 0.2, 4)
        vertices, normals = mesh.vertices.astype(np.float64), mesh.normals.astype(np.float64)

        def outside(points):
            """The implicit function whose gradient is the normal."""
            radius = np.linalg.norm(points, axis=1)
            polar = np.arctan2(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
            return radius - 1 + 0.2 * (1 - np.cos(8 * polar)) / 2

        step = 1e-6
        gradient = np.stack(
            [(outside(vertices + e) - outside(vertices - e)) / (2 * step) for e in step * np.eye(3)], axis=1
        )
        gradient /= np.linalg.norm(gradient, axis=1, keepdims=True)
        assert np.allclose(normals, gradient, atol=1e-6)
        assert mesh.normals.dtype == np.float32

    def test_no_depth_is_a_sphere(self):
        mesh = grooved_sphere(16, 0.0, 9)
        assert np.allclose(mesh.normals, mesh.vertices, atol=1e-7)


class TestUnrolled:
    """The grooved sphere with texture coordinates."""

    @pytest.mark.parametrize(("segments", "depth", "grooves"), [(8, 0.0, 0), (9, 0.3, 1), (64, 0.1, 5)])
    def test_nothing_but_texture_coordinates_is_added(self, segments, depth, grooves):
        mesh = grooved_sphere(segments, depth, grooves)
        found = unrolled(mesh, segments)
        assert np.array_equal(found.vertices[found.faces], mesh.vertices[mesh.faces])
        assert np.array_equal(found.normals[found.faces], mesh.normals[mesh.faces])
        assert np.array_equal(mesh.faces, grooved_sphere(segments, depth, grooves).faces)

    @pytest.mark.parametrize(("segments", "depth", "grooves"), [(8, 0.0, 0), (9, 0.3, 1), (64, 0.1, 5)])
    def test_texture_coordinates_are_angles(self, segments, depth, grooves):
        mesh = unrolled(grooved_sphere(segments, depth, grooves), segments)
        x, y, z = mesh.vertices.T
        polar = np.arccos(z / np.linalg.norm(mesh.vertices, axis=1))
        assert np.allclose(mesh.uvs[:, 1], 1 - polar / np.pi, atol=1e-6)
        azimuth = np.arctan2(y, x) / (2 * np.pi) % 1.0
        is_pole = np.hypot(x, y) < 1e-9
        difference = (mesh.uvs[:, 0] - azimuth + 0.5) % 1.0 - 0.5
        assert np.abs(difference[~is_pole]).max() < 1e-6
        # No face goes around the back, and those at a pole have it in their middle.
        u = mesh.uvs[mesh.faces][..., 0]
        assert np.ptp(u, axis=1).max() < 1.01 / segments
        at_pole = is_pole[mesh.faces]
        assert np.allclose(u[at_pole], [np.mean(row) for row in u[at_pole.any(1)]], atol=1e-6)
