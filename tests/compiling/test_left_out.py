"""What a scene does not need is not compiled; nothing in a kernel allocates; the second process compiles nothing.

Each scene is compiled by a process of its own with an empty cache, which tells what was typed and lowered.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]

# What only a scene with the feature compiles: (module, function).
ONLY = {
    "dielectric": ("core.fresnel", "refract"),
    "dispersion": ("core.spectra", "choose_lane"),
    "media": ("transport.media", "filling_medium"),
    "conductor": ("core.fresnel", "fresnel_conductor"),
    "mirror": ("core.frame", "reflect"),
    "thin_dielectric": ("core.fresnel", "slab_reflectance"),
    "quadrics": ("geometry.quadrics", "quadric_position"),
    "instances": ("core.affine", "transform_normal"),
    "sphere_emitters": ("core.warp", "square_to_cone"),
    "alias": ("core.alias_table", "sample_alias"),
    "lens": ("cameras.lens", "sample_aperture"),
    "diffuse": ("core.warp", "square_to_cosine_hemisphere"),
    "fluorescence": ("bsdf.fluorescence", "reradiated"),
    "coated_dyes": ("bsdf.fluorescence", "_transmitted"),
    "shifting": ("transport.shifting", "redistributed"),
    "coated_shifting": ("bsdf.plastic", "base_below"),
}

SCRIPT = """
import importlib, json, sys, time
sys.path.insert(0, {tests!r})
from rendering import diffuse, look, render, scene, shape
from numba.core.registry import cpu_target
from artist_py.integrators.path_tracing import trace_paths

compiled = {scene}
begun = time.process_time()
statistics = render(compiled, 1).statistics
cpu_seconds = time.process_time() - begun
typing = cpu_target.typing_context
found = []
for name, (module, function) in {only!r}.items():
    called = getattr(importlib.import_module("artist_py." + module), function)
    if any(template._impl_cache for template in typing.resolve_value_type(called).templates):
        found.append(name)
text = "".join(trace_paths.inspect_llvm().values())
words = [word for word in ("NRT_", "rtcIntersect1", "rtcOccluded1", "llvm.cos", "@cos") if word in text]
counts = {{key: statistics[key] for key in ("cache_hits", "cache_misses")}}
print(json.dumps({{"found": found, "words": words, "cpu_seconds": cpu_seconds, **counts}}))
"""

DIFFUSE_BOX = """scene(
    [shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
     shape("rectangle", corner=[-1, -1, 0.99], edges=[[0, 1, 0], [1, 0, 0]], emission=1)],
    materials={"wall": diffuse(0.5)},
)"""
RICH = """scene(
    [shape("sphere", "flint", center=[0, 2, 0], radius=0.5),
     shape("sphere", "water", center=[0.3, 2, 0], radius=0.5),
     shape("disk", "gold", center=[2, 2, 0], normal=[-1, 0, 0], radius=1),
     shape("disk", "silver", center=[-2, 2, 0], normal=[1, 0, 0], radius=1),
     shape("disk", "pane", center=[0, 1, 0], normal=[0, 1, 0], radius=1),
     shape("disk", "dye", center=[0, 9, 0], normal=[0, -1, 0], radius=1),
     shape("sphere", center=[0, 0, 5], radius=1, emission=1),
     shape("sphere", center=[0, 0, -5], radius=1, emission=1)],
    materials={"flint": {"type": "dielectric", "ior": "N-SF11"}, "water": {"type": "dielectric", "ior": 1.33},
               "gold": {"type": "conductor", "metal": "Au"}, "silver": {"type": "mirror"},
               "pane": {"type": "thin-dielectric"},
               "dye": {"type": "fluorescent", "reradiation": {"excitation": [400, 30], "emission": [500, 20]},
                       "coat_ior": 1.5}},
    objects={"ball": [shape("sphere", "gold", center=[0, 0, 0], radius=0.2)]},
    instances=[{"object": "ball", "transform": [{"translate": [1, 1, 1]}]}],
    camera=look([0, 0, 0], [0, 1, 0]) | {"type": "thin-lens", "aperture_radius": 0.1, "focus_distance": 2},
    render={"wavelength_range": [380, 780]},
)"""


def run(code, cache):
    """What the script prints, by a process with this folder as its cache."""
    script = SCRIPT.format(tests=str(TESTS), scene=code, only=ONLY)
    environment = {**os.environ, "ARTIST_CACHE_DIR": str(cache)}
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def reports(tmp_path_factory):
    """Of a box of diffuse walls: compiled, and again by a second process."""
    cache = tmp_path_factory.mktemp("cache")
    return run(DIFFUSE_BOX, cache), run(DIFFUSE_BOX, cache)


def test_a_diffuse_box_compiles_nothing_else(reports):
    """One lamp, no glass, no metal, no exact shapes, no lens."""
    assert reports[0]["found"] == ["diffuse"]


def test_kernels_neither_allocate_nor_call_back(reports):
    """No run time of numba's, no sines: rays go straight to Embree."""
    assert reports[0]["words"] == ["rtcIntersect1", "rtcOccluded1"]


def test_the_second_process_compiles_nothing(reports):
    first, second = reports
    assert first["cache_misses"] == 2 and first["cache_hits"] == 0
    assert second["cache_misses"] == 0 and second["cache_hits"] == 2
    assert second["found"] == []
    assert first["cpu_seconds"] < 60  # it is about 8
    assert second["cpu_seconds"] < first["cpu_seconds"] / 2


@pytest.mark.slow
def test_what_a_scene_has_is_compiled(tmp_path):
    """The same functions are found where they are needed: the test above can fail."""
    assert set(run(RICH, tmp_path)["found"]) == set(ONLY) - {"shifting", "coated_shifting"}
    with_own = RICH.replace("render={", 'render={"wavelengths": "independent", ')
    assert set(run(with_own, tmp_path)["found"]) == set(ONLY) - {"fluorescence", "coated_dyes"}
