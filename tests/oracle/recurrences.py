"""The weights of all techniques of one given path by the recurrences of transport/mis.py."""

from typing import NamedTuple

from artist_py.cameras.lens import aperture_area
from artist_py.cameras.sensor import pdf_camera_direction, projected_lens_area
from artist_py.core.frame import to_local
from artist_py.emitters.dispatch import pdf_emitter
from artist_py.emitters.emission import pdf_emission_of_hit
from artist_py.integrators.reference_densities import emitter_of, ior_on_side, pdf_direction
from artist_py.transport import mis
from artist_py.transport.local_counts import counts_at
from artist_py.transport.mis import Partial


class Case(NamedTuple):
    """Who weighs which path."""

    setup: object
    wavelengths: object
    path: object

    @property
    def length(self):
        """Edges of the path."""
        return len(self.path.edges)

    def counts(self, i):
        """`Counts` for weights at vertex i."""
        method = self.setup.method
        return counts_at(self.setup.scene, method, method.counts, self.path.nodes[i].surface)

    def density(self, i, forwards):
        """Density, sr^-1, of leaving vertex i towards the lens (`forwards`) or towards the light."""
        before, after = self.path.edges[i - 1].direction, self.path.edges[i].direction
        ends = (-before, after) if forwards else (after, -before)
        return pdf_direction(self.setup.scene, self.wavelengths, self.path.nodes[i], *ends)

    def eta(self, i):
        """Index of refraction at vertex i towards the lens over that towards the light."""
        node, scene = self.path.nodes[i], self.setup.scene
        material = scene.materials[node.surface.material]
        ends = self.path.edges[i].direction, -self.path.edges[i - 1].direction
        index = [
            ior_on_side(scene, self.wavelengths, material, node, to_local(node.frame, end)) for end in ends
        ]
        return index[0] / index[1]


def start_densities(case):
    """`(emission, next event)` of the light end: p>_0 s>_0, and pc_0 per solid angle at the second vertex."""
    scene, first, edge = case.setup.scene, case.path.nodes[0].surface, case.path.edges[0]
    emitter = emitter_of(scene, case.path)
    emission = pdf_emission_of_hit(scene, emitter, first, -edge.direction)
    return emission, pdf_emitter(scene, emitter, case.path.second, first.position, first.normal)


def light_partials(case):
    """C and E on arrival at vertices 1 to k of the light subpath, the lens being k."""
    counts, edges = case.setup.method.counts, case.path.edges
    emission, next_event = start_densities(case)
    cosine = edges[0].cos_start
    partial = Partial(counts.nee * next_event * cosine / emission, counts.hit * cosine / emission)
    found = [None, mis.on_arrival(partial, 1.0, edges[0].cos_end)]
    for i in range(1, case.length):
        if case.path.nodes[i].is_delta:
            partial = mis.after_delta(found[i], edges[i - 1].cos_end, case.eta(i))
        else:
            densities = case.density(i, True), case.density(i, False)
            partial = mis.after_scatter(case.counts(i), found[i], *densities, edges[i].cos_start)
        found.append(mis.on_arrival(partial, edges[i].distance_squared, edges[i].cos_end))
    return found


def eye_partials(case):
    """C and E on arrival at vertices k - 1 to 0 of the eye subpath, by vertex."""
    setup, edges = case.setup, case.path.edges
    counts, last = setup.method.counts, case.length - 1
    density = pdf_camera_direction(setup.camera, setup.method.n_pixels, -edges[last].direction)
    partial = mis.eye_start(counts, density, projected_lens_area(setup.camera, -edges[last].direction))
    found = {last: mis.on_arrival(partial, edges[last].distance_squared, edges[last].cos_start)}
    for i in range(last, 0, -1):
        if case.path.nodes[i].is_delta:
            partial = mis.after_delta(found[i], edges[i].cos_start, 1.0 / case.eta(i))
        else:
            densities = case.density(i, False), case.density(i, True)
            partial = mis.after_scatter(case.counts(i), found[i], *densities, edges[i - 1].cos_end)
        found[i - 1] = mis.on_arrival(partial, edges[i - 1].distance_squared, edges[i - 1].cos_start)
    return found


def all_weights(case):
    """`{technique: weight}` of a path of 2 edges or more, of all techniques that have samples."""
    counts, k = case.setup.method.counts, case.length
    light, eye = light_partials(case), eye_partials(case)
    can_join = [0 < i < k and not node.is_delta for i, node in enumerate(case.path.nodes)]
    weights = _weights_of_ends(case, light, eye, can_join)
    for s in range(2, k):
        if counts.vc > 0.0 and can_join[s - 1] and can_join[s]:
            edge = case.path.edges[s - 1]
            weights["vc", s] = mis.weight_of_connection(
                counts,
                case.density(s, False) * edge.cos_start / edge.distance_squared,
                mis.bracket(case.counts(s - 1), light[s - 1], case.density(s - 1, False)),
                case.density(s - 1, True) * edge.cos_end / edge.distance_squared,
                mis.bracket(case.counts(s), eye[s], case.density(s, True)),
            )
    for m in range(1, k):
        if counts.vm_area > 0.0 and can_join[m] and case.path.nodes[m].can_merge:
            brackets = (
                mis.bracket(case.counts(m), light[m], case.density(m, False)),
                mis.bracket(case.counts(m), eye[m], case.density(m, True)),
            )
            weights["vm", m] = mis.weight_of_merge(case.counts(m), *brackets)
    return weights


def _weights_of_ends(case, light, eye, can_join):
    """Those of hits, next-event estimation and the light image."""
    setup, edges, k = case.setup, case.path.edges, case.length
    counts, weights = setup.method.counts, {}
    emission, next_event = start_densities(case)
    if counts.hit > 0.0:
        ratio = next_event / case.density(1, False) if can_join[1] else 0.0
        weights["hit", 0] = mis.weight_of_hit(counts, ratio, emission, eye[0])
    if counts.nee > 0.0 and can_join[1]:
        ratio = emission / (next_event * edges[0].cos_start) * edges[0].cos_end
        weights["nee", 1] = mis.weight_of_next_event(
            counts,
            case.density(1, False) / next_event,
            ratio,
            mis.bracket(case.counts(1), eye[1], case.density(1, True)),
        )
    last = edges[k - 1]
    density = pdf_camera_direction(setup.camera, setup.method.n_pixels, -last.direction)
    area, ratio = 1.0 if setup.camera.lens is None else aperture_area(setup.camera.lens), 0.0
    if can_join[k - 1]:
        ratio = case.density(k - 1, True) * last.cos_end * area / last.distance_squared
    if counts.lt > 0.0 and can_join[k - 1]:
        weights["lt", k] = mis.weight_of_light_image(
            counts,
            density * last.cos_start / last.distance_squared,
            mis.bracket(case.counts(k - 1), light[k - 1], case.density(k - 1, False)),
            ratio,
        )
    if counts.lens is not None:
        image_ratio = 1.0 / ratio if ratio > 0.0 else 0.0
        weights["lens", k + 1] = mis.weight_of_lens_hit(counts, image_ratio, density / area, light[k])
    return weights
