"""Where in which file something stands: cheap to keep, turned into a line only when a problem is reported."""

import re
from bisect import bisect_right
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from artist_py.errors import Problem
from artist_py.scene.messages import dotted


@dataclass(eq=False)
class Source:
    """One scene file: its name as shown to the user, its text, its parsed table."""

    file: str
    text: str
    table: dict
    names: dict = field(default_factory=dict)  # {section: what may be referred to}, of all files of the scene
    overridden: set = field(default_factory=set)  # paths of keys given by --set
    _headers: dict = field(default_factory=dict)  # {path of an array of tables: positions of its headers}

    def line(self, keys):
        """Line (1-based) of the deepest part of the path `keys` that the text has, or None."""
        position = None
        node = self._spanned
        for depth, key in enumerate(keys):
            inner = node.inner() if node is not None else None
            if isinstance(inner, dict) and key in inner:
                position = next(k for k in inner if k.inner() == key).span().start
                node = inner[key]
            elif isinstance(inner, list) and isinstance(key, int) and key < len(inner):
                node = inner[key]
                element = node.span()
                position = element.start if element.stop else self._header(tuple(keys[:depth]), key, position)
            else:
                break
        return None if position is None else bisect_right(self._line_starts, position)

    def _header(self, keys, index, default):
        """Position of the header of element `index` of the array of tables `keys`; the parser keeps none."""
        if keys not in self._headers:
            name = r"[ \t]*\.[ \t]*".join(rf"[\"']?{re.escape(str(key))}[\"']?" for key in keys)
            matches = re.finditer(rf"^[ \t]*(\[\[)[ \t]*{name}[ \t]*\]\]", self._text, re.MULTILINE)
            self._headers[keys] = [match.start(1) for match in matches]
        found = self._headers[keys]
        return found[index] if index < len(found) else default

    @cached_property
    def _text(self):
        return self.text.replace("\r\n", "\n")

    @cached_property
    def _line_starts(self):
        return [0, *(match.end() for match in re.finditer("\n", self._text))]

    @cached_property
    def _spanned(self):
        import spanned_toml

        try:
            return spanned_toml.loads(as_toml_1_0(self._text))
        except (ValueError, RecursionError):  # an escape of TOML 1.1: problems are then told without a line
            return None


@dataclass(frozen=True, slots=True)
class Where:
    """A place in a scene file: the source and the path of keys and indices to the value."""

    source: Source
    keys: tuple = ()

    def at(self, *keys):
        """The place `keys` further down."""
        return Where(self.source, self.keys + keys)

    @property
    def is_overridden(self):
        """Whether the value here was given by --set."""
        return any(self.keys[:depth] in self.source.overridden for depth in range(1, len(self.keys) + 1))

    @property
    def folder(self):
        """The folder that paths written here are relative to: the file's, or for --set the current one."""
        return Path() if self.is_overridden else Path(self.source.file).parent

    def place(self):
        """File and line, as a message names them."""
        return str(replace(self.problem(""), key=None))

    def problem(self, message):
        """A Problem at this place."""
        key = dotted(self.keys) or None
        if self.is_overridden:
            return Problem(message, "--set", None, key)
        return Problem(message, self.source.file, self.source.line(self.keys), key)


def problem(node, key, message):
    """A Problem with `key` (dotted, or None for the whole) of a node of the scene graph."""
    keys = key.split(".") if key else ()
    if node.where is None:  # made in Python, not read from a file
        return Problem(message, key=key)
    return node.where.at(*keys).problem(message)


_PART = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*|[{}\n,]|[^\s{},"\'#]+',
    re.DOTALL,
)


def as_toml_1_0(text):
    """The text with spaces for what TOML 1.1 allows inside { }: line ends, comments and a comma at the end.

    `spanned_toml` knows TOML 1.0 only; all positions stay.
    """
    pieces, end, depth, comma = [], 0, 0, None
    for match in _PART.finditer(text):
        part = match.group()
        pieces.append(text[end : match.start()])
        end = match.end()
        depth += (part == "{") - (part == "}")
        if depth > 0 and part[0] in "#\n":
            part = " " * len(part)
        elif part == "}" and comma is not None:
            pieces[comma] = " "
        if part.strip():
            comma = len(pieces) if part == "," else None
        pieces.append(part)
    return "".join([*pieces, text[end:]])
