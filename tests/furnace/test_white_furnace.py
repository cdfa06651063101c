"""Objects in a closed sphere that emits 1 everywhere: what loses no light cannot be seen in it.

Radiance over the square of the index of refraction is what interfaces conserve, so that a camera in glass sees n^2.
Smooth surfaces without loss give every single path the exact weight, so that most of these tests have no noise at all;
the others fail a correct program by chance with probability 1e-4 each; there are 12 comparisons of that kind.
"""

import math

import numpy as np
import pytest
from rendering import (
    MONOCHROME,
    assert_sample_mean,
    assert_uniform,
    diffuse,
    look,
    radiance,
    render,
    scene,
    shape,
    with_render,
)

from artist_py.bsdf.oren_nayar import evaluate_oren_nayar
from artist_py.core.vector import Spectrum, vec3
from artist_py.scene.optics import metal_table
from artist_py.scene.tables import material_dtype

SKY = shape("sphere", center=[0, 0, 0], radius=4, reverse=True, emission=1)
MATERIALS = {
    "white": diffuse(1.0),
    "matte": {"type": "oren-nayar", "reflectance": 0.9, "roughness": 35},
    "mirror": {"type": "mirror", "reflectance": 1.0},
    "metal": {"type": "conductor", "metal": "Au"},
    "glass": {"type": "dielectric", "ior": 1.5},
    "ice": {"type": "dielectric", "ior": 1.31},
    "dense": {"type": "dielectric", "ior": 1.8, "priority": 2},
    "water": {"type": "dielectric", "ior": 1.33, "priority": 1},
    "flint": {"type": "dielectric", "ior": "N-SF11"},
    "pane": {"type": "thin-dielectric", "ior": 1.5},
    "air": {"type": "none"},
}
# One of each outside the sky, where nothing sees them, so that all these scenes share their kernels.
UNSEEN = [shape("sphere", name, center=[6, 0.15 * i, 0], radius=0.1) for i, name in enumerate(MATERIALS)] + [
    shape("rectangle", corner=[5, 5, 5], edges=[[0.1, 0, 0], [0, 0.1, 0]], emission=0)
]
OBJECTS = {
    "sphere": {"center": [0.1, 0, 0], "radius": 0.8},
    "box": {"min": [-0.6, -0.5, -0.4], "max": [0.4, 0.6, 0.7]},
    "cylinder": {"base": [-0.3, 0, -0.6], "top": [0.2, 0.3, 0.5], "radius": 0.5},
    "cone": {"base": [0, 0.1, -0.6], "apex": [0.2, 0.3, 0.9], "radius": 0.6},
}
VIEW = look([1.2, -1.6, 0.7], [0, 0, 0], 60)
NO_ROULETTE = 1_000_000


def furnace(shapes, camera=VIEW, size=12, film=(), **render):
    return scene(
        [SKY, *shapes, *UNSEEN],
        materials=MATERIALS,
        camera=camera,
        film={"resolution": [size, size], **dict(film)},
        render={"max_path_length": 400, "roulette_length": NO_ROULETTE, **render},
    )


@pytest.mark.parametrize("kind", OBJECTS)
@pytest.mark.parametrize("material", ["mirror", "glass", "flint", "pane", "air"])
def test_smooth_objects_cannot_be_seen(kind, material):
    compiled = furnace([shape(kind, material, **OBJECTS[kind])])
    assert np.allclose(radiance(compiled, 8).mean, 1.0, rtol=1e-5)


@pytest.mark.parametrize("kind", OBJECTS)
def test_white_objects_cannot_be_seen(kind):
    """Two objects, with light between them, lit by next-event estimation and by chance."""
    floor = shape("rectangle", "white", corner=[-1, -1, -0.6], edges=[[2, 0, 0], [0, 2, 0]])
    compiled = furnace([floor, shape(kind, "white", **OBJECTS[kind])], roulette_length=4)
    assert_uniform(radiance(compiled, 64), 1, 4e-3)


def test_white_behind_what_is_not_there():
    """Shadow rays pass surfaces of type none, and paths do not spend edges on them."""
    shells = [shape("sphere", "air", center=[0, 0, 0], radius=r) for r in (0.85, 0.9, 0.95)]
    compiled = furnace([*shells, shape("sphere", "white", center=[0, 0, 0], radius=0.8)], max_path_length=2)
    assert_uniform(radiance(compiled, 64), 1, 4e-3)


def test_roulette_in_glass():
    """The n^2 inside is no reason to end fewer paths or more."""
    compiled = furnace([shape("box", "dense", **OBJECTS["box"])], roulette_length=2)
    assert_uniform(radiance(compiled, 64), 1, 4e-3)


OVERLAPS = {
    "ball in ball": [("glass", 0, 0.9), ("ice", 0.2, 0.5)],
    "bubble in ball": [("ice", 0, 0.9), ("glass", 0.3, 0.4)],
    "water overlaps glass": [("dense", 0, 0.8), ("water", 0.6, 0.7)],
    "three": [("water", 0, 0.9), ("dense", 0.1, 0.5), ("ice", 0.5, 0.7)],
    "dispersive in water": [("water", 0, 0.9), ("flint", 0.1, 0.5)],
}


@pytest.mark.parametrize("spheres", OVERLAPS.values(), ids=OVERLAPS)
def test_nested_dielectrics_cannot_be_seen(spheres):
    shapes = [shape("sphere", name, center=[x, 0, 0], radius=r) for name, x, r in spheres]
    compiled = furnace(shapes)
    assert np.allclose(radiance(compiled, 16).mean, 1.0, rtol=1e-5)


