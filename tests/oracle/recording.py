"""The kernels' own walks as plain Python, and every weight that they give along the way together with its full path.

Nothing is evaluated twice: the functions that kernels call are replaced by ones that call them and take notes. Stored
vertices and photons are float64 here, so that what is read again is what was stored.
"""

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from artist_py.cameras.perspective import camera_ray, sample_film
from artist_py.cameras.sensor import pdf_camera_direction, projected_lens_area
from artist_py.core.rng import random_pair, stream_of
from artist_py.core.table import Table
from artist_py.integrators import eye_subpath, lens_hits, light_subpath
from artist_py.integrators.methods import method_of
from artist_py.integrators.pair import LIGHT_SEED, Setup, Stores, path_dtype
from artist_py.integrators.path_tracing import FILM, Pass, lens_numbers
from artist_py.integrators.reference_paths import (
    DoubleSpectrum,
    EmitterHit,
    FullPath,
    Subpath,
    background_hit,
    connecting_edge,
    edge_to,
    end_node,
    joined,
    lane_left,
    light_node,
    merged,
    node_at,
    path_of_hit,
    up_to,
)
from artist_py.transport import connect, merge, photon_grid
from artist_py.transport.local_counts import counts_at
from artist_py.transport.merge import Merging
from artist_py.transport.mis import eye_start
from artist_py.transport.recording import Place
from artist_py.transport.roulette import Limits, local_survival
from artist_py.transport.sensing import Sensing
from artist_py.transport.splats import splat_dtype
from artist_py.transport.subpath import seen_from, start_path
from artist_py.transport.vertices import Pool, load_vertex, vertex_dtype

RECORDS = 64
SEED = 5


class Found(NamedTuple):
    """A weight that a kernel gave to a path."""

    technique: tuple
    weight: float
    path: FullPath


def doubled(dtype):
    """The record type with float64 for float32."""
    fields = []
    for name in dtype.names:
        base, shape = (dtype[name].subdtype or (dtype[name], ()))[:2]
        fields.append((name, "f8" if base == np.float32 else base, shape))
    return np.dtype(fields)


def pool_of(dtype):
    """A pool of one chunk."""
    ends, used = np.array([[0, RECORDS]]), np.zeros(1, np.int32)
    return Pool(
        Table(np.zeros(RECORDS, doubled(dtype))), Table(np.zeros(2, np.int64)), Table(ends), Table(used)
    )


def counts_in(method, counts, hits_everything=None):
    """The method with other counts; what has none is absent."""
    techniques = method.techniques._replace(
        nee=counts.nee > 0 or None,
        connect=counts.vc > 0 or None,
        light_image=counts.lt > 0 or None,
        merge=counts.vm_area > 0 or None,
        light_paths=True,
    )
    if hits_everything is None:
        hits_everything = counts.hit > 0
    return method._replace(techniques=techniques, counts=counts, hits_everything=hits_everything)


def setup_of(compiled, counts, wavelengths, hits_everything=None):
    """The `Setup` of the kernels, for one light and one eye subpath at a time."""
    graph = compiled.graph
    width, height = graph.film.resolution
    ratio = wavelengths * 0.0 + 1.0 if compiled.scene.needs.dispersion else None
    sensing = Sensing(wavelengths * 0.0, ratio, Table(compiled.nodes), None, None)
    work = Pass(SEED, 0, 0, (0, width, 0, height), width, None)
    lanes = len(wavelengths.values)
    light, eye = pool_of(vertex_dtype(lanes)), pool_of(vertex_dtype(lanes))
    stores = Stores(light, eye, pool_of(splat_dtype(lanes)), Table(np.zeros(1, path_dtype)), None, None)
    method = counts_in(method_of("vcm", width * height, 1.0, 0.0, 1.0), counts, hits_everything)
    limits = Limits(graph.render.max_path_length, 0)
    return Setup(
        compiled.scene, compiled.camera, compiled.pixel_filter, sensing, limits, work, method, stores
    )


