"""`--set key=value`: values that replace those of the scene file before it is checked."""

import copy
import re

from artist_py.errors import Problem, SceneError
from artist_py.scene.messages import dotted, expected, nearest, show

BARE_WORD = re.compile(r"[A-Za-z][\w./+-]*")


def apply_overrides(sources, overrides):
    """Change the tables of the sources by a mapping or pairs; the problems of what cannot be applied."""
    problems = []
    for text, value in dict(overrides).items():
        try:
            keys = parse_key(text)
            _apply(sources, keys, parse_value(value, keys))
        except SceneError as error:
            problems += error.problems
    return problems


def _failure(keys, message):
    return SceneError([Problem(message, "--set", None, dotted(keys))])


def parse_key(text):
    """The parts of a dotted key, which may be quoted as in TOML."""
    import tomli

    try:
        node, keys = tomli.loads(f"{text} = 0"), []
        while node != 0:
            [(key, node)] = node.items()
            keys.append(key)
    except (ValueError, AttributeError, RecursionError):
        raise _failure([], expected("a dotted key such as render.seed", text)) from None
    if keys[0] == "include":
        raise _failure(keys, "cannot be set, since files are included first")
    return keys


def parse_value(value, keys):
    """The value of a TOML text, where a word needs no quotes; anything but a text is the value itself."""
    import tomli

    if not isinstance(value, str):
        return copy.deepcopy(value)
    try:
        [(_, parsed)] = tomli.loads(f"value = {value}").items()
    except (ValueError, RecursionError):
        if not BARE_WORD.fullmatch(value):
            raise _failure(keys, expected("a value as in TOML", value)) from None
        return value
    return parsed


def _apply(sources, keys, value):
    """Set one value where its table is, in the main file if there is none yet."""
    source, first = _owner(sources, keys)
    container, path = source.table, []
    for depth, key in enumerate(keys):
        if isinstance(container, list):
            path.append(first if depth == 1 and first is not None else _index(container, key, keys[:depth]))
        elif isinstance(container, dict):
            path.append(key)
        else:
            raise _failure(keys, f"{dotted(keys[:depth])} is {show(container)} and has no keys")
        if depth == len(keys) - 1:
            container[path[-1]] = value
        elif isinstance(container, dict):
            container = container.setdefault(key, {})
        else:
            container = container[path[-1]]
    source.overridden.add(tuple(path))


def _owner(sources, keys):
    """The source that has what the keys lead to, and, for an array of tables, the index in that source.

    The elements of arrays of tables count through all files, in the order of the sources.
    """
    section, *rest = keys
    owners = [source for source in sources if section in source.table]
    lists = [source for source in owners if isinstance(source.table[section], list)]
    if rest and lists:
        elements = [(source, i) for source in lists for i in range(len(source.table[section]))]
        return elements[_index([source.table[section][i] for source, i in elements], rest[0], [section])]
    tables = [source for source in owners if isinstance(source.table[section], dict)]
    named = [source for source in tables if rest and rest[0] in source.table[section]]
    return (named or owners or sources)[0], None


def _index(elements, key, parents):
    """The index of an element of an array, by number or by its name."""
    if key.isdecimal() and len(key) < 10 and int(key) < len(elements):
        return int(key)
    names = [element.get("name") if isinstance(element, dict) else None for element in elements]
    if key in names:
        return names.index(key)
    known = [name for name in names if isinstance(name, str)]
    count = f", {dotted(parents)} has {len(elements)}"
    raise _failure([*parents, key], "no such element" + (nearest(key, known, otherwise=False) or count))
