"""How TOML values become typed values: the converters that the classes of the scene graph name, key by key.

A converter is called with a value and its place. It returns the typed value, or raises SceneError with all
problems it found; its `expected` says in words what it takes.
"""

import sys
from dataclasses import MISSING, dataclass, field, fields
from functools import cache
from typing import Any

from artist_py.errors import SceneError
from artist_py.scene.messages import expected, listing, nearest, show
from artist_py.scene.where import Where, problem

WHOLE_LIMIT = 2**31 - 1  # whole numbers end up in 32-bit fields
FLOAT_LIMIT = sys.float_info.max


@dataclass(frozen=True, kw_only=True)
class Node:
    """Anything read from the scene file; it knows where it stood there (None if made in Python)."""

    where: Where | None = field(default=None, compare=False, repr=False)

    def problems(self):
        """(key or None, message) of all that is wrong although each key by itself is right."""
        return ()


node = dataclass(frozen=True, kw_only=True)


def key(convert, default=MISSING, *, name=None):
    """A dataclass field that is a key of the scene file; `name` where that differs from the field's."""
    return field(default=default, metadata={"convert": convert, "name": name})


@cache
def keys_of(cls):
    """{key in the scene file: dataclass field} of a node class."""
    return {f.metadata["name"] or f.name: f for f in fields(cls) if "convert" in f.metadata}


def failure(at, message):
    """The SceneError of one problem."""
    return SceneError([at.problem(message)])


def convert_all(convert, items):
    """[convert(value, place)] of all items, or one SceneError with the problems of all."""
    values, problems = [], []
    for value, at in items:
        try:
            values.append(convert(value, at))
        except SceneError as error:
            problems += error.problems
    if problems:
        raise SceneError(problems)
    return values


@dataclass(frozen=True)
class Number:
    """A finite float, or int if `whole`, within the bounds given and not larger in size than `limit`."""

    at_least: float | None = None
    at_most: float | None = None
    above: float | None = None
    below: float | None = None
    whole: bool = False
    limit: float | None = None

    @property
    def expected(self):
        return "a whole number" if self.whole else "a number"

    def __call__(self, value, at):
        kinds = int if self.whole else (int, float)
        if isinstance(value, bool) or not isinstance(value, kinds):
            found = repr(value) if isinstance(value, float) else show(value)
            raise failure(at, f"expected {self.expected}, found {found}")
        if not abs(value) <= FLOAT_LIMIT:  # true for NaN; no conversion, which an int may be too large for
            raise failure(at, expected("a finite number", value))
        if not self.allows(value):
            raise failure(at, expected(self.range(at), value))
        limit = self.limit or (WHOLE_LIMIT if self.whole else FLOAT_LIMIT)
        if abs(value) > limit:
            raise failure(at, expected(f"{self.expected} of size {show(limit)} at most", value))
        return value if self.whole else float(value)

    def allows(self, number):
        """Whether `number` keeps the bounds."""
        return not (
            (self.at_least is not None and number < self.at_least)
            or (self.at_most is not None and number > self.at_most)
            or (self.above is not None and number <= self.above)
            or (self.below is not None and number >= self.below)
        )

    def range(self, at):
        """The bounds as a formula of the key, such as "0 <= reflectance <= 1"."""
        name = next((k for k in reversed(at.keys) if isinstance(k, str)), "value")
        low, below = (self.above, "<") if self.at_least is None else (self.at_least, "<=")
        high, above = (self.below, "<") if self.at_most is None else (self.at_most, "<=")
        if low is None:
            return f"{name} {above} {show(high)}"
        if high is None:
            return f"{name} {below.replace('<', '>')} {show(low)}"
        return f"{show(low)} {below} {name} {above} {show(high)}"


@dataclass(frozen=True)
class Array:
    """An array of `count` (or at least `at_least`) elements of one kind, as a tuple; `expected` in words."""

    element: Any
    count: int | None = None
    at_least: int = 0
    expected: str = "an array"

    def __call__(self, value, at):
        if not isinstance(value, list | tuple):
            raise failure(at, expected(self.expected, value))
        if len(value) < self.at_least or self.count not in (None, len(value)):
            raise failure(at, expected(self.expected, value))
        return tuple(convert_all(self.element, ((v, at.at(i)) for i, v in enumerate(value))))


def numbers(count, words, element=Number()):
    """An array of `count` numbers; `words` tells what they are."""
    return Array(element, count, expected=words)


@dataclass(frozen=True)
class Flag:
    """true or false."""

    expected = "true or false"

    def __call__(self, value, at):
        if not isinstance(value, bool):
            raise failure(at, expected(self.expected, value))
        return value


