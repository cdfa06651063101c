"""Every kind of emitter over a white plane, against closed forms and against quadrature over its surface.

Fixed seeds; a correct program fails one comparison by chance with probability 1e-4; there are 60.
"""

import math

import numpy as np
import pytest
from rendering import assert_sample_mean, assert_uniform, diffuse, look, radiance, render, scene, shape

WHITE = {"white": diffuse(1.0)}
PLANE = shape("rectangle", "white", corner=[-0.01, -0.01, 0], edges=[[0.02, 0, 0], [0, 0.02, 0]])
EYE = look([0, -1, 0.02], [0, 0, 0], 1e-4)  # below all emitters
EMISSION = 3.0
# One of each below the plane and without power, so that all these scenes share their kernels.
UNSEEN = [
    shape("rectangle", corner=[0, 0, -1], edges=[[0.1, 0, 0], [0, 0.1, 0]], emission=0),
    shape("sphere", center=[0, 0.5, -1], radius=0.1, emission=0),
    shape("disk", center=[0, 1, -1], normal=[0, 0, 1], radius=0.1, emission=0),
    shape("grooved-sphere", center=[0, 1.5, -1], radius=0.1, grooves=0, segments=8, emission=0),
]
UNSEEN_OBJECT = {"unseen": [shape("sphere", center=[0, 0, 0], radius=0.1, emission=0)]}
UNSEEN_INSTANCE = {"object": "unseen", "transform": [{"translate": [0, 2, -1]}]}


def lit_by(emitters, objects=(), instances=(), **render):
    """The scene of the origin of a white plane, lit by emitters alone, without interreflection.

    All pixels see the same. Many of them and few iterations take less time than the reverse.
    """
    return scene(
        [PLANE, *emitters, *UNSEEN],
        materials=WHITE,
        objects={**UNSEEN_OBJECT, **dict(objects)},
        instances=[UNSEEN_INSTANCE, *instances],
        camera=EYE,
        film={"resolution": [32, 32]},
        render={"max_path_length": 2, "sampler": "sobol", **render},
    )


def assert_irradiance(compiled, expected, precision=2.5e-3, iterations=192):
    """Irradiance at the origin is `expected`; a white plane shows it divided by pi.

    Small emitters are hit by chance so rarely that what these hits add, the (R / d)^2-th part, is no measured noise.
    """
    assert_uniform(radiance(compiled, iterations), expected / math.pi, precision, rounding=1e-4)


# --- closed forms -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("center", [(0, 0, 1.5), (1, 0.5, 1), (-3, 1, 0.8), (0.1, 0, 0.301)])
@pytest.mark.parametrize("radius", [0.3, 0.01])
def test_sphere(center, radius):
    """pi L (R / d)^2 cos, for spheres above the horizon."""
    distance = math.hypot(*center)
    expected = math.pi * EMISSION * (radius / distance) ** 2 * center[2] / distance
    emitter = shape("sphere", center=center, radius=radius, emission=EMISSION)
    assert_irradiance(lit_by([emitter]), expected)


@pytest.mark.parametrize(
    ("height", "radius", "aside"), [(1, 0.5, 0), (0.1, 1, 0), (2, 0.01, 0), (1, 0.7, 1.3)]
)
def test_disk(height, radius, aside):
    """A disk parallel to the plane, `aside` from the axis; on the axis pi L R^2 / (R^2 + h^2)."""
    h2, r2, a2 = height**2, radius**2, aside**2
    ratio = (h2 + a2 - r2) / math.sqrt((h2 + a2 + r2) ** 2 - 4 * a2 * r2)
    emitter = shape("disk", center=[aside, 0, height], normal=[0, 0, -2], radius=radius, emission=EMISSION)
    assert_irradiance(lit_by([emitter]), 0.5 * math.pi * EMISSION * (1 - ratio))


def polygon_irradiance(corners, normal=(0, 0, 1)):
    """Irradiance at the origin per radiance, from a polygon above the horizon (Lambert 1760); 0 from its back."""
    v = np.array(corners, float)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    after = np.roll(v, -1, axis=0)
    across = np.cross(v, after)
    sine = np.linalg.norm(across, axis=1)
    angle = np.arctan2(sine, (v * after).sum(axis=1))
    return max(0.0, -0.5 * float((across / sine[:, None] @ np.array(normal)) @ angle))


