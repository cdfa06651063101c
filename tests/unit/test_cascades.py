"""What is lost where light goes through more dyes than there are sets of wavelengths, and what is said about it."""

import re
from pathlib import Path

import numpy as np
import pytest
from rendering import compile_tables, look, scene, shape

import artist_py
from artist_py.film.color import RGB_TO_XYZ
from artist_py.samplers.wavelengths import sets_of_wavelengths
from artist_py.scene import cascades
from artist_py.stress.fluorescence import Dye, glowing_room

SCENES = Path(__file__).parents[2] / "scenes"
CERTAINTY = 4.5  # standard errors; 1e-5 by chance
TEN = [Dye((first, first + 40), (first + 40, first + 80)) for first in range(300, 700, 40)]
LAMP = (300, 740, 0.3)
EDGES = 8
WIDE = [
    {
        "absorption": {"wavelengths": [first, first + 60], "values": [0.9, 0.9]},
        "emission": {"wavelengths": [first + 60, first + 120], "values": [1, 1]},
    }
    for first in range(300, 640, 60)
]


def ten_dyes(**render):
    """A room whose wall makes ten fluorescent events possible, compiled."""
    tables, _ = glowing_room(LAMP, TEN, edges=11)
    return compile_tables({**tables, "render": {**tables["render"], "integrator": "pt", **render}})


def closed(dyes, **render):
    """A room of nothing but its wall, compiled."""
    spectrum = {"wavelengths": [300, 740], "values": [0.3, 0.3]}
    wall = shape("sphere", "wall", center=[0, 0, 0], radius=1, reverse=True, emission={"spectrum": spectrum})
    return scene(
        [wall],
        materials={"wall": {"type": "fluorescent", "reflectance": 0.05, "dyes": dyes}},
        render={"wavelength_range": [300, 780], "max_path_length": EDGES, **render},
    )


def light_of(compiled):
    """Surfaces and `Light` of a compiled scene with one lamp."""
    spectra = compiled.spectra.astype(float)
    lamp = compiled.scene.emitters.records.array[0]
    seen = np.maximum(RGB_TO_XYZ @ spectra[:3], 0.0).sum(axis=0)
    fluorescent, count = compiled.fluorescence, compiled.graph.render.hero_count
    emitted = spectra[lamp["spectrum"]] * lamp["scale"]
    surfaces = cascades.surfaces_of(compiled.scene, compiled.spectra, fluorescent.matrices)
    return surfaces, cascades.Light(emitted, seen, fluorescent.set_nodes, count, 300)


# --- the estimate ---------------------------------------------------------------------------------------------------


def test_share_and_loss_are_those_of_a_closed_room(monkeypatch):
    """By linear algebra, the loss at the wavelengths that iterations really have; dyes in bands of 60 nm, two sets."""
    compiled = closed(WIDE, wavelength_sets=2)
    surfaces, light = light_of(compiled)
    exact = _radiance(light.emitted, np.diag(surfaces.reflectance[1]) + surfaces.matrices[0]) @ light.seen
    batches = np.reshape([_with_sets_of(i, surfaces, light) for i in range(1024)], (16, -1)).mean(axis=1)
    error = batches.std(ddof=1) / 4.0 / exact
    wrong = batches.mean() / exact - 1.0
    monkeypatch.setattr(cascades, "CERTAINTY", np.inf)  # all draws
    loss = cascades.loss_among_dyes(surfaces, light, EDGES)
    assert 0.5 < loss.share < 0.7
    assert wrong < -0.15
    assert max(loss.error, error) < 0.03
    assert abs(loss.wrong - wrong) < CERTAINTY * np.hypot(loss.error, error)


def _radiance(emitted, scatter):
    """Of a closed room, per bin or lane, but for what is emitted."""
    radiance, part = np.zeros_like(emitted), emitted
    for _ in range(EDGES - 1):
        part = scatter @ part
        radiance += part
    return radiance


def _with_sets_of(iteration, surfaces, light):
    """X + Y + Z at the sets of wavelengths of an iteration, by theory (3.2)."""
    sets, count = len(light.set_nodes), light.count
    wavelengths, weights = sets_of_wavelengths(light.set_nodes, count, 1, iteration)
    bins = (wavelengths - light.first).astype(int)
    scatter = np.zeros((len(bins), len(bins)))
    for m in range(sets):
        out, into = (slice(i * count, (i + 1) * count) for i in (m, (m + 1) % sets))
        scatter[out, into] = surfaces.matrices[0][bins[out, None], bins[None, into]] * weights[into]
    scatter += np.diag(surfaces.reflectance[1][bins])
    radiance = _radiance(light.emitted[bins], scatter)
    return (light.seen[bins] * weights * radiance)[:count].sum()


