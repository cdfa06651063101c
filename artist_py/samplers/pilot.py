"""The pilot pass of `merging.correlation = "vcm+"`: light subpaths whose density the weights of all iterations use."""

import math
from itertools import pairwise

import numpy as np

from ..core.table import Table
from ..integrators.methods import method_of
from ..integrators.pair import Setup, Stores, Techniques, path_dtype
from ..integrators.path_tracing import Pass
from ..integrators.pilot import count_pilot_photons
from ..transport.photon_density import PhotonDensity, scale_of
from ..transport.vertices import CHUNK, Pool
from .memory import stored_vertex_dtype

PATHS = 1 << 17  # light subpaths
BUCKETS = 1 << 20
# Edge of a cell in merge radii. Where the kernel holds one photon of an iteration with as many light subpaths, a cell
# then gets five: enough for weights, which do not have to be precise, and small enough for caustics.
CELL = 4.0


class Pilot:
    """Counters, and the jobs that fill them once."""

    def __init__(self, sampler, radius):
        n_light_paths = sampler.n_pixels * sampler.light_paths
        cell = CELL * radius * math.sqrt(max(1.0, n_light_paths / PATHS))
        counters = Table(np.zeros(BUCKETS, np.int64))
        self.density = PhotonDensity(counters, cell, scale_of(PATHS, cell))
        self.threads, self.is_done = sampler.threads, False

    def jobs(self, sampler):
        """`[(kernel, arguments)]`, one for each thread."""
        setup = self._setup(sampler)
        edges = np.linspace(0, PATHS, self.threads + 1).astype(int).tolist()
        return [
            (count_pilot_photons, (setup, self.density, thread, *each))
            for thread, each in enumerate(pairwise(edges))
        ]

    def _setup(self, sampler):
        """What light subpaths need, and nothing but their vertices.

        The wavelengths are those of iteration 0, and paths that are black at them count as well: others will not be.
        """
        compiled, threads = sampler.compiled, self.threads
        scene, sensing = sampler.scene_and_sensing(0, None)
        method = method_of("bpm", sampler.n_pixels, 1.0, 0.0, 1.0)
        nothing = Techniques(*[None] * len(Techniques._fields))
        method = method._replace(techniques=nothing._replace(light_paths=True))
        work = Pass(sampler.seed, 0, 0, sampler.crop, sampler.width, Table(np.zeros(4, np.int64)))
        first = CHUNK * np.arange(threads)
        ends = np.stack([first, first + CHUNK, first], axis=1)
        pool = Pool(
            Table(np.empty(threads * CHUNK, stored_vertex_dtype(compiled, sampler.lanes))),
            Table(np.zeros(2, np.int64)),
            Table(ends),
            Table(np.zeros(threads, np.int32)),
            compiled.scene.needs.smooth_triangles,
            compiled.scene.needs.textures,
        )
        paths, resume = Table(np.zeros(threads, path_dtype)), Table(np.zeros((threads, 2), np.int64))
        stores = Stores(pool, None, None, paths, resume, None)
        limits = sampler.limits._replace(ends_black=None)
        return Setup(scene, compiled.camera, compiled.pixel_filter, sensing, limits, work, method, stores)
