"""Transforms: exact matrices, the order of steps, and what counts as degenerate."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from artist_py.errors import SceneError
from artist_py.scene.reader import read_scene_text
from artist_py.scene.transforms import (
    LookAt,
    Matrix,
    Rotate,
    Scale,
    Translate,
    View,
    are_parallel,
    cosine_sine,
    cross,
    matrix,
    normalized,
)

numbers = st.floats(-100, 100, allow_subnormal=False)
vectors = st.tuples(numbers, numbers, numbers)


def steps_of(text):
    """The steps of a TOML array."""
    scene = read_scene_text(
        'camera = { type = "pinhole", position = [0, 0, 1], look_at = [1, 0, 0] }\n'
        f'shapes = [{{ type = "sphere", center = [0, 0, 0], radius = 1, emission = 1, transform = {text} }}]'
    )
    return scene.shapes[0].transform


def applied(steps, point):
    return (matrix(steps) @ [*point, 1.0])[:3]


def test_no_steps_are_the_identity():
    assert np.array_equal(matrix(()), np.eye(4))
    assert matrix(()).dtype == np.float64


@pytest.mark.parametrize(
    ("text", "image"),
    [
        ("[{ translate = [1, 2, 3] }]", (2, 2, 3)),
        ("[{ scale = 3 }]", (3, 0, 0)),
        ("[{ scale = [-2, 1, 1] }]", (-2, 0, 0)),
        ("[{ rotate = [0, 0, 1, 90] }]", (0, 1, 0)),
        ("[{ rotate = [0, 0, 5, -90] }]", (0, -1, 0)),
        ("[{ rotate = [0, 1, 0, 90] }]", (0, 0, -1)),
        ("[{ rotate = [0, 0, 1, 180] }]", (-1, 0, 0)),
        ("[{ rotate = [0, 0, 1, 630] }]", (0, -1, 0)),
        ("[{ matrix = [[0, 0, 1, 4], [1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 0, 1]] }]", (4, 6, 6)),
        ("[{ look_at = { from = [1, 2, 3], to = [1, 2, 9], up = [0, 1, 0] } }]", (2, 2, 3)),
        # In the order in which they are written:
        ("[{ translate = [1, 0, 0] }, { rotate = [0, 0, 1, 90] }]", (0, 2, 0)),
        ("[{ rotate = [0, 0, 1, 90] }, { translate = [1, 0, 0] }]", (1, 1, 0)),
        ("[{ translate = [1, 0, 0] }, { scale = 10 }, { translate = [0, 1, 0] }]", (20, 1, 0)),
    ],
)
def test_exact_image_of_the_x_axis(text, image):
    assert applied(steps_of(text), (1, 0, 0)).tolist() == [float(x) for x in image]


@pytest.mark.parametrize("degrees", [0, 90, 180, 270, 360, -90, -450, 3690])
def test_right_angles_are_exact(degrees):
    cosine, sine = cosine_sine(float(degrees))
    assert (cosine, sine) == (round(math.cos(math.radians(degrees))), round(math.sin(math.radians(degrees))))
    assert {abs(cosine), abs(sine)} == {0.0, 1.0}


@given(vectors, st.floats(-720, 720))
def test_rotations_keep_lengths_hands_and_the_axis(axis, degrees):
    if normalized(axis) is None or math.hypot(*axis) < 1e-6:
        return
    rotation = matrix([Rotate(rotate=(*axis, degrees))])[:3, :3]
    assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
    assert math.isclose(np.linalg.det(rotation), 1.0, abs_tol=1e-14)
    assert np.allclose(rotation @ axis, axis, atol=1e-12)


@given(vectors, st.floats(-180, 180))
def test_a_rotation_and_back_is_the_identity(axis, degrees):
    if math.hypot(*axis) < 1e-6:
        return
    steps = [Rotate(rotate=(*axis, degrees)), Rotate(rotate=(*axis, -degrees))]
    assert np.allclose(matrix(steps), np.eye(4), atol=1e-14)


@given(vectors, vectors, vectors)
def test_look_at_is_a_frame_at_the_origin_that_looks_at_the_target(origin, target, up):
    direction = tuple(b - a for a, b in zip(origin, target, strict=True))
    if math.hypot(*direction) < 1e-3 or math.hypot(*up) < 1e-3:
        return
    if math.hypot(*cross(normalized(direction), normalized(up))) < 1e-3:
        return
    frame = matrix([LookAt(look_at=View(origin=origin, target=target, up=up))])
    assert np.array_equal(frame[:3, 3], origin)
    assert np.allclose(frame[:3, :3] @ frame[:3, :3].T, np.eye(3), atol=1e-12)
    assert math.isclose(np.linalg.det(frame[:3, :3]), 1.0, abs_tol=1e-12)
    assert np.allclose(frame[:3, 2], normalized(direction), atol=1e-15)
    assert frame[:3, 1] @ up > 0
    assert abs(frame[:3, 0] @ up) < 1e-10 * math.hypot(*up)


def test_a_matrix_is_taken_as_it_is():
    rows = ((1.5, 2.0, 0.25, 4.0), (0.0, 3.0, 1.0, 5.0), (1.0, 0.0, 7.0, 6.0), (0.0, 0.0, 0.0, 1.0))
    assert matrix([Matrix(rows=rows)]).tolist() == [list(row) for row in rows]


def test_order_is_that_of_matrix_products():
    steps = [
        Translate(translate=(1.0, 2.0, 3.0)),
        Scale(scale=(2.0, 3.0, 4.0)),
        Rotate(rotate=(1.0, 1.0, 0.0, 33.0)),
    ]
    translation, scaling, rotation = (matrix([step]) for step in steps)
    assert np.array_equal(matrix(steps), rotation @ (scaling @ translation))


@pytest.mark.parametrize(
    ("a", "b", "parallel"),
    [
        ((1, 0, 0), (2, 0, 0), True),
        ((1, 0, 0), (-1e-9, 0, 0), True),
        ((1, 0, 0), (0, 0, 0), True),
        ((1, 0, 0), (1, 1e-6, 0), False),
        ((1e15, 0, 0), (1e15, 1e9, 0), False),
        ((1e17, 1e17, 0), (1e-12, 1e-12, 0), True),
    ],
)
def test_parallel_whatever_the_lengths(a, b, parallel):
    assert are_parallel(a, b) is parallel
    assert are_parallel(b, a) is parallel


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_singular_whatever_the_scale(scale):
    regular = [[scale, 0, 0, 0], [0, scale, 0, 0], [scale, scale, scale, 0], [0, 0, 0, 1]]
    steps_of(f"[{{ matrix = {regular} }}]")
    singular = [[scale, 0, scale, 0], [0, scale, scale, 0], [scale, scale, 2 * scale, 0], [0, 0, 0, 1]]
    with pytest.raises(SceneError, match="flattens space"):
        steps_of(f"[{{ matrix = {singular} }}]")
