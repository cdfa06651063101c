"""Spheres with patches of several paints and lamps against their closed form, for every integrator and its options.

Theory 3.10 without fluorescence; see spheres.py. Each of the four wavelengths is another problem: paints and lamps
differ from one to the next. An image is split into what its two paints show, by least squares; independent renders tell
how precise these estimates are, and they may be off by Student's bound, about six standard errors as there are few
renders, or three for many. All standard errors of the whole are about 0.1 %. A correct program fails one of the 28
tests by chance with probability 2e-4 (Sidak); with one that is wrong by more than 1 % on the whole all fail.
"""

import math

import numpy as np
import pytest
from rendering import render, with_render
from scipy import stats
from spheres import CAP, patches, sphere, visible_patches

SEEDS, ITERATIONS = 12, 24
LENGTH = 40  # longer paths bring less than 0.65^40
FALSE_ALARM = 1e-4
PRECISION = 2e-3  # relative standard error of each of the six estimates; of the image it is half of that
WIDE = {"radius": 0.03, "light_paths": 32, "alpha": 1}
BOUNDING_RADIUS = math.sqrt(3)  # of the scene, in radii of the sphere
SUBSETS = {
    "pt": ("pt", {}),
    "lt": ("lt", {"merging": {"light_paths": 32}}),
    "bpt": ("bpt", {}),
    "bpt, few light paths": ("bpt", {"merging": {"light_paths": 0.25}}),
    "bpt, many light paths": ("bpt", {"merging": {"light_paths": 3.5}}),
    "ppm": ("ppm", {"merging": WIDE}),
    "ppm, Epanechnikov": ("ppm", {"merging": {**WIDE, "kernel": "epanechnikov"}}),
    "bpm": ("bpm", {"merging": WIDE}),
    "bpm, SmallVCM's schedule": ("bpm", {"merging": {**WIDE, "alpha": 0.9, "schedule": "smallvcm"}}),
    "vcm": ("vcm", {}),
    "vcm, wide": ("vcm", {"merging": {"radius": 0.02}}),
    "vcm, Epanechnikov": ("vcm", {"merging": {"kernel": "epanechnikov"}}),
    "vcm, few light paths": ("vcm", {"merging": {"light_paths": 0.25}}),
    "vcm, many light paths": ("vcm", {"merging": {"light_paths": 3.5}}),
    "bpt, power heuristic": ("bpt", {"heuristic": "power"}),
    "vcm, power heuristic": ("vcm", {"heuristic": "power"}),
}
SLOW = {
    "bpt, power heuristic",
    "bpt, few light paths",
    "bpt, many light paths",
    "ppm, Epanechnikov",
    "bpm, SmallVCM's schedule",
    "vcm, power heuristic",
    "vcm, few light paths",
    "vcm, many light paths",
    "vcm, Epanechnikov",
}


def lost(settings):
    """Upper bound of the share of light that merges leave out; see spheres.py."""
    radius = settings.get("merging", {}).get("radius", 0.003) * BOUNDING_RADIUS
    return radius**2 / 8


def estimates(compiled, iterations=ITERATIONS, seeds=SEEDS):
    """R, G and B of the two paints in independent renders: (seeds, 2, 3)."""
    split = np.linalg.pinv(visible_patches(compiled).reshape(-1, 2))
    found = []
    for seed in range(seeds):
        film = render(with_render(compiled, seed=seed), iterations).film
        assert film.rejected_count == 0
        found.append(split @ film.rgb.reshape(-1, 3))
    return np.array(found)


def expected(edges=None, left_out=0.0, *, lamps):
    """R, G and B of the two paints in closed form, (2, 3)."""
    return patches(lamps=lamps).radiance(edges, left_out)[:2, :3]


def assert_agree(found, truth, rounding):
    """Means over seeds are `truth`, as far as their standard error and a relative deviation of `rounding` can tell."""
    error = found.std(axis=0, ddof=1) / math.sqrt(len(found))
    assert (error <= PRECISION * truth).all(), f"too noisy: {(error / truth).max():.2g}"
    alarm = 1 - (1 - FALSE_ALARM) ** (1 / truth.size)
    allowed = stats.t.isf(0.5 * alarm, len(found) - 1) * error + rounding * truth
    deviation = found.mean(axis=0) - truth
    assert (np.abs(deviation) <= allowed).all(), (deviation / truth, error / truth)
    # The mean of all six: a bias that all have in common shows here first.
    whole = (found / truth).mean(axis=(1, 2))
    error = whole.std(ddof=1) / math.sqrt(len(whole))
    assert error <= 0.6 * PRECISION
    assert abs(whole.mean() - 1) <= stats.t.isf(0.5 * FALSE_ALARM, len(whole) - 1) * error + rounding


def cases(names, slow=frozenset(SLOW)):
    return [pytest.param(name, marks=pytest.mark.slow if name in slow else ()) for name in names]


@pytest.mark.parametrize("name", cases(SUBSETS))
def test_point_in_a_glowing_sphere(name):
    integrator, settings = SUBSETS[name]
    compiled = sphere(lamps=False, integrator=integrator, max_path_length=LENGTH, **settings)
    assert_agree(estimates(compiled), expected(lamps=False), 1e-5 + lost(settings))


@pytest.mark.parametrize("name", cases(["pt", "lt", "bpt", "ppm", "bpm", "vcm"], {"pt", "lt", "ppm", "bpm"}))
def test_lamps_of_two_colors(name):
    """Black disks at the poles. Within a merge radius of their rims, photons are missing: a part of WIDE["radius"]."""
    integrator, settings = SUBSETS[name]
    compiled = sphere(lamps=True, integrator=integrator, max_path_length=LENGTH, **settings)
    assert_agree(estimates(compiled), expected(lamps=True), 1e-5 + lost(settings) + rim(settings))


def rim(settings):
    """Upper bound of the share of photons that merges beside the rims of the lamps miss: half, in that area's share."""
    radius = settings.get("merging", {}).get("radius", 0.0) * BOUNDING_RADIUS
    return 0.5 * radius * math.sin(CAP)


@pytest.mark.parametrize("edges", [pytest.param(2, marks=pytest.mark.slow), 4])
@pytest.mark.parametrize("name", cases(["pt", "lt", "bpt", "ppm", "bpm", "vcm"], {"lt", "ppm", "bpm"}))
def test_limited_length(name, edges):
    integrator, settings = SUBSETS[name]
    compiled = sphere(lamps=False, integrator=integrator, max_path_length=edges, **settings)
    assert_agree(estimates(compiled), expected(edges, lamps=False), 1e-5 + lost(settings))


def test_merges_over_half_of_the_scene():
    """What photon mapping with a radius of half the scene leaves out is known exactly."""
    settings = {"merging": {"radius": 0.5, "alpha": 1, "light_paths": 6}}
    compiled = sphere(lamps=False, integrator="ppm", max_path_length=LENGTH, **settings)
    found = estimates(compiled)
    assert lost(settings) > 0.09
    assert_agree(found, expected(None, lost(settings), lamps=False), 1e-5)
