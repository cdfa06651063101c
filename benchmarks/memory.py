"""Peak memory of the command line on a scene, process and all."""

import sys
import tempfile
from pathlib import Path

from .measure import ROOT, SCENES, run_timed, save

DEMO = ROOT / "scenes" / "glass_sphere.toml"
MIB = 2**20
TARGET_BYTES = 400 * MIB
ITERATIONS = 2


def run(options):
    """Measure and save."""
    paths = {"demo": DEMO, **{name: SCENES / f"{name}.toml" for name in ("cornell_box", "glass_sphere")}}
    peaks = {name: measure_scene(path) for name, path in paths.items()}
    for name, figures in peaks.items():
        print(
            f"  {name}: {figures['cached'] / MIB:.0f} MiB, {figures['compiling'] / MIB:.0f} with compilation"
        )
    save("memory", __doc__, target_bytes=TARGET_BYTES, peak_bytes=peaks)


def measure_scene(path):
    """Peak bytes of two renders, the first with an empty cache of kernels."""
    with tempfile.TemporaryDirectory() as directory:
        output = ["-q", "-o", str(Path(directory) / "image.exr")]
        command = [
            sys.executable,
            "-m",
            "artist_py",
            "render",
            str(path),
            "--iterations",
            str(ITERATIONS),
            *output,
        ]
        peaks = [run_timed(command, {"ARTIST_CACHE_DIR": directory})[1] for _ in range(2)]
    return {"compiling": peaks[0], "cached": peaks[1]}
