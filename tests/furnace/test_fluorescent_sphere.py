"""A sphere with patches of several dyes against linear algebra, by every integrator and its options (theory 3.10).

See dyed_spheres.py. An image is split into what its three paints show, by least squares; independent renders tell how
precise these nine estimates are, and they may be off by Student's bound. A correct program fails one comparison by
chance with probability 1e-4.
"""

import math

import numpy as np
import pytest
from dyed_spheres import (
    BALL,
    DISK,
    GAP,
    PAINTS,
    dyed_sphere,
    patches,
    patches_of,
    shown,
    sphere_of,
    visible_paints,
    visible_points,
)
from fluorescence import CASCADE, LAMP, ORANGE, RANGE, on_bins
from rendering import render, with_render
from scipy import stats
from spheres import CHANNELS
from test_shifting_wavelengths import blur
from test_sphere_oracle import BOUNDING_RADIUS, LENGTH, SUBSETS

from artist_py.samplers.wavelengths import tolerance_of
from artist_py.scene.shape_types import Disk

FALSE_ALARM = 1e-4
# Renders, iterations of each, and the largest of the nine relative standard errors; of their mean it is half of that.
SEEDS, ITERATIONS, PRECISION = 24, 16, 6.5e-3  # measured: 4e-3
PRECISE = 24, 100, 2.4e-3  # the same of slow tests; measured: 1.5e-3, and 0.6e-3 of the mean
FEW = 24, 300, 2.4e-3  # with few light paths
LIMITED = 24, 100, 4e-3  # of few edges
SHIFTING = 24, 100, 8e-3  # of photon mapping with one wavelength each; measured: 5e-3
SPECTRAL = 24, 512, 3e-3  # of smooth spectra; measured with pt: 0.9e-3
NAMES = ["pt", "lt", "bpt", "ppm", "bpm", "vcm, wide"]
# All techniques that there are, and kernels that test_fluorescent_rooms.py has compiled.
FAST = ["pt", "bpt", "vcm, wide"]

SMOOTH = {"wall": CASCADE, "polar": ORANGE, "side": {"type": "diffuse", "reflectance": 0.6}}


def estimates(compiled, seeds=SEEDS, iterations=ITERATIONS):
    """R, G and B of the three paints in independent renders: (seeds, 3, 3)."""
    split = np.linalg.pinv(visible_paints(compiled).reshape(-1, len(PAINTS)))
    found = []
    for seed in range(seeds):
        film = render(with_render(compiled, seed=seed), iterations).film
        assert film.rejected_count == 0
        found.append(split @ film.rgb.reshape(-1, 3))
    return np.array(found)


def assert_agree(found, truth, precision, rounding):
    """Means over seeds are `truth`, as far as their standard error and a relative deviation of `rounding` can tell."""
    count, relative = len(found), found / truth - 1
    # All nine, and their mean: a bias that all have in common shows there first.
    relative = np.column_stack([relative.reshape(count, -1), relative.mean(axis=(1, 2))])
    error = relative.std(axis=0, ddof=1) / math.sqrt(count)
    assert error.max() < precision and error[-1] < 0.5 * precision, f"too noisy: {error}"
    allowed = stats.t.isf(0.5 * FALSE_ALARM / error.size, count - 1) * error + rounding
    assert (np.abs(relative.mean(axis=0)) < allowed).all(), (relative.mean(axis=0), error)


def assert_is_solved(compiled, truth, seeds=SEEDS, iterations=ITERATIONS, precision=PRECISION):
    found = estimates(compiled, seeds, iterations)
    assert_agree(found, truth, precision, GAP + BALL**3 + left_out(compiled.graph))


def left_out(graph):
    """Upper bound of the share of light that merges leave out.

    That is what spheres.py says, and beside the rims of two disks, where no photons are, 2/3 r sin(DISK) / pi: the mean
    over the sphere of the part of a merge's area that lies beyond a rim.
    """
    if graph.render.integrator in ("pt", "lt", "bpt"):
        return 0.0
    radius = graph.render.merging.radius * BOUNDING_RADIUS
    disks = any(isinstance(each, Disk) for each in graph.shapes)
    return radius**2 / 8 + (2 * radius * math.sin(DISK) / (3 * math.pi) if disks else 0.0)


def scene_of(name, **more):
    """The scene for a technique subset."""
    integrator, settings = SUBSETS[name]
    return dyed_sphere(integrator=integrator, **{"max_path_length": LENGTH, **settings, **more})


def solution(edges=None, *, disks=False):
    """What the film shows of the three paints, (3, 3)."""
    closed = patches(disks=disks)
    return shown(closed.radiance() if edges is None else sum(closed.orders(edges)))


