"""The backwards image sampler: for all methods that start at the lights.

One iteration traces light and eye subpaths over tiles of 32 x 32; behind a barrier the photons are sorted into a grid;
behind another they are gathered around the stored eye vertices. No ray is traced twice and no vertex is dropped, and
images are the same to the bit for any number of threads: what threads do at the same time never meets in one sum.
"""

import math
import time
from itertools import pairwise

import numpy as np

from ..core.table import Table
from ..integrators.bidirectional import trace_pairs
from ..integrators.light_image import add_splats
from ..integrators.merging import MERGES, gather
from ..integrators.methods import has_lens_hits, method_of, subset_of
from ..integrators.pair import Setup, Stores, path_dtype
from ..integrators.path_tracing import RAYS, SHADOW_RAYS, STOP, Pass
from ..transport.merge import Merging
from ..transport.photon_grid import Grid, count_photons, place_photons
from ..transport.rotation import Rotation
from ..transport.shifting import Matching
from ..transport.splats import splat_dtype
from ..transport.vertices import CHUNK, NEXT_CHUNK, SHORTAGE, Pool
from .memory import RECORDS_PER_PATH, lanes_of, stored_photon_dtype, stored_vertex_dtype
from .pilot import Pilot
from .stochastic import StochasticSampler
from .wavelengths import mean_acceptance, tolerance_of, van_der_corput

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
SHARES_SEED = 0x5348  # makes the random starts of shares others than those of wavelengths
SMALLEST_RADIUS = 1e-7  # of the scene's radius: below, float32 positions decide what is near


def radius_of(first, alpha, iteration, schedule="knaus-zwicker"):
    """Merge radius of an iteration: r_{n+1}^2 = r_n^2 (n + alpha) / (n + 1) (Knaus and Zwicker 2011).

    In closed form, so that an iteration depends on its index alone: the product is a ratio of gamma functions.
    "smallvcm" is the approximation r_1 n^((alpha - 1) / 2) of Georgiev's implementation.
    """
    n = iteration + 1
    if schedule == "smallvcm":
        return first * n ** (0.5 * (alpha - 1.0))
    log_ratio = math.lgamma(n + alpha) - math.lgamma(1 + alpha) - math.lgamma(n + 1)
    return first * math.exp(0.5 * log_ratio)


def share_offsets(seed, iteration):
    """Offsets of the three shares of light subpaths in an iteration (`Chosen`), each uniformly distributed.

    They follow the golden ratio's sequence, which goes evenly with the one that deals subpaths out to pixels. Even and
    odd iterations have random starts of their own, like all their random numbers (core/rng.py).
    """
    starts = np.random.default_rng([seed, iteration & 1, SHARES_SEED]).random(3)
    return tuple(((starts + (iteration >> 1) * GOLDEN) % 1.0).tolist())


def merge_radius(compiled, iteration):
    """Merge radius of an iteration in render space."""
    merging, space, camera = compiled.graph.render.merging, compiled.space, compiled.graph.camera
    scene_radius = space.radius * space.scale
    if merging.radius_pixels is None:
        first = merging.radius * scene_radius
    else:
        pixel = float(np.linalg.norm(compiled.camera.right.values))
        first = merging.radius_pixels * pixel * math.hypot(*camera.view()) * space.scale
    radius = radius_of(first, merging.alpha, iteration, merging.schedule)
    return max(radius, SMALLEST_RADIUS * scene_radius)