class Recorder:
    """Traces pairs of subpaths and notes every weight; `patch` is pytest's monkeypatch."""

    def __init__(self, patch, compiled, counts, lanes=1, hits_everything=None):
        first, last = compiled.wavelength_range
        self.wavelengths = DoubleSpectrum(first + (last - first) * (np.arange(lanes) + 0.5) / lanes)
        self.setup, self.patch = setup_of(compiled, counts, self.wavelengths, hits_everything), patch
        self.found, self.light, self.eye, self.walk = [], None, None, None
        self._listen_to_walks()
        self._listen_to_connections()
        self._listen_to_hits()
        self._listen(merge, "weight_of_merge", lambda weight, *_: self.merge_weights.append(weight))

    def _listen(self, module, name, note):
        """Have `note(result, *arguments)` called after `module.name`."""
        function = getattr(module, name)

        def listening(*arguments):
            result = function(*arguments)
            note(result, *arguments)
            return result

        self.patch.setattr(module, name, listening)

    def _note(self, technique, weight, path):
        self.found.append(Found(technique, weight, path))

    # --- walks

    def _listen_to_walks(self):
        self._listen(light_subpath, "choose_emitter", lambda index, *_: setattr(self, "emitter", index))
        self._listen(light_subpath, "sample_emission", lambda start, *_: self._begin_light(start))
        for module in (light_subpath, eye_subpath):
            self._listen(module, "vertex_at", self._arrive)
            self._listen(module, "scatter", self._leave)

    def _begin_light(self, start):
        node = light_node(self.setup.scene, self.emitter, start)
        self.walk = self.light = Subpath([node], [], [], [])

    def _arrive(self, vertex, scene, surface, path, wavelengths):
        self.walk.edges.append(edge_to(surface, path, self.walk.nodes[-1]))
        self.walk.nodes.append(node_at(scene, vertex, path.media, wavelengths))

    def _leave(self, step, *_):
        lane = lane_left(step.path)
        self.walk.nodes[-1] = self.walk.nodes[-1]._replace(is_delta=step.is_delta, lane=lane)

    # --- connections

    def _listen_to_connections(self):
        self._before(light_subpath, "connect_to_camera", lambda *a: setattr(self, "sensor", a[5]))
        self._listen(connect, "weight_of_light_image", self._note_light_image)
        self._listen(lens_hits, "hit_lens", self._meet_lens)
        self._listen(lens_hits, "weight_of_lens_hit", self._note_lens_hit)
        self._listen(connect, "choose_emitter", lambda index, *_: setattr(self, "emitter", index))
        self._before(connect, "emission_over_next_event", lambda *a: setattr(self, "point", a[2]))
        self._listen(connect, "weight_of_next_event", self._note_next_event)
        self._before(eye_subpath, "connect_vertices", lambda *a: setattr(self, "length", a[5].length))
        self._listen(connect, "weight_of_connection", self._note_connection)

    def _before(self, module, name, note):
        """Have `note(*arguments)` called before `module.name`."""
        function = getattr(module, name)

        def listening(*arguments):
            note(*arguments)
            return function(*arguments)

        self.patch.setattr(module, name, listening)

    def _note_light_image(self, weight, *_):
        lens = end_node(self.sensor.position, self.setup.camera.forward, 0.0, -1)
        edge = connecting_edge(self.light.nodes[-1], lens)
        path = joined(self.light.nodes, self.light.edges, edge, [lens], [])
        self._note(("lt", len(path.edges)), weight, path)

    def _meet_lens(self, hit, camera, origin, direction):
        point = end_node(origin + direction * hit.t, camera.forward, 0.0, -1)
        path = SimpleNamespace(direction=direction)
        self.lens = point, edge_to(point.surface, path, self.light.nodes[-1])

    def _note_lens_hit(self, weight, *_):
        lens, edge = self.lens
        path = joined(self.light.nodes, self.light.edges, edge, [lens], [])
        self._note(("lens", len(path.edges) + 1), weight, path)

    def _note_next_event(self, weight, *_):
        light = light_node(self.setup.scene, self.emitter, self.point)
        edge = connecting_edge(light, self.eye.nodes[-1])
        self._note(("nee", 1), weight, joined([light], [], edge, self.eye.nodes, self.eye.edges))

    def _note_connection(self, weight, *_):
        nodes, edges = up_to(self.light, self.length)
        edge = connecting_edge(nodes[-1], self.eye.nodes[-1])
        self._note(
            ("vc", self.length + 1), weight, joined(nodes, edges, edge, self.eye.nodes, self.eye.edges)
        )

    # --- hits

    def _listen_to_hits(self):
        self._before(eye_subpath, "emission_hit", self._note_surface)
        self._before(eye_subpath, "_background_weight", self._note_background)
        self._listen(eye_subpath, "emission_hit", self._note_only_way)
        self._listen(eye_subpath, "weight_of_hit", lambda weight, *_: self._note_hit(weight))

    def _note_surface(self, scene, method, surface, path, *_):
        edge = edge_to(surface, path, self.eye.nodes[-1])
        self.hit = EmitterHit(len(self.eye.nodes), surface, edge, None)

    def _note_background(self, scene, method, emitter, path, *_):
        records = scene.emitters.records
        number = next(i for i in range(records.shape[0]) if records[i] == emitter)
        self.hit = background_hit(scene, self.eye, path, number)

    def _note_only_way(self, radiance, scene, method, surface, path, length, partial, is_only_way, *_):
        if surface.emitter >= 0 and not eye_subpath.is_hit_weighed(method, is_only_way):
            self._note_hit(1.0 if is_only_way else 0.0)

    def _note_hit(self, weight):
        self._note(("hit", 0), weight, path_of_hit(self.eye, self.hit))

    # --- pairs

    def trace(self, pair, x, y):
        """Trace light subpath number `pair` and an eye subpath of pixel (x, y), connect them, and merge everywhere."""
        setup = self.setup
        for pool in setup.stores[:3]:
            pool.ends[0, 0] = pool.used[0] = 0
        with np.errstate(over="ignore"):
            stream = stream_of(SEED ^ LIGHT_SEED, pair, pair, 0)
            light_subpath.trace_light_subpath(setup, 0, 0, 0, stream, self.wavelengths)
            self._trace_eye(stream_of(SEED, pair, pair, 0), x, y)
        self._merge_all()

    def _trace_eye(self, stream, x, y):
        setup = self.setup
        camera, counts = setup.camera, setup.method.counts
        film_x, film_y, film_weight = sample_film(setup.pixel_filter, x, y, *random_pair(stream, FILM))
        lens_u, lens_v = lens_numbers(camera.lens, stream)
        lens_point, origin, direction = camera_ray(camera, film_x, film_y, lens_u, lens_v)
        self.walk = self.eye = Subpath([end_node(lens_point, camera.forward, 0.0, -1)], [], [], [])
        path = seen_from(start_path(origin, direction, setup.sensing, camera.media), lens_point)
        density = pdf_camera_direction(camera, setup.method.n_pixels, direction)
        start = eye_start(counts, density, projected_lens_area(camera, direction))
        place = Place(y, x, self.wavelengths, self.wavelengths)
        eye_subpath.trace_eye_subpath(setup, 0, 0, stream, place, path, start, film_weight)

    def _merge_all(self):
        """Merge every stored eye vertex with every photon, near or not: weights do not ask."""
        setup = self.setup
        if setup.method.techniques.merge is None:
            return
        for eye in setup.stores.eye.records.array[: setup.stores.eye.used[0]]:
            stored = load_vertex(setup.scene, eye, setup.sensing.zero, self.wavelengths)
            survival = local_survival(setup.scene, stored.vertex, self.wavelengths)
            for light in setup.stores.light.records.array[: setup.stores.light.used[0]]:
                self._merge(stored, survival, light)

    def _merge(self, stored, survival, light):
        setup, i, j = self.setup, stored.length, light.length
        if not self.light.nodes[j].can_merge:  # such are no photons
            return
        photon = np.zeros(1, doubled(photon_grid.photon_dtype(len(self.wavelengths.values)))).view(
            np.recarray
        )
        photon_grid._copy(light, photon[0])
        self.merge_weights = []
        counts = counts_at(setup.scene, setup.method, setup.method.counts, stored.vertex.surface)
        constants, flux = Merging(1.0, 1.0, 0.0, None), self.wavelengths
        merge._merge(
            setup.scene, setup.method, counts, constants, photon[0], flux, stored, survival, self.wavelengths
        )
        for weight in self.merge_weights:
            path = merged(*up_to(self.light, j), *up_to(self.eye, i))
            self._note(("vm", j), weight, path)
