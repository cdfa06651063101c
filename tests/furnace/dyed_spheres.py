"""A sphere seen from inside, with patches of several dyes: its radiance by linear algebra, and scenes of it.

Every point of a sphere sees every patch under the same form factor, the patch's share f_q of the sphere's area. So with
T_p, the matrix over wavelengths that says what patch p scatters, and H, what lamps bring to each of its points,

    L_p = T_p (sum_q F_pq L_q + H),    F_pq = f_q

(theory 3.10). The lamps are either black disks that span a cap each, which have the cap's form factor, so that H is
the sum of f E; or a black ball of radius a in the centre, which brings H = a^2 E and hides from each point the same
share a^2 of the wall, about the point opposite. Patches lie in opposite pairs, so that this is of the point's own
patch: F_pq = f_q - a^2 if q = p, but within 2 a of the edges of patches, where it may be of its neighbour. That
changes radiances by less than a^3, relative.

Patches are caps of other spheres, which meet the wall in the patch's edge and lie within GAP of it. Their areas, their
distances, and with them form factors, are those of the wall's caps but for about GAP, relative. What is behind a cap is
never lit, since nothing emits light there.

Wavelengths fill four bins of 1 nm. A set of four has one in each of them, and materials are constant in each: sums over
a set are exact, however many fluorescent events there are, and no noise comes from the choice of wavelengths.
"""

import math
from dataclasses import replace
from typing import NamedTuple
from unittest import mock

import numpy as np
from rendering import look, scene, shape
from spheres import BINS, CHANNELS, FIRST_NM, at, colors, pixel_means, visible_points

from artist_py.core.table import Table

GAP = 2e-4  # radii of the sphere
BALL = 0.05
DISK = math.pi / 16  # half angle of the caps of lamps
SHOWN = [1, 2, 3]  # bins that are the film's R, G and B: all but the one that excites most
PAINTS = {  # reflectance, and (absorption, emission, quantum yield) of the dyes: a cascade from bin 0 to bin 3
    "wall": (colors(0.4, 0.5, 0.4, 0.6, 0.5), [(colors(0.6, 0.3, 0, 0, 0), colors(0, 1, 3, 0, 0), 0.9)]),
    "polar": (colors(0.2, 0.3, 0.4, 0.5, 0.7), [(colors(0.1, 0.6, 0.4, 0, 0), colors(0, 0, 1, 3, 1), 0.95)]),
    "side": (
        colors(0.1, 0.2, 0.2, 0.1, 0.7),
        [
            (colors(0.5, 0.3, 0.1, 0, 0), colors(0, 0, 2, 0, 0), 0.8),
            (colors(0, 0.1, 0.6, 0.7, 0), colors(0, 0, 0, 1, 4), 1.0),
        ],
    ),
}
CAPS = {"polar": ([0, 0, 1], math.radians(60)), "side": ([1, 0, 0], math.radians(25))}
LAMPS = (colors(9, 6, 2, 0.5, 0.2), colors(3, 5, 1, 0.2, 1))
CENTRES = BINS + 0.5  # nm


class Patches(NamedTuple):
    """Form factors and matrices of the patches, in the order of `PAINTS`."""

    factors: np.ndarray  # F (patches, patches)
    scatter: np.ndarray  # T (patches, bins out, bins in)
    lamps: np.ndarray  # H (bins,)

    def orders(self, edges):
        """Radiance of the patches, (patches, bins), by paths of 2, 3, .. `edges` edges."""
        terms = [self.scatter @ self.lamps]
        for _ in range(edges - 2):
            terms.append(np.einsum("poi,pi->po", self.scatter, self.factors @ terms[-1]))
        return terms

    def radiance(self):
        """Radiance of the patches by all paths, (patches, bins)."""
        count, bins = self.scatter.shape[:2]
        once = np.einsum("poi,pq->poqi", self.scatter, self.factors).reshape(count * bins, -1)
        return np.linalg.solve(np.eye(count * bins) - once, self.orders(2)[0].ravel()).reshape(count, bins)


def matrix_of(paint):
    """T of a paint: what it reflects, and Q a(in) in e(out) / sum(e l) of each dye below the diagonal (theory 3.1)."""
    reflectance, dyes = PAINTS[paint]
    scatter = np.diag(at(reflectance))
    for absorption, emission, quantum_yield in dyes:
        photons = at(emission) @ CENTRES
        scatter += np.tril(np.outer(at(emission) / photons, quantum_yield * at(absorption) * CENTRES), -1)
    return scatter