# --- the solution itself ------------------------------------------------------------------------------------------


def test_orders_sum_up():
    np.testing.assert_allclose(solution(120), solution(), rtol=1e-12)
    np.testing.assert_allclose(solution(LENGTH), solution(), rtol=1e-6)


@pytest.mark.parametrize("disks", [False, True])
def test_what_is_shown_depends_on_cascades(disks):
    """At least a fifth of the last bin's light has been through two dyes or more, and some through three."""
    closed = patches(disks=disks)
    elastic = closed.scatter * np.eye(CHANNELS)
    times = np.arange(CHANNELS)  # what has been through n dyes grows with the n-th power of their matrices
    light = [
        closed._replace(scatter=elastic + t * (closed.scatter - elastic)).radiance()[:, -1] for t in times
    ]
    events = np.linalg.solve(np.vander(times, increasing=True).astype(float), light)
    shares = events / events.sum(axis=0)
    assert (shares[2:].sum(axis=0) > 0.2).all() and (shares[3] > 0.01).all()


def test_lamps_are_out_of_sight():
    compiled = dyed_sphere(disks=True, integrator="pt")
    camera = compiled.graph.camera
    assert np.abs(visible_points(compiled, 4)[..., 1]).max() < math.cos(DISK)
    assert np.dot(camera.position, np.subtract(camera.look_at, camera.position)) > 0


# --- renders ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FAST)
def test_lamp_in_the_middle(name):
    assert_is_solved(scene_of(name), solution())


@pytest.mark.parametrize("name", FAST)
def test_up_to_three_events(name):
    assert_is_solved(scene_of(name, max_path_length=4), solution(4))


@pytest.mark.slow
@pytest.mark.parametrize("edges", [2, 3, 4])
@pytest.mark.parametrize("name", NAMES)
def test_limited_length(name, edges):
    """One fluorescent event, two at different patches, and three."""
    assert_is_solved(scene_of(name, max_path_length=edges), solution(edges), *LIMITED)


@pytest.mark.slow
@pytest.mark.parametrize("name", SUBSETS)
def test_every_option(name):
    assert_is_solved(scene_of(name), solution(), *(FEW if "few" in name else PRECISE))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pt", "lt", "bpt", "ppm", "bpm", "vcm"])
def test_lamps_on_the_wall(name):
    assert_is_solved(scene_of(name, disks=True), solution(disks=True), *PRECISE)


@pytest.mark.slow
@pytest.mark.parametrize("sets", [2, 4])
def test_other_numbers_of_sets(sets):
    """More fluorescent events than there are sets: with a wavelength in each bin these may be used again."""
    assert_is_solved(scene_of("bpt", wavelength_sets=sets), solution(), *PRECISE)


# --- wavelengths that shift ---------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("heroes", "precision"), [(1, (24, 600, 3e-3)), (4, PRECISE)])
def test_path_tracing_by_shifting_wavelengths(heroes, precision):
    compiled = scene_of("pt", wavelengths="independent", hero_count=heroes)
    assert_is_solved(compiled, solution(), *precision)


@pytest.mark.slow
def test_photon_mapping_by_shifting_wavelengths():
    """A merge within a tolerance blurs what the paint that is seen reflects, and nothing else."""
    merging = {"radius": 0.03, "alpha": 1, "light_paths": 32, "wavelength_tolerance": 0.5}
    compiled = scene_of("ppm", wavelengths="rotate", hero_count=1, merging=merging)
    closed = patches(disks=False)
    incoming = closed.factors @ closed.radiance() + closed.lamps
    elastic = np.diagonal(closed.scatter, axis1=1, axis2=2)
    blurred = elastic * (incoming @ blur(CHANNELS, tolerance_of(compiled.graph.render.merging, 0)).T)
    truth = np.einsum("poi,pi->po", closed.scatter, incoming) - elastic * incoming + blurred
    assert_is_solved(compiled, shown(truth), *SHIFTING)


# --- the whole spectrum -------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("name", FAST)
def test_the_whole_spectrum(name):
    """Smooth spectra, which sets of wavelengths sample; three sets are exact for what three edges bring."""
    integrator, settings = SUBSETS[name]
    lamps = [LAMP["spectrum"]]
    compiled = sphere_of(
        SMOOTH, lamps, integrator=integrator, wavelength_range=RANGE, max_path_length=3, **settings
    )
    surfaces = on_bins(compiled)
    closed = patches_of(surfaces.scatter, surfaces.emission[0] * BALL**2, disks=False)
    assert_is_solved(compiled, sum(closed.orders(3)) @ surfaces.response.T, *SPECTRAL)
