"""Materials, directions and compiled loops that the tests of BSDFs share."""

import math

import numba
import numpy as np

from artist_py.bsdf.dispatch import (
    evaluate_bsdf,
    pdf_bsdf,
    sample_bsdf,
)
from artist_py.bsdf.reflectance import reflectance_at
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, Vec3, lane, vec3
from artist_py.jit import kernel
from artist_py.scene.optics import diffuse_transmittance
from artist_py.scene.tables import (
    CONDUCTOR,
    DIELECTRIC,
    DIFFUSE,
    MIRROR,
    OREN_NAYAR,
    PASS_THROUGH,
    PHONG,
    PLASTIC,
    THIN_DIELECTRIC,
    Needs,
    Spectra,
    material_dtype,
)

ALL = Needs(
    diffuse=True,
    oren_nayar=True,
    phong=True,
    plastic=True,
    mirror=True,
    conductor=True,
    dielectric=True,
    thin_dielectric=True,
    pass_through=True,
    dispersion=True,
    one_sided=True,
)
LANES = 4
WAVELENGTHS = Spectrum([450.0, 500.0, 600.0, 700.0])
COLOUR, WHITE, GOLD_ETA, GOLD_K, GLASS, GLOSS, BLACK = range(7)
RESOLVED = np.array(
    [
        [0.2, 0.5, 0.8, 0.95],
        [1.0, 1.0, 1.0, 1.0],
        [1.516, 0.887, 0.241, 0.152],  # gold, Yakubovsky et al. 2017
        [1.961, 1.898, 3.233, 4.277],
        [1.56, 1.54, 1.52, 1.50],
        [0.8, 0.4, 0.1, 0.05],  # with COLOUR at most 1
        [0.0, 0.0, 0.0, 0.0],
    ],
    np.float32,
)
SPECTRA = Spectra(Table(RESOLVED), None, 0.0)
DELTA = (MIRROR, CONDUCTOR, DIELECTRIC, THIN_DIELECTRIC, PASS_THROUGH)
REFLECTIVE = (DIFFUSE, OREN_NAYAR, PHONG, PLASTIC, MIRROR, CONDUCTOR)
# Plain Python, which measures coverage, cannot afford as many.
STRATA = 1_000 if numba.config.DISABLE_JIT else 100_000
ALBEDO_BINS = 12 if numba.config.DISABLE_JIT else 96
# Of integrals over directions: the kink of Fujii's form at s = 0 limits the rule at grazing angles.
ALBEDO_TOLERANCE = 0.05 / ALBEDO_BINS


def materials(
    kind, reflectance=COLOUR, *, roughness=30.0, specular=GLOSS, exponent=40.0, ior=1.5, is_dispersive=0, two_sided=1
):  # fmt: skip
    """A table of one material; roughness in degrees."""
    table = np.zeros(1, material_dtype).view(np.recarray)
    table.kind, table.reflectance, table.roughness, table.ior = (
        kind,
        reflectance,
        math.radians(roughness),
        ior,
    )
    table.is_dispersive, table.two_sided = is_dispersive, two_sided
    table.specular, table.exponent, table.absorption = specular, exponent, GOLD_K
    table.transmittance = diffuse_transmittance(ior) if kind == PLASTIC else 0.0
    table.eta = GOLD_ETA if kind == CONDUCTOR else GLASS
    return Table(table)


def direction(degrees, azimuth=0.7):
    """Unit direction at an angle from the normal."""
    sine = math.sin(math.radians(degrees))
    return Vec3((sine * math.cos(azimuth), sine * math.sin(azimuth), math.cos(math.radians(degrees))))


def reflectance_of(table, spectra=SPECTRA):
    """Reflectance of the material, a Spectrum."""
    return reflectance_at(None, table[0], spectra, WAVELENGTHS, 0.0, 0.0)


def ones():
    """The ratio of theory (2.6) at the start of a path."""
    return Spectrum(np.ones(LANES))


def sample(table, wo, numbers, *, ratio=None, ior_outside=1.0, light_walk=None):
    """`sample_bsdf` as plain Python."""
    u, v, w = numbers
    reflectance = reflectance_of(table)
    return sample_bsdf(
        ALL, table[0], reflectance, SPECTRA, WAVELENGTHS, wo, u, v, w, ratio, ior_outside, light_walk
    )


