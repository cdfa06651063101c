"""Error against CPU seconds of all integrators, and of the wavelength modes, by `artist converge`, one thread.

Writes findings/SCENE/ (CSV, JSON and a plot), which README.md discusses.
"""

import subprocess
import sys
from pathlib import Path

from .measure import HERE, ROOT

FOLDER = HERE / "findings"
KEPT = ("convergence.csv", "convergence.json", "plot.svg")
SIZE = "160x160"
TIMES, QUICK_TIMES = "1,2,4,8", "0.5,1"
REFERENCE_SECONDS, QUICK_REFERENCE_SECONDS = 60, 5
INTEGRATORS = "pt,lt,bpt,ppm,bpm,vcm"
# Scene, and what makes its reference: bpt, or vcm where bpt hardly finds the light.
SCENES = {
    "cornell_box": "bpt",
    "box_glossy": "bpt",
    "veach_room": "bpt",
    "cone_caustic": "vcm",
    "small_light": "vcm",
    "sds_pool": "vcm",
}
MODES = ("shared", "independent", "rotate")
WAVELENGTH_SCENES = {"cornell_box": ("bpt", "bpt"), "lights": ("bpt", "bpt"), "small_light": ("vcm", "vcm")}


def run(options):
    """Measure all, and keep what is small."""
    for scene, reference in SCENES.items():
        converge(scene, scene, INTEGRATORS, reference, options.quick)
    for scene, (integrator, reference) in WAVELENGTH_SCENES.items():
        variants = ",".join(
            f"{integrator}:wavelengths={mode}:hero_count={count}"
            for mode in MODES
            for count in (1, 4, 8)
            if integrator != "vcm" or mode != "independent"
        )
        converge(f"wavelengths_{scene}", scene, variants, reference, options.quick)


def converge(name, scene, integrators, reference, quick):
    """One run of the command, from which the folder NAME keeps the small files."""
    print(f"  {name}", flush=True)
    folder = ROOT / "out" / "findings" / name
    command = [
        str(Path(sys.executable).with_name("artist")), "converge", f"scenes/{scene}.toml",
        "--integrators", integrators, "--times", QUICK_TIMES if quick else TIMES, "--axis", "cpu",
        "--threads", "1", "--repeat", "2", "--size", SIZE, "--reference-integrator", reference,
        "--make-reference", f"{QUICK_REFERENCE_SECONDS if quick else REFERENCE_SECONDS}s", "-o", str(folder),
    ]  # fmt: skip
    subprocess.run(command, check=True, cwd=ROOT)  # noqa: S603 - our own command
    (FOLDER / name).mkdir(parents=True, exist_ok=True)
    for file in KEPT:
        (FOLDER / name / file).write_bytes((folder / file).read_bytes())
