"""What tells one render from another: the effective settings, and a hash of what is rendered."""

import hashlib
import json
from pathlib import Path

from artist_py.errors import SceneError
from artist_py.scene.fields import FilePath, Node, keys_of
from artist_py.scene.graph import TYPE_NAMES, Scene
from artist_py.scene.includes import reason
from artist_py.scene.spectrum_types import Constant
from artist_py.scene.where import problem


def settings(scene: Scene):
    """Film, camera and render with all defaults filled in, as for JSON; null is "automatic" or "no limit"."""
    sections = ("film", "camera", "render")
    return {section: _plain(getattr(scene, section), lambda *place: place[-1]) for section in sections}


def scene_hash(scene: Scene):
    """SHA-256 in hexadecimal of what is rendered: all but [render]; files count by their bytes."""
    digests = {}

    def digest(node, key, path):
        if path not in digests:
            digests[path] = _digest(node, key, path)
        return digests[path]

    parts = keys_of(Scene).keys() - {"render", "include"}
    content = {name: _plain(getattr(scene, name), digest) for name in parts}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _digest(node, key, path):
    try:
        with Path(path).open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (OSError, ValueError) as error:
        raise SceneError([problem(node, key, f"{path}: {reason(error)}")]) from None


def _plain(value, of_path):
    """A part of the graph as dicts, lists, scalars; the path of a file as `of_path(node, key, path)`."""
    if isinstance(value, Constant):
        return value.value * value.scale
    if isinstance(value, Node):
        content = {"type": TYPE_NAMES[type(value)]} if type(value) in TYPE_NAMES else {}
        for name, f in keys_of(type(value)).items():
            item = getattr(value, f.name)
            is_path = isinstance(f.metadata["convert"], FilePath) and item is not None
            content[name] = of_path(value, name, item) if is_path else _plain(item, of_path)
        return content
    if isinstance(value, dict):
        return {name: _plain(item, of_path) for name, item in value.items()}
    if isinstance(value, tuple):
        return [_plain(item, of_path) for item in value]
    return value
