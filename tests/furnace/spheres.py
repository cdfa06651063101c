"""A diffuse sphere seen from inside, with patches: its radiance in closed form, and scenes of it.

Every point of a sphere sees every patch under the same form factor, the patch's share of the sphere's area. So the
mean radiance M of a sphere with patches p of shares f_p, emission E_p and reflectance rho_p obeys a linear equation,

    M = sum_p f_p (E_p + rho_p (M + H)),    L_p = E_p + rho_p (M + H),

with pi H the irradiance by a point of intensity I in the centre, H = I / (pi R^2). All quantities are spectral. A black
disk that spans a cap has the cap's form factor: it is the patch of a lamp.

A merge leaves out photons that came from below the horizon of the point that they are merged with. In a sphere these
come from the cap of the points that are nearer than the photon; within a merge radius of r that is r^2 / (8 R^2) of all
photons but those of the point in the centre.
"""

import math
from typing import NamedTuple

import numpy as np
from rendering import look, scene, shape

from artist_py.core.table import Table

RADIUS = 1.0
FIRST_NM, CHANNELS = 550, 4
BINS = np.arange(FIRST_NM, FIRST_NM + CHANNELS)


def colors(*values):
    """A spectrum that differs from bin to bin of 1 nm: straight lines between the values at their edges."""
    return {"wavelengths": [*range(FIRST_NM, FIRST_NM + CHANNELS + 1)], "values": values}


DARK = colors(0.25, 0.35, 0.45, 0.5, 0.4)
LIGHT = colors(0.7, 0.6, 0.55, 0.65, 0.7)
GLOW = colors(0.4, 0.2, 0.1, 0.3, 0.2)
LAMP = colors(1.0, 3.0, 6.0, 2.0, 1.0)
OTHER_LAMP = colors(5.0, 1.0, 1.0, 4.0, 2.0)
POINT = colors(0.6, 0.4, 1.2, 0.8, 0.4)
MATERIALS = {"paint": {"type": "diffuse", "reflectance": {"checkerboard": [DARK, LIGHT], "repeat": [8, 16]}}}
CAP = math.pi / 16  # half angle of the lamps: a whole row of squares each, so that both paints lose the same


class Patches(NamedTuple):
    """The sphere as a table of patches: shares of the area, and spectra (patches); `extra` is H."""

    share: np.ndarray
    emission: np.ndarray
    reflectance: np.ndarray
    extra: np.ndarray

    def mean(self):
        """M, (bins,)."""
        gain = self.share @ self.reflectance
        return (self.share @ (self.emission + self.reflectance * self.extra)) / (1 - gain)

    def radiance(self, edges=None, lost=0.0):
        """Radiance of the patches by paths of up to `edges` edges; (patches).

        `lost` is the share of M that a first merge leaves out.
        """
        if edges is not None:
            return sum(self.orders(edges))
        return self.emission + self.reflectance * ((1 - lost) * self.mean() + self.extra)

    def orders(self, edges):
        """Radiance of the patches by paths of 1, 2, ... `edges` edges."""
        terms = [self.emission]
        for _ in range(edges - 1):
            incoming = self.share @ terms[-1] + (self.extra if len(terms) == 1 else 0.0)
            terms.append(self.reflectance * incoming)
        return terms


def at(spectrum):
    """A spectrum of this module on bins of 1 nm, (CHANNELS,): means of straight lines."""
    return np.interp(BINS + 0.5, spectrum["wavelengths"], spectrum["values"])


def patches(*, lamps):
    """`Patches` of the scene of `sphere`: dark and light paint, and with `lamps` the two lamps."""
    paint = np.stack([at(DARK), at(LIGHT)])
    glow = np.stack([at(GLOW)] * 2)
    if not lamps:
        return Patches(np.array([0.5, 0.5]), glow, paint, at(POINT) / (math.pi * RADIUS**2))
    cap = 0.5 * (1 - math.cos(CAP))
    share = np.array([0.5 - cap, 0.5 - cap, cap, cap])
    emission = np.concatenate([glow, [at(LAMP), at(OTHER_LAMP)]])
    return Patches(share, emission, np.concatenate([paint, 0 * paint]), np.zeros(CHANNELS))


