"""Binary PLY files with triangles and larger polygons side by side, as Blender writes them, to triangles only.

trimesh reads binary PLY files of one face size, and takes all faces to be of the size of the first.
"""

import re

import numpy as np

TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
LAYOUT = re.compile(
    r"ply\nformat binary_(?P<order>little|big)_endian 1.0\n"
    r"element vertex (?P<vertices>\d+)\n(?P<properties>(?:property \w+ \w+\n)+)"
    r"element face (?P<faces>\d+)\nproperty list (?P<count>\w+) (?P<index>\w+) \w+\nend_header"
)


def triangulate_ply(data):
    """The bytes of a PLY file, with every face as a fan of triangles where their sizes differ.

    Files that hold something else than vertices, then faces without other properties, stay as they are.
    """
    end = data.find(b"\n", data.find(b"end_header")) + 1
    header = _tidy(data[:end])
    layout = LAYOUT.fullmatch(header)
    if layout is None or not {*_types(layout), layout["count"], layout["index"]} <= TYPES.keys():
        return data
    order = "<" if layout["order"] == "little" else ">"
    start = end + int(layout["vertices"]) * sum(np.dtype(TYPES[name]).itemsize for name in _types(layout))
    count, index = (np.dtype(order + TYPES[layout[name]]) for name in ("count", "index"))
    n_faces = int(layout["faces"])
    if n_faces == 0 or _are_equal(data, start, n_faces, count, index):
        return data
    triangles = _fans(data, *_positions(data, start, n_faces, count, index), index)
    faces = np.zeros(len(triangles), [("size", count), ("corners", index, 3)])
    faces["size"], faces["corners"] = 3, triangles
    header = header.replace(f"element face {n_faces}\n", f"element face {len(faces)}\n")
    return header.encode() + b"\n" + data[end:start] + faces.tobytes()


def _tidy(header):
    """The header's lines as LAYOUT has them: no comments, single spaces."""
    lines = (" ".join(line.split()) for line in header.decode("ascii", "replace").splitlines())
    return "\n".join(line for line in lines if not line.startswith(("comment", "obj_info")))


def _types(layout):
    return [line.split()[1] for line in layout["properties"].splitlines()]


def _are_equal(data, start, n_faces, count, index):
    """Whether all faces have as many corners as the first one."""
    if len(data) < start + count.itemsize:
        return False
    first = int(np.frombuffer(data, count, 1, start)[0])
    if len(data) - start != n_faces * (count.itemsize + first * index.itemsize):
        return False
    face = np.dtype([("size", count), ("corners", index, first)])
    return bool((np.frombuffer(data, face, n_faces, start)["size"] == first).all())


def _positions(data, start, n_faces, count, index):
    """Where in the data the corners of each face start, and how many there are; two int64 (n_faces,)."""
    if start + n_faces * count.itemsize > len(data):
        raise ValueError(f"expected {n_faces} faces, found {max(0, len(data) - start)} bytes")
    positions, sizes = np.zeros(n_faces, np.int64), np.zeros(n_faces, np.int64)
    order = "big" if count.str[0] == ">" else "little"
    for face in range(n_faces):
        size = int.from_bytes(data[start : start + count.itemsize], order)
        positions[face], sizes[face] = start + count.itemsize, size
        start += count.itemsize + size * index.itemsize
        if start > len(data):
            raise ValueError(f"expected {n_faces} faces, found {face}")
    if (sizes < 3).any():
        face = int(np.argmax(sizes < 3))
        raise ValueError(f"expected faces with 3 corners or more, found face {face} with {sizes[face]}")
    return positions, sizes


def _fans(data, positions, sizes, index):
    """Triangles (first, previous, next corner) of each face, as indices of vertices; (n, 3)."""
    per_face = sizes - 2
    first = np.repeat(positions, per_face)
    step = np.arange(per_face.sum()) - np.repeat(np.cumsum(per_face) - per_face, per_face) + 1
    corners = np.stack([np.zeros_like(step), step, step + 1], axis=1)
    starts = first[:, None] + corners * index.itemsize
    raw = np.frombuffer(data, np.uint8)[starts[..., None] + np.arange(index.itemsize)]
    return np.ascontiguousarray(raw).view(index)[..., 0]
