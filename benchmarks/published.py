"""Error at equal CPU time of fluorescence by shared sets of wavelengths, and by published ways (`artist converge`).

Those are path tracing whose wavelengths shift (Mojzik et al. 2018), and photon mapping with one wavelength per path,
merged within a tolerance that shrinks from 50 nm with the fourth root of the iterations.
"""

import json
import statistics
import sys
import tempfile
from pathlib import Path

from .measure import ROOT, on_one_processor, run_timed, save

# What makes the reference: what finds the scene's light best.
SCENES = {"fluorescent_spheres": "bpt", "black_light": "vcm", "cascade": "bpt"}
PLAIN = (
    "ppm:wavelengths=rotate:hero_count=1"
    ":render.merging.wavelength_tolerance=50:render.merging.tolerance_exponent=0.25"
)
RADII = (0.03, 0.06)  # of the scene, at the beginning: images are small, and so is the number of photons
# By the names of the table.
ENTRIES = {
    "pt": "pt",
    "pt, shifting": "pt:wavelengths=independent",
    **{f"ppm, {radius}": f"ppm:render.merging.radius={radius}" for radius in RADII},
    **{f"ppm, one wavelength, {radius}": f"{PLAIN}:render.merging.radius={radius}" for radius in RADII},
    "vcm": f"vcm:render.merging.radius={RADII[0]}",
}
SIZE, SECONDS, REFERENCE_SECONDS = 64, (2, 8), 120


def run(options):
    """Measure and save."""
    on_one_processor()
    seconds, reference = ((0.5,), 5) if options.quick else (SECONDS, REFERENCE_SECONDS)
    scenes = {}
    for name in SCENES:
        scenes[name] = figures = measure(name, seconds, reference, options.repeats)
        print(f"  {name}: {figures['relmse']}")
    save(
        "published",
        __doc__,
        size=SIZE,
        seconds=seconds,
        radii=RADII,
        repeats=options.repeats,
        scenes=scenes,
    )


def measure(name, seconds, reference_seconds, repeats):
    """Median relMSE of every entry at each time, and the reference's own error."""
    with tempfile.TemporaryDirectory() as folder:
        run_timed(
            [
                *(sys.executable, "-m", "artist_py", "converge", str(ROOT / "scenes" / f"{name}.toml")),
                *("--integrators", ",".join(ENTRIES.values())),
                *("--times", ",".join(map(str, seconds)), "--axis", "cpu", "--repeat", str(repeats)),
                *("--reference-integrator", SCENES[name], "--make-reference", str(reference_seconds)),
                *("--size", f"{SIZE}x{SIZE}", "--threads", "1", "--quiet", "-o", folder),
            ]
        )
        found = json.loads((Path(folder) / "convergence.json").read_text(encoding="utf-8"))
    return {
        "relmse": {
            label: [statistics.median(errors) for errors in _by_mark(found["rows"], entry, seconds)]
            for label, entry in ENTRIES.items()
        },
        "lowest_and_highest": {
            label: [(min(errors), max(errors)) for errors in _by_mark(found["rows"], entry, seconds)]
            for label, entry in ENTRIES.items()
        },
        "reference_relmse": found["reference"]["relmse"],
        "reference_integrator": SCENES[name],
    }


def _by_mark(rows, entry, seconds):
    """The errors of an entry's renders at each time, without the reference's own where they are larger."""
    return [
        [row["own_relmse"] or row["relmse"] for row in rows if (row["entry"], row["mark"]) == (entry, mark)]
        for mark in seconds
    ]
