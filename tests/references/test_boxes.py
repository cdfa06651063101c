"""The two boxes that VCM was published with, against images of another renderer: `benchmarks/boxes.py` says how.

The images lie beside the repository, in ../shared/references; without them the tests are skipped.
Each box was rendered there by two methods. What these two differ by, as relMSE over the part of the image that is
rendered here, is the measure: ours may differ from their mean by twice that. Of that, noise is about 0.3 for vcm on the
diffuse box (relMSE 0.020 after 12 iterations). With 20 % of the light missing, relMSE is about 0.04, and tests fail.

All are slow: each renders for minutes. What is in these boxes the closed forms, the comparisons of methods and the
golden images have too; what only these tests have are pictures that another program made.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

import artist_py
from artist_py.compare.metrics import relmse
from artist_py.evidence.reference import block_means

ROOT = Path(__file__).resolve().parents[2]
REFERENCES = ROOT.parent / "shared" / "references"
SIZE = 512
CROP = (
    128,
    384,
    256,
    512,
)  # pixels x0, x1, y0, y1: both spheres, or the large one, and the floor before them
ITERATIONS = {"bpt": 384, "vcm": 160, "ppm": 96}
METHODS = list(ITERATIONS)
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def boxes():
    """benchmarks/boxes.py; it is no part of the package."""
    if not REFERENCES.is_dir():
        pytest.skip(f"{REFERENCES} is absent: the reference images are no part of this repository")
    sys.path.insert(0, str(ROOT))
    from benchmarks import boxes

    return boxes


def part(image):
    """The rendered part of a reference, whose pixels are the means of 2 x 2."""
    x0, x1, y0, y1 = (edge // 2 for edge in CROP)
    return image[y0:y1, x0:x1].astype(float)


def relative_errors(boxes, box, integrator):
    """relMSE of our image against the mean of both references, and of these against each other."""
    # As many light paths per area of the image as if it were whole.
    merging = {"light_paths": SIZE**2 / ((CROP[1] - CROP[0]) * (CROP[3] - CROP[2]))}
    more = {"film__crop": list(CROP), "render__merging": merging}
    compiled = boxes.rgb_scene(boxes.SCENES[box], integrator, SIZE, **more)
    found = artist_py.render(compiled, iterations=ITERATIONS[integrator], threads=2).film
    assert found.rejected_count == 0
    references = np.load(REFERENCES / f"box_s{box}.npz")
    vcm, bpt = part(references["vcm"]), part(references["bpt"])
    return relmse(block_means(found.rgb, 2), 0.5 * (vcm + bpt)), relmse(vcm, bpt)


@pytest.mark.parametrize("integrator", METHODS)
def test_diffuse_box(boxes, integrator):
    error, disagreement = relative_errors(boxes, "4", integrator)
    assert error <= 2 * disagreement, f"relMSE {error:.4f}, the references' own {disagreement:.4f}"


@pytest.mark.parametrize("integrator", METHODS)
def test_glossy_box(boxes, integrator):
    error, disagreement = relative_errors(boxes, "1", integrator)
    assert error <= 2 * disagreement, f"relMSE {error:.4f}, the references' own {disagreement:.4f}"
