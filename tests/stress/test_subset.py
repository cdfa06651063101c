"""A few of the extreme scenes with the simplest and the most complete integrator, by the command itself."""

import pytest

from artist_py.cli.main import main
from artist_py.stress.cases import gallery

CASES = (
    "lamp-1e-6",
    "radiance-1e30",
    "scale-1e-5-things",
    "offset-1e5-things",
    "nested-glass",
    "camera-in-nested-glass",
    "trap-cube",
    "light-at-1e-6-rad",
    "slivers-triangles",
    "field-of-view-179.99",
    "ultraviolet",
    "emitter-without-area",
)


def test_extreme_scenes(capsys):
    """A correct program fails by chance with probability 1e-3; the seed is fixed."""
    options = [part for name in CASES for part in ("--only", name)]
    code = main(["stress", *options, "--integrator", "pt", "--integrator", "vcm"])
    out = capsys.readouterr().out
    assert code == 0, out
    assert f"all {2 * len(CASES) - 1} cells are right" in out


def test_light_paths_that_are_not_whole(capsys):
    """Two or three per iteration: the third may not be lost, and none of an earlier iteration stay."""
    code = main(["stress", "--only", "light-paths-0.01", "--integrator", "bpm"])
    assert code == 0, capsys.readouterr().out


@pytest.mark.slow
def test_fluorescent_scenes(capsys):
    """Those of the gallery, by path tracing and by all techniques together."""
    options = [part for case in gallery.CASES for part in ("--only", case.name)]
    code = main(["stress", *options, "--integrator", "pt", "--integrator", "vcm"])
    out = capsys.readouterr().out
    assert code == 0, out
    assert f"all {2 * len(gallery.CASES)} cells are right" in out
