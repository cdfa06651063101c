"""Sampling of exact shapes against its density, and their areas against closed forms and fine meshes.

Statistical tests use fixed seeds; the probability that a correct program fails one by chance stands beside it.
"""

import math

import numpy as np
import pytest
from quadric_cases import EPSILON, all_kinds, off_surface, random_map, record
from scipy import stats

from artist_py.geometry.quadric_records import quadric_area
from artist_py.geometry.quadrics import CANONICAL_AREAS, pdf_quadric_area, sample_quadric
from artist_py.jit import kernel
from artist_py.scene.tables import CONE, CYLINDER, DISK, SPHERE


@kernel
def sample_all(quadrics, numbers, out):
    for i in range(len(numbers)):
        position, normal, pdf_area = sample_quadric(quadrics[0], numbers[i, 0], numbers[i, 1])
        again = pdf_quadric_area(quadrics[0], position)
        out[i, 0], out[i, 1], out[i, 2] = position.x, position.y, position.z
        out[i, 3], out[i, 4], out[i, 5] = normal.x, normal.y, normal.z
        out[i, 6], out[i, 7] = pdf_area, again


def compiled_samples(quadric, numbers):
    """Positions, normals, densities and the densities found again."""
    out = np.empty((len(numbers), 8))
    sample_all(np.array([quadric], quadric.dtype).view(np.recarray), numbers, out)
    return out[:, :3], out[:, 3:6], out[:, 6], out[:, 7]


# Of canonical points uniform by area: a second coordinate that is uniform in [0, 1], and the mean of (x², z, z²).
EQUAL_AREA = {
    SPHERE: lambda p: 0.5 * (p[:, 2] + 1.0),
    DISK: lambda p: p[:, 0] ** 2 + p[:, 1] ** 2,
    CYLINDER: lambda p: p[:, 2],
    CONE: lambda p: (1.0 - p[:, 2]) ** 2,
}
MOMENTS = {
    SPHERE: (1 / 3, 0, 1 / 3),
    DISK: (1 / 4, 0, 0),
    CYLINDER: (1 / 2, 1 / 2, 1 / 3),
    CONE: (1 / 4, 1 / 3, 1 / 6),
}


@all_kinds
def test_samples_are_uniform_in_the_canonical_frame(kind):
    """Chi-squared on 16 x 16 cells of equal area, and moments. False alarms: 4 x 0.001, and 4 x 5 x 6e-7 at 5 sigma."""
    rng = np.random.default_rng(9)
    matrix = random_map(rng)
    n = 20_000
    positions, _, _, _ = compiled_samples(record(kind, matrix), rng.random((n, 2)))
    p = np.linalg.solve(matrix[:, :3], (positions - matrix[:, 3]).T).T
    assert max(off_surface(kind, each) for each in p[:1000]) < 1e-13
    turn = np.arctan2(p[:, 1], p[:, 0]) / (2.0 * math.pi) + 0.5
    counts, _, _ = np.histogram2d(turn, EQUAL_AREA[kind](p), bins=16, range=[[0, 1 + 1e-12], [0, 1 + 1e-12]])
    assert counts.sum() == n
    assert stats.chisquare(counts.ravel()).pvalue > 0.001
    values = np.stack([p[:, 0], p[:, 1], p[:, 0] ** 2, p[:, 2], p[:, 2] ** 2])
    expected = np.array([0.0, 0.0, *MOMENTS[kind]])
    errors = values.std(axis=1) / math.sqrt(n)
    assert (np.abs(values.mean(axis=1) - expected) <= 5.0 * errors + 1e-15).all()


@all_kinds
def test_density_is_the_jacobian_of_sampling(kind):
    """1 / pdf_area = |dP/du x dP/dv|, by central differences, at every point; the normal is its direction."""
    rng = np.random.default_rng(10)
    step = 1e-5
    for _ in range(5):
        quadric = record(kind, random_map(rng))
        numbers = rng.uniform(0.01, 0.99, (200, 2))
        # The concentric map of the disk has creases on the diagonals.
        creases = np.abs(np.abs(numbers[:, 0] - 0.5) - np.abs(numbers[:, 1] - 0.5))
        numbers = numbers[creases > 10 * step]
        _, normals, pdf_area, again = compiled_samples(quadric, numbers)
        shifted = [
            compiled_samples(quadric, numbers + s * np.eye(2)[i])[0] for i in (0, 1) for s in (step, -step)
        ]
        along_u, along_v = (shifted[0] - shifted[1]) / (2 * step), (shifted[2] - shifted[3]) / (2 * step)
        across = np.cross(along_u, along_v)
        jacobian = np.linalg.norm(across, axis=1)
        assert np.allclose(pdf_area * jacobian, 1.0, rtol=1e-5)
        assert np.allclose(np.abs((across * normals).sum(axis=1)), jacobian, rtol=1e-9)
        assert np.allclose(pdf_area, again, rtol=1e-12)


