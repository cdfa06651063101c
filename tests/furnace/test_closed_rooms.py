"""Closed rooms whose walls all emit 1 and reflect a: the radiance is 1 / (1 - a) everywhere, in every direction.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 18.
"""

import pytest
from rendering import assert_uniform, diffuse, look, radiance, scene, shape

import artist_py

BOX = shape("box", "wall", min=[-1, -1.5, -0.7], max=[1, 1, 1.3], reverse=True, emission=1)
SPHERE = shape("sphere", "wall", center=[0.2, 0, 0.1], radius=1.3, reverse=True, emission=1)
ROOMS = {"box": BOX, "sphere": SPHERE}
# A lamp of each kind that is off, outside: so both rooms share their kernels.
UNSEEN = [
    shape("rectangle", corner=[2, 0, 0], edges=[[0.1, 0, 0], [0, 0.1, 0]], emission={"spectrum": 0}),
    shape("sphere", center=[2, 0.5, 0], radius=0.1, emission={"spectrum": 0}),
]
NO_ROULETTE = 1_000_000


def room(walls, albedo, size=16, **render):
    return scene(
        [walls, *UNSEEN],
        materials={"wall": diffuse(albedo)},
        camera=look([0, -0.5, 0], [0.3, 1, 0.2], 90),
        film={"resolution": [size, size]},
        render=render,
    )


@pytest.mark.parametrize("walls", ROOMS.values(), ids=ROOMS)
@pytest.mark.parametrize(
    ("albedo", "edges", "iterations", "precision"),
    [(0.1, 20, 64, 5e-4), (0.5, 60, 128, 2e-3), (0.9, 300, 256, 4e-3)],
)
def test_all_orders_of_reflection(walls, albedo, edges, iterations, precision):
    """Paths end by roulette, long before the limit on their length."""
    compiled = room(walls, albedo, max_path_length=edges)
    assert_uniform(radiance(compiled, iterations), 1 / (1 - albedo), precision)


@pytest.mark.parametrize("walls", ROOMS.values(), ids=ROOMS)
def test_long_paths(walls):
    """Paths of 1600 edges; those that are longer would bring 0.99^1600 = 1e-7."""
    compiled = room(walls, 0.99, size=8, max_path_length=1600, roulette_length=NO_ROULETTE)
    assert_uniform(radiance(compiled, 12), 100, 2e-3)


@pytest.mark.parametrize("walls", ROOMS.values(), ids=ROOMS)
@pytest.mark.parametrize("edges", [1, 2, 3, 7])
def test_limited_length(walls, edges):
    """Paths of up to L edges bring sum of a^i over i < L: also where next-event estimation adds the last edge."""
    albedo = 0.8
    compiled = room(walls, albedo, max_path_length=edges, roulette_length=NO_ROULETTE)
    assert_uniform(radiance(compiled, 32), (1 - albedo**edges) / (1 - albedo), 2e-3)


@pytest.mark.parametrize("roulette_length", [0, 2])
def test_roulette_from_the_start(roulette_length):
    """Roulette as early as allowed does not change the expectation."""
    compiled = room(BOX, 0.5, max_path_length=60, roulette_length=roulette_length)
    assert_uniform(radiance(compiled, 128), 2, 4e-3)


@pytest.mark.parametrize("sampler", ["sobol", "independent"])
def test_stratified_numbers(sampler):
    """Sobol points have the same expectation."""
    compiled = room(BOX, 0.6, max_path_length=80, sampler=sampler)
    assert_uniform(radiance(compiled, 128), 2.5, 3e-3)


def test_black_walls_end_paths():
    """One ray per path, though roulette is put off: what brings nothing is not followed."""
    compiled = room(BOX, 0.0, max_path_length=400, roulette_length=NO_ROULETTE)
    result = artist_py.render(compiled, iterations=2, threads=1)
    assert result.statistics["rays"] == 2 * 16 * 16
