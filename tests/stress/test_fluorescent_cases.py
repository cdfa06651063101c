"""What fluorescent stress cases expect is worked out apart from the program: both must have the same matrices."""

import numpy as np
import pytest

from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.stress.case import Radiance
from artist_py.stress.cases.fluorescence import CASES
from artist_py.stress.fluorescence import light_in_room, luminance
from artist_py.stress.measure import scene_text


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_bins_of_the_program_give_what_is_expected(case, tmp_path):
    """And it warns of what it is said to warn of, in scenes that its integrators take."""
    for name, write, arguments in case.files:
        write(tmp_path / name, *arguments)
    for integrator in case.integrators:
        compiled = compile_scene(
            read_scene_text(scene_text(case, integrator, 1), str(tmp_path / "scene.toml"))
        )
    lamp, materials = compiled.scene.emitters.records.array[0], compiled.scene.materials.array
    wall = materials[materials["fluorescence"] >= 0][0]
    spectra = compiled.spectra.astype(float)
    scatter = compiled.fluorescence.matrices[0] + np.diag(spectra[wall["reflectance"]])
    emission = spectra[lamp["spectrum"]] * lamp["scale"]
    found = luminance(light_in_room(emission, scatter, compiled.graph.render.max_path_length))
    if isinstance(case.expect, Radiance):
        assert found == pytest.approx(case.expect.value, rel=2e-6)
    assert found > 0
    assert any(case.warning in text for text in compiled.warnings) or not case.warning