@all_kinds
def test_mean_inverse_density_is_the_area(kind):
    """Monte Carlo area against `quadric_area`, 5 maps each. False alarms: 20 x 6e-7 at 5 sigma."""
    rng = np.random.default_rng(11)
    for _ in range(5):
        quadric = record(kind, random_map(rng))
        inverse = 1.0 / compiled_samples(quadric, rng.random((4_000, 2)))[2]
        area = quadric_area(quadric)
        assert abs(inverse.mean() - area) <= 5.0 * inverse.std() / math.sqrt(4_000) + 1e-13 * area


@all_kinds
def test_compiled_samples_are_the_plain_ones(kind):
    """Kernels and plain Python draw the same points."""
    rng = np.random.default_rng(12)
    quadric = record(kind, random_map(rng))
    numbers = np.vstack([rng.random((50, 2)), [[0.0, 0.0], [0.5, 0.5], [1.0 - EPSILON, 1.0 - EPSILON]]])
    for (u, v), position, normal, pdf_area, again in zip(
        numbers, *compiled_samples(quadric, numbers), strict=True
    ):
        plain = sample_quadric(quadric, u, v)
        assert np.allclose(np.array(plain[0]), position, rtol=1e-13, atol=1e-14)
        assert np.allclose(np.array(plain[1]), normal, rtol=1e-13, atol=1e-14)
        assert plain[2] == pytest.approx(pdf_area, rel=1e-13)
        if v > 0.0:  # at an apex the density has no limit
            assert pdf_quadric_area(quadric, plain[0]) == pytest.approx(again, rel=1e-12)


@all_kinds
def test_area_of_similar_shapes(kind):
    """Rotated and scaled, the canonical area grows with the square of the scale, to rounding."""
    rng = np.random.default_rng(14)
    for scale in (1e-5, 1.0, 37.0):
        rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        area = quadric_area(record(kind, np.column_stack([scale * rotation, rng.normal(size=3)])))
        assert area == pytest.approx(CANONICAL_AREAS[kind] * scale**2, rel=1e-14)


@pytest.mark.parametrize("c", [1e-3, 0.5, 2.0, 1e3])
def test_area_of_spheroids(c):
    """Semi-axes 1, 1, c against the elementary formulas for prolate and oblate spheroids."""
    e = math.sqrt(1.0 - min(c, 1.0 / c) ** 2)
    ring = c / e * math.asin(e) if c > 1.0 else c * c / e * math.atanh(e)
    assert quadric_area(record(SPHERE, np.diag([1.0, c, 1.0, 0.0])[:3])) == pytest.approx(
        2.0 * math.pi * (1.0 + ring), rel=1e-12
    )


@pytest.mark.parametrize("squeeze", [1.0, 0.3, 1e-2])
@pytest.mark.parametrize("kind", [DISK, CYLINDER, CONE], ids=["disk", "cylinder", "cone"])
def test_area_of_skewed_shapes_is_that_of_a_fine_mesh(kind, squeeze):
    """Against 400 000 facets inscribed, whose area is short by (pi / n)² / 6 or, seen edge on, little more."""
    matrix = random_map(np.random.default_rng(15)) @ np.diag([1.0, squeeze, 1.0, 1.0])
    x, y, z, _ = matrix.T
    angle = np.linspace(0.0, 2.0 * math.pi, 400_001)[:, None]
    circle = x * np.cos(angle) + y * np.sin(angle)
    edges = np.diff(circle, axis=0)
    rungs = {DISK: -circle[:-1], CYLINDER: 2.0 * z, CONE: z - circle[:-1]}[kind]
    mesh = 0.5 * np.linalg.norm(np.cross(edges, rungs), axis=1).sum()
    assert quadric_area(record(kind, matrix)) == pytest.approx(mesh, rel=1e-8)


def test_inverse_maps():
    """Records carry the map and its inverse; a singular map is refused."""
    matrix = random_map(np.random.default_rng(16), 1e-3, 10.0)
    quadric = record(SPHERE, matrix)
    both = np.vstack([quadric.object_to_world, [0, 0, 0, 1]]) @ np.vstack(
        [quadric.world_to_object, [0, 0, 0, 1]]
    )
    assert np.allclose(both, np.eye(4), atol=1e-11)
    with pytest.raises(np.linalg.LinAlgError):
        record(SPHERE, np.zeros((3, 4)))
