"""Emitters without a surface: directions of environments and suns, and the starts of light subpaths, against densities.

Fixed seeds; a correct program fails this file by chance with probability 0.01 (chi-squared, Sidak over its cases).
"""

import math

import numpy as np
import pytest
from chi_squared import SPHERE, ChiSquaredTest, Domain, cap, constant, disk_from_unit, turns
from rendering import MONOCHROME, compile_tables, diffuse, look, shape

from artist_py.core.table import Table
from artist_py.core.vector import Vec3, vec3
from artist_py.emitters.dispatch import pdf_emitter, sample_emitter
from artist_py.emitters.emission import (
    emission_over_next_event,
    next_event_over_emission,
    pdf_emission_of_background,
    sample_emission,
)
from artist_py.emitters.environment import bilinear
from artist_py.jit import kernel
from artist_py.scene.images import cell_means, solid_angles

CASES = 5
KINDS = ("point", "spot", "directional", "sun", "environment", "image")
TURN = [{"rotate": [1, 2, 3, 50]}]


@kernel
def towards_rows(scene, row, reference, numbers, out):
    """Rows of the direction to the sampled point and its density, sampled and stated."""
    emitter = scene.emitters.records[row]
    for i in range(numbers.shape[0]):
        point = sample_emitter(scene, emitter, reference, numbers[i, 0], numbers[i, 1])
        w = -point.normal
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = w.x, w.y, w.z, point.pdf_solid_angle
        out[i, 4] = pdf_emitter(scene, emitter, reference, point.position, point.normal)


@kernel
def density_rows(scene, row, directions, out):
    emitter = scene.emitters.records[row]
    zero = vec3(0.0, 0.0, 0.0)
    for i in range(directions.shape[0]):
        w = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        out[i] = pdf_emitter(scene, emitter, zero, zero, -w)


@kernel
def emission_rows(scene, row, numbers, out):
    """Rows of position, direction, density; and of the ratios of densities both ways round, at a vertex hit."""
    emitter = scene.emitters.records[row]
    for i in range(numbers.shape[0]):
        start = sample_emission(scene, emitter, numbers[i, 0], numbers[i, 1], numbers[i, 2], numbers[i, 3])
        p, w = start.position, start.direction
        out[i, 0], out[i, 1], out[i, 2] = p.x, p.y, p.z
        out[i, 3], out[i, 4], out[i, 5] = w.x, w.y, w.z
        out[i, 6] = start.density
        vertex = p + w * 0.7
        out[i, 7] = next_event_over_emission(scene, emitter, start, vertex)
        point = sample_emitter(scene, emitter, vertex, numbers[i, 2], numbers[i, 3])
        light = point.pdf_solid_angle * emitter.pdf_select
        out[i, 8] = emission_over_next_event(scene, emitter, point, point.position - vertex, light)
        out[i, 9] = pdf_emission_of_background(scene, emitter, -w)


@kernel
def image_rows(scene, directions, out):
    for i in range(directions.shape[0]):
        w = vec3(directions[i, 0], directions[i, 1], directions[i, 2])
        out[i] = bilinear(scene.emitters.images, 0, w).y


@pytest.fixture(scope="module")
def texels():
    values = np.random.default_rng(3).random((5, 9)) ** 2
    values[1, 4] = 30.0
    values[3:, 2:6] = 0.0
    return np.repeat(values[..., None], 3, axis=2).astype(np.float32)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory, texels):
    oiio = pytest.importorskip("OpenImageIO")
    path = str(tmp_path_factory.mktemp("images") / "sky.exr")
    output = oiio.ImageOutput.create(path)
    assert output.open(path, oiio.ImageSpec(9, 5, 3, "float"))
    assert output.write_image(texels)
    output.close()
    emitters = [
        {"type": "point", "position": [0.1, 0.2, 0.3], "spectrum": 1},
        {
            "type": "spot",
            "position": [0.1, 0.2, 0.3],
            "look_at": [1, 0, 0.5],
            "angle": 50,
            "falloff": 20,
            "spectrum": 3,
        },
        {"type": "directional", "direction": [1, 2, -3], "spectrum": 1},
        {"type": "directional", "direction": [1, -2, 3], "spectrum": 1, "angle": 30},
        {"type": "environment", "spectrum": 1},
        {"type": "environment", "image": path, "transform": TURN},
    ]
    ball = shape("sphere", "white", center=[0, 0, 0], radius=0.9)
    table = {
        "camera": {"type": "pinhole", **look([0, -3, 0], [0, 0, 0])},
        "render": {"wavelength_range": MONOCHROME},
        "materials": {"white": diffuse(0.5)},
        "shapes": [ball],
        "emitters": emitters,
    }
    return compile_tables(table)


def towards(compiled, kind, numbers):
    out = np.empty((len(numbers), 5))
    towards_rows(compiled.scene, KINDS.index(kind), Vec3((0.3, -0.2, 0.1)), Table(numbers), Table(out))
    return out


def density(compiled, kind):
    """Per solid angle, without the choice of the emitter."""
    row = KINDS.index(kind)
    select = compiled.scene.emitters.records.array["pdf_select"][row]

    def evaluate(directions):
        out = np.empty(len(directions))
        density_rows(compiled.scene, row, Table(np.ascontiguousarray(directions)), Table(out))
        return out / select

    return evaluate


