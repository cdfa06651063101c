"""How long a user waits: for help, for the first sample with a warm cache of kernels, and with none."""

import os
import subprocess
import sys
import tempfile
import time

from .measure import ROOT, SCENES, median_and_spread, run_timed, save

TARGETS = {"help_seconds": 0.3, "first_sample_warm_seconds": 1.5, "first_sample_cold_seconds": 20.0}
NAMES = ("cornell_box", "glass_sphere")
COLD_REPEATS = 2


def run(options):
    """Measure and save."""
    helps = [run_timed([sys.executable, "-m", "artist_py", "--help"])[0] for _ in range(options.repeats + 1)]
    scenes = {name: measure_scene(SCENES / f"{name}.toml", options.repeats) for name in NAMES}
    save("start_up", __doc__, targets=TARGETS, help_seconds=median_and_spread(helps[1:]), scenes=scenes)


def measure_scene(path, repeats):
    """Seconds from the start of the process to the first sample."""
    cold, warm = [], []
    for _ in range(COLD_REPEATS):
        with tempfile.TemporaryDirectory() as cache:
            cold.append(seconds_to_first_sample(path, cache))
            warm += [seconds_to_first_sample(path, cache) for _ in range(repeats)]
    result = {
        "first_sample_cold_seconds": median_and_spread(cold),
        "first_sample_warm_seconds": median_and_spread(warm),
    }
    print(f"  {path.stem}: cold {min(cold):.1f} s, warm {min(warm):.2f} s", flush=True)
    return result


def seconds_to_first_sample(path, cache):
    """Of a new process whose kernels are cached in the directory `cache`."""
    command = [sys.executable, "-m", "benchmarks.first_sample", str(path)]
    begun = time.time()
    done = subprocess.run(  # noqa: S603 - our own script
        command,
        cwd=ROOT,
        env={**os.environ, "ARTIST_CACHE_DIR": cache},
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout.splitlines()[-1]) - begun
