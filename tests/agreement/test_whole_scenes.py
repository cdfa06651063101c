"""Every integrator against bidirectional path tracing, on whole scenes."""

import pytest
from whole_scenes import Renders, allowed_t, assert_agrees, names_for, smallest_t, unbiased


@pytest.fixture(scope="module")
def renders(tmp_path_factory):
    return Renders(tmp_path_factory.mktemp("scenes"))


@pytest.mark.parametrize("name", names_for("pt"))
def test_path_tracing(renders, name):
    assert_agrees(renders, name, "pt")


@pytest.mark.parametrize("name", names_for("lt"))
def test_light_tracing(renders, name):
    assert_agrees(renders, name, "lt")


@pytest.mark.parametrize("name", names_for("ppm"))
def test_progressive_photon_mapping(renders, name):
    assert_agrees(renders, name, "ppm")


@pytest.mark.parametrize("name", names_for("bpm"))
def test_bidirectional_photon_mapping(renders, name):
    assert_agrees(renders, name, "bpm")


@pytest.mark.parametrize("name", names_for("vcm"))
def test_vertex_connection_and_merging(renders, name):
    assert_agrees(renders, name, "vcm")


def test_what_is_left_out_would_be_found(renders):
    """Light tracing does not see point emitters' light in mirrors: the comparison shows what is missing."""
    name = "spots and a point, one reflection"
    deviation, slope = unbiased(renders, name, "lt")
    scale = renders.image(name, "bpt").mean()
    assert deviation.mean() < -0.05 * scale
    whole = (each.mean(axis=(1, 2)) for each in (deviation, slope))
    assert smallest_t(*whole, scale).max() > allowed_t()
