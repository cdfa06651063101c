"""Error against CPU seconds of integrators and wavelength modes, and what unneeded features cost: `artist converge`.

Writes findings/NAME/ (CSV, JSON and a plot), which README.md discusses. All with one thread.
"""

import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

from .measure import HERE, ROOT

FOLDER = HERE / "findings"
KEPT = ("convergence.csv", "convergence.json", "plot.svg")
KEPT_OF_ABLATIONS = ("ablation.csv", "ablation.json")
INTEGRATORS = ("pt", "lt", "bpt", "ppm", "bpm", "vcm")
QUICK_TIMES, QUICK_REFERENCE_SECONDS = "0.5,1", 5


class Run(NamedTuple):
    """One run of `artist converge`."""

    scene: str
    entries: tuple = INTEGRATORS
    reference: str = "bpt"  # vcm where bpt hardly finds the light
    size: str = "160x160"
    times: str = "1,2,4,8"  # CPU seconds
    reference_seconds: int = 60
    repeats: int = 2
    settings: tuple = ()  # for all entries, KEY=VALUE


def modes(*pairs):
    """Entries with 1, 4 and 8 wavelengths for each (integrator, wavelength mode)."""
    return tuple(
        f"{integrator}:wavelengths={mode}:hero_count={count}"
        for integrator, mode in pairs
        for count in (1, 4, 8)
    )


# Methods that merge cannot have independent wavelengths, and pt has no light paths to rotate towards.
INDEPENDENT, MERGED = modes(("pt", "independent")), modes(("vcm", "shared"), ("vcm", "rotate"))
# `samplers` compares independent and shared wavelengths of pt on the other two scenes.
ALL_MODES = (*INDEPENDENT, *modes(("pt", "shared")), *MERGED)
WAVELENGTHS = {"times": "1,2,4", "reference_seconds": 30}
# Whatever fluoresces has shared wavelengths in every method.
FLUORESCENCE = {"entries": ("pt", "lt", "bpt", "ppm", "vcm"), "size": "96x96", "reference_seconds": 30}
CONVERGENCE = {
    "cornell_box": Run("cornell_box"),
    "box_glossy": Run("box_glossy"),
    "veach_room": Run("veach_room"),
    "cone_caustic": Run("cone_caustic", reference="vcm"),
    "small_light": Run("small_light", reference="vcm"),
    "sds_pool": Run("sds_pool", reference="vcm"),
    "wavelengths_cornell_box": Run(
        "cornell_box", (*INDEPENDENT, *MERGED), size="96x96", repeats=1, **WAVELENGTHS
    ),
    "wavelengths_lights": Run("lights", ALL_MODES, "pt", "192x45", **WAVELENGTHS),
    "wavelengths_glass_sphere": Run(
        "glass_sphere", (*INDEPENDENT, *MERGED), "vcm", "96x96", repeats=1, **WAVELENGTHS
    ),
    "fluorescent_spheres": Run("fluorescent_spheres", **FLUORESCENCE),
    "fluorescent_room": Run("fluorescent_room", **FLUORESCENCE),
    "cascade": Run("cascade", **FLUORESCENCE),
    "highlighters": Run("highlighters", **{**FLUORESCENCE, "size": "120x75"}),
    "black_light": Run("black_light", reference="vcm", **FLUORESCENCE),
    "black_light_caustic": Run(
        "black_light",
        reference="vcm",
        settings=("film.crop=[99, 191, 177, 209]",),  # the floor in the shadow of the glass ball
        **{**FLUORESCENCE, "size": "224x224"},
    ),
}
# With more arguments: kernels of bpt take long to compile, over and over.
ABLATIONS = {
    "ablation_pt": (Run("cornell_box", ("pt",), size="64x64", times="4"), ()),
    "ablation_bpt": (Run("cornell_box", ("bpt",), size="64x64", times="4"), ("--skip-compile-times",)),
}


def run(options):
    """Measure what `options.only` asks for, by default all, and keep what is small."""
    for name, each in CONVERGENCE.items():
        if fnmatch(name, options.only):
            seconds = QUICK_REFERENCE_SECONDS if options.quick else each.reference_seconds
            reference = (
                "--repeat",
                str(each.repeats),
                "--axis",
                "cpu",
                "--reference-integrator",
                each.reference,
            )
            measure(name, each, options.quick, (*reference, "--make-reference", f"{seconds}s"), KEPT)
    for name, (each, arguments) in ABLATIONS.items():
        if fnmatch(name, options.only):
            measure(name, each, options.quick, ("--ablate", *arguments), KEPT_OF_ABLATIONS)


def measure(name, each, quick, arguments, kept):
    """One run of the command, from which the folder NAME keeps the small files."""
    print(f"  {name}", flush=True)
    folder = ROOT / "out" / "findings" / name
    command = [
        str(Path(sys.executable).with_name("artist")), "converge", f"scenes/{each.scene}.toml",
        "--integrators", ",".join(each.entries), "--times", QUICK_TIMES if quick else each.times,
        "--threads", "1", "--size", each.size, *arguments, "-o", str(folder),
    ]  # fmt: skip
    for setting in each.settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, cwd=ROOT)  # noqa: S603 - our own command
    (FOLDER / name).mkdir(parents=True, exist_ok=True)
    for file in kept:
        (FOLDER / name / file).write_bytes((folder / file).read_bytes())
