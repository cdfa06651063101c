"""Keeping what each technique brings: tables for the kernels, and their way to the film."""

import numpy as np

from ..core.table import Table
from ..errors import OptionError
from ..film.accumulation import add_technique_rows
from ..film.techniques import TechniqueFilm, techniques_of
from ..integrators.methods import METHODS, has_lens_hits, subset_of
from ..transport.recording import TECHNIQUES, VM, TechniqueTables

BYTES_PER_VALUE = 2 * (4 + 8)  # weighted and unweighted, of one iteration and of all


def kinds_of(integrator, camera, samples):
    """Kinds of techniques that a method has; OptionError for one that does not tell them apart."""
    if integrator == "pt":
        return ("hit", "nee")
    if integrator not in METHODS:
        raise OptionError(f"--techniques: integrator {integrator} keeps no images of techniques")
    subset = subset_of(integrator, samples)
    # A method without hits still takes those that no other technique finds.
    present = {
        "hit": True, "nee": subset.nee, "vc": subset.connect, "lt": subset.light_image,
        "lens": has_lens_hits(subset, camera), "vm": subset.merge,
    }  # fmt: skip
    return tuple(kind for kind, is_present in present.items() if is_present)


def techniques_of_render(compiled, longest):
    """All techniques of the render of a compiled scene that get images of their own."""
    render = compiled.graph.render
    kinds = kinds_of(render.integrator, compiled.camera, render.samples)
    return techniques_of(kinds, render.max_path_length, longest)


class TechniqueRecorder:
    """Tables of one iteration, `tables`, and the film that they are added to, `film`."""

    def __init__(self, techniques, height, width):
        self.film = TechniqueFilm(techniques, height, width)
        shape = self.film.weighted.shape
        self._weighted, self._unweighted = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
        rows = Table(technique_rows(techniques))
        self.tables = TechniqueTables(Table(self._weighted), Table(self._unweighted), rows)

    def add_job(self, image, first, end):
        """`(kernel, arguments)` that adds rows [first, end) to the film, but for pixels that `image` rejects."""
        film = self.film
        tables = self._weighted, self._unweighted, film.weighted, film.unweighted
        return add_technique_rows, (image, *tables, first, end)


def technique_rows(techniques):
    """`TechniqueTables.rows`; -1 for what cannot be."""
    longest = max(technique.length or 0 for technique in techniques)
    rows = np.full((len(TECHNIQUES), longest + 2, longest + 2), -1, np.int32)
    for row, technique in enumerate(techniques):
        kind = TECHNIQUES.index(technique.kind)
        if technique.length is None:
            rows[kind, longest + 1, :] = row
        elif technique.kind == "vc":
            rows[kind, technique.length, technique.t - 1] = row
        elif kind == VM:
            rows[kind, technique.length, technique.length - technique.m] = row
        else:
            rows[kind, technique.length, :] = row
    return rows
