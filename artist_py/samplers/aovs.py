"""Auxiliary outputs of the first hit, averaged over a few samples per pixel."""

import numpy as np

from ..core.table import Table
from ..integrators.first_hit import FirstHits, trace_first_hits
from ..integrators.path_tracing import Pass

SAMPLES = 16
# A seed of their own, so that they do not follow the noise of the image.
SEED_OFFSET = 0x5EED


def render_aovs(compiled, sampler, settings, observer):
    """`{name: float32 (h, w, c)}` of the auxiliary outputs that `settings` asks for, in the world's units."""
    height, width = sampler.film.height, sampler.film.width
    hits = FirstHits(*(np.zeros((height, width, n), np.float32) for n in (3, 3, 3, 1, 3, 1, 1)))
    hits.material[:] = -1.0
    tables = FirstHits(*(Table(array) for array in hits))
    for sample in range(SAMPLES):
        progress = np.zeros(4, np.int64)
        scene, sensing = _scene_and_sensing(compiled, sampler, sample)
        work = Pass(
            sampler.seed + SEED_OFFSET,
            sample,
            sampler.stratified_pairs,
            sampler.crop,
            sampler.width,
            Table(progress),
        )
        arguments = scene, compiled.camera, compiled.pixel_filter, sensing, work, tables
        if sample == 0:
            sampler.compile_calls([(trace_first_hits, arguments)], observer)
        sampler.run([(trace_first_hits, arguments)] * sampler.threads)
    return {
        name: values for name, values in _finished(compiled, hits).items() if name in settings.first_hit_aovs
    }


def _scene_and_sensing(compiled, sampler, sample):
    """As the sampler has them; where wavelengths shift, with sets of them, which albedos take fewer samples by."""
    if compiled.fluorescence is not None:
        return sampler.fluorescent_scene_and_sensing(sample, None, False)
    return sampler.scene_and_sensing(sample, None)


def _finished(compiled, hits):
    """Means over the samples that hit something; elsewhere zero, and infinite depth."""
    count = np.maximum(hits.coverage, 1.0)
    is_hit = hits.coverage > 0.0
    space = compiled.space
    position = np.where(is_hit, hits.position / count / space.scale + space.centre, 0.0)
    return {
        "normal": _unit(hits.normal),
        "shading_normal": _unit(hits.shading_normal),
        "albedo": hits.albedo / SAMPLES / _white(compiled),
        "depth": np.where(is_hit, hits.depth / count / space.scale, np.inf).astype(np.float32),
        "position": position.astype(np.float32),
        "material": hits.material,
    }


def _white(compiled):
    """RGB of a radiance of 1: what reflects everything shall have albedo (1, 1, 1)."""
    return compiled.spectra[:3].sum(axis=1)


def _unit(vectors):
    size = np.linalg.norm(vectors, axis=2, keepdims=True)
    return vectors / np.where(size > 0.0, size, 1.0)