def evaluate(table, wo, wi):
    """f as plain Python, (C,)."""
    return evaluate_bsdf(ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, wi).values


def density(table, wo, wi):
    """`pdf_bsdf` as plain Python, sr^-1."""
    return pdf_bsdf(ALL, table[0], reflectance_of(table), SPECTRA, WAVELENGTHS, wo, wi)


def random_directions(rng, count):
    w = rng.normal(size=(count, 3))
    return w / np.linalg.norm(w, axis=1, keepdims=True)


@kernel
def evaluate_rows(needs, materials, spectra, wavelengths, wo, directions, f, pdf):
    reflectance = reflectance_at(None, materials[0], spectra, wavelengths, 0.0, 0.0)
    for i in range(len(directions)):
        wi = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        value = evaluate_bsdf(needs, materials[0], reflectance, spectra, wavelengths, wo, wi)
        for j in range(LANES):
            f[i, j] = lane(value, j)
        pdf[i] = pdf_bsdf(needs, materials[0], reflectance, spectra, wavelengths, wo, wi)


def evaluated(table, wo, directions):
    """f (n, C) and pdf (n,), compiled."""
    f, pdf = np.empty((len(directions), LANES)), np.empty(len(directions))
    evaluate_rows(ALL, table, SPECTRA, WAVELENGTHS, wo, directions, f, pdf)
    return f, pdf


sample_dtype = np.dtype(
    [
        ("wi", "f8", 3),
        ("weight", "f4", LANES),
        ("ratio", "f4", LANES),
        ("pdf", "f8"),
        ("pdf_rev", "f8"),
        ("eta", "f8"),
        ("is_delta", "i4"),
    ]
)


@kernel
def sample_rows(needs, materials, spectra, wavelengths, wo, numbers, ratio, ior_outside, light_walk, out):
    reflectance = reflectance_at(None, materials[0], spectra, wavelengths, 0.0, 0.0)
    for i in range(len(numbers)):
        u, v, w = numbers[i, 0], numbers[i, 1], numbers[i, 2]
        s = sample_bsdf(
            needs,
            materials[0],
            reflectance,
            spectra,
            wavelengths,
            wo,
            u,
            v,
            w,
            ratio,
            ior_outside,
            light_walk,
        )
        row = out[i]
        row.wi[0], row.wi[1], row.wi[2] = s.wi.x, s.wi.y, s.wi.z
        row.pdf, row.pdf_rev, row.eta, row.is_delta = s.pdf, s.pdf_rev, s.eta, s.is_delta
        for j in range(LANES):
            row.weight[j], row.ratio[j] = lane(s.weight, j), lane(s.ratio, j)


def sampled(table, wo, numbers, *, ratio=None, ior_outside=1.0, light_walk=None):
    """Samples for each row of numbers, compiled."""
    out = np.zeros(len(numbers), sample_dtype).view(np.recarray)
    ratio = ones() if ratio is None else ratio
    sample_rows(ALL, table, SPECTRA, WAVELENGTHS, wo, numbers, ratio, ior_outside, light_walk, out)
    return out


def strata(count=STRATA):
    """Numbers whose third column visits the middles of `count` equal parts of [0, 1)."""
    numbers = np.full((count, 3), 0.5)
    numbers[:, 2] = (np.arange(count) + 0.5) / count
    return numbers


def albedo(table, wo):
    """Integral of f |cos| over both sides, (C,); Gauss and Legendre's rule in cosine, squared towards grazing."""
    nodes, weights = np.polynomial.legendre.leggauss(ALBEDO_BINS)
    root = 0.5 * (nodes + 1.0)
    cosine, width = root * root, weights * root
    angle = (np.arange(2 * ALBEDO_BINS) + 0.5) * math.pi / ALBEDO_BINS
    total = 0.0
    for side in (1.0, -1.0):
        z, phi = (each.ravel() for each in np.meshgrid(side * cosine, angle, indexing="ij"))
        sine = np.sqrt(1.0 - z * z)
        f, _ = evaluated(table, wo, np.column_stack([sine * np.cos(phi), sine * np.sin(phi), z]))
        area = np.repeat(width, len(angle)) * math.pi / ALBEDO_BINS
        total = total + (f * (np.abs(z) * area)[:, None]).sum(0)
    return total
