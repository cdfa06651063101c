"""Quadrics as Embree's user geometry, among others and in instances, against brute force over all shapes."""

import math

import numpy as np
import pytest
from quadric_cases import random_maps, random_rays

from artist_py.core.vector import vec3
from artist_py.geometry.embree import INVALID_ID, Device, EmbreeScene, closest_hit, is_occluded
from artist_py.geometry.quadric_callbacks import quadric_callbacks
from artist_py.geometry.quadric_records import quadric_records
from artist_py.jit import kernel
from artist_py.scene.tables import CONE, CYLINDER, DISK, SPHERE

# Rays whose answer changes when every shape grows or shrinks by this much are too close to an edge to compare.
DOUBT = 1e-4


@pytest.fixture(scope="module")
def device():
    return Device(1)


@pytest.fixture(scope="module")
def addresses():
    return quadric_callbacks()


def scene_of(device, addresses, quadrics, geometry_id=0):
    scene = EmbreeScene(device)
    scene.add_quadrics(geometry_id, quadrics, addresses, "shapes")
    return scene.commit()


@kernel
def trace_all(embree, origins, directions, t_far, distances, ids, occluded):
    for i in range(len(origins)):
        o = vec3(origins[i, 0], origins[i, 1], origins[i, 2])
        d = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        hit = closest_hit(embree, o, d, math.inf)
        distances[i] = hit.t
        ids[i, 0], ids[i, 1], ids[i, 2] = hit.geometry, hit.primitive, hit.instance
        occluded[i] = is_occluded(embree, o, d, t_far[i])


def embree_answers(scene, origins, directions, t_far):
    """Distances (inf for none), (geometry, primitive, instance) IDs and occlusion within t_far."""
    n = len(origins)
    distances, ids, occluded = np.empty(n), np.empty((n, 3), np.int64), np.empty(n, np.bool_)
    trace_all(scene.address, origins, directions, t_far, distances, ids, occluded)
    return distances, ids, occluded


def brute_force(kinds, maps, origins, directions):
    """Distance to and index of the nearest shape, per ray; textbook quadratics in the canonical frame."""
    nearest, index = np.full(len(origins), np.inf), np.full(len(origins), -1)
    for i, (kind, matrix) in enumerate(zip(kinds, maps, strict=True)):
        inverse = np.linalg.inv(matrix[:, :3])
        o, d = (origins - matrix[:, 3]) @ inverse.T, directions @ inverse.T
        for t in canonical_roots(kind, o, d):
            x, y, z = (o + d * t[:, None]).T
            is_inside = {SPHERE: z < np.inf, DISK: x * x + y * y <= 1.0}.get(kind, (z >= 0.0) & (z <= 1.0))
            is_first = is_inside & (t > 0.0) & (t < nearest)
            nearest[is_first], index[is_first] = t[is_first], i
    return nearest, index


def canonical_roots(kind, o, d):
    if kind == DISK:
        return [-o[:, 2] / d[:, 2]]
    form = np.array([1.0, 1.0, {SPHERE: 1.0, CYLINDER: 0.0, CONE: -1.0}[kind]])
    o = o - [0.0, 0.0, 1.0] if kind == CONE else o
    a, b, c = (form * d * d).sum(1), (form * o * d).sum(1), (form * o * o).sum(1) - (kind != CONE)
    with np.errstate(invalid="ignore"):
        root = np.sqrt(b * b - a * c)
    return [(-b - root) / a, (-b + root) / a]


def certain_answers(kinds, maps, origins, directions):
    """Brute force, and which rays it is sure of: those for which no slightly different size changes the shape found."""
    distances, index = brute_force(kinds, maps, origins, directions)
    is_sure = np.ones(len(origins), bool)
    for factor in (1.0 - DOUBT, 1.0 + DOUBT):
        other, other_index = brute_force(kinds, maps * [factor, factor, factor, 1.0], origins, directions)
        is_sure &= (other_index == index) & np.isclose(other, distances, rtol=0.01)
    return distances, index, is_sure