@pytest.mark.parametrize(
    ("corner", "edges"),
    [
        ((-0.5, -0.5, 1), ((0, 1, 0), (1, 0, 0))),
        ((0.3, -2, 0.4), ((0, 4, 0), (0.4, 0, 0.3))),
        ((-1, 0.5, 0.1), ((1.5, 0, 0.2), (0.5, 0.7, 0.9))),
    ],
)
def test_rectangle(corner, edges):
    """Lambert's formula for polygons; skewed and steep ones too, which emit towards edge 0 x edge 1."""
    p, a, b = (np.array(each, float) for each in (corner, *edges))
    expected = EMISSION * polygon_irradiance([p, p + a, p + a + b, p + b])
    assert expected > 0.01
    assert_irradiance(lit_by([shape("rectangle", corner=corner, edges=edges, emission=EMISSION)]), expected)


def test_box():
    """The sum over those of the six faces that are turned towards the point."""
    low, high = np.array([0.4, -0.3, 0.5]), np.array([1.2, 0.6, 0.9])
    expected = 0.0
    for axis in range(3):
        for side, bound in ((-1, low), (1, high)):
            corner, size = low.copy(), high - low
            corner[axis] = bound[axis]
            a, b = np.zeros(3), np.zeros(3)
            a[(axis + 1) % 3], b[(axis + 2) % 3] = size[(axis + 1) % 3], size[(axis + 2) % 3]
            face = [corner, corner + a, corner + a + b, corner + b]
            expected += EMISSION * polygon_irradiance(face[::side])
    emitter = shape("box", min=low, max=high, emission=EMISSION)
    assert_irradiance(lit_by([emitter]), expected)


@pytest.mark.parametrize("radius", [1e-2, 1e-4])
def test_small_sphere_in_the_middle_of_the_scene(radius):
    """There its own coordinates are small; rays to it are as inexact as where they come from."""
    lamp = shape("sphere", center=[0, 0, 1], radius=radius, emission=EMISSION / radius**2)
    opposite = shape("sphere", center=[0, -2, 3], radius=0.1, emission=0)
    compiled = lit_by([lamp, opposite])
    assert np.allclose(compiled.space.centre, [0, 0, 1], atol=1e-6)
    assert_irradiance(compiled, math.pi * EMISSION)


@pytest.mark.parametrize("sides", ["front", "both"])
@pytest.mark.parametrize("reverse", [False, True])
def test_sides(sides, reverse):
    """A rectangle that faces up: the plane below is lit by its back, where it has one or is reversed."""
    corners = np.array([[0.2, -0.5, 0.7], [1.2, -0.5, 0.7], [1.2, 0.5, 0.7], [0.2, 0.5, 0.7]])
    emission = {"spectrum": EMISSION, "sides": sides}
    emitter = shape(
        "rectangle", corner=corners[0], edges=[[1, 0, 0], [0, 1, 0]], reverse=reverse, emission=emission
    )
    compiled = lit_by([emitter])
    if reverse or sides == "both":
        assert_irradiance(compiled, EMISSION * polygon_irradiance(corners[::-1]))
    else:
        assert radiance(compiled, 4).mean.max() == 0.0


def test_two_sided_from_within():
    """A closed sphere that emits to both sides lights what is in it, with pi L, by its inner side."""
    emitter = shape("sphere", center=[0, 0, 0.4], radius=2, emission={"spectrum": EMISSION, "sides": "both"})
    assert_irradiance(lit_by([emitter]), math.pi * EMISSION)


# --- quadrature ---------------------------------------------------------------------------------------------------


def midpoints(n):
    return (np.arange(n) + 0.5) / n


def surface_irradiance(patches, to_world=None):
    """Irradiance at the origin per radiance of a convex surface that emits outwards.

    `patches` are (position, edge along u, edge along v) of small parallelograms, arrays (n, 3), with outer normals
    edge u x edge v; `to_world` (3, 4) is applied to them.
    """
    total = 0.0
    for position, du, dv in patches:
        p = position
        normal = np.cross(du, dv)
        if to_world is not None:
            m = np.asarray(to_world, float)
            p = position @ m[:, :3].T + m[:, 3]
            normal = np.cross(du @ m[:, :3].T, dv @ m[:, :3].T)
            normal = normal * np.sign(np.linalg.det(m[:, :3]))
        d2 = (p * p).sum(axis=1)
        cosines = np.maximum(-(normal * p).sum(axis=1), 0.0) * np.maximum(p[:, 2], 0.0)
        total += float((cosines / d2**2).sum())
    return total


