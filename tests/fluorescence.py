"""What fluorescent scenes should look like, worked out by linear algebra: on bins, or at an iteration's wavelengths.

Rooms are two concentric spheres. By symmetry each is as bright everywhere; the inner one sees the outer one only, which
sees the inner one with the share (r / R)^2 of what it sees, and itself with the rest. With both radiances in one
vector, emission E and what is scattered once K, paths of up to n edges bring the sum of K^i E over i < n (theory 3.10).
"""

from typing import NamedTuple

import numpy as np
from rendering import look, scene, shape
from scipy import stats

from artist_py.samplers.render_job import RenderSettings, Silence, film_of, sampler_for
from artist_py.samplers.wavelengths import sets_of_wavelengths

FALSE_ALARM = 1e-4  # probability that one comparison fails by chance
ROUNDING = 2e-5  # relative; long paths carry float32
RANGE = [300, 780]
INNER, OUTER = 0, 1
RADII = (0.5, 1.5)
SHARE = (RADII[0] / RADII[1]) ** 2
DYES = [
    {
        "absorption": {"gaussian": [380, 28], "peak": 0.5},
        "emission": {"gaussian": [470, 22]},
        "quantum_yield": 0.9,
    },
    {
        "absorption": {"gaussian": [480, 25], "peak": 0.45},
        "emission": {"gaussian": [600, 25]},
        "quantum_yield": 0.8,
    },
]
CASCADE = {
    "type": "fluorescent",
    "reflectance": {"wavelengths": [300, 500, 620, 780], "values": [0.15, 0.17, 0.45, 0.5]},
    "dyes": DYES,
}
ORANGE = {
    "type": "fluorescent",
    "reflectance": 0.3,
    "reradiation": {"excitation": [460, 40], "emission": [590, 20], "strength": 0.55},
}
LAMP = {"spectrum": {"wavelengths": [300, 385, 500, 780], "values": [1.5, 2.0, 0.8, 1.2]}}
GLIMMER = {"spectrum": {"wavelengths": [300, 420, 780], "values": [0.3, 0.5, 0.1]}}


def room(seen=INNER, inner=ORANGE, outer=CASCADE, lamp=None, glimmer=None, **render):
    """The compiled scene of two concentric spheres, seen from between them; `seen` is the one that fills the image."""
    ends = {INNER: [0, 0, 0], OUTER: [0.1, -2, 0.05]}
    return scene(
        [
            shape("sphere", "inner", center=[0, 0, 0], radius=RADII[0], emission=lamp or LAMP),
            shape(
                "sphere",
                "outer",
                center=[0, 0, 0],
                radius=RADII[1],
                reverse=True,
                emission=glimmer or GLIMMER,
            ),
        ],
        materials={"inner": inner, "outer": outer},
        camera=look([0, -0.7, 0], ends[seen], 60),
        film={"resolution": [32, 32]},
        render={
            "wavelength_range": RANGE,
            "max_path_length": 5,
            "merging": {"radius": 0.02, "alpha": 1, "light_paths": 4},
            **render,
        },
    )


class Surfaces(NamedTuple):
    """Per surface and, of `scatter`, from lane to lane: what is emitted, and what becomes of light that arrives."""

    emission: np.ndarray  # (2, lanes)
    scatter: np.ndarray  # (2, lanes out, lanes in)
    response: np.ndarray  # of the film (3, lanes)


def on_bins(compiled):
    """`Surfaces` over all bins of 1 nm: nothing is left to chance."""
    reflectance, emission, matrices = _tables(compiled)
    scatter = [np.diag(rho) + matrix for rho, matrix in zip(reflectance, matrices, strict=True)]
    return Surfaces(emission, np.array(scatter), compiled.spectra[:3].astype(float))


def on_sets(compiled, iteration, by_wavelength=False):
    """`Surfaces` at the wavelengths of an iteration, where fluorescence leads from each set to the one before.

    But for images by wavelength there is a lane more for each channel of the film: of what it should get by all
    wavelengths what it does not get by those of set 0.
    """
    render, sets = compiled.graph.render, compiled.fluorescence.n_sets
    wavelengths, weights = sets_of_wavelengths(
        compiled.fluorescence.set_nodes, render.hero_count, render.seed, iteration
    ).reshape(2, sets, -1)
    bins = np.minimum((wavelengths - RANGE[0]).astype(int), RANGE[1] - RANGE[0] - 1)
    reflectance, emission, matrices = _tables(compiled)
    count, lanes = bins.shape[1], bins.size
    scatter = np.array([np.diag(rho[bins.ravel()]) for rho in reflectance])
    for m in range(sets):
        source = (m + 1) % sets
        block = matrices[:, bins[m][:, None], bins[source][None, :]] * weights[source]
        scatter[:, m * count : (m + 1) * count, source * count : (source + 1) * count] += block
    response = np.zeros((3, lanes))
    response[:, :count] = compiled.spectra[:3, bins[0]] * weights[0]
    surfaces = Surfaces(emission[:, bins.ravel()], scatter, response)
    if by_wavelength or sets == 1:
        return surfaces
    return _controlled(compiled, surfaces, slice(count, 2 * count), bins[1], weights[1])