def check_rays(answers, expected, t_far, places, tolerance):
    """Embree's answers are the expected ones, with IDs places[index], wherever those are sure."""
    distances, ids, occluded = answers
    expected_distances, index, is_sure = expected
    is_hit = np.isfinite(expected_distances)
    assert is_sure.mean() > 0.98
    assert is_hit[is_sure].sum() > 1000
    assert (~is_hit[is_sure]).sum() > 1000
    assert (np.isfinite(distances) == is_hit)[is_sure].all()
    assert (ids[~is_hit & is_sure, 0] == INVALID_ID).all()
    sure_hits = is_sure & is_hit
    assert (ids[sure_hits] == places[index[sure_hits]]).all()
    assert np.allclose(distances[sure_hits], expected_distances[sure_hits], rtol=tolerance)
    is_clear = is_sure & ~np.isclose(t_far, expected_distances, rtol=0.001)
    assert (occluded == (expected_distances < t_far))[is_clear].all()
    assert 1000 < occluded.sum() < len(occluded) - 1000


@pytest.mark.parametrize("size", [0.5, 0.1])
def test_hits_and_occlusion_are_those_of_brute_force(device, addresses, size):
    """10 000 rays among 40 shapes of all kinds in one geometry, or 400 small ones; distances to float32 rounding."""
    rng = np.random.default_rng(1)
    n = 40 if size > 0.2 else 400
    kinds, maps = np.arange(n) % 4, random_maps(rng, n, size, 1.0)
    scene = scene_of(device, addresses, quadric_records(kinds, maps), 7)
    origins, directions = random_rays(rng, 10_000)
    t_far = rng.uniform(0.1, 2.0, 10_000).astype(np.float32).astype(float)
    places = np.stack([np.full(n, 7), np.arange(n), np.full(n, INVALID_ID)], axis=1)
    expected = certain_answers(kinds, maps, origins, directions)
    check_rays(embree_answers(scene, origins, directions, t_far), expected, t_far, places, 2.0**-23)


def test_instances_are_reported(device, addresses):
    """Two instances of shapes beside shapes in the top scene: each hit names its instance, or none."""
    rng = np.random.default_rng(2)
    kinds = np.arange(24) % 4
    maps = [random_maps(rng, 24, 0.3, 1.0), random_maps(rng, 24, 0.3, 1.0)]
    shared = scene_of(device, addresses, quadric_records(kinds, maps[1]), 5)
    placements = random_maps(rng, 2, 1.0, 0.5).astype(np.float32).astype(float)
    top = EmbreeScene(device)
    top.add_quadrics(3, quadric_records(kinds, maps[0]), addresses, "shapes")
    for geometry_id, placement in zip((10, 11), placements, strict=True):
        top.add_instance(geometry_id, shared, placement, "instance")
    top.commit()
    corner = np.tile([0.0, 0.0, 0.0, 1.0], (24, 1, 1))
    composed = [placement @ np.concatenate([maps[1], corner], axis=1) for placement in placements]
    origins, directions = random_rays(rng, 10_000)
    t_far = rng.uniform(0.1, 2.0, 10_000).astype(np.float32).astype(float)
    places = [
        (geometry, i, instance)
        for geometry, instance in ((3, INVALID_ID), (5, 10), (5, 11))
        for i in range(24)
    ]
    expected = certain_answers(np.tile(kinds, 3), np.concatenate([maps[0], *composed]), origins, directions)
    # Embree carries the ray into the instance in float32.
    check_rays(embree_answers(top, origins, directions, t_far), expected, t_far, np.array(places), 1e-4)


def test_a_disk_in_a_coordinate_plane_is_hit(device, addresses):
    """A box without thickness, at zero, loses no ray."""
    scene = scene_of(device, addresses, quadric_records([DISK], [np.eye(3, 4)]))
    origins = np.random.default_rng(6).uniform(-1.0, 1.0, (10_000, 3)).astype(np.float32).astype(float)
    below = origins - [0.0, 0.0, 1.5]
    up = np.tile([0.0, 0.0, 1.0], (10_000, 1))
    distances, _, occluded = embree_answers(scene, below, up, np.full(10_000, 9.0))
    radius = np.hypot(origins[:, 0], origins[:, 1])
    assert (np.isfinite(distances) == (radius <= 1.0)).all()
    assert (occluded == (radius <= 1.0)).all()
