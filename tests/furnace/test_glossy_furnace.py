"""Plastic and Phong's lobe under a sky of radiance 1, and lit by a lamp whose light is known by quadrature.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 29.
"""

import math

import numpy as np
import pytest
from rendering import assert_uniform, look, radiance, scene, shape

from artist_py.bsdf.phong import lobe_albedo, scattering
from artist_py.core.fresnel import fresnel_dielectric
from artist_py.core.vector import Spectrum, vec3
from artist_py.scene.optics import diffuse_transmittance

SKY = shape("sphere", center=[0, 0, 0], radius=4, reverse=True, emission=1)
RHO, GLOSS, IOR = 0.6, 0.35, 1.5
LEAVING = diffuse_transmittance(IOR) / IOR**2  # share of diffuse light within plastic that leaves it
PLASTIC = {"type": "plastic", "reflectance": RHO}
WHITE_PLASTIC = {"type": "plastic", "reflectance": 1.0}
DARK_PLASTIC = {"type": "plastic", "reflectance": 0.0}
ANGLES = (0.0, 50.0, 80.0)  # degrees from the normal
LAMP_RADIUS = 0.8


def phong(exponent):
    return {"type": "phong", "reflectance": RHO, "specular": GLOSS, "exponent": exponent}


LIT = {"plastic": PLASTIC, "dark plastic": DARK_PLASTIC, "phong": phong(10), "sharp phong": phong(500)}
# One of each that nothing sees, so that all these scenes share their kernels.
UNSEEN = [
    shape("sphere", "phong", center=[6, 0, 0], radius=0.1),
    shape("sphere", "plastic", center=[6, 1, 0], radius=0.1),
]


def plate(material, degrees, light, **render):
    """A plate in the plane z = 0 that fills the view, seen `degrees` from its normal."""
    angle = math.radians(degrees)
    eye = [0, -2 * math.sin(angle), 2 * math.cos(angle)]
    return scene(
        [light, shape("rectangle", "plate", corner=[-1, -1, 0], edges=[[2, 0, 0], [0, 2, 0]]), *UNSEEN],
        materials={"phong": phong(10), "plastic": PLASTIC, "plate": material},
        camera=look(eye, [0, 0, 0], 1e-3),
        film={"resolution": [32, 32]},
        render={"max_path_length": 2, **render},
    )


class TestFurnace:
    """Under a uniform sky a surface shows its reflectance."""

    @pytest.mark.parametrize("degrees", ANGLES)
    @pytest.mark.parametrize(
        "material", [PLASTIC, WHITE_PLASTIC, DARK_PLASTIC], ids=["grey", "white", "dark"]
    )
    def test_plastic(self, material, degrees):
        rho, coat = material["reflectance"], fresnel_dielectric(math.cos(math.radians(degrees)), IOR)[0]
        expected = coat + (1 - coat) * rho * LEAVING / (1 - rho * (1 - LEAVING))
        assert_uniform(radiance(plate(material, degrees, SKY), 48), expected, 3e-3)

    @pytest.mark.parametrize("degrees", ANGLES)
    @pytest.mark.parametrize("exponent", [0, 10, 500])
    def test_phong(self, exponent, degrees):
        expected = RHO + GLOSS * lobe_albedo(math.cos(math.radians(degrees)), exponent)
        # The albedo's own quadrature is good to 3e-4.
        image = radiance(plate(phong(exponent), degrees, SKY), 48)
        assert_uniform(image, expected, 3e-3, rounding=3e-4)

    @pytest.mark.parametrize("kind", ["box", "sphere"])
    def test_white_plastic_cannot_be_seen(self, kind):
        """Two objects that exchange light, with no more than the roulette's noise."""
        keys = {
            "sphere": {"center": [0.1, 0, 0], "radius": 0.8},
            "box": {"min": [-0.6, -0.5, -0.4], "max": [0.4, 0.6, 0.7]},
        }[kind]
        floor = shape("rectangle", "white", corner=[-1, -1, -0.8], edges=[[2, 0, 0], [0, 2, 0]])
        compiled = scene(
            [SKY, floor, shape(kind, "white", **keys), *UNSEEN],
            materials={"phong": phong(10), "plastic": PLASTIC, "white": WHITE_PLASTIC},
            camera=look([1.2, -1.6, 0.7], [0, 0, 0], 60),
            render={"max_path_length": 400},
        )
        assert_uniform(radiance(compiled, 64), 1, 4e-3)


class TestLamp:
    """Emitter sampling and chance hits together bring what quadrature over the lamp brings."""

    @pytest.mark.parametrize("material", LIT.values(), ids=LIT)
    @pytest.mark.parametrize("aside", [0.0, 20.0])
    def test_direct_light(self, material, aside):
        """The lamp stands in the mirrored direction, or `aside` of it by some degrees; its edge is at 15.5."""
        degrees, distance = 50.0, 3.0
        angle = math.radians(degrees)
        wo = vec3(0, -math.sin(angle), math.cos(angle))
        turn = math.radians(degrees + aside)
        centre = np.array([0, math.sin(turn), math.cos(turn)]) * distance
        lamp = shape("sphere", center=centre, radius=LAMP_RADIUS, emission=1)
        expected = reflected(material, wo, centre / distance, LAMP_RADIUS / distance)
        assert_uniform(radiance(plate(material, degrees, lamp), 384), expected, 5e-3, rounding=1e-4)


def reflected(material, wo, axis, sine):
    """Radiance towards `wo` of light of radiance 1 from a cone of directions around `axis`."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    smallest = math.sqrt(1 - sine * sine)
    height = 1 - (0.5 + 0.5 * nodes) * (1 - smallest)
    turns = (np.arange(96) + 0.5) / 96 * 2 * math.pi
    z, turn = (each.ravel() for each in np.meshgrid(height, turns, indexing="ij"))
    r = np.sqrt(1 - z * z)
    across = np.array([1.0, 0.0, 0.0])
    other = np.cross(axis, across)
    w = np.outer(z, axis) + np.outer(r * np.cos(turn), across) + np.outer(r * np.sin(turn), other)
    area = np.repeat(0.5 * weights * (1 - smallest), len(turns)) * 2 * math.pi / len(turns)
    values = [scattered(material, wo, vec3(*wi)) * wi[2] for wi in w]
    mirror = vec3(-wo.x, -wo.y, wo.z)
    is_mirrored = float(np.asarray(mirror)[:3] @ axis) > smallest
    delta = coat(wo) if material["type"] == "plastic" and is_mirrored else 0.0
    return float(np.sum(np.array(values) * area)) + delta


def coat(w):
    return fresnel_dielectric(w.z, IOR)[0]


def scattered(material, wo, wi):
    """f of the part without delta, by formulas of its own for plastic."""
    if material["type"] == "phong":
        rho, k = Spectrum([RHO]), Spectrum([GLOSS])
        return float(np.asarray(scattering(rho, k, material["exponent"], wo, wi))[0])
    rho = material["reflectance"]
    return (1 - coat(wo)) * (1 - coat(wi)) * rho / (math.pi * IOR**2 * (1 - rho * (1 - LEAVING)))