def _controlled(compiled, surfaces, set_1, bins, weights):
    """`surfaces` with the lanes of the control (theory 3.9); lanes, bins and weights are those of set 1."""
    reflectance, emission, matrices = _tables(compiled)
    sensor, means = compiled.spectra[:3].astype(float), compiled.fluorescence.means
    lanes = surfaces.response.shape[1]
    missed = emission @ sensor.T - surfaces.emission @ surfaces.response.T
    scatter = np.zeros((len(matrices), lanes + 3, lanes + 3))
    scatter[:, :lanes, :lanes] = surfaces.scatter
    for surface in range(len(matrices)):
        scatter[surface, lanes:, lanes:] = np.diag(means @ reflectance[surface])
        by_set_0 = surfaces.response[:, : bins.size] @ surfaces.scatter[surface, : bins.size, set_1]
        scatter[surface, lanes:, set_1] = sensor @ matrices[surface][:, bins] * weights - by_set_0
    return Surfaces(
        np.hstack([surfaces.emission, missed]), scatter, np.hstack([surfaces.response, np.eye(3)])
    )


def _tables(compiled):
    """Reflectance, emission (2, bins) and matrices (2, bins, bins) of the inner and the outer sphere."""
    scene, spectra = compiled.scene, compiled.spectra.astype(float)
    materials, lamps = scene.materials.array[1:], scene.emitters.records.array
    zero = np.zeros_like(compiled.fluorescence.matrices[0])
    matrices = [compiled.fluorescence.matrices[i] if i >= 0 else zero for i in materials["fluorescence"]]
    emission = spectra[lamps["spectrum"]] * lamps["scale"][:, None]
    return spectra[materials["reflectance"]], emission, np.array(matrices)


def colours(surfaces, edges):
    """RGB of the inner and the outer sphere by paths of up to so many edges, (2, 3)."""
    radiance, part = surfaces.emission.copy(), surfaces.emission
    for _ in range(edges - 1):
        around = np.array([part[OUTER], SHARE * part[INNER] + (1.0 - SHARE) * part[OUTER]])
        part = np.einsum("soi,si->so", surfaces.scatter, around)
        radiance += part
    return radiance @ surfaces.response.T


def enclosure_colour(compiled, iteration, edges=200):
    """RGB of a room of one surface, which is as bright everywhere, at the wavelengths of an iteration (3,)."""
    surfaces = on_sets(compiled, iteration)
    radiance, part = surfaces.emission[0].copy(), surfaces.emission[0]
    for _ in range(edges - 1):
        part = surfaces.scatter[0] @ part
        radiance = radiance + part
    return surfaces.response @ radiance


def iteration_images(compiled, iterations, spectral=False):
    """The image of each iteration, (iterations, h, w, 3)."""
    settings = RenderSettings(iterations=iterations, threads=2, spectral=spectral)
    film = film_of(compiled, settings)
    found = []
    with sampler_for(compiled, film, settings, Silence()) as sampler:
        sampler.compile_kernels(Silence())
        for iteration in range(iterations):
            before = film.sums.copy()
            sampler.iterate(iteration)
            found.append(film.sums - before)
    assert film.rejected_count == 0
    return np.array(found)


def iteration_colours(compiled, iterations, spectral=False):
    """Mean RGB of the image of each iteration, (iterations, 3)."""
    return iteration_images(compiled, iterations, spectral).mean(axis=(1, 2))


def assert_deviations_vanish(found, expected, precision):
    """Images of iterations are as expected; t-test over iterations, per channel.

    Deviations are relative to the brightest channel of their iteration, which differs from one to the next.
    """
    deviation = (found - expected) / np.abs(expected).max(axis=1, keepdims=True)
    error = deviation.std(axis=0, ddof=1) / np.sqrt(len(found))
    assert (error < precision).all(), error
    limit = stats.t.ppf(1.0 - FALSE_ALARM / 6, len(found) - 1) * error + ROUNDING
    assert (np.abs(deviation.mean(axis=0)) < limit).all(), (deviation.mean(axis=0), error)
