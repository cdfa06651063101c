"""The backwards image sampler: for all methods that start at the lights.

One iteration traces a light and an eye subpath per pixel over tiles of 32 x 32, sorts the photons into a grid behind a
barrier, and gathers them around the stored eye vertices. No ray is traced twice and no vertex is dropped.
"""

import math

import numpy as np

from ..core.table import Table
from ..core.vector import lane_count
from ..integrators.bidirectional import Stores, path_dtype, trace_pairs
from ..integrators.light_image import add_splats
from ..integrators.merging import gather
from ..integrators.methods import METHODS, method_of
from ..integrators.path_tracing import NEXT_TILE, RAYS, SHADOW_RAYS, STOP, Pass
from ..transport.merge import Merging
from ..transport.photon_grid import Grid, count_photons, photon_dtype, place_photons
from ..transport.splats import splat_dtype
from ..transport.vertices import CHUNK, NEXT_CHUNK, SHORTAGE, Pool, vertex_dtype
from .stochastic import StochasticSampler

RECORDS_PER_PATH = 4  # to begin with


def radius_of(radius, alpha, iteration):
    """Merge radius of an iteration (Knaus and Zwicker 2011): r_{n+1}^2 = r_n^2 (n + alpha) / (n + 1).

    In closed form, so that an iteration depends on its index alone: the product is a ratio of gamma functions.
    """
    n = iteration + 1
    log_ratio = math.lgamma(n + alpha) - math.lgamma(1 + alpha) - math.lgamma(n + 1) + math.lgamma(2)
    return radius * math.exp(0.5 * log_ratio)


class BackwardsSampler(StochasticSampler):
    """Drives a bidirectional method over a film."""

    def __init__(self, compiled, film, threads):
        super().__init__(compiled, film, threads)
        render = compiled.graph.render
        self.subset = METHODS[render.integrator]
        self.n_pixels = film.width * film.height
        self.lanes = render.hero_count
        self.merges = 0
        self.paths = Table(np.zeros(self.n_pixels, path_dtype))
        self.light = self._pool(vertex_dtype(self.lanes), self.subset.connect or self.subset.merge)
        self.eye = self._pool(vertex_dtype(self.lanes), self.subset.merge)
        self.splats = self._pool(splat_dtype(self.lanes), self.subset.light_image)

    def _pool(self, dtype, is_needed):
        """An empty pool with room for some records per path, at least one chunk per thread and one more."""
        if not is_needed:
            return None
        chunks = self.n_pixels * RECORDS_PER_PATH // CHUNK + 2 * self.threads + 1
        return self._pool_of(np.empty(chunks * CHUNK, dtype))

    def _pool_of(self, records):
        ends = Table(np.zeros((self.threads, 2), np.int64))
        return Pool(Table(records), Table(np.zeros(2, np.int64)), ends, Table(np.zeros(len(records) // CHUNK, np.int32)))

    # --- one iteration

    def iterate(self, iteration, stop=None):
        """Trace one pair of subpaths per pixel and add them to the film; `False` if `stop` was set meanwhile."""
        progress = np.zeros(4, np.int64)
        scene, sensing = self.scene_and_sensing(iteration, self.bands)
        work = Pass(self.seed, iteration, self.stratified_pairs, self.crop, self.width, Table(progress))
        radius = self._radius(iteration)
        method = method_of(self.compiled.graph.render.integrator, self.n_pixels, math.pi * radius**2)
        for pool in (self.light, self.eye, self.splats):
            _empty(pool)
        resume = np.full((self.threads, 2), -1, np.int64)
        while True:
            stores = Stores(self.light, self.eye, self.splats, self.paths, Table(resume))
            jobs = [(trace_pairs, self._pair_arguments(scene, sensing, work, method, stores, i)) for i in range(self.threads)]
            self.run(jobs, stop, progress)
            if progress[STOP]:
                return False
            if not self._enlarge():
                break
        self._merge(scene, sensing, work, method, radius)
        self._add_light_image(scene, sensing, work)
        self.add_to_film(iteration)
        self.rays = self.rays[0] + int(progress[RAYS]), self.rays[1] + int(progress[SHADOW_RAYS])
        return True

    def _radius(self, iteration):
        merging = self.compiled.graph.render.merging
        space = self.compiled.space
        first = merging.radius * space.radius * space.scale
        return max(radius_of(first, merging.alpha, iteration), 1e-7 * space.radius * space.scale)

    def _pair_arguments(self, scene, sensing, work, method, stores, thread):
        compiled = self.compiled
        return (
            scene, compiled.camera, compiled.pixel_filter, sensing, self.limits, work, method, stores, thread,
            Table(self.image),
        )  # fmt: skip

    def _enlarge(self):
        """Give the pools that ran short half as much again; `False` if none did."""
        enlarged = False
        for name in ("light", "eye", "splats"):
            pool = getattr(self, name)
            if pool is not None and pool.state[SHORTAGE]:
                old = pool.records.array
                records = np.empty(len(old) + max(len(old) // 2 // CHUNK, self.threads) * CHUNK, pool.records.dtype)
                records[: len(old)] = old
                grown = self._pool_of(records)
                grown.state.array[NEXT_CHUNK] = pool.state[NEXT_CHUNK]
                grown.ends.array[:] = pool.ends.array
                grown.used.array[: len(pool.used)] = pool.used.array
                setattr(self, name, grown)
                enlarged = True
        return enlarged

    def _merge(self, scene, sensing, work, method, radius):
        if self.eye is None:
            return
        n_photons = int(self.paths.array["n_vertices"].sum())
        buckets = 1 << max(int(n_photons - 1).bit_length(), 4)
        photons = np.empty(n_photons, photon_dtype(self.lanes))
        grid = Grid(Table(photons), Table(np.zeros(buckets + 1, np.int64)), 2.0 * radius)
        edges = np.linspace(0, buckets, self.threads + 1).astype(int)
        ranges = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
        records = self.light.records
        counts = self.run([(count_photons, (grid, records, self.paths, *each)) for each in ranges])
        before = np.concatenate([[0], np.cumsum(counts)]).tolist()
        self.run(
            [(place_photons, (grid, records, self.paths, *each, before[i])) for i, each in enumerate(ranges)]
        )
        merging = Merging(radius, 1.0 / (math.pi * radius**2 * self.n_pixels))
        progress = np.zeros(2, np.int64)
        arguments = (
            scene, sensing, self.limits, work, method, grid, merging, self.eye, Table(progress), Table(self.image),
        )  # fmt: skip
        self.run([(gather, arguments)] * self.threads)
        self.merges += int(progress[1])

    def _add_light_image(self, scene, sensing, work):
        if self.splats is None:
            return
        edges = np.linspace(0, self.film.height, self.threads + 1).astype(int).tolist()
        rows = zip(edges[:-1], edges[1:], strict=True)
        image = Table(self.image)
        self.run([(add_splats, (scene, sensing, work, self.paths, self.splats.records, *row, image)) for row in rows])

    def compile_kernels(self, observer):
        """Compilation happens in the first iteration."""
        return 0.0


def _empty(pool):
    """Forget what a pool holds."""
    if pool is not None:
        for table in (pool.state, pool.ends, pool.used):
            table.array[:] = 0


__all__ = ["NEXT_TILE", "BackwardsSampler", "lane_count"]
