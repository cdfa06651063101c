"""Error against CPU seconds of all methods on the two reference boxes, and pairs of subpaths per CPU second.

    python -m benchmarks.boxes REFERENCES [--integrators pt,bpt,ppm,vcm] [--seconds 5,10,20,40] [--boxes 1,4]

REFERENCES is a folder with box_s1.npz and box_s4.npz: 256 x 256 linear RGB, keys "vcm" and "bpt", path length up to 10.
They were rendered in RGB. So are ours here: the scene is compiled over four bins of 1 nm that stand for R, G, B and
nothing, and each of the four shared wavelengths of an iteration falls into one of them.
"""

import argparse
from pathlib import Path

import numpy as np

import artist_py
from artist_py.compare.metrics import relmse
from artist_py.core.table import Table
from artist_py.evidence.reference import block_means
from artist_py.samplers.render_job import RenderSettings
from artist_py.samplers.snapshots import snapshots
from artist_py.scene.spectrum_types import Rgb

from .measure import save
from .tables import rewrite_readme

SCENES = {"1": "box_glossy.toml", "4": "box_spheres.toml"}
FIRST_NM = 550
FULL_SIZE = 512  # of the published figures; the references are half as large
FOLDER = Path(__file__).parent


def rgb_scene(name, integrator, size, **more):
    """The compiled box, its four bins of wavelength turned into the channels R, G, B and nothing.

    `more` overrides keys of the scene file, with "__" for each dot.
    """
    compiled = artist_py.load_scene(
        FOLDER.parent / "scenes" / name,
        {
            "render.integrator": integrator,
            "render.wavelengths": "shared",
            "render.wavelength_range": [FIRST_NM, FIRST_NM + 4],
            "film.resolution": [size, size],
            **{key.replace("__", "."): value for key, value in more.items()},
        },
    )
    spectra, materials = compiled.spectra, compiled.scene.materials.array
    spectra[:3] = np.eye(4)[:3]
    used = [each for key, each in compiled.graph.materials.items() if _is_used(compiled, key)]
    for row, material in zip(materials[1:], used, strict=True):
        reflectance = getattr(material, "reflectance", None)
        if isinstance(reflectance, Rgb):
            spectra[row["reflectance"], :3] = reflectance.rgb
    compiled.nodes[:] = np.linspace(FIRST_NM, FIRST_NM + 4, len(compiled.nodes))
    compiled.scene = compiled.scene._replace(spectra=compiled.scene.spectra._replace(dense=Table(spectra)))
    return compiled


def _is_used(compiled, name):
    return any(shape.material == name for shape in compiled.graph.shapes)


def measure(box, integrator, references, seconds, size):
    """Rows of one method on one box: CPU seconds, iterations, relMSE against the mean of both references."""
    compiled = rgb_scene(SCENES[box], integrator, size)
    reference = 0.5 * (references["vcm"] + references["bpt"]).astype(float)
    rows = []
    for snapshot in snapshots(compiled, RenderSettings(threads=1), seconds, "cpu"):
        image, spent = snapshot.film.rgb, snapshot.cpu_seconds
        error = relmse(block_means(image, 2) if size == FULL_SIZE else image, reference)
        rows.append({"cpu_seconds": spent, "iterations": snapshot.iterations, "relmse": error})
    rate = snapshot.iterations * size * size / spent
    mean = image.mean(axis=(0, 1)).tolist()
    return {"box": box, "integrator": integrator, "pairs_per_cpu_second": rate, "mean": mean, "rows": rows}


def main():
    """Measure, print a table, and, of images of full size, benchmarks/results/boxes.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("references", type=Path)
    parser.add_argument("--integrators", default="pt,lt,bpt,ppm,vcm")
    parser.add_argument("--seconds", default="5,10,20,40")
    parser.add_argument("--boxes", default="1,4")
    parser.add_argument("--size", type=int, default=FULL_SIZE)
    options = parser.parse_args()
    seconds = [float(word) for word in options.seconds.split(",")]
    runs, disagreement = [], {}
    for box in options.boxes.split(","):
        references = np.load(options.references / f"box_s{box}.npz")
        disagreement[box] = relmse(references["vcm"], references["bpt"])
        print(f"box {box}: the references' own disagreement is {disagreement[box]:.4f}", flush=True)
        for integrator in options.integrators.split(","):
            result = measure(box, integrator, references, seconds, options.size)
            runs.append(result)
            errors = ", ".join(f"{row['cpu_seconds']:.0f} s {row['relmse']:.4f}" for row in result["rows"])
            print(
                f"  {integrator}: {result['pairs_per_cpu_second']:.0f} pairs / CPU s; relMSE {errors}",
                flush=True,
            )
    if options.size == FULL_SIZE:
        save("boxes", __doc__, seconds=seconds, disagreement=disagreement, runs=runs)
        rewrite_readme()


if __name__ == "__main__":
    main()
