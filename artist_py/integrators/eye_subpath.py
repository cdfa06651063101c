"""Eye subpaths: hit emitters, next-event estimation, connections to the pair's light subpaths, vertices for merges."""

import numpy as np

from ..bsdf.dispatch import is_delta_bsdf, is_mergeable
from ..core.rng import lattice_point, random_number, random_pair
from ..core.sets import received
from ..core.spectra import black
from ..core.vector import dot
from ..emitters.dispatch import emitted_radiance, is_emitting_towards, is_hidden, pdf_emitter
from ..emitters.emission import pdf_emission_of_background, pdf_emission_of_hit
from ..emitters.infinite import is_in_background
from ..geometry.embree import INVALID_ID, closest_hit
from ..geometry.surface import surface_at
from ..jit import function
from ..scene.tables import ABSORBER
from ..transport.connect import Connected, connect_to_light, connect_vertices, no_connection
from ..transport.local_counts import counts_at
from ..transport.mis import on_arrival, partial_after, weight_of_hit
from ..transport.recording import HIT, NEE, VC, record
from ..transport.roulette import is_spent, local_survival, survived
from ..transport.shares import is_chosen
from ..transport.subpath import go_straight, is_passed_through, scatter, vertex_at
from ..transport.vertices import load_vertex, store_vertex
from .pair import BSDF, CHOICE, EMITTER, FIRST_VERTEX, PAIRS_PER_VERTEX, ROULETTE, Walk, light_paths_of


@function
def trace_eye_subpath(  # noqa: PLR0915 - one loop, a line or two per step of the walk
    setup, thread, index, stream, place, path, partial, film_weight
):
    """Radiance along `path` but for merges, whose vertices are stored with the sample's `film_weight`; a `Walk`."""
    scene, limits, method, wavelengths = setup.scene, setup.limits, setup.method, place.wavelengths
    radiance = black(place.weights)
    length, rays, shadow_rays = 1, 0, 0
    # Whether no vertex so far can be merged at, and whether the first one cannot be connected.
    is_specular, begins_specular = True, True
    while True:
        rays += 1
        hit = closest_hit(scene.geometry.embree, path.origin, path.direction, np.inf)
        is_only_way = is_found_by_hits_only(method.techniques, length, is_specular, begins_specular)
        if hit.geometry == INVALID_ID:
            # Before (1.20): there is nothing to arrive at.
            background = background_hit(setup, path, length, partial, is_only_way, place)
            radiance = radiance + received(scene.fluorescence, path.throughput, background)
            break
        surface = surface_at(scene.geometry, scene.needs, path.origin, path.direction, hit)
        material = scene.materials[surface.material]
        way = surface.position - path.reference
        cos_in = abs(dot(path.direction, surface.normal))
        arrived = on_arrival(partial, dot(way, way), cos_in)
        emitted = emission_hit(scene, method, surface, path, length, arrived, is_only_way, wavelengths)
        radiance = radiance + received(scene.fluorescence, path.throughput, emitted.value)
        _record(setup, place, HIT, length, length, path.throughput, emitted)
        if is_passed_through(scene, surface, material, path):
            path = go_straight(scene, surface, material, path)
            continue
        if material.kind == ABSORBER or length >= limits.max_length:
            break
        partial = arrived
        vertex = vertex_at(scene, surface, path, wavelengths)
        counts = counts_at(scene, method, method.counts, surface)
        survival = local_survival(scene, vertex, wavelengths)
        pair = FIRST_VERTEX + (length - 1) * PAIRS_PER_VERTEX
        u_select, u_lobe = random_pair(stream, pair + CHOICE)
        if not is_delta_bsdf(material):
            joined = connect(
                setup,
                counts,
                index,
                vertex,
                partial,
                survival,
                length,
                place,
                path,
                stream,
                pair + EMITTER,
                u_select,
            )
            radiance = radiance + received(scene.fluorescence, path.throughput, joined.value)
            shadow_rays += joined.rays
            _store(setup, thread, surface, material, path, partial, length, index, film_weight)
        if random_number(stream, ROULETTE + length) >= survival:
            break
        step = scatter(scene, vertex, path, wavelengths, stream, pair + BSDF, u_lobe, None)
        # Not the material but the lobe counts: one of a plastic's two can neither be connected nor merged.
        is_specular = is_specular and is_unmergeable(scene, material, step)
        begins_specular = begins_specular and (length > 1 or step.is_delta)
        if is_spent(limits.ends_black, step.path) or is_done(method, is_specular, begins_specular):
            break
        partial = partial_after(counts, partial, step, surface, survival, cos_in)
        path = survived(step.path, survival)
        length += 1
    return Walk(radiance, rays, shadow_rays)


