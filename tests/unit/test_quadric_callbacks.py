"""The callbacks of quadrics one by one: as C functions, as plain Python, and what they write to Embree's records."""

import ctypes
import math

import numpy as np
import pytest
from quadric_cases import random_maps, random_rays

from artist_py.core.vector import Vec3
from artist_py.geometry.embree import BLOCKS_LIGHT, INVALID_ID, SEEN, Device, EmbreeScene, rtc
from artist_py.geometry.quadric_callbacks import (
    bounds_query_dtype,
    box_dtype,
    context_dtype,
    quadric_callbacks,
    ray_dtype,
    ray_hit_dtype,
    ray_query_dtype,
    record_at,
    report_bounds,
    report_closest_hit,
    report_occlusion,
)
from artist_py.geometry.quadric_records import quadric_records
from artist_py.geometry.quadrics import quadric_bounds, quadric_normal
from artist_py.scene.tables import SPHERE, quadric_dtype


@pytest.fixture(scope="module")
def device():
    return Device(1)


@pytest.fixture(scope="module")
def addresses():
    return quadric_callbacks()


def aligned(dtype):
    """A zeroed record at an address that is a multiple of 16, as Embree wants it."""
    memory = np.zeros(dtype.itemsize + 16, np.uint8)
    start = -memory.ctypes.data % 16
    return memory[start : start + dtype.itemsize].view(dtype).view(np.recarray)


def ray_record(origin, direction, t_near=0.0, t_far=math.inf, mask=INVALID_ID):
    ray = aligned(ray_hit_dtype)
    ray.origin, ray.direction, ray.t_near, ray.t_far, ray.mask = origin, direction, t_near, t_far, mask
    ray.geometry = ray.primitive = ray.instance = INVALID_ID
    return ray


def trace(scene, *arguments, **options):
    ray = ray_record(*arguments, **options)
    rtc.rtcIntersect1(scene.address, ray.ctypes.data, None)
    return ray[0]


def test_layouts():
    """Sizes and offsets of Embree's records."""
    records = (ray_dtype, ray_hit_dtype, bounds_query_dtype, box_dtype, ray_query_dtype)
    assert [record.itemsize for record in records] == [48, 96, 24, 32, 48]
    assert ray_hit_dtype.fields["instance"][1] == 76
    assert ray_query_dtype.fields["geometry"][1] == 44


def test_ray_segment_and_mask(device, addresses):
    """t_near skips the near side, t_far ends the ray, and Embree lets rays of another mask pass."""
    scene = EmbreeScene(device)
    scene.add_quadrics(0, quadric_records([SPHERE], [np.eye(3, 4)]), addresses, "sphere", blocks_light=False)
    scene.commit()
    ray = (0.0, 0.0, -3.0), (0.0, 0.0, 1.0)
    assert trace(scene, *ray).t_far == 2.0
    assert trace(scene, *ray, t_near=2.5).t_far == 4.0
    assert trace(scene, *ray, t_far=1.5).geometry == INVALID_ID
    assert trace(scene, *ray, t_near=4.5).geometry == INVALID_ID
    assert trace(scene, *ray, mask=SEEN).t_far == 2.0
    assert trace(scene, *ray, mask=BLOCKS_LIGHT).geometry == INVALID_ID
    for mask, expected in ((SEEN, -math.inf), (BLOCKS_LIGHT, math.inf)):
        shadow = ray_record(*ray, mask=mask)
        rtc.rtcOccluded1(scene.address, shadow.ctypes.data, None)
        assert shadow.t_far[0] == expected


def test_normals_are_reported(device, addresses):
    """Embree's Ng points along the normal at the hit."""
    rng = np.random.default_rng(3)
    quadrics = quadric_records(range(4), random_maps(rng, 4, 0.8, 0.3))
    scene = EmbreeScene(device)
    scene.add_quadrics(0, quadrics, addresses, "shapes")
    scene.commit()
    hits = 0
    for origin, direction in zip(*random_rays(rng, 200), strict=True):
        hit = trace(scene, origin, direction)
        if hit["geometry"] != INVALID_ID:
            point = Vec3(origin + direction * float(hit["t_far"]))
            expected = np.array(quadric_normal(quadrics.view(np.recarray)[hit["primitive"]], point))
            assert np.allclose(hit["normal"] / np.linalg.norm(hit["normal"]), expected, atol=1e-5)
            hits += 1
    assert hits > 30


def query(quadrics, primitive, ray, context):
    """What Embree hands to a callback, as a record."""
    record = np.zeros(1, ray_query_dtype)
    record["quadrics"], record["primitive"], record["geometry"] = quadrics.ctypes.data, primitive, 9
    record["context"], record["ray"], record["ray_count"] = context.ctypes.data, ray.ctypes.data, 1
    return record


def test_compiled_callbacks_are_the_plain_ones(addresses):
    """Hits, misses and occlusion of the C callbacks are those of the same functions as plain Python."""
    call = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
    compiled = [call(address) for address in addresses]
    rng = np.random.default_rng(4)
    quadrics = quadric_records(np.arange(200) % 4, random_maps(rng, 200, 0.8, 0.3))
    context = np.array([(12, 13)], context_dtype)
    hits = 0
    for primitive, (origin, direction) in enumerate(zip(*random_rays(rng, 200), strict=True)):
        ends = (origin, direction, 0.0, 1.5)
        for plain, native in ((report_closest_hit, compiled[1]), (report_occlusion, compiled[2])):
            rays = ray_record(*ends), ray_record(*ends)
            for function, ray in zip((plain, native), rays, strict=True):
                asked = query(quadrics, primitive, ray, context)
                function(asked.ctypes.data)
            assert rays[0].instance[0] == (12 if rays[0].primitive[0] == primitive else INVALID_ID)
            for name in ray_hit_dtype.names:
                assert np.allclose(rays[0][name], rays[1][name], rtol=1e-6, atol=1e-6), name
        hits += rays[0]["t_far"][0] == -math.inf
    assert 20 < hits < 180


def test_bounds_are_rounded_outwards():
    """The float32 box contains the float64 one and exceeds it by two units in the last place at most."""
    rng = np.random.default_rng(5)
    quadrics = quadric_records(np.arange(400) % 4, random_maps(rng, 400, 1e-3, 3.0)).view(np.recarray)
    box = np.zeros(1, box_dtype)
    for primitive, quadric in enumerate(quadrics):
        asked = np.zeros(1, bounds_query_dtype)
        asked["quadrics"], asked["primitive"], asked["box"] = quadrics.ctypes.data, primitive, box.ctypes.data
        report_bounds(asked.ctypes.data)
        lower, upper = (np.array(corner) for corner in quadric_bounds(quadric))
        below, above = lower - box["lower"][0, :3], box["upper"][0, :3] - upper
        assert (below >= 0.0).all() and (above >= 0.0).all()
        assert (below <= 2.0**-22 * np.abs(lower)).all() and (above <= 2.0**-22 * np.abs(upper)).all()


def test_record_at_shares_memory():
    """Writing to the record writes to the memory."""
    quadrics = np.zeros(2, quadric_dtype)
    record = record_at(quadrics.ctypes.data + quadric_dtype.itemsize, quadric_dtype)
    record.kind = 3
    record.object_to_world[1, 2] = 5.0
    assert quadrics["kind"].tolist() == [0, 3]
    assert quadrics["object_to_world"][1, 1, 2] == 5.0
