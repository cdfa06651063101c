"""What a scene that fluoresces needs: tables by bins of 1 nm, and where its sets of wavelengths lie (theory 3.5)."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from artist_py.errors import SceneError
from artist_py.film.wavelengths import excitation_density, inverse_cdf, normalised, wavelength_density
from artist_py.scene.compile_shifting import shifting_problem, shifts
from artist_py.scene.graph import Fluorescent
from artist_py.scene.where import problem

EVENTS = 3  # fluorescent events in a row that densities of wavelengths think of
FLAT = 0.1  # share that equal light has in what dyes under a coat are sampled by: none that can shine is left out


@dataclass(frozen=True)
class FluorescentScene:
    """Reradiation of all fluorescent materials of a scene, and the distributions of its sets of wavelengths."""

    matrices: np.ndarray  # R, 1 / nm, float64 (materials, bins out, bins in)
    totals: (
        np.ndarray
    )  # share of the power that is scattered at all, by where it arrives; float64 (materials, bins)
    shares: np.ndarray  # of the scene's light given off at other wavelengths; float64 (materials,)
    set_nodes: tuple  # inverse distribution of each set, nm
    sensor: np.ndarray  # what the film's channels get per radiance and nm, float64 (3, bins)
    means: (
        np.ndarray
    )  # weights of wavelengths, of sum 1, in what stands for all of them, per channel; (3, bins)

    @cached_property
    def colours(self):
        """What the film's channels get of light at each wavelength by reradiation, (materials, 3, bins)."""
        return self.sensor @ self.matrices

    @property
    def n_sets(self):
        """Number of sets of wavelengths, M."""
        return len(self.set_nodes)


def fluoresces(graph, used):
    """Whether any of the materials used does."""
    return any(isinstance(graph.materials.get(name), Fluorescent) for name in used)


def with_fluorescent_wavelengths(graph):
    """The graph of a scene that fluoresces, whose wavelengths are shared unless others are asked for.

    Raises SceneError where these have no meaning.
    """
    render = graph.render
    if render.integrator == "reference":
        message = "the reference integrator knows no fluorescence, found a material that fluoresces"
        raise SceneError([problem(render, "integrator", message)])
    if not _is_given(render, "wavelengths"):
        return replace(graph, render=replace(render, wavelengths="shared"))
    if found := shifting_problem(render):
        raise SceneError([problem(render, *found)])
    if shifts(render):  # two densities of wavelengths: where eye and where light subpaths begin
        return replace(graph, render=replace(render, wavelength_sets=2))
    return graph


def _is_given(node, key):
    """Whether a key was written, and not left to its default."""
    if node.where is None:
        return False
    table = node.where.source.table
    for name in node.where.keys:
        table = table.get(name, {})
    return key in table


def fluorescent_scene(glows, sensor, light, first, n_sets):
    """The `FluorescentScene` of all `Glow`s of a scene, or `None` if there are none.

    `sensor` is the (3, bins) table of `sensor_table`, `light` the power per nm of all emitters (bins,).
    """
    if not glows:
        return None
    matrices = np.array([glow.matrix for glow in glows])
    yields = matrices.sum(axis=1)
    everywhere = _light_after_events(matrices.mean(axis=0), light)
    seen = wavelength_density(sensor, everywhere)
    mixture = excitation_density(seen, everywhere, yields.sum(axis=0))
    densities = [seen if n_sets > 1 else mixture] + [mixture] * (n_sets - 1)
    # What a coat mirrors may be all of the light, at grazing angles.
    elastic = np.array([np.ones_like(light) if glow.is_coated else glow.reflectance for glow in glows])
    shares = (1.0 - FLAT) * _mean(yields, everywhere) + FLAT * yields.mean(axis=1)
    nodes = tuple(inverse_cdf(density, first) for density in densities)
    means = np.abs(sensor) * (matrices.mean(axis=0) @ everywhere)
    means = np.array([normalised(*each) for each in zip(means, np.abs(sensor), strict=True)])
    totals = np.minimum(elastic + yields, 1.0)
    return FluorescentScene(matrices, totals, shares, nodes, sensor, means)


def _mean(yields, light):
    """Means (materials,) of yields (materials, bins) over light (bins,); 0 in the dark."""
    power = light.sum()
    return yields @ light / power if power > 0.0 else np.zeros(len(yields))


def _light_after_events(matrix, light):
    """The light of the emitters, and what fluorescence makes of it, per nm (bins,)."""
    everywhere, part = light.copy(), light
    for _ in range(EVENTS):
        part = matrix @ part
        everywhere += part
    return everywhere