INSIDE = {
    "glass": ([("glass", 0.9)], 1.5),
    "glass in water": ([("water", 1.5), ("dense", 0.7)], 1.8),
    "water in glass": ([("dense", 1.5), ("ice", 0.7)], 1.8),  # the ice has the lower priority
}


@pytest.mark.parametrize(("spheres", "ior"), INSIDE.values(), ids=INSIDE)
def test_camera_in_glass_sees_more(spheres, ior):
    """n^2 of the medium that the camera is in; near the centre nothing is reflected totally for ever."""
    shapes = [shape("sphere", name, center=[0, 0, 0], radius=r) for name, r in spheres]
    compiled = furnace(shapes, look([0.05, -0.1, 0], [0, 1, 0.1], 90))
    assert np.allclose(radiance(compiled, 16).mean, ior**2, rtol=1e-5)


def test_lamp_in_glass():
    """A lamp of radiance 2 within glass is seen with (1 - F) 2 / n^2, beside what the surface reflects of the sky."""
    lamp = shape("rectangle", corner=[-2, -2, 0], edges=[[4, 0, 0], [0, 4, 0]], emission=2)
    block = shape("box", "glass", min=[-2.2, -2.2, -1], max=[2.2, 2.2, 0.5])
    compiled = furnace([lamp, block], look([0, 0, 2], [0, 0, 0], 0.01))
    face = (0.5 / 2.5) ** 2
    assert_uniform(radiance(compiled, 64), face + (1 - face) * 2 / 1.5**2, 2e-3)


@pytest.mark.parametrize("degrees", [0, 30, 60, 80])
@pytest.mark.parametrize("metal", ["Au", "Ag"])
def test_metal(degrees, metal):
    """Fresnel's reflectance of a complex index, written down another way."""
    eta, k = (table[0] for table in metal_table(metal, *MONOCHROME))
    n2 = (eta + 1j * k) ** 2
    cos = math.cos(math.radians(degrees))
    root = np.sqrt(n2 - (1 - cos**2))
    r_s, r_p = (cos - root) / (cos + root), (n2 * cos - root) / (n2 * cos + root)
    expected = 0.5 * (abs(r_s) ** 2 + abs(r_p) ** 2)
    image = plate({"type": "conductor", "metal": metal}, degrees)
    assert expected < 1
    assert np.allclose(radiance(image, 1).mean, expected, rtol=1e-5)


@pytest.mark.parametrize("degrees", [0, 40, 75])
@pytest.mark.parametrize("roughness", [0, 20, 60])
def test_rough_matte(roughness, degrees):
    """The integral of f cos by quadrature; it is below 1."""
    image = plate({"type": "oren-nayar", "reflectance": 0.9, "roughness": roughness}, degrees)
    expected = oren_nayar_albedo(0.9, math.radians(roughness), math.radians(degrees))
    assert expected < 0.95
    assert_uniform(radiance(image, 128), expected, 3e-3)


def plate(material, degrees):
    """A plate that fills the view, seen `degrees` from its normal."""
    angle = math.radians(degrees)
    eye = [0, -2 * math.sin(angle), 2 * math.cos(angle)]
    return scene(
        [SKY, shape("rectangle", "plate", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]]), *UNSEEN],
        materials={**MATERIALS, "plate": material},
        camera=look(eye, [0, 0, 0], 1e-3, **({"up": [0, 1, 0]} if degrees == 0 else {})),
        render={"max_path_length": 2},
    )


def oren_nayar_albedo(reflectance, sigma, angle):
    """Integral of f cos over the hemisphere, for light at `angle` from the normal."""
    materials = np.zeros(1, material_dtype).view(np.recarray)
    materials.roughness = sigma
    rho, wavelengths = Spectrum([reflectance]), Spectrum([550.0])
    nodes, weights = np.polynomial.legendre.leggauss(24)
    total = 0.0
    wo = vec3(math.sin(angle), 0.0, math.cos(angle))
    turns = (np.arange(64) + 0.5) / 64 * 2 * math.pi
    for z, weight in zip(0.5 + 0.5 * nodes, 0.5 * weights, strict=True):
        r = math.sqrt(1 - z * z)
        for turn in turns:
            wi = vec3(r * math.cos(turn), r * math.sin(turn), z)
            f = evaluate_oren_nayar(True, materials[0], rho, None, wavelengths, wo, wi)
            total += float(np.asarray(f)[0]) * z * weight * 2 * math.pi / 64
    return total


@pytest.mark.parametrize("wavelengths", ["independent", pytest.param("shared", marks=pytest.mark.slow)])
def test_white_light_through_dispersive_glass(wavelengths):
    """All wavelengths at once: whatever each of them does, what comes out is white in all three channels.

    The noise is that between seeds, since pixels may share their wavelengths.
    """
    prism = shape("box", "flint", **OBJECTS["box"])
    ball = shape("sphere", "flint", center=[0.7, 0.3, 0.6], radius=0.4)
    settings = {"wavelength_range": [380, 780], "wavelengths": wavelengths}
    compiled = furnace([prism, ball], **settings)
    scenes = [with_render(compiled, seed=seed) for seed in range(1, 17)]
    means = np.array([render(each, 64).film.rgb.mean(axis=(0, 1)) for each in scenes])
    white = compiled.spectra[:3].sum(axis=1, dtype=float)
    for channel in range(3):
        assert_sample_mean(means[:, channel], white[channel], 1e-2)
