"""The reference image sampler: iterations of the brute-force integrator, in one thread of plain Python."""

import math
import time

import numpy as np

from ..core.table import Table
from ..errors import OptionError
from ..film.accumulation import add_rows
from ..integrators.reference import render_reference
from ..integrators.reference_paths import DoubleSpectrum
from ..integrators.reference_techniques import Reference, counts_of
from ..transport.merge import Merging
from ..transport.sensing import Sensing, add_sample
from .backwards import merge_radius
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
        if compiled.scene.needs.surfaceless_emitters:
            raise OptionError("render.integrator: reference knows no emitters without a surface, found some")
        render = compiled.graph.render
        self.settings, self.merging = render.reference, render.merging
        self.is_power = render.heuristic == "power"
        # Weights with dispersion are those of one wavelength (reference_densities.py).
        self.lanes = 1 if compiled.scene.needs.dispersion else render.hero_count

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
        n_light = n_pixels if settings.light_samples is None else settings.light_samples
        radius = merge_radius(compiled, iteration)
        merging = Merging(
            radius,
            1.0 / (math.pi * radius**2 * max(n_light, 1)),
            self.merging.min_normal_cosine,
            True if self.merging.kernel == "epanechnikov" else None,
        )
        return Reference(
            scene=compiled.scene,
            camera=compiled.camera,
            pixel_filter=compiled.pixel_filter,
            sensing=Sensing(zero, ratio, Table(compiled.nodes), None, self.bands),
            wavelengths=wavelengths,
            limits=self.limits,
            min_length=settings.min_path_length,
            counts=counts_of(settings.mode, n_pixels * settings.eye_samples, n_light, radius, self.is_power),
            merging=merging,
            crop=self.crop,
            n_light=n_light,
            seed=self.seed,
            iteration=iteration,
        )

    def compile_kernels(self, observer):
        """Nothing of the integrator is compiled; says that it is slow."""
        observer.warning(SLOW)
        return self.compile_calls([(add_rows, self._rows(0, 0, 0, self._places()))], observer)
