"""From scene files to the scene graph: include, override, convert, and report every problem at once."""

import os

from artist_py.errors import SceneError
from artist_py.scene.fields import Table
from artist_py.scene.graph import Scene
from artist_py.scene.identity import scene_hash, settings
from artist_py.scene.includes import load_file, load_text
from artist_py.scene.messages import show
from artist_py.scene.overrides import apply_overrides
from artist_py.scene.spectrum_fields import given_names
from artist_py.scene.where import Where

__all__ = ["read_scene", "read_scene_text", "scene_hash", "settings"]
NAMED_SECTIONS = ("spectra", "materials", "objects")
LISTS = ("shapes", "instances", "emitters")
SINGLE_TABLES = ("film", "camera", "render")


def read_scene(path, overrides=()):
    """The Scene of a file and of all it includes; `overrides` maps dotted keys to TOML texts or values.

    Raises SceneError with all problems, sorted by file and line.
    """
    return _read(*load_file(os.fspath(path)), overrides)


def read_scene_text(text, file="scene.toml", overrides=()):
    """The Scene of a text; `file` is its name in messages, and its paths start in the folder of that."""
    return _read(*load_text(text, file), overrides)


def _read(sources, problems, overrides):
    """The Scene of its sources, the main one first; `problems` are those of loading them."""
    is_complete = bool(sources) and not problems
    problems = problems + apply_overrides(sources, overrides) if sources else problems
    names = {section: _named(sources, section) for section in NAMED_SECTIONS}
    names["incomplete"] = not is_complete
    problems += _duplicates(sources)
    problems += _missing(sources) if is_complete else []
    scenes = []
    for source in sources:
        source.names = names
        try:
            scenes.append(Table(Scene)(source.table, Where(source)))
        except SceneError as error:
            problems += error.problems
    if problems:
        raise SceneError(_sorted(problems, sources))
    return _merged(scenes)


def _sorted(problems, sources):
    """Each problem once, by file and line; --set comes last."""
    order = {source.file: index for index, source in enumerate(sources)}
    return sorted(dict.fromkeys(problems), key=lambda p: (order.get(p.file, len(order)), p.line or 0))


def _entries(source, section):
    """[(name or None, value, place)] of what a source has in a section, as far as it is well-formed."""
    at, content = Where(source, (section,)), source.table.get(section)
    if isinstance(content, dict):
        return [(name, value, at.at(name)) for name, value in content.items()]
    return _elements(content, at)


def _elements(content, at):
    """The same of an array of tables, where names are optional."""
    tables = content if isinstance(content, list) else []
    named = [(i, table) for i, table in enumerate(tables) if isinstance(table, dict)]
    return [(table.get("name"), table, at.at(i, "name")) for i, table in named]


def _named(sources, section):
    """{name: (value, place)} of a section of all sources."""
    return {name: (value, at) for source in sources for name, value, at in _entries(source, section)}


def _duplicates(sources):
    """Problems of names that are given twice, or taken."""
    problems = []
    for section in SINGLE_TABLES:
        tables = [(section, None, Where(s, (section,))) for s in sources if section in s.table]
        problems += _given_twice(tables)
    for section in NAMED_SECTIONS + LISTS:
        problems += _given_twice([entry for source in sources for entry in _entries(source, section)])
    for source in sources:
        for _, item, at in _entries(source, "objects"):
            if isinstance(item, dict):
                problems += _given_twice(_elements(item.get("shapes"), at.at("shapes")))
        for name, _, at in _entries(source, "spectra"):
            if name in given_names():
                problems.append(at.problem(f"the package has a spectrum {show(name)}, expected another name"))
    return problems


def _given_twice(entries):
    """A Problem for each entry whose name an earlier one has."""
    problems, first = [], {}
    for name, _, at in entries:
        if isinstance(name, str) and name in first:
            problems.append(at.problem(f"{show(name)} is already defined at {first[name].place()}"))
        elif isinstance(name, str):
            first[name] = at
    return problems


def _missing(sources):
    """Problems of what the files together must have."""
    if any("camera" in source.table for source in sources):
        return []
    return [Where(sources[0], ("camera",)).problem("missing, expected a table")]


def _merged(scenes):
    """One Scene of those of all files."""
    main = scenes[0]
    values = {"where": main.where}
    for section in SINGLE_TABLES:
        owner = next((scene for scene in scenes if section in scene.where.source.table), main)
        values[section] = getattr(owner, section)
    for section in NAMED_SECTIONS:
        values[section] = {k: v for scene in scenes for k, v in getattr(scene, section).items()}
    for section in LISTS:
        values[section] = tuple(item for scene in scenes for item in getattr(scene, section))
    return Scene(**values)
