"""Scenes without textures contain no code of textures, and scenes without images none of images."""

import math

import numba
import numpy as np
import pytest
from rendering import diffuse, scene, shape

from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3
from artist_py.geometry.embree import closest_hit
from artist_py.geometry.surface import surface_at
from artist_py.jit import kernel
from artist_py.transport.sensing import Sensing
from artist_py.transport.subpath import start_path, vertex_at

# Functions that are called for textures only. The LLVM names every function that was compiled for a kernel.
TELLTALES = {
    "uv": "10quadric_uv",
    "table": "20textured_reflectance",
    "checkerboard": "7checker",
    "image": "11image_value",
}
PLATE = shape("rectangle", "paint", corner=[-1, 3, -1], edges=[[2, 0, 0], [0, 0, 2]])
BALL = shape("sphere", "paint", center=[0, 5, 0], radius=0.5, emission=1)


@kernel
def first_reflectance(scene, path, wavelengths):
    hit = closest_hit(scene.geometry.embree, path.origin, path.direction, math.inf)
    surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
    return vertex_at(scene, surface, path, wavelengths).reflectance


def compiled_code(reflectance):
    """LLVM of the kernel for a scene with this reflectance; numba shows none for what comes out of its cache."""
    uncached = numba.jit(**first_reflectance.targetoptions)(first_reflectance.py_func)
    compiled = scene([PLATE, BALL], materials={"paint": diffuse(reflectance)})
    sensing = Sensing(Spectrum(np.zeros(1)), None, Table(np.zeros(2)), None, None)
    camera = compiled.camera
    path = start_path(camera.position, Vec3((0.0, 1.0, 0.0)), sensing, camera.media)
    found = uncached(compiled.scene, path, Spectrum([550.5]))
    assert 0.0 < float(np.asarray(found)[0]) <= 1.0
    (code,) = uncached.inspect_llvm().values()
    return code


def names_in(code):
    return {name for name, mangled in TELLTALES.items() if mangled in code}


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
class TestCode:
    """LLVM of one kernel for three scenes."""

    def test_none_without_textures(self):
        assert names_in(compiled_code(0.5)) == set()

    def test_none_of_images_for_checkerboards(self):
        assert names_in(compiled_code({"checkerboard": [0.2, 0.8]})) == {"uv", "table", "checkerboard"}

    def test_all_for_images(self, tmp_path):
        (tmp_path / "a.pgm").write_bytes(b"P5\n2 1\n255\n\x80\xff")
        assert names_in(compiled_code({"image": str(tmp_path / "a.pgm")})) == set(TELLTALES)
