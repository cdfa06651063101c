"""The measured Cornell box against a render by Mitsuba 3 that is kept beside the repository.

The reference is a mean without its variance: that of the difference is estimated within blocks of pixels. Its
folder is `ARTIST_REFERENCES`, or `shared/references` beside the repository. Fixed seeds; a correct program fails by
chance with probability 1e-4 per comparison; there are 7.
"""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from rendering import FALSE_ALARM, assert_equals, render, scene, shape
from scipy import stats

from artist_py import data
from artist_py.film.color import rgb_to_xyz

FOLDER = Path(os.environ.get("ARTIST_REFERENCES") or Path(__file__).parents[3] / "shared" / "references")
SIZE = 256
REFERENCE_NORM = 106.7502594  # what the reference's XYZ are divided by, nm
SIDES = (("min", -1), ("max", 1))


def load():
    """The description of the scene, and XYZ (256, 256, 3)."""
    description = FOLDER / "cornell_spectral.json"
    image = FOLDER / "cornell_spectral_xyz.npz"
    if not (description.exists() and image.exists()):
        pytest.skip(f"no {description.name} and {image.name} in {FOLDER}; set ARTIST_REFERENCES")
    with np.load(image) as arrays:
        xyz = arrays[arrays.files[0]].astype(float)
    return json.loads(description.read_text(encoding="utf-8")), xyz


def spectrum(samples):
    """Samples [nm, value] as a spectrum."""
    nm, values = zip(*samples, strict=True)
    return {"wavelengths": nm, "values": values}


def box_shapes(table):
    """Rectangles from corners, and cubes from -1 to 1 under a matrix."""
    for name, item in table.items():
        if not isinstance(item, dict) or "material" not in item:
            continue
        if item["type"] == "rectangle":
            corners = np.array(item["corners"])
            edges = [corners[1] - corners[0], corners[3] - corners[0]]
            more = {"emission": spectrum(table["spectra"]["LIGHT"])} if item["emitter"] else {}
            if item["emitter"] and np.cross(*edges)[1] > 0:  # the lamp shines down
                edges.reverse()
            yield shape("rectangle", item["material"], name=name, corner=corners[0], edges=edges, **more)
        else:
            steps = [{"matrix": item["to_world"]}]
            yield shape("box", item["material"], min=[-1, -1, -1], max=[1, 1, 1], transform=steps)


def cornell_box(table, seed):
    """The scene; all spectra are zero outside 400 to 700 nm, which the range of wavelengths expresses."""
    materials = {
        name: {"type": "diffuse", "reflectance": spectrum(table["spectra"][name.upper()])}
        for name in ("white", "red", "green")
    }
    camera = {"position": [0, 0, 3.9], "look_at": [0, 0, 0], "up": [0, 1, 0], "field_of_view": 39.3077}
    return scene(
        list(box_shapes(table)),
        materials=materials,
        camera=camera,
        film={"resolution": [SIZE, SIZE]},
        render={
            "wavelength_range": [400, 700],
            "max_path_length": 10,
            "roulette_length": 10,
            "sampler": "sobol",
            "seed": seed,
        },
    )


def compare(iterations, block, precision):
    """Both images: their means, and t-tests of the differences in blocks."""
    table, reference = load()
    film = render(cornell_box(table, 1), iterations).film
    mine = rgb_to_xyz(film.rgb) * data.luminous_integral("CIE 1931 2") / REFERENCE_NORM
    for channel in range(3):
        difference = mine[..., channel] - reference[..., channel]
        blocks = difference.reshape(SIZE // block, block, SIZE // block, block).transpose(0, 2, 1, 3)
        blocks = blocks.reshape(-1, block**2)
        mean, error = blocks.mean(axis=1), blocks.std(axis=1, ddof=1) / block
        level = reference[..., channel].mean()
        total_error = math.sqrt((error**2).mean() / len(mean))
        assert_equals(level + difference.mean(), total_error, level, precision)
        lit = error > 0
        p = 2 * stats.t.sf(np.abs(mean[lit] / error[lit]), block**2 - 1)
        # Were the expectations equal, p would be uniform: as many below 1 % as that.
        few = stats.binom.isf(FALSE_ALARM, lit.sum(), 0.01)
        assert np.count_nonzero(p < 0.01) <= few, f"{np.count_nonzero(p < 0.01)} of {lit.sum()} blocks differ"


def test_cornell_box():
    """The mean to 0.1 %, 1024 blocks to about 3 % each."""
    compare(24, 8, 1e-3)


@pytest.mark.slow
def test_cornell_box_precisely():
    """As good as the reference: 4096 blocks to about 1 %."""
    compare(256, 4, 8e-4)
