"""FLIP: how different two images look to people who flip between them; by NVIDIA's evaluator, in a child process.

The evaluator ends its process on some inputs, a black reference among them, and takes NaN for equal; so it gets a
process of its own, finite values, and exposures where it finds none. Andersson et al. 2020 and 2021.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from artist_py.errors import OptionError
from artist_py.film.tonemap import BRIGHTEST, automatic_exposure

STOPS = 2.0  # to each side of the automatic exposure, where the evaluator finds none
SECONDS = 600

CHILD = """
import json, sys
import numpy as np
import flip_evaluator
reference, image, out, kind, parameters = sys.argv[1:]
errors, _, _ = flip_evaluator.evaluate(
    np.load(reference), np.load(image), kind, applyMagma=False, parameters=json.loads(parameters)
)
np.save(out, np.asarray(errors)[..., 0])
"""


def flip_map(image, reference, *, is_display=False):
    """FLIP error of each pixel, (h, w) float32 in [0, 1]; its mean is the image's.

    Images are (h, w, 3): linear sRGB of any range (HDR-FLIP), or with `is_display` sRGB code values in [0, 1]. Seen at
    67 pixels per degree. NaN counts as black.
    """
    image, reference = _clean(image, is_display), _clean(reference, is_display)
    if np.array_equal(image, reference):
        return np.zeros(image.shape[:2], np.float32)
    require_flip()
    kind = "LDR" if is_display else "HDR"
    with tempfile.TemporaryDirectory(prefix="artist-flip-") as folder:
        errors = _evaluate(Path(folder), reference, image, kind, "{}")
        if errors is None and not is_display:
            errors = _evaluate(Path(folder), reference, image, kind, _exposures(image, reference))
    if errors is None:
        raise OptionError("FLIP: the evaluator gave up on these images")
    return errors


def require_flip():
    """Raise OptionError where there is no evaluator."""
    import importlib.util

    if importlib.util.find_spec("flip_evaluator") is None:
        raise OptionError("FLIP: flip-evaluator is not installed: pip install 'artist-py[report]'")


def _clean(image, is_display):
    """float32, contiguous, nothing negative or not finite."""
    largest = 1.0 if is_display else 1e6
    values = np.nan_to_num(np.asarray(image, np.float64), nan=0.0, posinf=BRIGHTEST, neginf=0.0)
    return np.ascontiguousarray(np.clip(values, 0.0, largest), np.float32)


def _exposures(image, reference):
    """Parameters for images from which the evaluator derives no exposures, as JSON."""
    stops = automatic_exposure(np.maximum(image, reference).astype(np.float64))
    return f'{{"startExposure": {stops - STOPS}, "stopExposure": {stops + STOPS}, "numExposures": 5}}'


def _evaluate(folder, reference, image, kind, parameters):
    """The map, or `None` if the evaluator failed."""
    paths = [folder / name for name in ("reference.npy", "image.npy", "errors.npy")]
    np.save(paths[0], reference)
    np.save(paths[1], image)
    command = [sys.executable, "-c", CHILD, *map(os.fspath, paths), kind, parameters]
    done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)  # noqa: S603 - our own script
    return np.load(paths[2]) if done.returncode == 0 and paths[2].exists() else None
