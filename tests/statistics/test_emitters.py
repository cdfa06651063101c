"""Every kind of emitter: the points it is sampled at, against the density that `pdf_emitter` states for them.

Points are compared by area on the emitter, with parametrisations of their own, so that the factor from area to solid
angle is tested as well. Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared,
Sidak over its cases).
"""

import numpy as np
import pytest
from chi_squared import SAMPLES, ChiSquaredTest, Domain, constant, triangle_from_unit, triangle_to_unit, turns
from rendering import scene, shape

from artist_py.core.table import Table
from artist_py.core.vector import Vec3, vec3
from artist_py.emitters.dispatch import pdf_emitter, sample_emitter
from artist_py.jit import kernel


@kernel
def sample_rows(scene, reference, numbers, out):
    """Rows of position, normal, density per solid angle without and with the choice of the emitter."""
    for i in range(numbers.shape[0]):
        emitter = scene.emitters.records[0]
        point = sample_emitter(scene, emitter, reference, numbers[i, 0], numbers[i, 1])
        p, n = point.position, point.normal
        out[i, 0], out[i, 1], out[i, 2] = p.x, p.y, p.z
        out[i, 3], out[i, 4], out[i, 5] = n.x, n.y, n.z
        out[i, 6] = point.pdf_solid_angle
        out[i, 7] = pdf_emitter(scene, emitter, reference, p, n)


@kernel
def density_rows(scene, reference, points, normals, out):
    for i in range(points.shape[0]):
        p = vec3(points[i, 0], points[i, 1], points[i, 2])
        n = vec3(normals[i, 0], normals[i, 1], normals[i, 2])
        out[i] = pdf_emitter(scene, scene.emitters.records[0], reference, p, n)


# --- emitters, and their surfaces parametrised by the unit square -------------------------------------------------

SKEW = np.array([[0.5, 0.2, 0.0, 0.3], [-0.1, 0.3, 0.4, 0.0], [0.0, 0.1, 0.7, 0.2], [0, 0, 0, 1]])
CANONICAL = {
    "sphere": (
        shape("sphere", center=[0, 0, 0], radius=1),
        lambda h: (np.sqrt(1 - (2 * h - 1) ** 2), 2 * h - 1),
    ),
    "disk": (shape("disk", center=[0, 0, 0], normal=[0, 0, 1], radius=1), lambda h: (np.sqrt(h), 0 * h)),
    "tube": (
        shape("cylinder", base=[0, 0, 0], top=[0, 0, 1], radius=1, caps=False),
        lambda h: (1 + 0 * h, h),
    ),
    "cone": (
        shape("cone", base=[0, 0, 0], apex=[0, 0, 1], radius=1, cap=False),
        lambda h: (np.sqrt(h), 1 - np.sqrt(h)),
    ),
}
HEIGHTS = {
    "sphere": lambda p: 0.5 * (p[:, 2] + 1),
    "disk": lambda p: p[:, 0] ** 2 + p[:, 1] ** 2,
    "tube": lambda p: p[:, 2],
    "cone": lambda p: (1 - p[:, 2]) ** 2,
}