class BackwardsSampler(StochasticSampler):
    """Drives a bidirectional method over a film; a context manager, because it owns threads."""

    def __init__(self, compiled, film, threads, light_paths, recorder=None):
        super().__init__(compiled, film, threads, recorder)
        render = compiled.graph.render
        self.method_name, self.merging = render.integrator, render.merging
        self.subset = subset_of(render.integrator, render.samples)
        self.n_pixels = film.width * film.height
        self.light_paths = light_paths  # per pixel
        lanes = lanes_of(compiled, self.bands is not None)
        self.lanes = lanes.light
        self.counts = {"light_vertices": 0, "eye_vertices": 0, "merges": 0}
        self.phases = dict.fromkeys(("subpaths", "photon_grid", "merging", "light_image", "film"), 0.0)
        self.offsets = self._offsets(render)
        # Whether photons have one wavelength each, which shifts (transport/shifting.py), instead of heroes.
        self.matches = self.offsets is not None and compiled.scene.reemission is not None
        self.paths = Table(np.zeros(math.ceil(self.n_pixels * self.light_paths) + 1, path_dtype))
        self.light = self._pool(
            stored_vertex_dtype(compiled, self.lanes), self.subset.connect or self.subset.merge
        )
        self.eye = self._pool(stored_vertex_dtype(compiled, lanes.eye), self.subset.merge)
        self.splats = self._pool(splat_dtype(lanes.film, recorder is not None), self.subset.light_image)
        is_weighed = self.subset.merge and not self.subset.merge_once
        self.pilot = None
        if is_weighed and self.merging.correlation == "vcm+":
            self.pilot = Pilot(self, merge_radius(compiled, 0))

    # --- stores

    def _offsets(self, render):
        """Room for what places each pixel's wavelengths, where merges ask for it; else `None`."""
        if render.wavelengths != "rotate" or not self.subset.merge:
            return None
        return Table(np.zeros(self.n_pixels))

    @property
    def _rotated_offsets(self):
        """`offsets` where heroes have to be brought in line, else `None`."""
        return None if self.matches else self.offsets

    def _pool(self, dtype, is_needed):
        """An empty pool with room for some records per path, or `None`."""
        if not is_needed:
            return None
        chunks = len(self.paths) * RECORDS_PER_PATH // CHUNK + 2 * self.threads + 1
        return self._pool_of(np.empty(chunks * CHUNK, dtype))

    def _pool_of(self, records):
        ends = Table(np.zeros((self.threads, 3), np.int64))
        used = Table(np.zeros(len(records) // CHUNK, np.int32))
        needs = self.compiled.scene.needs
        state = Table(np.zeros(2, np.int64))
        return Pool(Table(records), state, ends, used, needs.smooth_triangles, needs.textures)

    def _enlarge(self):
        """Give the pools that ran short half as much again; `False` if none did."""
        short = [name for name in ("light", "eye", "splats") if _is_short(getattr(self, name))]
        for name in short:
            pool = getattr(self, name)
            old = pool.records.array
            more = max(len(old) // 2 // CHUNK, 2 * self.threads) * CHUNK
            records = np.empty(len(old) + more, pool.records.dtype)
            records[: len(old)] = old
            grown = self._pool_of(records)
            grown.state[NEXT_CHUNK] = pool.state[NEXT_CHUNK]
            grown.ends[:] = pool.ends.array
            grown.used[: len(pool.used)] = pool.used.array
            setattr(self, name, grown)
        return bool(short)

    # --- one iteration

    def iterate(self, iteration, stop=None):
        """Trace the subpaths of an iteration, merge, and add to the film; `False` if `stop` was set meanwhile."""
        self._count_pilot_photons()
        begun = time.monotonic()
        for pool in (self.light, self.eye, self.splats):
            _empty(pool)
        # Where light paths per pixel are not whole, their number varies by one: no earlier row may stay.
        self.paths.array[-2:] = np.zeros((), path_dtype)
        progress = np.zeros(4, np.int64)
        resume = np.full((self.threads, 2), -1, np.int64)
        while True:
            setup, radius = self._setup(iteration, progress, resume)
            calls = [(trace_pairs, (setup, i, Table(self.image))) for i in range(self.threads)]
            self.run(calls, stop, progress)
            if progress[STOP]:
                return False
            if not self._enlarge():
                break
        self.phases["subpaths"] += time.monotonic() - begun
        self._merge(setup, radius)
        self._add_light_image(setup)
        self.add_to_film(iteration)
        self.rays = self.rays[0] + int(progress[RAYS]), self.rays[1] + int(progress[SHADOW_RAYS])
        return True

    def _setup(self, iteration, progress, resume):
        """`(setup, radius)` of an iteration, with the stores as they are now."""
        compiled = self.compiled
        scene, sensing = self.scene_and_sensing(iteration, self.bands)
        work = Pass(self.seed, iteration, self.stratified_pairs, self.crop, self.width, Table(progress))
        radius = merge_radius(compiled, iteration)
        method = method_of(
            self.method_name,
            self.n_pixels,
            self.light_paths,
            van_der_corput(iteration),
            math.pi * radius**2 * self._acceptance(iteration),  # n_vm P_acc (2.7)
            compiled.graph.render.heuristic == "power",
            has_lens_hits(self.subset, compiled.camera),
            compiled.graph.render.samples,
            share_offsets(self.seed, iteration),
        )
        if self.pilot is not None:
            method = method._replace(density=self.pilot.density)
        stores = Stores(
            self.light, self.eye, self.splats, self.paths, Table(resume), self.technique_tables, self.offsets
        )
        camera, pixel_filter = compiled.camera, compiled.pixel_filter
        return Setup(scene, camera, pixel_filter, sensing, self.limits, work, method, stores), radius

    def _acceptance(self, iteration):
        """Mean P_acc (2.7) of an iteration's merges."""
        if self._rotated_offsets is None:
            return 1.0
        tolerance = tolerance_of(self.merging, iteration)
        return mean_acceptance(self.compiled.nodes, self.lanes, tolerance)

    def _count_pilot_photons(self):
        """Have the photon density that weights ask for, before the first iteration."""
        if self.pilot is None or self.pilot.is_done:
            return
        begun = time.monotonic()
        self.run(self.pilot.jobs(self))
        self.pilot.is_done = True
        self.phases["pilot"] = time.monotonic() - begun

    def _grid(self, n_photons, radius):
        """An empty grid for so many photons."""
        buckets = 1 << max((n_photons - 1).bit_length(), 4)
        photons = np.empty(n_photons, stored_photon_dtype(self.compiled, self.lanes))
        return Grid(Table(photons), Table(np.zeros(buckets + 1, np.int32)), 2.0 * radius)

    def _sharp_materials(self):
        """The scene's materials, where some are not merged at, or `None`."""
        return self.compiled.scene.materials if self.compiled.scene.needs.sharp else None

    def _most_photons(self, share):
        """Number of stored light vertices of the subpaths that are merged with."""
        n_vertices = self.paths.array["n_vertices"]
        if share is not None:
            passed = np.floor(np.arange(len(n_vertices) + 1) * share.share + share.offset)
            n_vertices = n_vertices[np.diff(passed) > 0]
        return int(n_vertices.sum())

    def _merging(self, setup, radius):
        tolerance = tolerance_of(self.merging, setup.work.iteration)
        ends = map(float, self.compiled.wavelength_range)
        return Merging(
            radius,
            1.0 / (math.pi * radius**2 * setup.method.n_photon_paths),
            self.merging.min_normal_cosine,
            True if self.merging.kernel == "epanechnikov" else None,
            None if self._rotated_offsets is None else Rotation(tolerance, self.offsets),
            Matching(tolerance, *ends) if self.matches else None,
        )

    def _merge(self, setup, radius):
        """Sort the photons, and gather them around the stored eye vertices."""
        if self.eye is None:
            return
        begun = time.monotonic()
        share, materials = setup.method.chosen.merge, self._sharp_materials()
        grid = self._grid(self._most_photons(share), radius)
        ranges = list(pairwise(np.linspace(0, len(grid.starts) - 1, self.threads + 1).astype(int).tolist()))
        records = self.light.records
        own = self._rotated_offsets, self.matches or None
        counts = self.run(
            [(count_photons, (grid, records, self.paths, share, materials, *each)) for each in ranges]
        )
        before = np.cumsum([0, *counts]).tolist()
        places = zip(ranges, before, strict=False)
        self.run(
            [
                (place_photons, (grid, records, self.paths, share, materials, *each, start, *own))
                for each, start in places
            ]
        )
        sorted_at = time.monotonic()
        merging = self._merging(setup, radius)
        progress = np.zeros(2, np.int64)
        self.run([(gather, (setup, grid, merging, Table(progress), Table(self.image)))] * self.threads)
        self.counts["light_vertices"] += sum(counts)
        self.counts["eye_vertices"] += int(self.eye.used.array.sum())
        self.counts["merges"] += int(progress[MERGES])
        self.phases["photon_grid"] += sorted_at - begun
        self.phases["merging"] += time.monotonic() - sorted_at

    def _add_light_image(self, setup):
        if self.splats is None:
            return
        begun = time.monotonic()
        edges = np.linspace(0, self.film.height, self.threads + 1).astype(int).tolist()
        self.run([(add_splats, (setup, *rows, Table(self.image))) for rows in pairwise(edges)])
        self.phases["light_image"] += time.monotonic() - begun

    # --- compilation

    def compile_kernels(self, observer):
        """Compile the kernels, or load them from the cache; returns seconds. Says so if it takes a while."""
        image = Table(self.image)
        setup, radius = self._setup(0, np.zeros(4, np.int64), np.full((self.threads, 2), -1, np.int64))
        calls = [(trace_pairs, (setup, 0, image)), *self._film_calls()]
        if self.splats is not None:
            calls.append((add_splats, (setup, 0, 0, image)))
        if self.eye is not None:
            grid, merging = self._grid(0, radius), self._merging(setup, radius)
            given = grid, self.light.records, self.paths, setup.method.chosen.merge, self._sharp_materials()
            calls.append((count_photons, (*given, 0, 0)))
            calls.append((place_photons, (*given, 0, 0, 0, self._rotated_offsets, self.matches or None)))
            calls.append((gather, (setup, grid, merging, Table(np.zeros(2, np.int64)), image)))
        if self.pilot is not None:
            calls.append(self.pilot.jobs(self)[0])
        return self.compile_calls(calls, observer)


def _is_short(pool):
    return pool is not None and bool(pool.state[SHORTAGE])


def _empty(pool):
    """Forget what a pool holds."""
    if pool is not None:
        for table in (pool.state, pool.ends, pool.used):
            table.array[...] = 0
