"""Adding the light image: splats of all light subpaths, in the order of the subpaths, whatever the threads."""

from ..core.rng import stream_of
from ..core.vector import with_lane
from ..jit import function, kernel
from ..transport.recording import Place, record
from ..transport.sensing import add_sample, wavelengths_of_path
from .path_tracing import WAVELENGTH


@kernel
def add_splats(setup, first, end, image):
    """Add the splats that lie on rows [first, end) of the window to `image` (h, w, 3)."""
    scene, sensing, work = setup.scene, setup.sensing, setup.work
    paths, splats = setup.stores.paths, setup.stores.splats.records
    width = work.crop[1] - work.crop[0]
    for index in range(paths.shape[0]):
        path = paths[index]
        if path.n_splats > 0:
            pixel = (path.pixel // width + work.crop[2]) * work.width + path.pixel % width + work.crop[0]
            stream = stream_of(work.seed, work.iteration, pixel, work.stratified_pairs)
            wavelengths, weights = wavelengths_of_path(sensing, stream, WAVELENGTH)
            for i in range(path.n_splats):
                splat = splats[path.first_splat + i]
                row = splat.pixel // width
                if first <= row < end:
                    value, column = _value(splat, weights), splat.pixel % width
                    add_sample(sensing, scene.spectra, image, row, column, value * weights, wavelengths)
                    place = Place(row, column, wavelengths, weights)
                    _record(setup.stores.techniques, scene, place, splat, value)


@function
def _value(splat, zero):
    value = zero
    for i in range(len(splat.value)):
        value = with_lane(value, i, splat.value[i])
    return value


@function
def _record(tables, scene, place, splat, value):
    if tables is None:
        return
    record(tables, scene.spectra, place, splat.technique, splat.length, 0, value, splat.weight)