class Case:
    """An emitter alone in its scene, seen from `reference`, in render space; `domain` parametrises its surface."""

    def __init__(self, table, domain, reference):
        self.compiled = scene([{**table, "emission": 1}, *CORNERS])
        space = self.compiled.space
        self.to_render = lambda p: space.scale * (np.asarray(p) - space.centre)
        self.to_world = lambda p: p / space.scale + space.centre
        self.reference, self.domain = self.to_render(reference), domain

    def rows(self, numbers):
        """Positions, normals and both densities, in render space."""
        out = np.empty((len(numbers), 8))
        sample_rows(self.compiled.scene, Vec3(self.reference), Table(numbers), Table(out))
        return out

    def sample(self, numbers):
        out = self.rows(numbers)
        return np.where(out[:, 6:7] > 0, self.to_world(out[:, :3]), np.nan)

    def density(self, points):
        """Per area of the world: the density per solid angle, times cos / d^2 where the front is seen."""
        step = 1e-6
        unit = self.domain.to_unit(points)
        low, high = np.clip(unit - step, 0, 1), np.clip(unit + step, 0, 1)
        along = [
            self.domain.from_unit(np.column_stack([high[:, 0], unit[:, 1]]))
            - self.domain.from_unit(np.column_stack([low[:, 0], unit[:, 1]])),
            self.domain.from_unit(np.column_stack([unit[:, 0], unit[:, 1] + step]))
            - self.domain.from_unit(np.column_stack([unit[:, 0], unit[:, 1] - step])),
        ]
        normals = np.cross(*along)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        out = np.empty(len(points))
        arguments = self.compiled.scene, Vec3(self.reference)
        density_rows(*arguments, Table(self.to_render(points)), Table(normals), Table(out))
        towards = points - self.to_world(self.reference)
        distance = np.linalg.norm(towards, axis=1)
        cosine = (normals * towards).sum(axis=1) / distance
        return out * self.seen(cosine) / distance**2

    def seen(self, cosine):
        """Emitters are sampled by area on both sides, but spheres on the side that is seen only."""
        return np.abs(cosine)


class SphereCase(Case):
    """From outside only the nearer cap is sampled."""

    def __init__(self, table, domain, reference, is_inside=False):
        super().__init__(table, domain, reference)
        self.is_inside = is_inside

    def seen(self, cosine):
        return np.abs(cosine) if self.is_inside else np.maximum(-np.abs(cosine) * self.outwards, 0.0)

    def density(self, points):
        centre = self.domain.from_unit(np.array([[0.0, 0.0], [1.0, 0.0]])).mean(axis=0)
        towards = points - self.to_world(self.reference)
        self.outwards = np.sign(((points - centre) * towards).sum(axis=1))
        return super().density(points)


# Nothing but the size of the scene, and with it of render space.
CORNERS = [shape("sphere", center=c, radius=1e-3, emission=0) for c in ([-3, -3, -3], [3, 3, 3])]


def parallelogram(corner, a, b):
    corner, edges = np.array(corner, float), np.array([a, b], float)
    area = np.linalg.norm(np.cross(a, b))
    solve = np.linalg.pinv(edges)
    return Domain(lambda u: corner + u @ edges, lambda p: (p - corner) @ solve, constant(area))


def triangle(corners):
    corner, edges = corners[0], corners[1:] - corners[0]
    solve = np.linalg.pinv(edges)
    area = 0.5 * np.linalg.norm(np.cross(*edges))
    return Domain(
        lambda u: corner + triangle_from_unit(u) @ edges,
        lambda p: triangle_to_unit((p - corner) @ solve),
        constant(area),
    )


def quadric(kind, matrix):
    """The canonical shape under a map; the measure is the length of the normal of the mapped tangents."""
    profile, height = CANONICAL[kind][1], HEIGHTS[kind]
    linear, shift = matrix[:3, :3], matrix[:3, 3]

    def from_unit(unit):
        r, z = profile(unit[:, 0])
        turn = 2 * np.pi * unit[:, 1]
        return np.column_stack([r * np.cos(turn), r * np.sin(turn), z]) @ linear.T + shift

    def to_unit(points):
        p = (points - shift) @ np.linalg.inv(linear).T
        return np.column_stack([height(p), turns(p)])

    def measure(unit):
        r, _ = profile(unit[:, 0])
        turn, slope = 2 * np.pi * unit[:, 1], SLOPES[kind](unit[:, 0])
        c, s = np.cos(turn), np.sin(turn)
        along = np.column_stack([slope[0] * c, slope[0] * s, slope[1]]) @ linear.T
        around = 2 * np.pi * np.column_stack([-r * s, r * c, 0 * r]) @ linear.T
        return np.linalg.norm(np.cross(along, around), axis=1)

    return Domain(from_unit, to_unit, measure)


