"""Files that appear whole or not at all."""

import os
import secrets
from contextlib import contextmanager, suppress
from pathlib import Path

from artist_py.errors import OutputError


@contextmanager
def replacing(path):
    """Yield a temporary path beside `path`; it takes that name when the block ends, and vanishes when it fails.

    The data are on the disk before the name changes, so that no crash leaves half a file under it. Operating system
    errors become OutputError.
    """
    path = Path(path)
    try:
        with _unnamed_twin(path) as temporary:
            yield temporary
            _flush(temporary)
            temporary.replace(_target(path))
            _flush_directory(temporary.parent)
    except (OSError, UnicodeError) as error:
        raise OutputError(f"{path}: cannot be written: {_reason(error)}") from error


def check_replaceable(path):
    """Raise OutputError unless a file can be made at `path` now; leaves nothing behind."""
    path = Path(path)
    try:
        with _unnamed_twin(path):
            pass
    except (OSError, UnicodeError) as error:
        raise OutputError(f"{path}: cannot be written: {_reason(error)}") from error


def _target(path):
    # A symbolic link keeps pointing where it did: the file behind it is what gets replaced.
    return Path(os.path.realpath(path))


@contextmanager
def _unnamed_twin(path):
    target = _target(path)
    str(target).encode()  # OpenImageIO takes UTF-8 names only
    if target.is_dir():
        raise OutputError(f"{path}: is a directory; give the name of a file")
    if not target.parent.is_dir():
        raise OutputError(f"{path}: there is no directory {str(target.parent)!r}")
    if target.exists() and not os.access(target, os.W_OK):
        raise OutputError(f"{path}: is read-only")
    # Not `tempfile`: its files are private, while an image gets the permissions that the user's umask gives.
    temporary = target.parent / f".artist-{secrets.token_hex(8)}{target.suffix}"
    os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    try:
        yield temporary
    finally:
        with suppress(FileNotFoundError):
            temporary.unlink()


def _flush(path):
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _flush_directory(path):
    # Some file systems cannot flush a directory; the file itself is safe by then.
    with suppress(OSError):
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _reason(error):
    if isinstance(error, UnicodeError):
        return "the name is not valid UTF-8"
    return getattr(error, "strerror", None) or str(error)
