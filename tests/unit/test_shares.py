"""Shares of light subpaths: how many are chosen, and each as often as any other."""

import numpy as np
import pytest

from artist_py.core.rng import lattice_point
from artist_py.integrators.methods import Samples, method_of, share_of, subset_of
from artist_py.samplers.backwards import share_offsets
from artist_py.transport.shares import Chosen, Share, is_chosen, is_vertex_wanted


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.5, 0.999])
@pytest.mark.parametrize("offset", [0.0, 0.4, 0.99])
def test_a_share_is_spread_evenly(share, offset):
    chosen = np.array([is_chosen(Share(share, offset), i) for i in range(2000)])
    assert abs(chosen.sum() - 2000 * share) <= 1
    gaps = np.diff(np.flatnonzero(chosen))
    assert gaps.size == 0 or gaps.max() - gaps.min() <= 1


def test_every_subpath_is_as_likely_as_any_other():
    offsets = (np.arange(1000) + 0.5) / 1000
    for index in (0, 1, 17, 999):
        found = np.mean([is_chosen(Share(0.37, offset), index) for offset in offsets])
        assert found == pytest.approx(0.37, abs=1.1e-3)


def test_all_of_them_are_absent():
    assert share_of(1.0, 0.3) is None
    assert is_chosen(None, 5)


def test_vertices_are_kept_for_connections_or_merges():
    none, some = Share(0.0, 0.5), Share(0.5, 0.0)
    wanted = [is_vertex_wanted(Chosen(none, None, some), i) for i in range(6)]
    assert wanted == [is_chosen(some, i) for i in range(6)]
    assert is_vertex_wanted(Chosen(none, none, None), 3)
    assert not is_vertex_wanted(Chosen(none, None, none), 3)


def test_offsets_are_uniform_and_new_in_every_iteration():
    offsets = np.array([share_offsets(3, i) for i in range(4000)])
    assert offsets.min() >= 0 and offsets.max() < 1
    for column in offsets.T:
        counts = np.histogram(column, 10, (0, 1))[0]
        assert np.all(np.abs(counts - 400) <= 4)  # far more even than at random


def test_lattice_points_are_uniform():
    point, points = (0.3, 0.9, 0.1), []
    for _ in range(1000):
        point = lattice_point(*point)
        points.append(point)
    for column in np.transpose(points):
        assert np.all(np.abs(np.histogram(column, 10, (0, 1))[0] - 100) <= 3)


class TestCounts:
    """What weights and estimates divide by."""

    def test_as_many_as_there_are(self):
        method = method_of("vcm", 100, 2.0, 0.0, 0.01)
        assert method.counts[:5] == (1.0, 1.0, 2.0, 2.0, pytest.approx(2.0))
        assert method.chosen == (None, None, None)
        assert method.shadow_rays is None

    def test_numbers(self):
        samples = Samples(next_event=3, connections=0.5, light_image=0.25, merging=0.1)
        method = method_of("vcm", 100, 2.0, 0.0, 0.01, lens=True, samples=samples, offsets=(0.1, 0.2, 0.3))
        assert method.counts[:5] == (1.0, 3.0, 0.5, 0.5, pytest.approx(0.2))
        assert method.counts.lens == 0.5
        assert method.chosen == (Share(0.25, 0.1), Share(0.25, 0.2), Share(0.1, 0.3))
        assert method.n_image_paths == 50.0 and method.n_photon_paths == pytest.approx(20.0)

    def test_no_more_connections_than_light_paths(self):
        """Memory may have left fewer of these than the scene asks for."""
        method = method_of("bpt", 100, 0.5, 0.0, 0.01, samples=Samples(connections=1.0))
        assert method.counts.vc == 0.5

    def test_zero_leaves_out(self):
        assert not subset_of("vcm", Samples(next_event=0)).nee
        subset = subset_of("bpt", Samples(0, 0, 0, 0))
        assert subset.hit and not subset.light_paths
        method = method_of("bpt", 100, 1.0, 0.0, 0.01, samples=Samples(connections=0))
        assert method.techniques.connect is None and method.counts.vc == 0.0