def around_axis(profile, slope, n=150, turns=300):
    """Patches of a surface of revolution about z; `profile` (r, z) and its derivative `slope`, by s in [0, 1]."""
    s, turn = (
        each.ravel() for each in np.meshgrid(midpoints(n), 2 * np.pi * midpoints(turns), indexing="ij")
    )
    (r, z), (dr, dz) = profile(s), slope(s)
    c, d = np.cos(turn), np.sin(turn)
    p = np.column_stack([r * c, r * d, z])
    du = np.column_stack([-r * d, r * c, 0 * r]) * (2 * np.pi / turns)
    dv = np.column_stack([dr * c, dr * d, dz]) / n
    return p, du, dv


TUBE = around_axis(lambda s: (1 + 0 * s, s), lambda s: (0 * s, 1 + 0 * s))
MANTLE = around_axis(lambda s: (1 - s, s), lambda s: (-1 + 0 * s, 1 + 0 * s))
LID = around_axis(lambda s: (1 - s, 1 + 0 * s), lambda s: (-1 + 0 * s, 0 * s))
UNDERSIDE = LID[0], LID[2], LID[1]
FLOOR = around_axis(lambda s: (s, 0 * s), lambda s: (1 + 0 * s, 0 * s))
GLOBE = around_axis(
    lambda s: (np.sin(np.pi * s), -np.cos(np.pi * s)),
    lambda s: (np.pi * np.cos(np.pi * s), np.pi * np.sin(np.pi * s)),
)


def upright(base, top, radius):
    """(3, 4) map of the unit shape from z = 0 to 1 to one around the axis from base to top."""
    z = np.subtract(top, base)
    x = np.cross(z, [0.31, 0.77, -0.2])
    y = np.cross(z, x)
    x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
    return np.column_stack([radius * x, radius * y, z, base])


AXIS = {"base": (0.8, 0.2, 0.6), "top": (0.5, -0.6, 1.1)}


@pytest.mark.parametrize("caps", [True, False])
def test_cylinder(caps):
    """Without caps its inner side shows, which does not emit."""
    patches = [TUBE, LID, FLOOR] if caps else [TUBE]
    expected = EMISSION * surface_irradiance(patches, upright(AXIS["base"], AXIS["top"], 0.3))
    assert_irradiance(lit_by([shape("cylinder", **AXIS, radius=0.3, caps=caps, emission=EMISSION)]), expected)


@pytest.mark.parametrize("cap", [True, False])
def test_cone(cap):
    """The base is turned away from the plane: its cap makes no difference."""
    emitter = shape("cone", base=AXIS["top"], apex=AXIS["base"], radius=0.3, cap=cap, emission=EMISSION)
    expected = EMISSION * surface_irradiance([MANTLE, FLOOR], upright(AXIS["top"], AXIS["base"], 0.3))
    assert_irradiance(lit_by([emitter]), expected)


TRANSFORMS = {
    "scaled": [{"scale": 0.4}, {"translate": [0.6, 0.3, 1.0]}],
    "stretched": [{"scale": [0.5, 0.2, 0.35]}, {"rotate": [1, 2, 3, 40]}, {"translate": [0.5, -0.3, 0.9]}],
    "mirrored": [{"scale": [-0.4, 0.3, 0.5]}, {"rotate": [1, 0, 1, 70]}, {"translate": [-0.8, 0.5, 1.0]}],
}


def matrix_of(steps):
    """The (3, 4) map of a list of steps; written out, so as not to rely on the renderer's."""
    m = np.eye(4)
    for item in steps:
        step = np.eye(4)
        if "scale" in item:
            step[:3, :3] = np.diag(np.broadcast_to(item["scale"], 3))
        elif "translate" in item:
            step[:3, 3] = item["translate"]
        else:
            *axis, degrees = item["rotate"]
            k = np.array(axis) / np.linalg.norm(axis)
            cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
            turn = math.radians(degrees)
            step[:3, :3] += math.sin(turn) * cross + (1 - math.cos(turn)) * cross @ cross
        m = step @ m
    return m[:3]


UNIT_SHAPES = {
    "sphere": (shape("sphere", center=[0, 0, 0], radius=1), [GLOBE]),
    "cylinder": (shape("cylinder", base=[0, 0, 0], top=[0, 0, 1], radius=1), [TUBE, LID, FLOOR]),
    "cone": (shape("cone", base=[0, 0, 0], apex=[0, 0, 1], radius=1), [MANTLE, FLOOR]),
    "disk": (shape("disk", center=[0, 0, 1], normal=[0, 0, 1], radius=1), [LID, UNDERSIDE]),
}


