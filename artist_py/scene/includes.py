"""The files of a scene: the one asked for and, once each, all it includes; parsed, not yet understood."""

import os
import re
from pathlib import Path

from artist_py.errors import Problem, SceneError
from artist_py.scene.fields import FilePath
from artist_py.scene.where import Source, Where


def load_file(file):
    """([Source], [Problem]) of a scene file and all it includes; if it can be read, the file comes first."""
    try:
        return load_text(read_text(file), file)
    except (OSError, ValueError) as error:
        return [], [Problem(reason(error), file, getattr(error, "line", None))]


def load_text(text, file):
    """As `load_file`, of a text that `file` is the name of."""
    sources, problems = [], []
    _load(text, file, (), sources, problems)
    return sources, problems


def _load(text, file, chain, sources, problems):
    """Append the source of a text, then those it includes; `chain` holds the files that led here."""
    try:
        source = parse(text, file)
    except SceneError as error:
        problems += error.problems
        return
    sources.append(source)
    chain += (file,)
    for included, at in _included(source):
        if same := [other for other in chain if _is_same(included, other)]:
            problems.append(at.problem(f"includes itself: {' -> '.join([*chain, *same])}"))
        elif not any(_is_same(included, other.file) for other in sources):
            try:
                included_text = read_text(included)
            except (OSError, ValueError) as error:
                problems.append(at.problem(f"{included}: {reason(error)}"))
            else:
                _load(included_text, included, chain, sources, problems)


def _included(source):
    """(path, place) of the includes of a source; what is no path is reported when the source is converted."""
    paths = source.table.get("include")
    for index, path in enumerate(paths if isinstance(paths, list) else ()):
        at = Where(source, ("include", index))
        try:
            yield FilePath()(path, at), at
        except SceneError:
            continue


def _is_same(a, b):
    return os.path.realpath(a) == os.path.realpath(b)


class NotUtf8Error(ValueError):
    """A file that is not text; `line` is that of the first bad byte."""

    def __init__(self, error):
        self.line = error.object.count(b"\n", 0, error.start) + 1
        super().__init__(f"expected UTF-8, found the byte 0x{error.object[error.start]:02x}")


def read_text(file):
    """The text of a file; raises OSError, or ValueError where it is not UTF-8."""
    data = Path(file).read_bytes()
    try:
        return data.decode().removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        raise NotUtf8Error(error) from None


def reason(error):
    """Why a file cannot be read, in the words of a message."""
    known = {FileNotFoundError: "no such file", IsADirectoryError: "expected a file, found a directory"}
    strerror = getattr(error, "strerror", None)
    return known.get(type(error)) or (strerror.lower() if strerror else str(error))


def parse(text, file):
    """The Source of a TOML text; raises SceneError at the line of the first error."""
    import tomli

    try:
        return Source(file, text, tomli.loads(text))
    except tomli.TOMLDecodeError as error:
        text = re.sub(r"\('(.*?)',?\)", lambda keys: keys[1].replace("', '", "."), error.msg)
        text = text.replace("Cannot overwrite a value", "a key is given twice")
        message = f"not TOML: {text[:1].lower()}{text[1:]}, column {error.colno}"
        raise SceneError([Problem(message, file, error.lineno)]) from None
    except RecursionError:
        raise SceneError([Problem("not TOML: nested too deeply", file)]) from None
    except ValueError:  # Python's limit, which tomli passes on
        raise SceneError(
            [Problem("expected numbers of fewer digits, found one of thousands", file)]
        ) from None