@function
def _record(setup, place, technique, length, eye_length, throughput, found):
    tables, spectra = setup.stores.techniques, setup.scene.spectra
    contribution = received(setup.scene.fluorescence, throughput, found.value)
    record(tables, spectra, place, technique, length, eye_length, contribution, found.weight)


@function
def connect(setup, counts, index, vertex, partial, survival, length, place, path, stream, pair, u_select):
    """Next-event estimation and connections at an eye vertex, as far as the method has them; `Connected`.

    `counts` are those for weights here.
    """
    techniques = setup.method.techniques
    u, v = random_pair(stream, pair)
    direct = _next_event(
        techniques.nee, setup, counts, vertex, partial, survival, length, place, path, u, v, u_select
    )
    others = _connect_all(
        techniques.connect, setup, counts, index, vertex, partial, survival, length, place, path
    )
    return Connected(direct.value + others.value, direct.rays + others.rays, 1.0)


@function
def _next_event(needed, setup, counts, vertex, partial, survival, length, place, path, u, v, u_select):
    if needed is None:
        return no_connection(place.wavelengths)
    return _shadow_rays(
        setup.method.shadow_rays,
        setup,
        counts,
        vertex,
        partial,
        survival,
        length,
        place,
        path,
        u,
        v,
        u_select,
    )


@function
def _shadow_rays(many, setup, counts, vertex, partial, survival, length, place, path, u, v, u_select):
    """Next-event estimation by one shadow ray or the mean of `many`."""
    if many is None:
        return _shadow_ray(setup, counts, vertex, partial, survival, length, place, path, u, v, u_select, 1.0)
    total, rays = black(place.wavelengths), 0
    for _ in range(many):
        u, v, u_select = lattice_point(u, v, u_select)
        direct = _shadow_ray(
            setup, counts, vertex, partial, survival, length, place, path, u, v, u_select, 1.0 / many
        )
        total, rays = total + direct.value, rays + direct.rays
    return Connected(total, rays, 1.0)


@function
def _shadow_ray(setup, counts, vertex, partial, survival, length, place, path, u, v, u_select, scale):
    wavelengths = place.wavelengths
    direct = connect_to_light(setup.scene, counts, vertex, partial, survival, wavelengths, u, v, u_select)
    direct = Connected(direct.value * scale, direct.rays, direct.weight)
    _record(setup, place, NEE, length + 1, length, path.throughput, direct)
    return direct


@function
def _connect_all(needed, setup, counts, index, vertex, partial, survival, length, place, path):
    """Connections to all vertices of the pixel's light subpaths."""
    wavelengths = place.wavelengths
    if needed is None:
        return no_connection(wavelengths)
    scene, limits = setup.scene, setup.limits
    total, rays = black(wavelengths), 0
    first, end = light_paths_of(setup.method, index)
    if first == end:
        return no_connection(wavelengths)
    # The vertices of a pixel's light subpaths stand one after the other.
    last = setup.stores.paths[end - 1]
    for i in range(setup.stores.paths[first].first_vertex, last.first_vertex + last.n_vertices):
        if not is_chosen(setup.method.chosen.connect, setup.stores.light.records[i].pixel):
            continue
        row = setup.stores.light.records[i]
        stored = load_vertex(scene, row, setup.sensing.zero, wavelengths)
        if stored.length + length + 1 > limits.max_length:
            continue
        light_survival = local_survival(scene, stored.vertex, wavelengths)
        light_counts = counts_at(scene, setup.method, setup.method.counts, stored.vertex.surface)
        joined = connect_vertices(
            scene, counts, vertex, partial, survival, stored, light_survival, wavelengths, light_counts
        )
        _record(setup, place, VC, stored.length + length + 1, length, path.throughput, joined)
        total = total + joined.value
        rays += joined.rays
    return Connected(total, rays, 1.0)


@function
def is_unmergeable(scene, material, step):
    """Whether nothing is merged at a vertex for paths that leave it as `step` does."""
    return step.is_delta or not is_mergeable(scene.needs.sharp, material)


@function
def _store(setup, thread, surface, material, path, partial, length, index, film_weight):
    if is_mergeable(setup.scene.needs.sharp, material):
        _store_in(setup.stores.eye, thread, surface, path, partial, length, index, film_weight)


@function
def _store_in(pool, thread, surface, path, partial, length, index, film_weight):
    if pool is None:
        return
    throughput = path.throughput * film_weight
    store_vertex(pool, thread, surface, -path.direction, throughput, partial, length, index)


