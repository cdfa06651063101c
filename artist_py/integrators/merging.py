"""The merging pass: photons gathered around the eye vertices that the first pass has stored. No ray is traced."""

from ..core.atomic import fetch_and_add
from ..core.rng import stream_of
from ..core.sets import given, received
from ..jit import kernel
from ..transport.merge import merge_at
from ..transport.recording import Place
from ..transport.rotation import wavelengths_of_pixel, window_of
from ..transport.roulette import local_survival
from ..transport.sensing import add_sample, wavelengths_of_path
from ..transport.vertices import CHUNK, load_vertex

NEXT_CHUNK, MERGES = range(2)  # in progress


@kernel
def gather(setup, grid, merging, progress, image):
    """Take chunks of stored eye vertices until none is left; add what they gather to `image` (h, w, 3)."""
    scene, sensing, work, eye = setup.scene, setup.sensing, setup.work, setup.stores.eye
    stream = stream_of(work.seed, work.iteration, 0, 0)
    shared, rotation = wavelengths_of_path(sensing, stream, 0), merging.rotation
    width = work.crop[1] - work.crop[0]
    merges = 0
    while True:
        chunk = fetch_and_add(progress, NEXT_CHUNK, 1)
        if chunk >= eye.state[0]:
            break
        for index in range(chunk * CHUNK, chunk * CHUNK + eye.used[chunk]):
            record = eye.records[index]
            wavelengths, weights = wavelengths_of_pixel(setup.stores.offsets, sensing, shared, record.pixel)
            stored = load_vertex(scene, record, given(sensing.start, sensing.zero), wavelengths)
            survival = local_survival(scene, stored.vertex, wavelengths)
            place = Place(record.pixel // width, record.pixel % width, wavelengths, weights)
            merged = merge_at(
                scene,
                setup.method,
                grid,
                merging,
                stored,
                survival,
                setup.limits,
                setup.stores.techniques,
                place,
                window_of(rotation, sensing.nodes, wavelengths, record.pixel),
            )
            merges += merged.count
            value = received(scene.fluorescence, stored.throughput, merged.value) * weights
            add_sample(sensing, scene.spectra, image, place.row, place.column, value, wavelengths)
    fetch_and_add(progress, MERGES, merges)