def sphere(*, lamps, scale=1.0, size=16, lamp_radius=None, **render):
    """The `CompiledScene`: the sphere with either two lamps at its poles or a point that emits in its centre.

    Instead of the point there may be a ball of `lamp_radius`, in radii of the sphere, which lights it as the point
    does; the camera does not see its light.
    """
    # Tiny dark things outside, so that both kinds of scene share their kernels.
    place = {"center": [0.9 * scale] * 3, "normal": [0, 0, 1]}
    shapes = [shape("disk", **place, radius=1e-3 * scale, emission={"spectrum": 0, "visible": False})]
    emitters = [{"type": "point", "position": [0.9 * scale] * 3, "spectrum": 0}]
    shapes.append(
        shape("sphere", "paint", center=[0, 0, 0], radius=RADIUS * scale, reverse=True, emission=GLOW)
    )
    if lamps:
        for side, emission in ((1, LAMP), (-1, OTHER_LAMP)):
            place = {"center": [0, 0, side * scale * math.cos(CAP)], "normal": [0, 0, -side]}
            shapes.append(shape("disk", **place, radius=scale * math.sin(CAP), emission=emission))
    elif lamp_radius is not None:
        # The irradiance pi L a^2 / R^2 is that of the point, I / R^2.
        glow = {"spectrum": POINT, "radiance": 1 / (math.pi * lamp_radius**2), "visible": False}
        shapes.append(shape("sphere", center=[0, 0, 0], radius=lamp_radius * scale, emission=glow))
    else:
        # Radiance does not change with the size of a sphere if the intensity grows with its square.
        emitters.append({"type": "point", "position": [0, 0, 0], "spectrum": POINT, "intensity": scale**2})
    compiled = scene(
        shapes,
        emitters=emitters,
        materials=MATERIALS,
        camera=look([0.1 * scale, -0.6 * scale, 0.05 * scale], [0.2 * scale, scale, 0], 70),
        film={"resolution": [size, size]},
        render={
            "wavelength_range": [FIRST_NM, FIRST_NM + CHANNELS],
            "wavelengths": "shared",
            "sampler": "sobol",
            **render,
        },
    )
    return with_channels(compiled)


def with_channels(compiled):
    """The scene with one wavelength in each bin, the first three of them shown as R, G and B: no noise of colour."""
    spectra = compiled.spectra
    spectra[:3] = np.eye(CHANNELS)[:3]
    compiled.nodes[:] = np.linspace(FIRST_NM, FIRST_NM + CHANNELS, len(compiled.nodes))
    compiled.scene = compiled.scene._replace(spectra=compiled.scene.spectra._replace(dense=Table(spectra)))
    return compiled


def visible_patches(compiled, subsamples=48):
    """Share of each pixel that the dark and the light paint cover: (h, w, 2), by rays through a grid.

    Where a square begins is exact; only the shares of pixels that an edge crosses are rounded, to 1 / subsamples.
    """
    hit = visible_points(compiled, subsamples)
    u = np.arctan2(hit[..., 1], hit[..., 0]) / (2 * math.pi) % 1.0
    v = np.arccos(np.clip(-hit[..., 2], -1, 1)) / math.pi
    light = pixel_means((np.floor(u * 8) + np.floor(v * 16)) % 2, subsamples)
    return np.stack([1 - light, light], axis=-1)


def visible_points(compiled, subsamples):
    """Where rays through `subsamples` x `subsamples` points of each pixel meet the sphere, in radii of the sphere.

    (h subsamples, w subsamples, 3); the sphere is the first shape of a material.
    """
    height, width = compiled.graph.film.resolution[::-1]
    camera = compiled.graph.camera
    x, y = np.meshgrid(*((np.arange(n * subsamples) + 0.5) / subsamples for n in (width, height)))
    origin = np.array(camera.position, float)
    forward = np.subtract(camera.look_at, origin)
    right = np.cross(forward, camera.up)
    up = np.cross(right, forward)
    forward, right, up = (axis / np.linalg.norm(axis) for axis in (forward, right, up))
    reach = math.tan(math.radians(0.5 * camera.field_of_view)) / min(width, height)
    aside, above = reach * (2 * x - width)[..., None], reach * (height - 2 * y)[..., None]
    direction = forward + aside * right + above * up
    direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    radius = next(each for each in compiled.graph.shapes if each.material).radius
    along = direction @ origin
    reached = np.sqrt(along**2 - origin @ origin + radius**2) - along
    return (origin + direction * reached[..., None]) / radius


def pixel_means(values, subsamples):
    """Means over the pixels of values at `visible_points`, (h, w)."""
    height, width = (n // subsamples for n in values.shape)
    return values.reshape(height, subsamples, width, subsamples).mean(axis=(1, 3))
