"""Interrupted renders and readers that leave, in processes of their own."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from artist_py.film.reading import read_image

ROOT = Path(__file__).parents[3]
FAKE = Path(__file__).with_name("fake_artist.py")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}


def statistics(path="scene.json"):
    """The JSON file."""
    return json.loads(Path(path).read_text(encoding="utf-8"))


class TestSignals:
    """Interrupted renders, in a process of their own."""

    def start(self, *options, seconds=0.05):
        """A render that would take a minute, once it has begun."""
        arguments = [sys.executable, str(FAKE), "render", "scene.toml", "--iterations", "10000", *options]
        environment = {**ENVIRONMENT, "FAKE_SECONDS": str(seconds)}
        process = subprocess.Popen(arguments, stderr=subprocess.PIPE, text=True, env=environment)
        for line in process.stderr:
            if line.startswith("iteration" if seconds < 1 else "rendering"):
                return process
        pytest.fail("the render did not start")
        return None

    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
    def test_the_first_ends_the_render(self, folder, number):
        """The partial image has its final name, says that it is partial, and the exit code is 130."""
        process = self.start()
        process.send_signal(number)
        _, err = process.communicate(timeout=30)
        assert process.returncode == 130, err
        assert "interrupted: ending the render" in err
        iterations = statistics()["iterations"]
        assert 0 < iterations < 10_000
        assert statistics()["complete"] is False
        assert np.all(read_image("scene.exr").rgb == iterations)
        assert read_image("scene.exr").metadata["samplesPerPixel"] == iterations
        assert sorted(os.listdir(folder)) == ["scene.exr", "scene.json", "scene.toml"]

    def test_the_second_ends_it_at_once(self, folder):
        """No iteration is waited for, and nothing is written."""
        process = self.start(seconds=20)
        begun = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert "interrupted" in "".join(process.stderr.readline() for _ in range(2))
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        assert process.returncode == 130
        assert time.monotonic() - begun < 10
        assert os.listdir(folder) == ["scene.toml"]

    def test_images_on_the_way(self, folder):
        """--save-every writes whole images under the final name, which a killed render leaves."""
        process = self.start("--save-every", "1s")
        deadline = time.monotonic() + 20
        while not Path("scene.json").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.kill()
        process.communicate(timeout=30)
        assert np.all(read_image("scene.exr").rgb >= 1)
        assert statistics()["complete"] is False

    def test_a_reader_that_leaves(self, folder):
        """`artist info ... | head -1` ends quietly."""
        read_end, write_end = os.pipe()
        os.close(read_end)
        done = subprocess.run(
            [sys.executable, str(FAKE), "info", "scene.toml"],
            stdout=write_end,
            stderr=subprocess.PIPE,
            env=ENVIRONMENT,
            check=False,
        )
        os.close(write_end)
        assert (done.returncode, done.stderr) == (1, b"")

    def test_nobody_listens_to_the_progress(self, folder):
        """A closed error stream is no reason to lose a render."""
        read_end, write_end = os.pipe()
        os.close(read_end)
        done = subprocess.run(
            [sys.executable, str(FAKE), "render", "scene.toml"],
            stderr=write_end,
            check=False,
            env=ENVIRONMENT,
        )
        os.close(write_end)
        assert done.returncode == 0
        assert statistics()["complete"] is True
