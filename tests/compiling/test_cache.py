"""The kernel cache never replays what was edited, wherever the edit was, and keeps itself tidy."""

import ast
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from artist_py import jit

PACKAGE = Path(jit.__file__).parent
DECORATORS = {"kernel", "function", "callback", "primitive"}
PROBE = '''"""A kernel that calls another file's function."""

from ..jit import kernel
from .frame import length
from .vector import vec3


@kernel
def probe(x):
    return length(vec3(x, 0.0, 0.0))
'''
SCRIPT = """
from artist_py.core.probe import probe
print(probe(3.0), sum(probe.stats.cache_hits.values()), sum(probe.stats.cache_misses.values()))
"""


@pytest.fixture
def package(tmp_path):
    """A copy of the package with one more kernel, and a script to call it."""
    copy = tmp_path / "artist_py"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy / "core" / "probe.py").write_text(PROBE, encoding="utf-8")
    return copy


def run(package):
    """(result, cache hits, cache misses) of the probe, by a process of its own."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(package.parent),
        "ARTIST_CACHE_DIR": str(package.parent / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
        cwd=package.parent,
    )
    assert done.returncode == 0, done.stderr
    value, hits, misses = done.stdout.split()
    return float(value), int(hits), int(misses)


def test_an_edited_callee_is_compiled_anew(package):
    """The edit is in another file than the kernel, of the same length, and comes back."""
    frame = package / "core" / "frame.py"
    original = frame.read_text(encoding="utf-8")
    edited = original.replace("return math.sqrt(dot(v, v))", "return math.fabs(dot(v, v))")
    assert edited != original
    assert run(package) == (3.0, 0, 1)
    assert run(package) == (3.0, 1, 0)
    frame.write_text(edited, encoding="utf-8")
    assert run(package) == (9.0, 0, 1)
    frame.write_text(original, encoding="utf-8")
    assert run(package) == (3.0, 1, 0)


def test_every_kernel_source_counts(package):
    """The digest changes with any file that kernels are made of, and with no other."""
    before = jit.source_digest(package)
    for file in sorted(package.rglob("*.py")):
        source = file.read_text(encoding="utf-8")
        file.write_text(source + "\n# edited\n", encoding="utf-8")
        changed = jit.source_digest(package) != before
        file.write_text(source, encoding="utf-8")
        assert changed == is_covered(file.relative_to(package)), file
    assert jit.source_digest(package) == before


def test_new_and_renamed_sources_count(package):
    before = jit.source_digest(package)
    (package / "core" / "another.py").write_text("", encoding="utf-8")
    added = jit.source_digest(package)
    (package / "core" / "another.py").rename(package / "core" / "other.py")
    assert len({before, added, jit.source_digest(package)}) == 3


def is_covered(path):
    return any(path.is_relative_to(source) for source in jit.KERNEL_SOURCES)


def sources():
    """(path within the package, syntax tree) of every module."""
    for file in sorted(PACKAGE.rglob("*.py")):
        yield file.relative_to(PACKAGE), ast.parse(file.read_text(encoding="utf-8"))


def test_all_compiled_code_is_covered():
    """Whatever is decorated as compiled stands in a file that the digest reads."""
    for path, tree in sources():
        names = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                decorators = [getattr(item, "func", item) for item in node.decorator_list]
                names |= {item.id for item in decorators if isinstance(item, ast.Name)}
        assert not names & DECORATORS or is_covered(path), path


def test_what_kernels_import_is_covered():
    """Constants are compiled in: a kernel's file imports from the package nothing that the digest does not read."""
    for path, tree in sources():
        if not is_covered(path):
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (
                node.level or (node.module or "").startswith("artist_py.")
            ):
                parts = path.parts[: -node.level] if node.level else ()
                module = Path(*parts, *(node.module or "").removeprefix("artist_py.").split("."))
                targets = [module.with_suffix(".py")] if module.name else []
                targets += [module / f"{alias.name}.py" for alias in node.names]
                present = [target for target in targets if (PACKAGE / target).exists()]
                assert all(is_covered(each) or each == Path("errors.py") for each in present), (path, present)


# --- folders ------------------------------------------------------------------------------------------------------


def test_where_caches_are(monkeypatch, tmp_path):
    """ARTIST_CACHE_DIR, else XDG_CACHE_HOME, else the home's."""
    monkeypatch.setenv("ARTIST_CACHE_DIR", str(tmp_path / "mine"))
    assert jit.cache_root() == tmp_path / "mine"
    monkeypatch.delenv("ARTIST_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert jit.cache_root() == tmp_path / "xdg" / "artist"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert jit.cache_root() == Path.home() / ".cache" / "artist"


def test_old_caches_are_forgotten(monkeypatch, tmp_path):
    """Those that no process has opened for two weeks; not the others, and nothing that is no folder."""
    monkeypatch.setenv("ARTIST_CACHE_DIR", str(tmp_path))
    for name, days in (("young", 13), ("old", 15)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "kernel.nbc").write_bytes(b"x")
        age = time.time() - days * 86400
        os.utime(tmp_path / name, (age, age))
    (tmp_path / "file").write_text("", encoding="utf-8")
    opened = jit.open_cache()
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["file", "young", opened.name])
    assert opened == tmp_path / jit.source_digest()


def test_a_cache_that_cannot_be_written(monkeypatch, tmp_path):
    """A temporary one takes its place."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setenv("ARTIST_CACHE_DIR", str(tmp_path / "file"))
    opened = jit.open_cache()
    try:
        assert opened.is_dir() and tmp_path not in opened.parents
    finally:
        opened.rmdir()
