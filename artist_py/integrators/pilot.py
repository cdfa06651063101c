"""The pilot pass: light subpaths that are only counted, where their vertices lie (transport/photon_density.py)."""

from ..core.rng import stream_of
from ..jit import function, kernel
from ..transport.photon_density import deposit
from ..transport.sensing import wavelengths_of_path
from ..transport.vertices import rewind
from .light_subpath import trace_light_subpath
from .pair import LIGHT_SEED
from .path_tracing import WAVELENGTH

PILOT_SEED = 0x50494C4F54  # makes the random numbers of these subpaths others than those of iterations


@kernel
def count_pilot_photons(setup, density, thread, first, end):
    """Trace light subpaths [first, end) and count their vertices; the sum does not depend on who traces which."""
    work, stores = setup.work, setup.stores
    for index in range(first, end):
        stream = stream_of(work.seed ^ LIGHT_SEED ^ PILOT_SEED, 0, index, 0)
        wavelengths, _ = wavelengths_of_path(setup.sensing, stream, WAVELENGTH)
        rewind(stores.light, None, thread)
        trace_light_subpath(setup, thread, thread, 0, stream, wavelengths)
        _count(density, stores.light.records, stores.paths[thread])


@function
def _count(density, records, path):
    for i in range(path.n_vertices):
        position = records[path.first_vertex + i].position
        deposit(density, position[0], position[1], position[2])
