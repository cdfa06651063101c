"""Methods that merge everywhere against bidirectional path tracing, on whole scenes."""

import pytest
from whole_scenes import Renders, assert_agrees, names_for


@pytest.fixture(scope="module")
def renders(tmp_path_factory):
    return Renders(tmp_path_factory.mktemp("scenes"))


@pytest.mark.parametrize("name", names_for("bpm"))
def test_bidirectional_photon_mapping(renders, name):
    assert_agrees(renders, name, "bpm")


@pytest.mark.parametrize("name", names_for("vcm"))
def test_vertex_connection_and_merging(renders, name):
    assert_agrees(renders, name, "vcm")
