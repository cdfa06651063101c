"""Every weight that the kernels give is that of theory (1.3) and (1.4), to 1e-9 in float64.

The kernels' own functions walk, connect and merge, as plain Python; `recording` notes every weight together with the
full path that it was given to, and `reference_densities` says what it should have been, strategy by strategy. The
vertices are the same, so that no rounding of geometry comes between.
"""

import functools
import math

import oracle_scenes
import pytest
import recording
from recording import Recorder
from recurrences import Case, all_weights

from artist_py.integrators.reference_densities import technique_densities, weight_of
from artist_py.transport import mis
from artist_py.transport.mis import Counts

TOLERANCE = 1e-9
N_LIGHT = 64
VM = 0.05  # n_vm pi r^2 at a radius that makes merges as good as connections, in these scenes

SUBSETS = {
    "pt": Counts(1, 1, 0, 0, 0, None),
    "pt-nee": Counts(1, 0, 0, 0, 0, None),
    "lt": Counts(0, 0, 0, 1, 0, None),
    "pt+lt": Counts(1, 1, 0, 1, 0, None),
    "bpt": Counts(1, 1, 1, 1, 0, None),
    "bpt-nee": Counts(1, 0, 1, 1, 0, None),
    "bpt-lt": Counts(1, 1, 1, 0, 0, None),
    "bpm": Counts(0, 0, 0, 0, VM, None),
    "pt+vm": Counts(1, 1, 0, 0, VM, None),
    "vcm-vc": Counts(1, 1, 0, 1, VM, None),
    "vcm": Counts(1, 1, 1, 1, VM, None),
    "many": Counts(1, 4, 2, 3, 7 * VM, None),
    "parts": Counts(1, 0.7, 0.25, 0.31, 0.4 * VM, None),
}
# With light that hits the lens.
WITH_LENS = {
    "lens": Counts(1, 0, 0, 0, 0, None, 1),
    "pt+lens": Counts(1, 1, 0, 0, 0, None, 0.5),
    "lt+lens": Counts(1, 0, 0, 1, 0, None, 1),
    "bpt": Counts(1, 1, 1, 1, 0, None, 1),
    "vcm": Counts(1, 1, 1, 1, VM, None, 1),
    "parts": Counts(1, 0.7, 0.25, 0.31, 0.4 * VM, None, 0.6),
}
EXPECTED = {
    "hit": lambda counts: True,
    "nee": lambda counts: counts.nee > 0,
    "vc": lambda counts: counts.vc > 0,
    "lt": lambda counts: counts.lt > 0,
    "lens": lambda counts: counts.lens is not None,
    "vm": lambda counts: counts.vm_area > 0,
}


@functools.cache
def scene_named(name):
    return oracle_scenes.SCENES[name]()