@dataclass(frozen=True)
class Text:
    """A string that is not empty."""

    expected = "a string"

    def __call__(self, value, at):
        if not isinstance(value, str):
            raise failure(at, expected(self.expected, value))
        if not value:
            raise failure(at, "expected a string that is not empty")
        return value


@dataclass(frozen=True)
class FilePath:
    """The path of a file, relative to the folder of the scene file that names it."""

    expected = "the path of a file"

    def __call__(self, value, at):
        if not isinstance(value, str) or not value or "\0" in value:
            raise failure(at, expected(self.expected, value))
        return str(at.folder / value)


@dataclass(frozen=True)
class Choice:
    """One of a few words or whole numbers."""

    options: tuple

    @property
    def expected(self):
        return listing(self.options)

    def __call__(self, value, at):
        if isinstance(value, str | int) and not isinstance(value, bool) and value in self.options:
            return value
        near = nearest(value, self.options, otherwise=False) if isinstance(value, str) else ""
        raise failure(at, expected(self.expected, value) + near)


@dataclass(frozen=True)
class Reference:
    """The name of something in another section of the scene, such as a material."""

    section: str

    @property
    def expected(self):
        return f"the name of one of the {self.section}"

    def __call__(self, value, at):
        name = Text()(value, at)
        known = at.source.names.get(self.section, {})
        if name not in known and not at.source.names.get("incomplete"):
            hint = nearest(name, known) or f", the scene has no {self.section}"
            raise failure(at, f"unknown {self.section.removesuffix('s')} {show(name)}{hint}")
        return name


@dataclass(frozen=True)
class Dictionary:
    """A table of named things of one kind."""

    element: Any
    expected = "a table of named tables"

    def __call__(self, value, at):
        if not isinstance(value, dict):
            raise failure(at, expected(self.expected, value))
        if "" in value:
            raise failure(at.at(""), "expected a name that is not empty")
        elements = convert_all(self.element, ((v, at.at(name)) for name, v in value.items()))
        return dict(zip(value, elements, strict=True))


@dataclass(frozen=True)
class Table:
    """A table whose keys are the fields of the node class `cls`."""

    cls: type
    expected = "a table"

    def __call__(self, value, at, known_apart=()):
        if not isinstance(value, dict):
            raise failure(at, expected(self.expected, value))
        known = keys_of(self.cls)
        unknown = [name for name in value if name not in known and name not in known_apart]
        strange = [at.at(name).problem(unknown_key(name, [*known, *known_apart], value)) for name in unknown]
        values, problems = {}, self._missing(value, at)
        for name in (name for name in value if name in known):
            try:
                values[known[name].name] = known[name].metadata["convert"](value[name], at.at(name))
            except SceneError as error:
                problems += error.problems
        if not problems:
            node = self.cls(**values, where=at)
            problems = [problem(node, name, message) for name, message in node.problems()]
        if strange or problems:
            raise SceneError([*strange, *problems])
        return node

    def _missing(self, value, at):
        """Problems of keys that must be there and are not."""
        return [
            at.at(name).problem(f"missing, expected {f.metadata['convert'].expected}")
            for name, f in keys_of(self.cls).items()
            if f.default is MISSING and name not in value
        ]


def unknown_key(name, known, given):
    """The message of a key that does not exist, with the nearest one still free, or all there are."""
    free = [key for key in known if key not in given]
    return "unknown key" + (nearest(name, free, otherwise=False) or nearest(name, known, cutoff=0.8))


@dataclass(frozen=True)
class Variant:
    """A table whose key `type` says which node class it is."""

    classes: dict
    expected = "a table"

    def __call__(self, value, at):
        if not isinstance(value, dict):
            raise failure(at, expected(self.expected, value))
        if "type" not in value:
            raise failure(at.at("type"), f"missing, expected {listing(self.classes)}")
        kind = Choice(tuple(self.classes))(value["type"], at.at("type"))
        return Table(self.classes[kind])(value, at, known_apart=("type",))


@dataclass(frozen=True)
class Forms:
    """A table that is told by one of its keys: {first key: node class}."""

    classes: dict
    expected: str

    def __call__(self, value, at):
        given = [name for name in self.classes if name in value] if isinstance(value, dict) else []
        if not given and isinstance(value, dict) and value:
            name = next(iter(value))
            raise failure(at.at(name), unknown_key(name, list(self.classes), value))
        if not given:
            raise failure(at, expected(self.expected, value))
        if len(given) > 1:
            raise failure(at, f"expected only one of {listing(given)}")
        return Table(self.classes[given[0]])(value, at)
