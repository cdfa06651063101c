"""The stochastic image sampler: one path per pixel and iteration, tiles taken by threads, sums in a fixed order."""

import time
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cached_property
from itertools import pairwise

import numpy as np

from ..core.table import Table
from ..core.vector import Spectrum
from ..film.accumulation import REJECTED_KEPT, add_rows
from ..integrators.path_tracing import RAYS, SHADOW_RAYS, STOP, Pass, trace_paths
from ..jit import cache_statistics
from ..transport.roulette import Limits
from ..transport.sensing import Bands, Sensing
from .compiling import compile_apart, types_of
from .memory import carries_colour
from .wavelengths import (
    CHANNELS,
    ControlledSpectra,
    fluorescence_at,
    resolve_spectra,
    sets_of_wavelengths,
    shared_wavelengths,
)

STRATIFIED_PAIRS = 9  # the film, the lens, the wavelengths and two vertices; see benchmarks/README.md
STOP_POLL_SECONDS = 0.05
ANNOUNCE_SECONDS = 1.0
COMPILE_SECONDS_HINT = 15


class StochasticSampler:
    """Drives the path tracer over a film; a context manager, because it owns threads."""

    def __init__(self, compiled, film, threads, recorder=None):
        self.compiled, self.film, self.threads, self.recorder = compiled, film, threads, recorder
        graph = compiled.graph
        render, (width, height) = graph.render, graph.film.resolution
        self.crop = tuple(graph.film.crop or (0, width, 0, height))
        self.width, self.seed = width, render.seed
        self.limits = Limits(render.max_path_length, render.roulette_length)
        self.stratified_pairs = STRATIFIED_PAIRS if render.sampler == "sobol" else 0
        self.image = np.zeros((film.height, film.width, 3), np.float32)
        self.bands = self._bands()
        # Whether eye subpaths carry the film's channels: not where the image is wanted by wavelength.
        self.in_colour = carries_colour(compiled, self.bands is not None)
        self.rays = (0, 0)  # closest hits, occlusion
        self.phases, self.counts = {"paths": 0.0, "film": 0.0}, {}
        self.cache_hits = self.cache_misses = 0
        self.compiles_apart = False  # see compiling.py
        self.pool = ThreadPoolExecutor(threads)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.pool.shutdown()

    def _bands(self):
        if not self.film.n_bands:
            return None
        first, last = self.compiled.wavelength_range
        shape = (self.film.height, self.film.width, self.film.n_bands)
        return Bands(Table(np.zeros(shape, np.float32)), float(first), (last - first) / self.film.n_bands)

    # --- one iteration

    def iterate(self, iteration, stop=None):
        """Trace one path per pixel and add them to the film; `False` if `stop` was set before all were traced."""
        begun = time.monotonic()
        progress = np.zeros(4, np.int64)
        arguments = self._arguments(iteration, progress)
        self.run([(trace_paths, arguments)] * self.threads, stop, progress)
        self.phases["paths"] += time.monotonic() - begun
        if progress[STOP]:
            return False
        self.add_to_film(iteration)
        self.rays = self.rays[0] + int(progress[RAYS]), self.rays[1] + int(progress[SHADOW_RAYS])
        return True

    def _arguments(self, iteration, progress):
        compiled = self.compiled
        scene, sensing = self.scene_and_sensing(iteration, self.bands)
        work = Pass(self.seed, iteration, self.stratified_pairs, self.crop, self.width, Table(progress))
        camera, pixel_filter, image = compiled.camera, compiled.pixel_filter, Table(self.image)
        return scene, camera, pixel_filter, sensing, self.limits, work, image, self.technique_tables

    @property
    def technique_tables(self):
        """Where kernels keep what each technique brings, or `None`."""
        return self.recorder and self.recorder.tables

    def scene_and_sensing(self, iteration, bands):
        """The scene's tables and the sensor at the wavelengths of `iteration`."""
        compiled = self.compiled
        if compiled.has_sets:
            return self.fluorescent_scene_and_sensing(iteration, bands, self.in_colour)
        render = compiled.graph.render
        zero, one = Spectrum(np.zeros(render.hero_count)), Spectrum(np.ones(render.hero_count))
        ratio = one if compiled.scene.needs.dispersion else None
        if render.wavelengths != "shared":
            return compiled.scene, Sensing(zero, ratio, Table(compiled.nodes), None, bands)
        shared = shared_wavelengths(compiled.nodes, render.hero_count, render.seed, iteration)
        spectra = resolve_spectra(
            compiled.spectra, compiled.ior_rows, compiled.wavelength_range[0], shared[0]
        )
        return compiled.scene._replace(spectra=spectra), Sensing(
            zero, ratio, Table(compiled.nodes), Table(shared), bands
        )

    def fluorescent_scene_and_sensing(self, iteration, bands, in_colour):
        """The same with several sets of wavelengths (theory 3.2); `in_colour` as in `fluorescence_at`."""
        compiled, render = self.compiled, self.compiled.graph.render
        count, first = render.hero_count, compiled.wavelength_range[0]
        shared = sets_of_wavelengths(compiled.fluorescence.set_nodes, count, render.seed, iteration)
        has_dispersion = compiled.scene.needs.dispersion
        fluorescence = fluorescence_at(
            compiled.fluorescence, count, first, *shared, in_colour, has_dispersion
        )
        if in_colour:
            spectra = self._controlled_spectra.at(*shared, count)
            # Lanes that are no wavelengths, and weights that are in the matrix already.
            wavelengths = np.concatenate([shared[0], np.zeros(CHANNELS)])
            shared, count = np.array([wavelengths, np.ones_like(wavelengths)]), CHANNELS
        else:
            spectra = resolve_spectra(compiled.spectra, compiled.ior_rows, first, shared[0])
        sensing = Sensing(
            fluorescence.zero,
            fluorescence.ratio,
            Table(compiled.nodes),
            Table(shared),
            bands,
            Spectrum(np.zeros(count)),
            fluorescence.matrix,
        )
        scene = compiled.scene._replace(excitation=None, reemission=None)
        return scene._replace(spectra=spectra, fluorescence=fluorescence), sensing

    @cached_property
    def _controlled_spectra(self):
        return ControlledSpectra(self.compiled)

    def add_to_film(self, iteration):
        """Add the image of the iteration to the film, in row order whatever the threads."""
        begun = time.monotonic()
        film, height = self.film, self.film.height
        edges = np.linspace(0, height, self.threads + 1).astype(int)
        places = [self._places() for _ in range(self.threads)]
        jobs = [
            (add_rows, self._rows(iteration, edges[i], edges[i + 1], places[i])) for i in range(self.threads)
        ]
        for count, where in zip(self.run(jobs), places, strict=True):
            if count:
                film.reject(count, where, (self.crop[0], self.crop[2]), iteration)
        if self.recorder is not None:
            jobs = [self.recorder.add_job(self.image, *rows) for rows in pairwise(edges)]
            self.recorder.film.rejected_count += sum(self.run(jobs))
        film.iterations += 1
        self.phases["film"] += time.monotonic() - begun

    @staticmethod
    def _places():
        """Room for the places (row, column) of rejected contributions."""
        return np.zeros((REJECTED_KEPT, 2), np.int64)

    def _rows(self, iteration, first, end, places):
        film = self.film
        bands = None if self.bands is None else self.bands.image.array
        is_odd = bool(iteration & 1)
        return (
            self.image, film.sums, film.odd_sums, film.squares, bands, film.band_sums, is_odd, first, end, places,
        )  # fmt: skip

    def run(self, jobs, stop=None, progress=None):
        """Run `(kernel, arguments)` on the threads; a `stop` that is set meanwhile is passed on through `progress`."""
        futures = [self.pool.submit(kernel, *arguments) for kernel, arguments in jobs]
        pending = set(futures)
        while pending:
            _, pending = wait(pending, STOP_POLL_SECONDS if stop is not None else None)
            if pending and stop is not None and stop.is_set():
                progress[STOP] = 1
        return [future.result() for future in futures]

    # --- compilation

    def compile_kernels(self, observer):
        """Compile the kernels, or load them from the cache; returns seconds. Says so if it takes a while."""
        calls = [
            (trace_paths, self._arguments(0, np.zeros(4, np.int64))),
            *self._film_calls(),
        ]
        return self.compile_calls(calls, observer)

    def _film_calls(self):
        """`(kernel, arguments)` of the film's kernels, to be compiled."""
        calls = [(add_rows, self._rows(0, 0, 0, self._places()))]
        if self.recorder is not None:
            calls.append(self.recorder.add_job(self.image, 0, 0))
        return calls

    def compile_calls(self, calls, observer):
        """Compile each `(kernel, arguments)` for the types of its arguments."""
        begun = time.monotonic()
        before = cache_statistics([kernel for kernel, _ in calls])
        future = self.pool.submit(self._compile, calls)
        wait([future], ANNOUNCE_SECONDS)
        is_slow = not future.done()
        if is_slow:
            observer.compiling("for this scene's features", COMPILE_SECONDS_HINT)
        future.result()
        seconds = time.monotonic() - begun
        if is_slow:
            observer.compiled(seconds)
        after = cache_statistics([kernel for kernel, _ in calls])
        self.cache_hits += after[0] - before[0]
        self.cache_misses += after[1] - before[1]
        return seconds

    def _compile(self, calls):
        if self.compiles_apart:
            compile_apart(calls)
        for kernel, arguments in calls:
            compile_for(kernel, arguments)


def compile_for(kernel, arguments):
    """Have `kernel` ready for arguments of these types, without calling it."""
    kernel.compile(types_of(kernel, arguments))