@pytest.mark.parametrize("sets", [1, 2, 3, 4])
def test_single_wavelengths_lose_all_that_comes_back_to_them(sets):
    """A set of one wavelength that is used again leads from there to there, which no dye does: no chance in that."""
    loss = cascades.loss_among_dyes(*light_of(closed(WIDE, wavelength_sets=sets, hero_count=1)), EDGES)
    assert loss.share > 0.1
    assert loss.wrong == pytest.approx(-loss.share, abs=1e-12)
    assert loss.error == 0.0


def test_light_that_does_not_need_more_sets_is_all_there():
    surfaces, light = light_of(closed(WIDE[:3]))
    assert cascades.loss_among_dyes(surfaces, light._replace(set_nodes=light.set_nodes[:1] * 4), EDGES) == (
        0,
        0,
        0,
    )


def test_chains_are_what_the_eye_meets():
    """A pane between the eye and a mirror, which shows a wall behind the eye; then out of the open side."""
    compiled = scene(
        [
            shape("rectangle", "pane", corner=[-9, 1, -9], edges=[[18, 0, 0], [0, 0, 18]]),
            shape("rectangle", "mirror", corner=[-9, 2, -9], edges=[[18, 0, 0], [0, 0, 18]]),
            shape("rectangle", "wall", corner=[-99, -1, -99], edges=[[198, 0, 0], [0, 0, 198]]),
        ],
        materials={
            "pane": {"type": "thin-dielectric", "ior": 1.5},
            "mirror": {"type": "mirror", "reflectance": 1},
            "wall": {"type": "diffuse", "reflectance": 0.5},
        },
        camera=look([0, 0, 0], [0, 1, 0], 20),
    )
    names = {None: cascades.NOWHERE, "mirror": 2, "wall": 3}
    chains = cascades.chains_of_image(compiled.scene, compiled.camera, (16, 16), 4)
    assert chains.shape == (cascades.WALKS, 3)
    assert (chains[:, :2] == [names["mirror"], names["wall"]]).all()
    assert set(np.unique(chains[:, 2])) <= {names[None], names["mirror"]}


# --- what a scene gets ----------------------------------------------------------------------------------------------


def test_ten_dyes_get_a_set_more_and_a_warning():
    compiled = ten_dyes()
    assert compiled.fluorescence.n_sets == compiled.graph.render.wavelength_sets == 4
    (text,) = compiled.warnings
    assert re.search(r"up to 1\d% too dark: 3\d% of its light is that of 4 or more fluorescent events", text)
    assert text.endswith("try render.hero_count = 8")


def test_sets_that_are_asked_for_are_kept():
    compiled = ten_dyes(wavelength_sets=3)
    assert compiled.fluorescence.n_sets == 3
    (text,) = compiled.warnings
    assert re.search(r"up to [23]\d% too dark: 5\d% of its light is that of 3 or more", text)
    assert text.endswith("try render.wavelength_sets = 4 and render.hero_count = 8")


def test_dyes_that_nobody_sees_cost_nothing():
    """Ten dyes in a closed ball, seen from outside: with what the eye meets, three sets suffice."""
    tables, _ = glowing_room(LAMP, TEN, edges=11)
    tables["camera"] = {**tables["camera"], "position": [0, -5, 0], "look_at": [0, -9, 0], "up": [0, 0, 1]}
    wall = shape("rectangle", "white", corner=[-5, -9, -5], edges=[[10, 0, 0], [0, 0, 10]])
    compiled = compile_tables({**tables, "shapes": [*tables["shapes"], wall]})
    assert cascades.loss_among_dyes(*light_of(compiled), 11).is_large
    assert compiled.graph.render.wavelength_sets == 3
    assert compiled.warnings == []


def test_wavelengths_that_shift_need_no_sets():
    """Each event has wavelengths of its own, however many there are."""
    assert ten_dyes(wavelengths="independent").warnings == []


@pytest.mark.parametrize(
    "name",
    [
        "fluorescent_spheres",
        "fluorescent_room",
        "black_light",
        "cascade",
        "highlighters",
        "highlighters_a",
        "highlighters_uv",
    ],
)
def test_scenes_of_the_gallery_lose_nothing_that_counts(name):
    compiled = artist_py.load_scene(SCENES / f"{name}.toml")
    assert compiled.fluorescence.n_sets == compiled.graph.render.wavelength_sets == 3
    assert compiled.warnings == []
