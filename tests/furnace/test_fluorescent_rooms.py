"""Fluorescent rooms whose light is known by linear algebra, by every integrator (theory 3.10).

Given its wavelengths an iteration has an exact expectation, so that nothing here waits for the noise of colours: images
are compared with that, and the mean of the expectations over iterations with the solution on bins. Fixed seeds; a
correct program fails one comparison by chance with probability 1e-4.
"""

import numpy as np
import pytest
from fluorescence import (
    CASCADE,
    INNER,
    LAMP,
    ORANGE,
    OUTER,
    RANGE,
    assert_deviations_vanish,
    colours,
    enclosure_colour,
    iteration_colours,
    on_sets,
    room,
)
from rendering import look, scene, shape

import artist_py

ITERATIONS = 48
# Standard errors that the images must have, relative: light subpaths alone are noisier here.
PRECISION = {"pt": 1e-3, "bpt": 2e-3, "vcm": 8e-3, "lt": 2e-2, "bpm": 2e-2, "ppm": 2e-2}
FAST = {"pt", "bpt", "vcm"}  # their techniques are all that there are


def assert_iterations_agree(compiled, seen, precision=None, iterations=ITERATIONS, spectral=False):
    """Each iteration's image has the expectation that its wavelengths give it."""
    render = compiled.graph.render
    expected = [
        colours(on_sets(compiled, i, by_wavelength=spectral), render.max_path_length)[seen]
        for i in range(iterations)
    ]
    found = iteration_colours(compiled, iterations, spectral)
    assert_deviations_vanish(found, np.array(expected), precision or PRECISION[render.integrator])


@pytest.mark.parametrize("seen", [INNER, OUTER])
@pytest.mark.parametrize(
    "integrator",
    [pytest.param(name, marks=() if name in FAST else pytest.mark.slow) for name in PRECISION],
)
def test_iterations_have_the_expectation_of_their_wavelengths(integrator, seen):
    assert_iterations_agree(room(seen, integrator=integrator), seen)


@pytest.mark.parametrize("integrator", ["pt", pytest.param("vcm", marks=pytest.mark.slow)])
def test_images_by_wavelength_have_it_without_control(integrator):
    assert_iterations_agree(room(OUTER, integrator=integrator), OUTER, spectral=True)


@pytest.mark.parametrize("edges", [1, 2, 3])
@pytest.mark.parametrize("integrator", ["pt", "bpt", "vcm"])
def test_limited_length(integrator, edges):
    """Paths of up to so many edges: no fluorescent event, one, and two at different surfaces."""
    assert_iterations_agree(room(OUTER, integrator=integrator, max_path_length=edges), OUTER)


def test_roulette_from_the_start():
    """Roulette by what a path brings at all wavelengths does not change the expectation."""
    assert_iterations_agree(room(OUTER, integrator="pt", roulette_length=0), OUTER, 3e-3)


def test_two_sets_of_one_wavelength():
    """One wavelength of the film, and one that excites: the smallest sets there are."""
    compiled = room(OUTER, integrator="pt", hero_count=1, wavelength_sets=2)
    assert_iterations_agree(compiled, OUTER)


LINE = {"spectrum": {"lines": [[405.5, 1.0]], "width": 1.0}}
GREEN = {
    "type": "fluorescent",
    "reflectance": 0.3,
    "absorption": {"wavelengths": [400, 401, 409, 410], "values": [0, 0.6, 0.6, 0]},
    "emission": {"wavelengths": [550, 551, 599, 600], "values": [0, 1, 1, 0]},
}


def test_light_stays_within_its_lines_and_bands():
    """A line at 405 nm and a dye that gives off 550 to 600 nm: all else of the spectrum is black, to the last bit.

    In a closed room of one paint all is as bright everywhere. Of the line's radiance L the paint takes in a L, and of
    the band's radiance G it gives off itself what it does not reflect, (1 - rho) G: as many photons, each with the
    energy of its wavelength, and so less power than it took in.
    """
    compiled = room(OUTER, GREEN, GREEN, LINE, LINE, integrator="pt", max_path_length=20)
    image = artist_py.render(compiled, iterations=256, threads=2, spectral=True).film
    bands, centres = image.spectral.mean(axis=(0, 1)), image.band_centres
    is_line, is_band = np.abs(centres - 405) < 1, np.abs(centres - 575) < 25
    assert (bands[is_line] > 0).all() and (bands[is_band] > 0).all()
    assert (bands[~is_line & ~is_band] == 0).all()
    ratio = (1 - 0.3) * bands[is_band].sum() / (0.6 * bands[is_line].sum())
    # Over seeds the expectation at 256 iterations' wavelengths has a standard deviation of 0.7 %.
    assert ratio < 1
    assert abs(ratio / (405.5 / 575) - 1) < 0.035


def test_what_no_dye_absorbs_excites_none():
    """Light outside every absorption: nothing but the line is seen."""
    line = {"spectrum": {"lines": [[650.5, 1.0]], "width": 1.0}}
    compiled = room(OUTER, lamp=line, glimmer=line, outer=ORANGE, integrator="pt")
    image = artist_py.render(compiled, iterations=64, threads=2, spectral=True).film
    bands = image.spectral.mean(axis=(0, 1))
    line_share = bands[np.abs(image.band_centres - 655) < 1].sum() / bands.sum()
    assert line_share > 1 - 1e-5  # the bell curve of the excitation is exp(-11) of its height there


# --- through glass ------------------------------------------------------------------------------------------------


def glass_room(**render):
    """A glass ball whose index depends on wavelength, in a sphere that is lit and fluoresces all over.

    What is as bright from everywhere is as bright through glass: the ball cannot be seen.
    """
    glass = {"type": "dielectric", "ior": {"cauchy": [1.5, 0.01]}}
    return scene(
        [
            shape("sphere", "wall", center=[0, 0, 0], radius=1.5, reverse=True, emission=LAMP),
            shape("sphere", "glass", center=[0, 0.4, 0], radius=0.45),
        ],
        materials={"wall": CASCADE, "glass": glass},
        camera=look([0, -0.7, 0], [0, 1, 0], 60),
        film={"resolution": [24, 24]},
        render={"wavelength_range": RANGE, "max_path_length": 80, "merging": {"radius": 0.02}, **render},
    )


@pytest.mark.parametrize(
    ("integrator", "precision"), [("pt", 1.3e-2), pytest.param("vcm", 2e-2, marks=pytest.mark.slow)]
)
def test_dispersion_with_fluorescence(integrator, precision):
    """A dispersive surface keeps one wavelength of all sets, and the next dye makes all of them of it (theory 3.7)."""
    compiled = glass_room(integrator=integrator)
    expected = np.array([enclosure_colour(compiled, i) for i in range(5 * ITERATIONS)])
    assert_deviations_vanish(iteration_colours(compiled, 5 * ITERATIONS), expected, precision)
