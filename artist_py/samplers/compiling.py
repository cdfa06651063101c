"""Compiling kernels in a process of its own, which takes LLVM's memory along when it ends (about 170 MiB for vcm).

The child is told modules, names and types of arguments, and leaves the machine code in the cache of kernels. What it
does not do, for whatever reason, the caller then does itself: nothing but memory depends on it.
"""

import contextlib
import importlib
import os
import pickle
import subprocess
import sys
from pathlib import Path

from ..jit import CACHE, cache_root

PACKAGE = Path(__file__).parents[1]


def types_of(kernel, arguments):
    """The types of a call's arguments."""
    return tuple(kernel.typeof_pyval(argument) for argument in arguments)


def is_cached(kernel, types):
    """Whether the cache has `kernel` for arguments of these types. numba has no public way to ask without loading."""
    cache = kernel._cache  # noqa: SLF001
    key = cache._index_key(types, kernel.targetctx.codegen())  # noqa: SLF001
    return key in cache._cache_file._load_index()  # noqa: SLF001


def compile_apart(calls):
    """Have what `[(kernel, arguments)]` needs compiled to the cache by a child process."""
    if CACHE.parent != cache_root():  # a temporary directory, which the child would not find
        return
    jobs = [(kernel, types_of(kernel, arguments)) for kernel, arguments in calls]
    missing = [
        (kernel.__module__, kernel.__name__, types) for kernel, types in jobs if not is_cached(kernel, types)
    ]
    if not missing:
        return
    paths = os.pathsep.join(filter(None, [str(PACKAGE.parent), os.environ.get("PYTHONPATH")]))
    with contextlib.suppress(OSError):
        subprocess.run(
            [sys.executable, "-m", "artist_py.samplers.compiling"],
            input=pickle.dumps(missing),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": paths},
            check=False,
        )


def main():
    """Compile what standard input asks for."""
    for module, name, types in pickle.load(sys.stdin.buffer):  # noqa: S301 - from our parent
        getattr(importlib.import_module(module), name).compile(types)


if __name__ == "__main__":
    main()