@pytest.mark.parametrize("steps", TRANSFORMS.values(), ids=TRANSFORMS)
@pytest.mark.parametrize("kind", UNIT_SHAPES)
@pytest.mark.parametrize("is_instance", [False, True], ids=["direct", "instance"])
def test_transformed(kind, steps, is_instance):
    """The same map as the shape's own, and as an instance's; normals stay outside, mirrored or not."""
    unit, patches = UNIT_SHAPES[kind]
    emission = {"spectrum": EMISSION, "sides": "both" if kind == "disk" else "front"}
    expected = EMISSION * surface_irradiance(patches, matrix_of(steps))
    if is_instance:
        compiled = lit_by(
            [], {"lamp": [{**unit, "emission": emission}]}, [{"object": "lamp", "transform": steps}]
        )
    else:
        compiled = lit_by([{**unit, "transform": steps, "emission": emission}])
    assert expected > 0.05
    assert_irradiance(compiled, expected, 4e-3, 96)


# --- meshes, and many ---------------------------------------------------------------------------------------------


def write_ply(path, vertices, faces):
    """A PLY file in words, without normals."""
    head = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(repr(float(x)) for x in vertex) for vertex in vertices]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    return str(path)


TETRAHEDRON = np.array([[0.4, 0.1, 0.5], [1.1, 0.3, 0.7], [0.5, -0.6, 0.8], [0.6, 0.0, 1.3]])
FACES = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]


@pytest.mark.parametrize("is_instance", [False, True], ids=["direct", "instance"])
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_mesh(tmp_path, is_instance, is_mirrored):
    """A tetrahedron, triangle by triangle; mirrored, its front stays in front."""
    file = write_ply(tmp_path / "tetrahedron.ply", TETRAHEDRON, FACES)
    mirror = np.array([-1 if is_mirrored else 1, 1, 1])
    steps = [{"scale": mirror}]
    order = -1 if is_mirrored else 1
    expected = EMISSION * sum(polygon_irradiance(TETRAHEDRON[list(face)][::order] * mirror) for face in FACES)
    assert expected > 0.05
    emitter = shape("mesh", file=file, emission=EMISSION)
    if is_instance:
        compiled = lit_by([], {"lamp": [emitter]}, [{"object": "lamp", "transform": steps}])
    else:
        compiled = lit_by([{**emitter, "transform": steps}])
    assert_irradiance(compiled, expected)


def test_smooth_mesh():
    """Interpolated normals change nothing about what a mesh emits: the sum over its triangles as Embree has them."""
    emitter = shape(
        "grooved-sphere", center=[0.5, 0.3, 0.8], radius=0.4, grooves=0, segments=16, emission=EMISSION
    )
    compiled = lit_by([emitter])
    geometry, space = compiled.scene.geometry, compiled.space
    emitters = compiled.scene.emitters.records
    faces = geometry.triangles[: np.count_nonzero((emitters["kind"] == 0) & (emitters["scale"] > 0))]
    corners = geometry.vertices["position"][faces].astype(float) / space.scale + space.centre
    is_lamp = (corners[:, :, 2] > 0).all(axis=1)
    outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_turned = (outwards * (corners[:, 0] - [0.5, 0.3, 0.8])).sum(axis=1) < 0
    triangles = np.where(is_turned[:, None, None], corners[:, ::-1], corners)[is_lamp]
    expected = EMISSION * sum(polygon_irradiance(triangle) for triangle in triangles)
    whole = math.pi * EMISSION * 0.4**2 * 0.8 / np.linalg.norm([0.5, 0.3, 0.8]) ** 3
    assert 0.9 * whole < expected < whole
    assert_irradiance(compiled, expected)


def test_ten_thousand_emitters_over_ten_orders_of_magnitude():
    """Chosen by power: each has its share, and none is noise to the others."""
    count = 10_000
    index = np.arange(count) + 0.5
    z = 0.05 + 0.95 * index / count  # Fibonacci's lattice on the hemisphere
    turn = math.pi * (1 + math.sqrt(5)) * index
    out = np.column_stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z])
    side = np.cross(out, [0, 0, 1])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    a, b = 0.01 * side, 0.01 * np.cross(out, side)
    strength = 10.0 ** np.random.default_rng(5).uniform(-5, 5, count)
    emitters, expected = [], 0.0
    for p, u, v, radiance_ in zip(out - 0.5 * (a + b), a, b, strength, strict=True):
        emitters.append(shape("rectangle", corner=p, edges=[v, u], emission=radiance_))
        expected += radiance_ * polygon_irradiance([p, p + v, p + v + u, p + u])
    compiled = lit_by(emitters)
    chance = compiled.scene.emitters.records["pdf_select"]
    assert chance.max() / chance[chance > 0].min() > 1e9
    assert_irradiance(compiled, expected, 2e-3, 24)