@function
def is_done(method, is_specular, begins_specular):
    """Whether nothing is to be found further along.

    Photon mapping ends at the first lobe that is not specular, light tracing where that is the first of all.
    """
    techniques = method.techniques
    if techniques.merge_once is not None:
        return not is_specular
    if not _finds_nothing(techniques.nee, techniques.connect, techniques.merge):
        return False
    return not (method.hits_everything or begins_specular)


@function
def _finds_nothing(nee, connects, merge):
    # Nested, because numba prunes a test for None but not a conjunction.
    if nee is None:  # noqa: SIM102
        if connects is None:  # noqa: SIM102
            if merge is None:
                return True
    return False


@function
def is_found_by_hits_only(techniques, length, is_specular, begins_specular):
    """Whether no other technique of a method without hits finds a path that ends on an emitter here (theory 1.9)."""
    if techniques.merge is not None:
        return is_specular
    return length == 1 or begins_specular


@function
def is_hit_weighed(method, is_only_way):
    """Whether a hit competes with other techniques.

    What a method without hits still finds by them is found by lens hits at most.
    """
    return method.hits_everything or _is_found_by_lens_hits(method.counts.lens, is_only_way)


@function
def _is_found_by_lens_hits(lens, is_only_way):
    if lens is None:
        return False
    return is_only_way


@function
def emission_hit(scene, method, surface, path, length, partial, is_only_way, wavelengths):
    """Radiance of an emitter that was hit, with its weight (1.17); `Connected`, without a ray."""
    return _emission_hit(
        scene.emitters, scene, method, surface, path, length, partial, is_only_way, wavelengths
    )


@function
def _emission_hit(emitters, scene, method, surface, path, length, partial, is_only_way, wavelengths):
    if emitters is None:
        return no_connection(wavelengths)
    if surface.emitter < 0:
        return no_connection(wavelengths)
    emitter = emitters.records[surface.emitter]
    if not is_emitting_towards(emitter, surface.normal, -path.direction):
        return no_connection(wavelengths)
    if is_hidden(scene.needs.hidden_emitters, emitter, length):
        return no_connection(wavelengths)
    radiance = emitted_radiance(scene, emitter, -path.direction, wavelengths)
    if not is_hit_weighed(method, is_only_way):
        weight = 1.0 if is_only_way else 0.0
        return Connected(radiance * weight, 0, weight)
    nee_ratio = 0.0
    if path.pdf_solid_angle > 0.0:
        reference = path.reference
        nee_ratio = pdf_emitter(scene, emitter, reference, surface.position, surface.normal)
        nee_ratio /= path.pdf_solid_angle
    emission = pdf_emission_of_hit(scene, emitter, surface, path.direction)
    weight = weight_of_hit(method.counts, nee_ratio, emission, partial)
    return Connected(radiance * weight, 0, weight)


@function
def background_hit(setup, path, length, partial, is_only_way, place):
    """Radiance that `path`, which leaves the scene, finds at infinity, with its weight (1.17)."""
    return _background_hit(setup.scene.emitters, setup, path, length, partial, is_only_way, place)


@function
def _background_hit(emitters, setup, path, length, partial, is_only_way, place):
    if emitters is None:
        return black(place.wavelengths)
    return _sum_of_background(
        emitters.background, emitters.records, setup, path, length, partial, is_only_way, place
    )


@function
def _sum_of_background(first, records, setup, path, length, partial, is_only_way, place):
    total, scene = black(place.wavelengths), setup.scene
    if first is None:
        return total
    for i in range(first, records.shape[0]):
        emitter = records[i]
        if is_in_background(emitter, path.direction) and not is_hidden(
            scene.needs.hidden_emitters, emitter, length
        ):
            # Nothing else finds what the camera sees directly, see lens_hits.py.
            weight = 1.0
            if length > 1:
                weight = _background_weight(scene, setup.method, emitter, path, partial, is_only_way)
            radiance = emitted_radiance(scene, emitter, -path.direction, place.wavelengths) * weight
            total = total + radiance
            _record(setup, place, HIT, length, length, path.throughput, Connected(radiance, 0, weight))
    return total


@function
def _background_weight(scene, method, emitter, path, partial, is_only_way):
    if not is_hit_weighed(method, is_only_way):
        return 1.0 if is_only_way else 0.0
    nee_ratio = 0.0
    if path.pdf_solid_angle > 0.0:
        density = pdf_emitter(scene, emitter, path.reference, path.reference, -path.direction)
        nee_ratio = density / path.pdf_solid_angle
    emission = pdf_emission_of_background(scene, emitter, path.direction)
    return weight_of_hit(method.counts, nee_ratio, emission, partial)
