"""What each technique brings, kept apart: an image per technique and path length, weighted and not.

The tables travel as an argument. It is `None` unless somebody wants these images, and then nothing of this is compiled.
"""

from typing import NamedTuple

from ..core.table import Table
from ..core.vector import Spectrum
from ..jit import function
from .sensing import rgb_of

# Techniques of theory 1.2, in the order of `TECHNIQUES`.
HIT, NEE, VC, LT, LENS, VM = range(6)
TECHNIQUES = ("hit", "nee", "vc", "lt", "lens", "vm")


class TechniqueTables(NamedTuple):
    """Images of one iteration, linear RGB, float32 (n, h, w, 3); `unweighted` is what each technique says alone."""

    weighted: Table
    unweighted: Table
    # int32 (6, lengths + 2, lengths + 2): the image of a technique, path length and number of edges on the eye's side.
    # The last length stands for all that are longer.
    rows: Table


class Place(NamedTuple):
    """To which pixel of the window a subpath belongs, and what its radiance counts there per wavelength."""

    row: int
    column: int
    wavelengths: Spectrum  # nm
    weights: Spectrum  # nm, that of the pixel filter included


@function
def record(tables, spectra, place, technique, length, eye_length, contribution, weight):
    """Note radiance that already holds its MIS `weight`, brought by paths of `length` edges."""
    if tables is None:
        return
    add_to_technique(tables, spectra, place, technique, length, eye_length, contribution, weight)


@function
def add_to_technique(tables, spectra, place, technique, length, eye_length, contribution, weight):
    """As `record`, where there are tables."""
    if weight > 0.0:
        longest = tables.rows.shape[1] - 1
        image = tables.rows[technique, min(length, longest), min(eye_length, longest)]
        red, green, blue = rgb_of(spectra, contribution * place.weights, place.wavelengths)
        _add(tables.weighted, image, place, red, green, blue)
        _add(tables.unweighted, image, place, red / weight, green / weight, blue / weight)


@function
def _add(images, image, place, red, green, blue):
    images[image, place.row, place.column, 0] += red
    images[image, place.row, place.column, 1] += green
    images[image, place.row, place.column, 2] += blue