# --- how much -----------------------------------------------------------------------------------------------------

LIT_SHAPES = {
    "sphere": (shape("sphere", center=[0.1, 2, 0], radius=0.3), 4 * math.pi * 0.09),
    "rectangle": (shape("rectangle", corner=[-1, 2, -1], edges=[[2, 0, 0], [0.5, 0, 3]]), 6),
    "box": (shape("box", min=[-1, 2, -2], max=[2, 4, 2]), 2 * (3 * 2 + 2 * 4 + 4 * 3)),
    "disk": (shape("disk", center=[0, 2, 0], normal=[0.1, -1, 0.2], radius=0.5), math.pi * 0.25),
    "cylinder": (
        shape("cylinder", base=[0, 2, -1], top=[0, 2, 1], radius=0.5),
        2 * math.pi * 0.5 * 2 + 2 * math.pi * 0.25,
    ),
    "tube": (
        shape("cylinder", base=[0, 2, -1], top=[0, 2, 1], radius=0.5, caps=False),
        2 * math.pi * 0.5 * 2,
    ),
    "cone": (
        shape("cone", base=[0, 2, -1], apex=[0, 2, 1], radius=0.6),
        math.pi * 0.6 * math.hypot(0.6, 2) + math.pi * 0.36,
    ),
}


def seen(shapes=(), **more):
    """What a camera at the origin sees of a lamp straight ahead, scenes as in `lit_by`."""
    return scene(
        [PLANE, *shapes, *UNSEEN], materials=WHITE, camera=look([0, 0, 0.1], [0, 2, 0.1], 1e-4), **more
    )


@pytest.mark.parametrize("sides", ["front", "both"])
@pytest.mark.parametrize("name", LIT_SHAPES)
def test_power(name, sides):
    """Radiance, seen directly, times pi, area, sides and the 480 nm that `power` is meant over, is the power."""
    lamp, area = LIT_SHAPES[name]
    emission = {"spectrum": 0.7, "power": 250, "sides": sides}
    instances = {"objects": UNSEEN_OBJECT, "instances": [UNSEEN_INSTANCE]}
    image = radiance(seen([{**lamp, "emission": emission}], **instances), 1).mean
    power = image * math.pi * area * 480 * (2 if sides == "both" else 1)
    assert np.allclose(power, 250, rtol=1e-5)


def test_power_of_an_instance():
    """Of the shape where it stands, scaled as it is; an ellipsoid's area is found by quadrature."""
    steps = [{"scale": [0.5, 0.2, 0.3]}, {"rotate": [1, 1, 0, 30]}, {"translate": [0, 2, 0]}]
    emission = {"spectrum": 1, "power": 10}
    objects = {**UNSEEN_OBJECT, "lamp": [shape("sphere", center=[0, 0, 0], radius=1, emission=emission)]}
    instances = [UNSEEN_INSTANCE, {"object": "lamp", "transform": steps}]
    image = radiance(seen(objects=objects, instances=instances), 1).mean
    m = matrix_of(steps)[:, :3]
    _, du, dv = GLOBE
    area = np.linalg.norm(np.cross(du @ m.T, dv @ m.T), axis=1).sum()
    assert np.allclose(image * math.pi * area * 480, 10, rtol=1e-4)


@pytest.mark.parametrize("spectrum", ["D65", {"blackbody": 2900}, {"lines": [[435.8, 1], [546.1, 2]]}])
def test_luminance(spectrum):
    """5000 cd/m2 are seen as Y = 5000 / white_luminance, whatever the spectrum."""
    lamp = shape("sphere", center=[0, 2, 0], radius=0.5, emission={"spectrum": spectrum, "luminance": 5000})
    settings = {
        "render": {"wavelength_range": [380, 780]},
        "film": {"white_luminance": 4000, "resolution": [32, 32]},
    }
    instances = {"objects": UNSEEN_OBJECT, "instances": [UNSEEN_INSTANCE]}
    image = render(seen([lamp], **settings, **instances), 96).film.rgb
    y = image @ [0.2126390, 0.7151687, 0.0721923]  # the middle row of the matrix from linear sRGB to XYZ
    assert_sample_mean(y, 5000 / 4000, 2e-3)