def around(axis, domain):
    """A domain of directions around z, turned to an axis."""
    z = np.array(axis, float) / np.linalg.norm(axis)
    x = np.cross(z, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    turn = np.array([x, np.cross(z, x), z])
    return Domain(lambda u: domain.from_unit(u) @ turn, lambda w: domain.to_unit(w @ turn.T), domain.measure)


@pytest.mark.parametrize("kind", ["environment", "image"])
def test_directions_follow_their_density(compiled, kind):
    test = ChiSquaredTest(
        lambda n: towards(compiled, kind, n)[:, :3], density(compiled, kind), SPHERE, bins=(12, 24), order=48
    )
    test.assert_passes(CASES)


def test_directions_to_a_sun_follow_their_density(compiled):
    domain = around([-1, 2, -3], cap(1 - math.cos(math.radians(15))))
    test = ChiSquaredTest(lambda n: towards(compiled, "sun", n)[:, :3], density(compiled, "sun"), domain)
    test.assert_passes(CASES)


def test_a_spot_emits_within_its_cone(compiled):
    axis = np.array([0.9, -0.2, 0.2])

    def sample(numbers):
        four = np.column_stack([numbers * 0, numbers])
        return emissions(compiled, "spot", four)[:, 3:6]

    one_minus_cos = 1 - math.cos(math.radians(50))
    uniform = constant(1 / (2 * math.pi * one_minus_cos))
    ChiSquaredTest(sample, uniform, around(axis, cap(one_minus_cos))).assert_passes(CASES)


def test_light_from_infinity_starts_all_over_the_disk(compiled):
    """Perpendicular to its direction, uniform, and in front of the whole scene."""
    light = np.array([1.0, 2, -3]) / math.sqrt(14)
    across = np.array([2.0, -1, 0]) / math.sqrt(5)
    plane = np.array([across, np.cross(light, across)])
    radius = compiled.scene.emitters.records.array["radius"][2]

    def sample(numbers):
        rows = emissions(compiled, "directional", np.column_stack([numbers, numbers * 0]))
        assert np.allclose(rows[:, 3:6], light)
        assert np.allclose(rows[:, :3] @ light, -radius)
        return rows[:, :3] @ plane.T / radius

    disk = Domain(
        disk_from_unit,
        lambda p: np.column_stack([(p**2).sum(axis=1), turns(p)]),
        constant(math.pi),
    )
    ChiSquaredTest(sample, constant(1 / math.pi), disk).assert_passes(CASES)


def emissions(compiled, kind, numbers):
    out = np.empty((len(numbers), 10))
    emission_rows(compiled.scene, KINDS.index(kind), Table(np.ascontiguousarray(numbers)), Table(out))
    return out


@pytest.mark.parametrize("kind", KINDS)
def test_densities_of_both_directions_are_those_of_the_theory(compiled, kind):
    """Theory 1.5: 1 / p_disk at infinity, d^2 / s of points; and the one ratio is the inverse of the other."""
    rows = emissions(compiled, kind, np.random.default_rng(2).random((200, 4)))
    record = compiled.scene.emitters.records.array[KINDS.index(kind)]
    disk = math.pi * record["radius"] ** 2
    if kind in ("point", "spot"):
        solid_angle = 4 * math.pi if kind == "point" else 2 * math.pi * (1 - math.cos(math.radians(50)))
        expected = 0.7**2 * solid_angle
        assert np.allclose(rows[:, 6], record["pdf_select"] / solid_angle)
        # In the direction that next-event estimation looks, which for a point is the same.
        assert np.allclose(rows[:, 7] * rows[:, 8], 1.0)
    else:
        expected = disk
        assert np.allclose(rows[:, 8], 1 / disk)
        assert np.allclose(rows[:, 9], rows[:, 6], rtol=1e-9)
    assert np.allclose(rows[:, 7], expected, rtol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_sampled_and_stated_densities_agree(compiled, kind):
    rows = towards(compiled, kind, np.random.default_rng(4).random((500, 2)))
    rows = rows[rows[:, 3] > 0]
    select = compiled.scene.emitters.records.array["pdf_select"][KINDS.index(kind)]
    assert np.allclose(rows[:, 4], rows[:, 3] * select, rtol=1e-9)


def test_the_density_of_an_image_is_its_radiance_on_average(compiled, texels):
    """Over each cell of a texel: the mean of the bilinear image over its integral."""
    assert np.allclose((solid_angles(5, 9) * 9).sum(), 4 * math.pi)
    means = cell_means(texels[..., 0].astype(float))
    # 32 x 32 points of every cell, in the image's own axes
    x, y = ((np.arange(n * 32) + 0.5) / 32 for n in (9, 5))
    theta, angle = y[:, None] * math.pi / 5, (x[None] / 9 - 0.5) * 2 * math.pi
    local = np.stack(
        [np.sin(theta) * np.sin(angle), np.sin(theta) * np.cos(angle), np.cos(theta) + 0 * angle], 2
    )
    out = np.empty(local.shape[0] * local.shape[1])
    image_rows(compiled.scene, Table(local.reshape(-1, 3)), Table(out))
    cells = out.reshape(5, 32, 9, 32).mean(axis=(1, 3))
    assert np.allclose(cells, means, rtol=2e-3, atol=1e-3)


def test_powers_choose(compiled):
    """Render space is that of a ball of radius 0.9 in a box: intensity, irradiance and radiance as powers."""
    records = compiled.scene.emitters.records.array
    scale = compiled.space.scale
    disk = math.pi * (compiled.space.radius * scale) ** 2
    spot = 3 * math.pi * (2 - math.cos(math.radians(50)) - math.cos(math.radians(20)))
    powers = np.array([4 * math.pi * scale**2, spot * scale**2, disk, disk, 4 * math.pi * disk])
    assert np.allclose(records["pdf_select"][:5] / records["pdf_select"][0], powers / powers[0], rtol=1e-4)
