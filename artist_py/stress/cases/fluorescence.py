"""Dyes: the smallest Stokes shift, many in cascade, light that excites none, and a matrix with noise."""

from artist_py.stress.case import Case, Radiance, SameAs
from artist_py.stress.fluorescence import Dye, glowing_room, measured_room, write_noisy_matrix
from artist_py.stress.scenes import EDGES

NOISY = "noisy.csv"
SEED = 11
TEN = [Dye((first, first + 40), (first + 40, first + 80)) for first in range(300, 700, 40)]


def glowing(name, shows, scene_and_luminance, **more):
    """A case of a room of known luminance."""
    scene, luminance = scene_and_luminance
    return Case(name, shows, scene, Radiance(luminance), **more)


def with_three_sets(scene):
    """The scene with the sets of wavelengths that other cases have, so that it shares their kernels."""
    return {**scene, "render": {**scene["render"], "wavelength_sets": 3}}


CASES = (
    glowing(
        "stokes-1nm",
        "All light of 500 nm becomes light of 501 nm, and that of 502 nm: a quantum yield of 1, in bands of 1 nm.",
        glowing_room((500, 501, 20.0), [Dye((500, 501), (501, 502)), Dye((501, 502), (502, 503))]),
    ),
    glowing(
        "dye-in-the-dark",
        "A dye that absorbs what no lamp emits; its light would be seen.",
        glowing_room((400, 700, 0.6), [Dye((300, 380), (500, 600), 0.6)], 0.4, EDGES),
    ),
    glowing(
        "dye-out-of-range",
        "A dye that absorbs what is not rendered.",
        glowing_room((400, 700, 0.6), [Dye((250, 300), (500, 600), 0.6)], 0.4, EDGES),
    ),
    glowing(
        "ten-dyes",
        "Ten dyes in cascade that lose no photon, up to two events: from each band of 40 nm to the next.",
        glowing_room((300, 740, 0.3), TEN),
    ),
    Case(
        "ten-dyes-in-full",
        "The same, up to all ten events.",
        with_three_sets(glowing_room((300, 740, 0.3), TEN, edges=11)[0]),
        SameAs("pt"),
        precision=0.03,
        least=1024,  # some sets of wavelengths bring many times the mean, and 16 iterations seldom see one
        why="More events than sets of wavelengths have a bias, the same for all integrators.",
        warning="fluorescent events in a row",
    ),
    glowing(
        "noisy-matrix",
        "A measured matrix with noise: small negative values, and light of shorter wavelengths than excited it.",
        measured_room((300, 450, 3.0), SEED, NOISY),
        files=((NOISY, write_noisy_matrix, (SEED,)),),
        warning="negative values taken as 0",
    ),
)
