"""The reference image sampler: iterations of the brute-force integrator, in one thread of plain Python."""

import math
import time

import numpy as np

from ..core.table import Table
from ..film.accumulation import add_rows
from ..integrators.methods import share_of
from ..integrators.reference import render_reference
from ..integrators.reference_paths import DoubleSpectrum
from ..integrators.reference_techniques import Reference, counts_of, samples_in
from ..transport.merge import Merging
from ..transport.sensing import Sensing, add_sample
from ..transport.shares import Chosen
from .backwards import merge_radius, share_offsets
from .stochastic import StochasticSampler
from .wavelengths import shared_wavelengths

SLOW = (
    "the reference integrator is plain Python and traces some hundred paths per second; "
    "it is there to check the others on images of a few pixels"
)


class ReferenceSampler(StochasticSampler):
    """Drives the reference integrator over a film."""

    def __init__(self, compiled, film, threads):
        super().__init__(compiled, film, threads)
        render = compiled.graph.render
        self.settings, self.merging, self.samples = render.reference, render.merging, render.samples
        self.is_power = render.heuristic == "power"
        self.lanes = render.hero_count

    def iterate(self, iteration, stop=None):
        """Trace, connect and merge all subpaths of an iteration; `False` if `stop` was set meanwhile."""
        begun = time.monotonic()
        shared = shared_wavelengths(self.compiled.nodes, self.lanes, self.seed, iteration)
        wavelengths, weights = DoubleSpectrum(shared[0]), DoubleSpectrum(shared[1])
        reference = self.reference(iteration, wavelengths)
        image, spectra = np.zeros(self.image.shape), self.compiled.scene.spectra
        is_stopped = stop.is_set if stop is not None else bool
        if self.bands is not None:
            self.bands.image.array[...] = 0.0
        # Random numbers are hashes, whose products overflow on purpose.
        with np.errstate(over="ignore"):
            for (row, column), radiance in render_reference(reference, self.settings.eye_samples, is_stopped):
                add_sample(reference.sensing, spectra, image, row, column, radiance * weights, wavelengths)
        self.phases["paths"] += time.monotonic() - begun
        if is_stopped():
            return False
        self.image[...] = image
        self.add_to_film(iteration)
        return True

    def reference(self, iteration, wavelengths):
        """What the integrator needs for an iteration at `wavelengths`."""
        compiled, settings = self.compiled, self.settings
        zero = wavelengths * 0.0
        ratio = zero + 1.0 if compiled.scene.needs.dispersion else None
        n_pixels = self.film.width * self.film.height
        n_light = settings.light_samples
        if n_light is None:
            n_light = math.ceil(n_pixels * self.merging.light_paths)
        radius = merge_radius(compiled, iteration)
        counts = counts_of(
            settings.mode, n_pixels * settings.eye_samples, n_light, radius, self.is_power, self.samples,
            compiled.camera.lens is not None and compiled.camera.clip is None,
        )  # fmt: skip
        merging = Merging(
            radius,
            1.0 / counts.vm_area if counts.vm_area > 0.0 else 0.0,
            self.merging.min_normal_cosine,
            True if self.merging.kernel == "epanechnikov" else None,
        )
        image, merged = (
            1.0 if each is None else each for each in samples_in(settings.mode, self.samples)[2:]
        )
        offsets = share_offsets(self.seed, iteration)
        return Reference(
            scene=compiled.scene,
            camera=compiled.camera,
            pixel_filter=compiled.pixel_filter,
            sensing=Sensing(zero, ratio, Table(compiled.nodes), None, self.bands),
            wavelengths=wavelengths,
            limits=self.limits,
            min_length=settings.min_path_length,
            counts=counts,
            merging=merging,
            crop=self.crop,
            n_light=n_light,
            chosen=Chosen(None, share_of(image, offsets[1]), share_of(merged, offsets[2])),
            n_image_paths=n_light * image,
            seed=self.seed,
            iteration=iteration,
        )

    def compile_kernels(self, observer):
        """Nothing of the integrator is compiled; says that it is slow."""
        observer.warning(SLOW)
        return self.compile_calls([(add_rows, self._rows(0, 0, 0, self._places()))], observer)
