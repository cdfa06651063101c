"""What a render stores, in bytes, and how it is kept within a bound."""

from typing import NamedTuple

import numpy as np

from ..core.table import Table
from ..errors import OptionError
from ..integrators.methods import METHODS, subset_of
from ..transport.photon_grid import photon_dtype
from ..transport.splats import splat_dtype
from ..transport.vertices import vertex_dtype
from .techniques import BYTES_PER_VALUE, techniques_of_render
from .wavelengths import CHANNELS

BAND_NM = 10
RECORDS_PER_PATH = 4  # vertices that are stored of a subpath, about; pools that run short grow
BYTES_PER_FACE = 110  # of Embree's acceleration structure, about
FEWEST_LIGHT_PATHS = 0.05  # per pixel


class LaneCounts(NamedTuple):
    """How many numbers there are of what is stored (core/sets.py)."""

    light: int  # throughput of a light subpath
    eye: int  # and of an eye subpath
    film: int  # wavelengths or channels that the film sees


def carries_colour(compiled, by_wavelength):
    """Whether eye subpaths carry what the film's channels get, and with it their control (bsdf/fluorescence.py).

    It makes up for the chance in set 0 by the wavelengths of set 1, and tells no wavelengths apart in the image.
    """
    return compiled.has_sets and compiled.fluorescence.n_sets > 1 and not by_wavelength


def lanes_of(compiled, by_wavelength):
    """`LaneCounts` of a render; `by_wavelength`: its image is wanted per wavelength as well."""
    count = compiled.graph.render.hero_count
    if not compiled.has_sets:
        return LaneCounts(count, count, count)
    lanes = compiled.fluorescence.n_sets * count
    if carries_colour(compiled, by_wavelength):
        return LaneCounts(lanes + CHANNELS, (lanes + CHANNELS) * CHANNELS, CHANNELS)
    return LaneCounts(lanes, lanes * count, count)


def stored_vertex_dtype(compiled, lanes):
    """Layout of the vertices that a render stores, of subpaths whose throughput has so many numbers."""
    needs, shifts = compiled.scene.needs, compiled.scene.reemission is not None
    return vertex_dtype(lanes, needs.smooth_triangles is not None, needs.textures is not None, shifts)


def stored_photon_dtype(compiled, lanes):
    """Layout of the photons of a render: each has its own wavelengths, those of its iteration, or one that shifts."""
    shifts = compiled.scene.reemission is not None
    return photon_dtype(lanes, compiled.graph.render.wavelengths == "rotate" and not shifts, shifts)


def crop_of(graph):
    """Pixels to render, (x0, x1, y0, y1), half open."""
    width, height = graph.film.resolution
    return graph.film.crop or (0, width, 0, height)


def band_edges(compiled):
    """Edges of the spectral bands, nm."""
    first, last = compiled.wavelength_range
    return np.arange(first, last + BAND_NM - 1, BAND_NM, dtype=float)


def pixels_of(graph):
    """Number of pixels to render."""
    x0, x1, y0, y1 = crop_of(graph)
    return (x1 - x0) * (y1 - y0)


def memory_estimate(compiled, settings):
    """Bytes that a render needs beyond the interpreter: `{what: bytes}`."""
    pixels = pixels_of(compiled.graph)
    bands = len(band_edges(compiled)) - 1 if settings.spectral else 0
    geometry = compiled.scene.geometry
    arrays = [array for array in geometry if isinstance(array, Table)]
    emitters = compiled.scene.emitters
    faces = len(geometry.triangles) + len(geometry.parallelograms)
    light_paths = compiled.graph.render.merging.light_paths
    lanes = lanes_of(compiled, settings.spectral)
    return {
        "film": pixels * (12 + 24 + 12 + (24 if "variance" in settings.aovs else 0) + 12 * bands),
        "techniques": pixels * _bytes_of_techniques(compiled, settings),
        "auxiliary outputs": pixels * 60 if settings.first_hit_aovs else 0,
        "geometry": sum(array.nbytes for array in arrays) + (emitters.records.nbytes if emitters else 0),
        "acceleration structure": BYTES_PER_FACE * faces,
        "spectra": compiled.spectra.nbytes
        + (_bytes_of_fluorescence(compiled) if compiled.fluorescence else 0),
        "textures": sum(image.nbytes for image in compiled.texture_images),
        "eye vertices": pixels * _bytes_per_eye_path(compiled, lanes),
        "light vertices": round(pixels * light_paths * _bytes_per_light_path(compiled, lanes)),
    }


def _bytes_of_fluorescence(compiled):
    """Matrices in float64, and where wavelengths shift one copy in float32 for eye or two for light subpaths."""
    scene, matrices = compiled.scene, compiled.fluorescence.matrices.nbytes
    copies = (scene.excitation is not None) + 2 * (scene.reemission is not None)
    return round(matrices * (1.0 + 0.5 * copies))


def _bytes_of_techniques(compiled, settings):
    if not settings.techniques:
        return 0
    return 3 * BYTES_PER_VALUE * len(techniques_of_render(compiled, settings.technique_length))


def _subset(render):
    """The `Subset` of a bidirectional method, None for others."""
    return subset_of(render.integrator, render.samples) if render.integrator in METHODS else None


def _bytes_per_eye_path(compiled, lanes):
    method, record = _subset(compiled.graph.render), stored_vertex_dtype(compiled, lanes.eye)
    return RECORDS_PER_PATH * record.itemsize if method and method.merge else 0


def _bytes_per_light_path(compiled, lanes):
    """Stored vertices, their copies in the photon grid, and splats."""
    method = _subset(compiled.graph.render)
    if method is None:
        return 0
    size, photon = 40, stored_photon_dtype(compiled, lanes.light)
    if method.merge:
        size += RECORDS_PER_PATH * (stored_vertex_dtype(compiled, lanes.light).itemsize + photon.itemsize + 8)
    if method.light_image:
        size += RECORDS_PER_PATH * splat_dtype(lanes.film).itemsize
    return size


def light_paths_within(compiled, settings, warn):
    """Light subpaths per pixel that `max_memory_bytes` leaves room for: as the scene asks for, or fewer.

    Estimates divide by the number of light subpaths, so that fewer of them mean more noise and no bias. Raises an
    `OptionError` where nothing but a smaller image would help.
    """
    wanted = compiled.graph.render.merging.light_paths
    if settings.max_memory_bytes is None:
        return wanted
    parts = memory_estimate(compiled, settings)
    needed = sum(parts.values())
    over = needed - settings.max_memory_bytes
    if over <= 0:
        return wanted
    share = 1.0 - over / parts["light vertices"] if parts["light vertices"] else 0.0
    if wanted * share >= FEWEST_LIGHT_PATHS:
        warn(f"--max-memory: {wanted * share:.3g} light paths per pixel instead of {wanted:.3g}")
        return wanted * share
    raise OptionError(
        f"--max-memory: this render needs about {needed / 2**20:.0f} MiB, and "
        f"{settings.max_memory_bytes / 2**20:.0f} MiB are allowed; render it in parts with --crop"
    )