def record(patch, name, counts, pairs, lanes=1, hits_everything=None):
    """A `Recorder` that has traced so many pairs over the image."""
    recorder = Recorder(patch, scene_named(name), counts, lanes, hits_everything)
    for pair in range(pairs):
        recorder.trace(pair, pair % 8, 5 * pair // 2 % 8)
    return recorder


def by_heuristic(values, with_power):
    """Parameters `(value, power)`: each value by the balance heuristic; by the power heuristic too, where slow.

    It changes one exponent, whatever the scene and the techniques: a fast test has it for the values `with_power`.
    """
    pairs = [(value, power) for value in values for power in (None, True)]
    return [
        pytest.param(
            value, power, id=f"{value}-{'power' if power else 'balance'}",
            marks=pytest.mark.slow if power and value not in with_power else (),
        )
        for value, power in pairs
    ]  # fmt: skip


def brute_force(recorder, path):
    setup = recorder.setup
    return technique_densities(
        setup.scene, setup.camera, setup.method.counts, setup.method.n_pixels, recorder.wavelengths, path,
        setup.method.hits_everything or setup.method.counts.lens is None,
    )  # fmt: skip


def deviations(recorder):
    """`(relative deviation, technique, path)` of every weight, the worst first."""
    power = 2 if recorder.setup.method.counts.power else 1
    found = []
    for technique, weight, path in recorder.found:
        expected = weight_of(technique, brute_force(recorder, path), power)
        found.append((abs(weight - expected) / max(expected, 1e-300), technique, path))
    return sorted(found, key=lambda each: -each[0])


def assert_exact(recorder, fewest):
    """All of at least so many weights are right."""
    found = deviations(recorder)
    assert len(found) >= fewest
    worst, technique, path = found[0]
    kinds = "".join("D" if node.is_delta else "." for node in path.nodes)
    assert worst < TOLERANCE, f"{technique} of the path {kinds}: off by {worst:.2g}"


def kinds_of(recorder):
    return {found.technique[0] for found in recorder.found}


@pytest.mark.parametrize(
    ("name", "power"),
    by_heuristic([name for name in oracle_scenes.SCENES if name != "lights on lens"], ("mixed", "lights")),
)
def test_all_techniques(monkeypatch, name, power):
    pairs = 150 if name in {"far", "dispersive"} else 50
    lanes = scene_named(name).graph.render.hero_count if name == "dispersive" else 1
    recorder = record(monkeypatch, name, SUBSETS["parts"]._replace(power=power), pairs, lanes)
    assert kinds_of(recorder) >= {"nee", "vc", "lt", "vm"}
    assert_exact(recorder, 60)


@pytest.mark.parametrize("subset", SUBSETS)
def test_every_subset(monkeypatch, subset):
    counts = SUBSETS[subset]
    recorder = record(monkeypatch, "mixed", counts, 40)
    wanted = {kind for kind, is_expected in EXPECTED.items() if is_expected(counts)}
    assert kinds_of(recorder) | {"hit"} == wanted
    assert_exact(recorder, 3)


@pytest.mark.parametrize("subset", ["bpm", "vcm", "parts"])
def test_sharp_lobes_are_not_merged_at(monkeypatch, subset):
    recorder = record(monkeypatch, "sharp", SUBSETS[subset], 40)
    sharp = [
        [node.can_join and not node.can_merge for node in found.path.nodes[1:-1]] for found in recorder.found
    ]
    assert sum(map(any, sharp)) >= 10
    assert any(map(all, sharp))
    assert_exact(recorder, 60)


@pytest.mark.parametrize(("subset", "power"), by_heuristic(WITH_LENS, ("parts",)))
def test_lens_hits(monkeypatch, subset, power):
    counts = WITH_LENS[subset]._replace(power=power)
    recorder = record(monkeypatch, "wide lens", counts, 80)
    assert kinds_of(recorder) == {kind for kind, is_expected in EXPECTED.items() if is_expected(counts)}
    lens_paths = [found.path for found in recorder.found if found.technique[0] == "lens"]
    assert len(lens_paths) >= 10
    assert any(path.nodes[-2].is_delta for path in lens_paths)
    assert any(len(path.edges) == 1 for path in lens_paths)
    assert_exact(recorder, 20)


def test_lens_hits_of_emitters_without_a_surface(monkeypatch):
    """Such are not seen themselves, only what they light and their images in mirrors."""
    recorder = record(monkeypatch, "lights on lens", WITH_LENS["parts"], 150)
    lens_paths = [found.path for found in recorder.found if found.technique[0] == "lens"]
    assert len(lens_paths) >= 5
    assert min(len(path.edges) for path in lens_paths) == 2
    assert_exact(recorder, 100)


@pytest.mark.parametrize("power", [None, True], ids=["balance", "power"])
def test_lens_hits_of_light_tracing(monkeypatch, power):
    """Hits take part only where the vertex before the lens cannot be connected to it."""
    counts = WITH_LENS["lt+lens"]._replace(power=power)
    recorder = record(monkeypatch, "wide lens", counts, 120, hits_everything=False)
    hits = [found for found in recorder.found if found.technique[0] == "hit" and 0.0 < found.weight < 1.0]
    assert any(found.path.nodes[-2].is_delta for found in hits)
    assert kinds_of(recorder) == {"hit", "lt", "lens"}
    assert_exact(recorder, 60)


@pytest.mark.parametrize(("radius", "power"), by_heuristic([1e-7, 1e-3, 0.1, 1e4], (1e-7, 1e4)))
def test_every_radius(monkeypatch, radius, power):
    counts = Counts(1, 1, 1, 1, N_LIGHT * math.pi * radius**2, power)
    assert_exact(record(monkeypatch, "mixed", counts, 20), 60)


def test_roulette_is_part_of_the_densities(monkeypatch):
    """Survival at a grey surface is 0.3: without it, weights would be others."""
    recorder = record(monkeypatch, "nested", SUBSETS["vcm"], 50)
    survivals = {node.survival for found in recorder.found for node in found.path.nodes[1:-1]}
    assert math.isclose(min(survivals), 0.3, rel_tol=1e-6)
    forget = [found._replace(path=found.path._replace(nodes=certain(found.path))) for found in recorder.found]
    recorder.found = forget
    assert deviations(recorder)[0][0] > 0.1


def test_lens_hits_are_part_of_the_eye_subpath(monkeypatch):
    """Eye subpaths that know nothing of lens hits weigh the other techniques too much."""
    monkeypatch.setattr(
        recording, "eye_start", lambda counts, density, area: mis.Partial(counts.lt / density, 0.0)
    )
    recorder = record(monkeypatch, "wide lens", WITH_LENS["vcm"], 20)
    assert deviations(recorder)[0][0] > 0.01


def certain(path):
    """The nodes of a path, with roulette that ends nothing."""
    return [node._replace(survival=1.0) for node in path.nodes]


def test_specular_chains(monkeypatch):
    """Chains of three delta vertices and more, refraction into glass in water among them."""
    recorder = record(monkeypatch, "nested", SUBSETS["vcm"], 120)
    chains = ["".join(".D"[int(node.is_delta)] for node in found.path.nodes) for found in recorder.found]
    assert sum("DDD" in chain for chain in chains) >= 5
    assert sum(chain.count("D.D") > 0 for chain in chains) >= 1
    assert_exact(recorder, 300)


def test_length_limit(monkeypatch):
    """Paths are found up to the limit and not beyond, by every technique."""
    recorder = record(monkeypatch, "cornell", SUBSETS["bpt"], 60)
    longest = dict.fromkeys(kinds_of(recorder), 0)
    for technique, _, path in recorder.found:
        longest[technique[0]] = max(longest[technique[0]], len(path.edges))
    assert {longest[kind] for kind in ("nee", "vc", "lt")} == {oracle_scenes.LENGTH}
    assert max(longest.values()) == oracle_scenes.LENGTH


# --- a path's weights sum to one ----------------------------------------------------------------------------------


@pytest.mark.parametrize("power", [None, True], ids=["balance", "power"])
@pytest.mark.parametrize(
    ("name", "counts"),
    [
        *(("mixed", SUBSETS[name]) for name in ("bpt", "pt+vm", "vcm", "parts")),
        ("wide lens", WITH_LENS["parts"]),
    ],
)
def test_weights_sum_to_one(monkeypatch, name, counts, power):
    """Of all techniques that can find a path, by the recurrences along that path from both ends."""
    recorder = record(monkeypatch, name, counts._replace(power=power), 20)
    summed = 0
    for _, _, path in recorder.found:
        if len(path.edges) > 1:
            weights = all_weights(Case(recorder.setup, recorder.wavelengths, path))
            assert math.isclose(sum(weights.values()), 1.0, rel_tol=TOLERANCE)
            summed += 1
    assert summed >= 30


# --- the oracle notices -------------------------------------------------------------------------------------------


def smallvcm_factor(partial, cos_theta_in, eta):
    """The factor of refraction without the change of solid angle."""
    return mis.Partial(0.0, partial.e * cos_theta_in)


def specular_is_connectable(partial, cos_theta_in, eta):
    return mis.Partial(1.0, partial.e * cos_theta_in / (eta * eta))


FAULTS = {
    "factor of refraction": (mis, "after_delta", smallvcm_factor),
    "connections to mirrors": (mis, "after_delta", specular_is_connectable),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_found(monkeypatch, fault):
    """A wrong recurrence is seen, and by far."""
    monkeypatch.setattr(*FAULTS[fault])
    assert deviations(record(monkeypatch, "mixed", SUBSETS["vcm"], 40))[0][0] > 0.01
