"""What is in a compiled kernel: its LLVM names every function that was compiled for it, also where it was inlined."""

from artist_py.samplers.compiling import types_of


def code_of(kernel, arguments):
    """LLVM of `kernel` for `arguments`, from the cache where another test has compiled it.

    numba's own inspection shows nothing of what comes out of its cache, though the module lies there for linking.
    """
    types = types_of(kernel, arguments)
    kernel.compile(types)
    return str(kernel.overloads[types].library._get_module_for_linking())
