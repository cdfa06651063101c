"""Adding the light image: splats of all light subpaths, in the order of the subpaths, whatever the threads."""

from ..core.rng import stream_of
from ..core.vector import with_lane
from ..jit import function, kernel
from ..transport.recording import LT, Place, record
from ..transport.sensing import rgb_of, wavelengths_of_path
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
                    place = Place(row, splat.pixel % width, wavelengths, weights)
                    _add(setup.stores.techniques, scene, image, place, splat)


@function
def _add(tables, scene, image, place, splat):
    value = place.wavelengths
    for i in range(len(splat.value)):
        value = with_lane(value, i, splat.value[i])
    red, green, blue = rgb_of(scene.spectra, value * place.weights, place.wavelengths)
    image[place.row, place.column, 0] += red
    image[place.row, place.column, 1] += green
    image[place.row, place.column, 2] += blue
    _record(tables, scene, place, splat, value)


@function
def _record(tables, scene, place, splat, value):
    if tables is None:
        return
    record(tables, scene.spectra, place, LT, splat.length, 0, value, splat.weight)