# Derivatives of the profiles (r, z) by the height.
SLOPES = {
    "sphere": lambda h: (-(2 * h - 1) * 2 / np.sqrt(1 - (2 * h - 1) ** 2), 2 + 0 * h),
    "disk": lambda h: (0.5 / np.sqrt(h), 0 * h),
    "tube": lambda h: (0 * h, 1 + 0 * h),
    "cone": lambda h: (0.5 / np.sqrt(h), -0.5 / np.sqrt(h)),
}


def quadric_case(kind, matrix, reference, cls=Case, **more):
    table = {**CANONICAL[kind][0], "transform": [{"matrix": matrix}]}
    return cls(table, quadric(kind, matrix), reference, **more)


def sphere_case(radius, reference, **more):
    matrix = np.diag([radius, radius, radius, 1.0])
    matrix[:3, 3] = 0.5, -0.3, 0.2
    return quadric_case("sphere", matrix, reference, SphereCase, **more)


def parallelogram_case(reference):
    corner, a, b = [-0.5, 0.2, 1.0], [1.5, 0, 0.3], [0.2, 0.7, -0.4]
    return Case(shape("rectangle", corner=corner, edges=[a, b]), parallelogram(corner, a, b), reference)


def triangle_case(folder, reference):
    corners = np.array([[0.5, 0.25, 1.0], [-0.5, 0.5, 0.75], [0.25, -1.0, 1.5]])
    head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    rows = "".join(" ".join(map(repr, corner)) + "\n" for corner in corners.tolist())
    (folder / "triangle.ply").write_text(head + rows + "3 0 1 2\n", encoding="utf-8")
    return Case(shape("mesh", file=str(folder / "triangle.ply")), triangle(corners), reference)


def make_cases(folder):
    return {
        "triangle": triangle_case(folder, [0.3, -0.4, 0.1]),
        "rectangle": parallelogram_case([0.3, -0.4, 0.1]),
        "rectangle from near": parallelogram_case([0.3, 0.5, 1.1]),
        "sphere from afar": sphere_case(0.5, [2, 2, -1]),
        "sphere from near": sphere_case(1.5, [0.5, 1.6, 0.2]),
        "small sphere": sphere_case(0.01, [0.5, 1, 0.2]),
        "sphere from within": sphere_case(1.5, [0.4, 0.3, 0.5], is_inside=True),
        "ellipsoid": quadric_case("sphere", SKEW, [1, -2, 0.5]),
        "disk": quadric_case("disk", SKEW, [0.2, 0.4, 1]),
        "tube": quadric_case("tube", SKEW, [-1, 1, 0.5]),
        "cone": quadric_case("cone", SKEW, [1, 1, 1]),
    }


NAMES = (
    "triangle",
    "rectangle",
    "rectangle from near",
    "sphere from afar",
    "sphere from near",
    "small sphere",
    "sphere from within",
    "ellipsoid",
    "disk",
    "tube",
    "cone",
)


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    return make_cases(tmp_path_factory.mktemp("meshes"))


@pytest.mark.parametrize("name", NAMES)
def test_points_follow_their_density(cases, name):
    case = cases[name]
    test = ChiSquaredTest(
        case.sample, case.density, case.domain, samples=SAMPLES // 4, bins=(16, 24), order=16
    )
    test.assert_passes(len(NAMES))


@pytest.mark.parametrize("name", NAMES)
def test_sampled_and_stated_densities_agree(cases, name):
    """At the points sampled: the factor between them is the probability of choosing the emitter, here 1."""
    rows = cases[name].rows(np.random.default_rng(2).random((200, 2)))
    assert np.allclose(rows[:, 7], rows[:, 6], rtol=1e-9)
    assert np.allclose(np.linalg.norm(rows[:, 3:6], axis=1), 1, rtol=1e-12)
