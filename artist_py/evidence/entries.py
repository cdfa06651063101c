"""What is compared: integrators, each with settings of its own, as `pt:wavelengths=shared:hero_count=8`."""

import dataclasses
import hashlib
import json
from typing import NamedTuple

from artist_py.errors import OptionError
from artist_py.scene.compile import compile_scene
from artist_py.scene.identity import scene_hash
from artist_py.scene.reader import read_scene

OPENING, CLOSING, QUOTES = "[{", "]}", "\"'"


class Entry(NamedTuple):
    """One curve of a plot: an integrator and what it changes in the scene file."""

    label: str  # as the user wrote it
    integrator: str
    settings: tuple  # (dotted key, value) texts


def parse_entries(text):
    """Entries of NAME[:KEY=VALUE]... with commas between; a KEY without a dot is one of [render].

    Commas and colons in brackets and quotes belong to the value. OptionError for what is not such a list.
    """
    entries = [_entry(part.strip()) for part in _split(text, ",")]
    labels = [entry.label for entry in entries]
    for label in labels:
        if labels.count(label) > 1:
            raise OptionError(f"--integrators: {label!r} is there twice")
    return entries


def _entry(text):
    name, *assignments = _split(text, ":")
    settings = []
    for assignment in assignments:
        key, equals, value = (part.strip() for part in assignment.partition("="))
        if not (key and equals and value):
            raise OptionError(f"--integrators: {text!r} is not NAME:KEY=VALUE, such as pt:hero_count=8")
        settings.append((key if "." in key else f"render.{key}", value))
    if not name.strip():
        raise OptionError(f"--integrators: {text!r} does not begin with the name of an integrator")
    return Entry(text, name.strip(), tuple(settings))


def _split(text, separator):
    """Parts of `text` between separators that are in neither brackets nor quotes."""
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in QUOTES:
            quote = character
        depth += (character in OPENING) - (character in CLOSING) if not quote else 0
        if character == separator and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def compile_entry(scene, entry, overrides=(), threads=None):
    """The `CompiledScene` of a file as an entry renders it; `overrides` are those of all entries. SceneError."""
    settings = [*overrides, ("render.integrator", entry.integrator), *entry.settings]
    return compile_scene(read_scene(scene, settings), threads)


def with_seed(compiled, seed):
    """The same compiled scene with another seed."""
    render = dataclasses.replace(compiled.graph.render, seed=seed)
    return dataclasses.replace(compiled, graph=dataclasses.replace(compiled.graph, render=render))


def picture_of(compiled):
    """What an exact image depends on: scene with size and crop, path length and wavelengths; for `picture_hash`."""
    render = compiled.graph.render
    return {
        "scene": scene_hash(compiled.graph),
        "max_path_length": render.max_path_length,
        "wavelength_range": list(compiled.wavelength_range),
    }


def picture_hash(compiled):
    """SHA-256 in hexadecimal of `picture_of`: equal for renders that converge to the same image."""
    return hashlib.sha256(json.dumps(picture_of(compiled), sort_keys=True).encode()).hexdigest()
