"""The golden images would show a small error: one is made on purpose."""

import json
import os
import subprocess
import sys
from pathlib import Path

import golden_cases
import numpy as np
from golden_cases import CASES, FALSE_ALARM, SIZE, Golden, read_golden, write_golden

from artist_py.compare.z_test import Moments

CAUGHT = "cornell_box-bpt"
PRECISION = 0.06  # relative standard error of a weighted mean image, at most
MEDIAN_PRECISION = 0.005  # and that of half of them


def test_an_error_of_one_per_cent_in_the_weight_of_next_event_estimation_is_caught(tmp_path):
    script = Path(__file__).parent / "render_wrong_weight.py"
    child = subprocess.run(
        [sys.executable, str(script), CAUGHT],
        env={**os.environ, "ARTIST_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    p, is_same = json.loads(child.stdout.splitlines()[-1])["whole"]
    assert not is_same
    assert p < FALSE_ALARM / (3 * len(CASES))


def test_golden_images_are_precise():
    errors = []
    for case in CASES:
        whole = read_golden(case).whole
        # Of the best channel: a scene may have no light in one of them, or less than none where that is outside sRGB.
        errors.append((np.sqrt(whole.variance) / np.abs(whole.mean)).min())
    assert max(errors) < PRECISION
    assert np.median(errors) < MEDIAN_PRECISION


def test_there_are_twenty_and_every_integrator_is_among_them():
    fast = [case for case in CASES if not case.is_slow]
    assert len(fast) >= 20
    assert {case.integrator for case in fast} == {"pt", "lt", "bpt", "ppm", "bpm", "vcm"}


def test_files_keep_the_errors_of_nearly_black_pixels(tmp_path, monkeypatch):
    monkeypatch.setattr(golden_cases, "IMAGES", tmp_path)
    mean, variance = np.full((SIZE, SIZE, 3), 1e-9), np.full((SIZE, SIZE, 3), 1e-18)
    moments = Moments(mean, variance, golden_cases.REPLICATES)
    written = Golden(
        moments, moments, Moments(np.ones(3), np.ones(3), golden_cases.REPLICATES), np.ones_like(mean)
    )
    write_golden(CASES[0], written)
    stored = read_golden(CASES[0]).pixels
    np.testing.assert_allclose(stored.mean, mean, rtol=1e-6)
    np.testing.assert_allclose(stored.variance, variance, rtol=1e-6)
