"""Imports point down only; and what is slow to load is not loaded before it is needed."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "artist_py"
CHAIN = ("samplers", "integrators", "transport", "physics", "core", "jit")
PHYSICS = {"bsdf", "emitters", "cameras", "geometry"}
KERNEL_LAYERS = {*CHAIN, *PHYSICS}
FOR_ALL = {"errors", "version", "data"}
SLOW = ("numba", "numpy", "scipy", "OpenImageIO", "trimesh", "colour", "rich", "matplotlib", "flip_evaluator")
FILES = sorted(str(path.relative_to(PACKAGE)) for path in PACKAGE.rglob("*.py"))


def allowed(layer):
    """Layers that files of `layer` may import; `scene.tables` counts as a layer of its own."""
    if layer in {"cli", "__init__", "__main__"}:
        return {*KERNEL_LAYERS, "scene", "scene.tables", "film", "compare", "evidence", "stress", "cli"}
    if layer == "evidence":
        return {"evidence", "compare", "samplers", "scene", "film", "jit"}
    if layer == "stress":
        return {"stress", "samplers", "scene", "film"}
    if layer == "scene":
        return {*KERNEL_LAYERS, "scene", "scene.tables", "film"} - {"samplers", "integrators"}
    if layer in {"film", "compare"}:
        return {layer, "film", "core", "jit"}
    below = (
        CHAIN[CHAIN.index("physics" if layer in PHYSICS else layer) + 1 :] if layer in KERNEL_LAYERS else ()
    )
    others = PHYSICS if "physics" in below else set()
    if layer in PHYSICS:
        others = {"geometry"}  # emitters have shapes
    if layer in {"samplers", "integrators"}:
        others = {*PHYSICS, "film"}
    return {layer, *below, *others, "scene.tables"}


def imported_modules(source, file):
    """Dotted names below `artist_py` that `file`, a path within it, imports anywhere."""
    for node in ast.walk(ast.parse(source)):
        names = [alias.name for alias in getattr(node, "names", ())]
        if isinstance(node, ast.ImportFrom):
            package = ("artist_py", *Path(file).parts)[: -node.level] if node.level else ()
            base = ".".join(filter(None, (*package, node.module)))
            names = [f"{base}.{name}" for name in names]
        elif not isinstance(node, ast.Import):
            continue
        yield from (name.removeprefix("artist_py.") for name in names if name.startswith("artist_py."))


def upward_imports(source, file):
    """Imports in `source` that `file` may not have."""
    layer = Path(file).parts[0].removesuffix(".py")
    for module in imported_modules(source, file):
        parts = module.split(".")
        target = "scene.tables" if parts[:2] == ["scene", "tables"] else parts[0]
        if target not in allowed(layer) | FOR_ALL:
            yield module


@pytest.mark.parametrize("file", FILES)
def test_imports_point_down(file):
    """No file imports from a layer above its own."""
    assert list(upward_imports((PACKAGE / file).read_text(encoding="utf-8"), file)) == []


@pytest.mark.parametrize(
    ("file", "source", "found"),
    [
        ("core/rng.py", "from artist_py.transport import mis", ["transport.mis"]),
        ("core/rng.py", "def f():\n    import artist_py.cli.main", ["cli.main"]),
        (
            "core/rng.py",
            "from ..bsdf.types import X\nfrom .warp import y\nfrom .. import jit",
            ["bsdf.types.X"],
        ),
        ("bsdf/types.py", "from artist_py.scene.tables import X\nfrom artist_py.core.rng import y", []),
        ("bsdf/types.py", "from artist_py.scene import graph", ["scene.graph"]),
        ("samplers/stochastic.py", "from artist_py.film.image import X\nfrom ..scene import tables", []),
        ("film/exr.py", "from artist_py import scene, errors", ["scene"]),
        ("jit.py", "from .core import rng", ["core.rng"]),
    ],
)
def test_the_rule_itself(file, source, found):
    """Upward imports are found wherever they stand, and downward ones are not."""
    assert list(upward_imports(source, file)) == found


@pytest.mark.parametrize(
    "code", ["import artist_py", "from artist_py.cli.main import main; main(['--help'])"]
)
def test_nothing_slow_at_startup(code):
    """The package and the help of the command load in no time."""
    script = f"import sys\n{code}\nprint([name for name in {SLOW} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
