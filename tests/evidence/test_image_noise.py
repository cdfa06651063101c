"""Z-tests of the renderer's images, with the variance that its film estimates.

Fixed seeds; what fails a right program by chance is said at each test.
"""

import pytest
from room import write_room

import artist_py
from artist_py.compare.z_test import symmetric_tail, z_test


@pytest.fixture
def images(tmp_path):
    """Function from seed, iterations and overrides to mean and variance of the room."""
    path = write_room(tmp_path)

    def image(seed, iterations, **overrides):
        settings = {"render.seed": seed, "render.sampler": "independent", **overrides}
        film = artist_py.render(
            artist_py.load_scene(path, settings), iterations=iterations, threads=1, aovs=("variance",)
        ).film
        return film.rgb, film.variance

    return image


def test_other_seeds(images):
    """30 pairs at a false alarm probability of 5 %: more than 8 alarms have probability 3e-5."""
    n = 64
    alarms = [
        not z_test(*images(2 * i, n), *images(2 * i + 1, n), false_alarm=0.05, tail=symmetric_tail(n)).is_same
        for i in range(30)
    ]
    assert sum(alarms) <= 8


def test_another_lamp(images):
    """Twice the light is seen with 500 iterations, and other random numbers are not; by chance 1e-3."""
    n = 500
    image = images(1, n)
    assert z_test(*image, *images(2, n), tail=symmetric_tail(n)).is_same
    assert not z_test(*image, *images(2, n, **{"shapes.1.emission": 10}), tail=symmetric_tail(n)).is_same