def patches(*, disks):
    """`Patches` of the scene of `dyed_sphere`."""
    return patches_of(np.array([matrix_of(paint) for paint in PAINTS]), *map(at, LAMPS), disks=disks)


def patches_of(scatter, *lamps, disks):
    """`Patches` of the scene of `sphere_of`, from the matrices of its paints and the spectra of its lamps."""
    caps = [2 * share(angle) for _, angle in CAPS.values()]
    hidden = 0 if disks else BALL**2
    rest = 1 - sum(caps) - (2 * share(DISK) if disks else 0)
    factors = np.tile([rest, *caps], (len(PAINTS), 1)) - hidden * np.eye(len(PAINTS))
    # The ball is bright enough to bring what a ball as large as the sphere would bring.
    return Patches(factors, scatter, share(DISK) * (lamps[0] + lamps[1]) if disks else lamps[0])


def share(angle):
    """The share of a sphere's area in a cap of this half angle."""
    return 0.5 * (1 - math.cos(angle))


def dyed_sphere(*, disks=False, **render):
    """The `CompiledScene`, lit by two lamps on the wall (`disks`) or by one in the middle."""
    with mock.patch("artist_py.scene.compile.sensor_table", _sensor):
        compiled = sphere_of(
            {name: _material(*paint) for name, paint in PAINTS.items()},
            LAMPS,
            disks=disks,
            wavelength_range=[FIRST_NM, FIRST_NM + CHANNELS],
            **render,
        )
    return _with_even_wavelengths(compiled)


def sphere_of(materials, lamps, *, disks=False, **render):
    """The same of other materials, one for each name in `PAINTS`, and lamps."""
    shapes = [shape("sphere", "wall", center=[0, 0, 0], radius=1, reverse=True)]
    for paint, (axis, angle) in CAPS.items():
        shapes += [_cap(paint, side * np.array(axis), angle) for side in (1, -1)]
    return scene(
        shapes + (_disks(lamps) if disks else _ball(lamps[0])),
        materials=materials,
        camera=look([0.25, -0.7, -0.1], [1.25, -0.7, 0.3], 90),
        render={"sampler": "sobol", **render},
    )


def _sensor(first, last, observer):
    """Instead of the eye: R, G and B are the radiance in one bin each."""
    return np.eye(CHANNELS)[SHOWN]


def _material(reflectance, dyes):
    dyes = [{"absorption": a, "emission": e, "quantum_yield": q} for a, e, q in dyes]
    return {"type": "fluorescent", "reflectance": reflectance, "dyes": dyes}


def _cap(paint, axis, angle):
    """A sphere through the circle `angle` from `axis` on the wall, whose pole is GAP before that of the wall."""
    pole = 1 - GAP
    center = (pole**2 - 1) / (2 * (pole - math.cos(angle)))
    return shape("sphere", paint, center=list(center * axis), radius=pole - center, reverse=True)


def _disks(lamps):
    return [
        shape(
            "disk",
            center=[0, side * math.cos(DISK), 0],
            normal=[0, -side, 0],
            radius=math.sin(DISK),
            emission=lamp,
        )
        for side, lamp in zip((1, -1), lamps, strict=True)
    ]


def _ball(lamp):
    """And a lamp outside, whose light must not come in."""
    light = {"spectrum": lamp, "radiance": 1 / BALL**2}
    return [
        shape("sphere", center=[0, 0, 0], radius=BALL, emission=light),
        shape("sphere", center=[0.9] * 3, radius=1e-3, emission=light),
    ]


def _with_even_wavelengths(compiled):
    """The scene with one wavelength of each set, or of each path, in each bin."""
    nodes = np.linspace(FIRST_NM, FIRST_NM + CHANNELS, len(compiled.nodes))
    compiled.nodes[:] = nodes
    sets = (nodes,) * compiled.fluorescence.n_sets
    compiled.fluorescence = replace(compiled.fluorescence, set_nodes=sets)
    if compiled.scene.reemission is not None:
        even = compiled.scene.reemission._replace(nodes=Table(nodes))
        compiled.scene = compiled.scene._replace(reemission=even)
    return compiled


def visible_paints(compiled, subsamples=48):
    """Share of each pixel that each of `PAINTS` covers: (h, w, 3); see `visible_patches` of spheres.py."""
    points = visible_points(compiled, subsamples)
    covered = [
        pixel_means(np.abs(points @ np.array(axis)) > math.cos(angle), subsamples)
        for axis, angle in CAPS.values()
    ]
    return np.stack([1 - sum(covered), *covered], axis=-1)


def shown(radiance):
    """What the film shows of radiances (.., bins): (.., 3)."""
    return radiance[..., SHOWN]
