"""Bytes of a PLY, OBJ, glTF or GLB file to trimesh objects that hold what the file holds.

trimesh reads some broken files without a word; those are refused here.
"""

import io
import logging
import re
import warnings

from artist_py.scene.messages import show
from artist_py.scene.ply_polygons import triangulate_ply

FORMATS = {".ply": "PLY", ".obj": "OBJ", ".gltf": "glTF", ".glb": "GLB"}

_INDEX_ZERO = re.compile(rb"^f(?:[ \t].*)?[ \t]0+(?=[/\s]|$).*", re.MULTILINE)
_RELATIVE = re.compile(rb"^f[ \t].*-\d.*", re.MULTILINE)
_NOT_FINITE = re.compile(rb"^v[ \t].*(?:nan|inf).*", re.MULTILINE | re.IGNORECASE)


def parse_mesh(data, path):
    """(trimesh scene, warnings) of the bytes of the file `path`, nothing merged or computed.

    Raises ValueError, with the words of a message, where the file is damaged or of another kind.
    """
    kind = FORMATS.get(path.suffix.lower())
    if kind is None:
        raise ValueError(f"unknown mesh format {show(path.suffix)}, expected {', '.join(FORMATS)}")
    if not data:
        raise ValueError("the file is empty")
    if kind == "PLY":
        return _parse_ply(data, path)
    if kind == "OBJ":
        return _parse_obj(data, path)
    return _load(data, kind, path), []


def _load(data, kind, path):
    import trimesh

    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # it logs what it raises, or what is checked here
    options = {"process": False, "fix_texture": False, "skip_materials": True}
    resolver = trimesh.resolvers.FilePathResolver(str(path))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # NumPy deprecates how trimesh parses text
        try:
            return trimesh.load_scene(io.BytesIO(data), kind.lower(), resolver, **options)
        except IndexError:
            raise ValueError("a face has a corner that is not in the file") from None
        except Exception as error:  # noqa: BLE001 - a damaged file may raise anything
            text = " ".join(f"{type(error).__name__}: {error}".split())[:120]
            raise ValueError(f"expected a whole {kind} file, found {text}") from None


def _parse_ply(data, path):
    """A PLY file that has as many elements as its header says."""
    scene = _load(triangulate_ply(data), "PLY", path)
    odd = []
    for geometry in scene.geometry.values():
        for name, element in geometry.metadata.get("_ply_raw", {}).items():
            rows = element.get("data")
            rows = next(iter(rows.values()), ()) if isinstance(rows, dict) else rows
            found = 0 if rows is None else len(rows)
            if found != element["length"]:
                raise ValueError(f"expected {element['length']} of the element {name}, found {found}")
            if "texcoord" in element["properties"]:
                odd.append("texture coordinates per face are not read, only those per vertex")
                geometry.visual.uv = None
    return scene, odd


def _parse_obj(data, path):
    """An OBJ file without what trimesh reads wrongly."""
    if match := _NOT_FINITE.search(data):
        raise ValueError(_at_line(data, match, "expected finite coordinates"))
    if match := _INDEX_ZERO.search(data):
        raise ValueError(_at_line(data, match, "expected indices from 1 on"))
    match = _RELATIVE.search(data)
    if match and data.rfind(b"\nv ") > match.start():
        raise ValueError(_at_line(data, match, "expected relative indices after the last vertex only"))
    scene, odd = _load(data, "OBJ", path), []
    for geometry in scene.geometry.values():
        if b"\nvn " in data and "vertex_normals" not in geometry._cache:  # noqa: SLF001 - trimesh's way to ask
            odd.append("normals are not read where some corners of an object have none")
        if b"\nvt " in data and getattr(geometry.visual, "uv", None) is None:
            odd.append("texture coordinates are not read where some corners of an object have none")
    return scene, list(dict.fromkeys(odd))


def _at_line(data, match, message):
    line = data.count(b"\n", 0, match.start()) + 1
    return f"line {line}: {message}, found {show(match.group().decode('utf-8', 'replace').strip())}"
