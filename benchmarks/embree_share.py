"""How much of a render is Embree's: CPU time of the render over that of Embree for the very same rays."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from .measure import ROOT, SCENES, median_and_spread, on_one_processor, save

NAMES = ("cornell_box", "glass_sphere")
ITERATIONS = 4
TARGET = 1.6


def run(options):
    """Record, replay and save."""
    on_one_processor()
    scenes = {name: measure_scene(SCENES / f"{name}.toml", options.repeats) for name in NAMES}
    save("embree_share", __doc__, target=TARGET, scenes=scenes)


def measure_scene(path, repeats):
    """Times per ray, and their ratio taken repeat by repeat."""
    with tempfile.TemporaryDirectory() as directory:
        file = str(Path(directory) / "rays.npy")
        _python("record_rays", path, ITERATIONS, file)
        timed = json.loads(_python("replay", path, ITERATIONS, file, repeats).splitlines()[-1])
    pairs = list(zip(timed["render_cpu_seconds"], timed["embree_cpu_seconds"], strict=True))
    rays = timed["rays"]
    result = {
        "rays": rays,
        "share_of_closest_hits": timed["closest_hits"] / rays,
        "render_ns_per_ray": median_and_spread([1e9 * render / rays for render, _ in pairs]),
        "embree_ns_per_ray": median_and_spread([1e9 * embree / rays for _, embree in pairs]),
        "render_over_embree": median_and_spread([render / embree for render, embree in pairs]),
    }
    print(f"  {path.stem}: {result['render_over_embree']['median']:.2f} times Embree's own time", flush=True)
    return result


def _python(module, *arguments):
    command = [sys.executable, "-m", f"benchmarks.{module}", *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode:
        raise ChildProcessError(f"{' '.join(command)}: {done.stderr.strip()[-2000:]}")
    return done.stdout
