"""Renders that stop to be looked at."""

import os
import subprocess
import sys
import threading

import numpy as np
import pytest
from room import write_room

import artist_py
from artist_py.samplers import snapshots as module
from artist_py.samplers.render_job import RenderSettings
from artist_py.samplers.snapshots import snapshots

SETTINGS = RenderSettings(threads=2)


@pytest.fixture
def compiled(tmp_path):
    """The room."""
    return artist_py.load_scene(write_room(tmp_path))


class Clock:
    """Time that passes when told to: `step` between the first and the second look at an iteration."""

    def __init__(self, step):
        self.now, self.step, self.looks = 0.0, step, 0

    def perf_counter(self):
        """Wall seconds."""
        self.looks += 1
        if self.looks % 2 == 0:
            self.now += self.step
        return self.now

    def process_time(self):
        """CPU seconds: three for one."""
        return 3.0 * self.now


def test_images_are_those_of_a_render(compiled):
    """Stopping changes nothing: bit by bit the image of as many iterations, and its counts."""
    seen = list(snapshots(compiled, SETTINGS, [4, 1], "iterations"))
    assert [snapshot.iterations for snapshot in seen] == [1, 4]
    for snapshot in seen:
        result = artist_py.render(compiled, iterations=snapshot.iterations, threads=1)
        assert np.array_equal(snapshot.film.rgb, result.film.rgb)
        assert snapshot.rays == result.statistics["rays"]
        assert snapshot.shadow_rays == result.statistics["shadow_rays"]
        assert snapshot.noise == result.statistics["error_estimate"]


def test_measuring_takes_no_time(compiled, monkeypatch):
    """The clocks stand still while the caller works, and run while an iteration does."""
    clock = Clock(step=0.25)
    monkeypatch.setattr(module, "time", clock)
    seen = []
    for snapshot in snapshots(compiled, SETTINGS, [0.5, 1.0]):
        seen.append((snapshot.wall_seconds, snapshot.cpu_seconds, snapshot.iterations))
        clock.now += 1000.0
    assert seen == [(0.5, 1.5, 2), (1.0, 3.0, 4)]


def test_marks_on_the_other_clock(compiled, monkeypatch):
    """CPU seconds, three times as fast; a mark that an iteration jumps over is not looked at twice."""
    monkeypatch.setattr(module, "time", Clock(step=1.0))
    seen = [(each.mark, each.along("cpu")) for each in snapshots(compiled, SETTINGS, [1, 2, 4, 7], "cpu")]
    assert seen == [(2, 3.0), (4, 6.0), (7, 9.0)]


def test_stop(compiled):
    """Nothing more once it is set."""
    stop, seen = threading.Event(), []
    for snapshot in snapshots(compiled, SETTINGS, [1, 2, 3], "iterations", stop=stop):
        seen.append(snapshot.iterations)
        stop.set()
    assert seen == [1]


MEMORY = """
import sys
import numpy as np
import artist_py
from artist_py.samplers import snapshots as module
from artist_py.samplers.render_job import RenderSettings

compiled = artist_py.load_scene(sys.argv[1], {"film.resolution": [600, 500]})
settings = RenderSettings(threads=1)
list(module.snapshots(compiled, settings, [1], "iterations"))
block = np.ones(400_000_000 // 8)
before = module.peak_memory()
assert before > block.nbytes
del block
[snapshot] = module.snapshots(compiled, settings, [1], "iterations")
print(before, snapshot.peak_memory_bytes, snapshot.render_memory_bytes)
"""


def test_memory_is_that_of_the_render(tmp_path):
    """What was used before does not count, and what the render stores does: a film of 600 x 500.

    In a process of its own: one that has run other tests has freed memory enough to need no more.
    """
    command = [sys.executable, "-c", MEMORY, str(write_room(tmp_path))]
    child = subprocess.run(command, capture_output=True, text=True, check=True)
    before, peak, of_render = map(int, child.stdout.split()[-3:])
    needed = 600 * 500 * 3 * (8 + 4 + 4)  # sums, odd sums, the iteration's image
    if os.access("/proc/self/clear_refs", os.W_OK):
        assert peak < before
    assert 0.5 * needed < of_render < 5 * needed + 50_000_000
