"""A scene's kernels contain the code of its own emitters and no other."""

import numba
import pytest
from rendering import MONOCHROME, compile_tables, diffuse, look, shape

from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3
from artist_py.emitters.dispatch import emitted_radiance, pdf_emitter, sample_emitter
from artist_py.emitters.emission import emission_over_next_event, sample_emission
from artist_py.jit import kernel
from artist_py.transport.next_event import radiance_of_background
from artist_py.transport.recording import Place
from artist_py.transport.subpath import Path

# Functions that only the code of the kind calls; the LLVM names every function that was compiled for a kernel.
TELLTALES = {
    "point": "emit_from_point",
    "spot": "spot_falloff",
    "directional": "sample_infinite",
    "environment": "is_in_background",
    "image": "first_above",
}
EMITTERS = {
    "point": {"type": "point", "position": [0, 0, 2], "spectrum": 1},
    "spot": {"type": "spot", "position": [0, 0, 2], "look_at": [0, 0, 0], "angle": 9, "spectrum": 1},
    "directional": {"type": "directional", "direction": [0, 0, 1], "spectrum": 1},
    "environment": {"type": "environment", "spectrum": 1},
}


@kernel
def use_everything(scene, path, wavelengths):
    emitter = scene.emitters.records[0]
    start = sample_emission(scene, emitter, 0.1, 0.2, 0.3, 0.4)
    point = sample_emitter(scene, emitter, path.origin, 0.1, 0.2)
    density = pdf_emitter(scene, emitter, path.origin, point.position, point.normal)
    density += emission_over_next_event(scene, emitter, point, point.position - path.origin, 1.0)
    radiance = emitted_radiance(scene, emitter, start.direction, wavelengths)
    place = Place(0, 0, wavelengths, wavelengths)
    return density, radiance + radiance_of_background(scene, path, 1, place, wavelengths, None)


def scene_with(emitters):
    ceiling = shape("rectangle", corner=[0, 0, 2], edges=[[0, 1, 0], [1, 0, 0]], emission=1)
    table = {
        "camera": {"type": "pinhole", **look([0, -3, 0], [0, 0, 0])},
        "render": {"wavelength_range": MONOCHROME},
        "materials": {"white": diffuse(0.5)},
        "shapes": [ceiling],
        "emitters": emitters,
    }
    return compile_tables(table)


def compiled_code(emitters):
    """LLVM of the kernel for a scene; numba shows none for what comes out of its cache."""
    uncached = numba.jit(**use_everything.targetoptions)(use_everything.py_func)
    compiled = scene_with(emitters)
    zero, w = Vec3((0.0, 0.0, 0.0)), Vec3((0.0, 0.6, 0.8))
    lanes = Spectrum([550.0] * 4)
    uncached(compiled.scene, Path(zero, w, lanes, 0.0, zero, 1.0, None, 0, False), lanes)
    (code,) = uncached.inspect_llvm().values()
    return code


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
class TestCode:
    """LLVM of one kernel for several scenes."""

    def test_shapes_alone_compile_nothing_for_other_emitters(self):
        code = compiled_code([])
        assert "sample_parallelogram" in code
        assert [kind for kind, name in TELLTALES.items() if name in code] == []

    def test_directional_light_has_no_background(self):
        code = compiled_code([EMITTERS["directional"]])
        assert TELLTALES["directional"] in code
        assert TELLTALES["environment"] not in code

    def test_all_but_images(self):
        code = compiled_code(list(EMITTERS.values()))
        assert [kind for kind, name in TELLTALES.items() if name not in code] == ["image"]


def test_one_table_is_enough():
    """Absent kinds leave no tables either."""
    emitters = scene_with([]).scene.emitters
    assert emitters.background is None
    assert emitters.images is None
    assert isinstance(emitters.records, Table)
