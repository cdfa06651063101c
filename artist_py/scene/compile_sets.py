"""How many sets of wavelengths a scene that fluoresces gets, and what is said where they do not suffice."""

from dataclasses import replace

import numpy as np

from artist_py.film.color import RGB_TO_XYZ
from artist_py.scene.cascades import Light, chains_of_image, loss, loss_among_dyes, surfaces_of

SETS, MOST_SETS = 3, 4  # where the scene does not say, and where it needs more than these
MOST_HEROES = 8


def with_enough_sets(graph, fluorescent, loss_at, warn):
    """`(graph, fluorescent)` of a scene, with one set of wavelengths more where too much light would be lost.

    `loss_at(set_nodes)` is the `Loss` of an image with these sets. `warn(text)` is told where they do not suffice, be
    it that there are no more or that the scene says how many there are.
    """
    found = loss_at(fluorescent.set_nodes)
    if found.is_large and graph.render.wavelength_sets is None:
        nodes = fluorescent.set_nodes  # all but the first are alike
        fluorescent = replace(fluorescent, set_nodes=(*nodes, *nodes[-1:] * (MOST_SETS - len(nodes))))
        found = loss_at(fluorescent.set_nodes)
    graph = replace(graph, render=replace(graph.render, wavelength_sets=fluorescent.n_sets))
    if found.is_large:
        warn(_words(found, graph.render))
    return graph, fluorescent


def loss_with(graph, scene, camera, fluorescent, light, spectra):
    """The function `loss_at` of `with_enough_sets`; `light` is the power per nm of all emitters (bins,)."""
    surfaces = surfaces_of(scene, spectra, fluorescent.matrices)
    seen = np.maximum(RGB_TO_XYZ @ spectra[:3], 0.0).sum(axis=0)
    render = graph.render
    chains = []  # traced once, and only where they are needed

    def loss_at(set_nodes):
        ends = Light(light, seen, set_nodes, render.hero_count, int(scene.spectra.first))
        found = loss_among_dyes(surfaces, ends, render.max_path_length)
        if not found.may_be_large:
            return found
        if not chains:
            chains.append(chains_of_image(scene, camera, graph.film.resolution, render.max_path_length))
        return loss(surfaces, chains[0], ends)

    return loss_at


def _words(found, render):
    """The warning of a `Loss`."""
    sets = render.wavelength_sets
    ways = [f"render.wavelength_sets = {MOST_SETS}"] if sets < MOST_SETS else []
    ways += [f"render.hero_count = {MOST_HEROES}"] if render.hero_count < MOST_HEROES else []
    advice = f"; try {' and '.join(ways)}" if ways else ""
    off = "too dark" if found.wrong < 0.0 else "too bright"
    return (
        f"the image may be up to {abs(found.wrong):.0%} {off}: {found.share:.0%} of its light is that of {sets} or "
        f"more fluorescent events in a row, and {sets} sets of wavelengths are exact for fewer{advice}"
    )
