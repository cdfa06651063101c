"""The kernel of bidirectional methods holds nothing of what a render does not want: the LLVM names what it holds."""

import numba
import numpy as np
import pytest
from kernel_code import code_of
from rendering import diffuse, look, scene, shape

from artist_py.core.table import Table
from artist_py.film.accumulation import Film
from artist_py.integrators.bidirectional import trace_pairs
from artist_py.samplers.backwards import BackwardsSampler
from artist_py.samplers.techniques import TechniqueRecorder, techniques_of_render

# Functions that only the code of a part calls.
TELLTALES = {
    "images of techniques": "add_to_technique",
    "light that hits the lens": "hit_lens",
    "several shadow rays": "lattice_point",
    "materials that are not merged at": "counts_of_sharp",
}
LENS = {"type": "thin-lens", "aperture_radius": 0.2}
SIZE = 8


def box(integrator, camera=(), samples=(), **material):
    """A closed box with a lamp."""
    return scene(
        [
            shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True),
            shape("rectangle", corner=[-1, -1, 0.99], edges=[[0, 1, 0], [1, 0, 0]], emission=1),
        ],
        materials={"wall": {**diffuse(0.5), **material}},
        camera={**look([0, 0, 0], [0, 1, 0]), **dict(camera)},
        film={"resolution": [SIZE, SIZE]},
        render={"integrator": integrator, "samples": dict(samples)},
    )


def compiled_code(compiled, with_techniques):
    """LLVM of `trace_pairs` for a scene."""
    recorder = None
    if with_techniques:
        recorder = TechniqueRecorder(techniques_of_render(compiled, 3), SIZE, SIZE)
    with BackwardsSampler(compiled, Film(SIZE, SIZE), 1, 1.0, recorder) as sampler:
        setup, _ = sampler._setup(0, np.zeros(4, np.int64), np.full((1, 2), -1, np.int64))
        return code_of(trace_pairs, (setup, 0, Table(sampler.image)))


def parts_in(code):
    """Which parts the code holds."""
    return {part for part, name in TELLTALES.items() if name in code}


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
class TestCode:
    """LLVM of one kernel."""

    def test_a_plain_render_holds_no_part(self):
        """All techniques, through a pinhole, without images of techniques."""
        assert parts_in(compiled_code(box("vcm"), False)) == set()

    def test_each_part_is_found_where_it_is_wanted(self):
        """The test above can fail. Without connections, which are no such part, this compiles in less time."""
        sharp = {"type": "phong", "specular": 0.4, "exponent": 1e5}
        rich = box("bpt", LENS, {"next_event": 2, "connections": 0}, **sharp)
        assert parts_in(compiled_code(rich, True)) == set(TELLTALES)
