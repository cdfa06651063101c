"""How kernels are compiled and where they are cached; the only importer of numba's decorators.

`kernel` is called from Python, once per pass. `function` is called from kernels; called from Python it is an
ordinary function, so that unit tests and debuggers see plain Python. An optional part of a scene travels as an
*argument* that is `None` when absent: numba prunes `if part is None` per type, and an absent part is not compiled.
"""

import hashlib
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

PACKAGE = Path(__file__).parent
KERNEL_SOURCES = (
    "jit.py",
    "core",
    "geometry",
    "bsdf",
    "emitters",
    "cameras",
    "transport",
    "integrators",
    "film/accumulation.py",
    "scene/tables.py",
)
KEPT_SECONDS = 14 * 86400


def source_digest(package=PACKAGE):
    """Hexadecimal digest of every source that a kernel can contain, and of the interpreter.

    numba checks only the file of the kernel itself, so that an edited callee in another file would replay old code;
    a cache directory named by this digest cannot.
    """
    digest = hashlib.sha256(sys.version.encode())
    for source in KERNEL_SOURCES:
        path = package / source
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(file.relative_to(package).as_posix().encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def cache_root():
    """Directory of all kernel caches: `ARTIST_CACHE_DIR`, or `artist` in the user's cache directory."""
    chosen = os.environ.get("ARTIST_CACHE_DIR")
    if chosen:
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "artist"


def open_cache():
    """This version's cache directory, made where needed; a temporary one where the user's cannot be written."""
    directory = cache_root() / source_digest()
    try:
        directory.mkdir(parents=True, exist_ok=True)
        os.utime(directory)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError:
        return Path(tempfile.mkdtemp(prefix="artist-kernels-"))
    forget_old_caches(directory.parent)
    return directory


def forget_old_caches(root):
    """Remove the caches below `root` that no process has opened for a while."""
    oldest = time.time() - KEPT_SECONDS
    for path in root.iterdir():
        if path.is_dir() and path.stat().st_mtime < oldest:
            shutil.rmtree(path, ignore_errors=True)


CACHE = open_cache()
os.environ["NUMBA_CACHE_DIR"] = str(CACHE)

import numba  # noqa: E402 - the cache directory must be named before numba reads its settings
from numba.extending import register_jitable  # noqa: E402

numba.config.CACHE_DIR = str(CACHE)

# No nnan and no ninf: NaN and infinity must keep their meaning in comparisons. (isfinite of a sum does not: it is
# x - x == 0, which reassociation makes true. Write abs(x) < inf.)
FASTMATH = {"nsz", "arcp", "contract", "afn", "reassoc"}

# Without numba's run time (_nrt) nothing in a kernel can allocate or count references: it would not compile.
# Inlining everything saves the scene's many words at every call, 30 % of the kernels' time, and compiles no slower.
kernel = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=FASTMATH, _nrt=False)
function = register_jitable(
    error_model="numpy", fastmath=FASTMATH, no_cfunc_wrapper=True, forceinline=True, _nrt=False
)


def callback(signature):
    """Decorator: a C callback that Embree calls from inside a traversal; `.address` is its entry point."""
    return numba.cfunc(signature, cache=True, nopython=True, error_model="numpy", fastmath=FASTMATH)


def cache_statistics(kernels):
    """`(hits, misses)` of the kernel cache, summed over dispatchers."""
    hits = sum(sum(each.stats.cache_hits.values()) for each in kernels)
    misses = sum(sum(each.stats.cache_misses.values()) for each in kernels)
    return hits, misses
