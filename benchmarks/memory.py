"""Peak memory of the command line on a scene, process and all."""

import sys
import tempfile
from pathlib import Path

from .measure import ROOT, SCENES, run_timed, save

DEMO = ROOT / "scenes" / "glass_sphere.toml"
TARGET_BYTES = 400 * 2**20
ITERATIONS = 2


def run(options):
    """Measure and save; the second run of a scene has its kernels in the cache."""
    paths = {"demo": DEMO, **{name: SCENES / f"{name}.toml" for name in ("cornell_box", "glass_sphere")}}
    peaks = {
        name: {"compiling": peak(path, fresh=True), "cached": peak(path)} for name, path in paths.items()
    }
    for name, figures in peaks.items():
        print(
            f"  {name}: {figures['cached'] / 2**20:.0f} MiB, {figures['compiling'] / 2**20:.0f} with compilation"
        )
    save("memory", __doc__, target_bytes=TARGET_BYTES, peak_bytes=peaks)


def peak(path, *, fresh=False):
    """Bytes that a render of the scene takes at most; `fresh`: with an empty cache of kernels."""
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
        return run_timed(command, {"ARTIST_CACHE_DIR": directory} if fresh else {})[1]
