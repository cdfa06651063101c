"""Affine maps as (3, 4) float64 fields of records, and vectors stored in records."""

from ..jit import function
from .vector import vec3


@function
def load_vec3(field):
    """The three numbers of a record field as a vector."""
    return vec3(float(field[0]), float(field[1]), float(field[2]))


@function
def transform_point(matrix, p):
    """The map applied to a point."""
    return vec3(
        matrix[0, 0] * p.x + matrix[0, 1] * p.y + matrix[0, 2] * p.z + matrix[0, 3],
        matrix[1, 0] * p.x + matrix[1, 1] * p.y + matrix[1, 2] * p.z + matrix[1, 3],
        matrix[2, 0] * p.x + matrix[2, 1] * p.y + matrix[2, 2] * p.z + matrix[2, 3],
    )


@function
def transform_direction(matrix, d):
    """The map's linear part applied to a direction; the length changes with it."""
    return vec3(
        matrix[0, 0] * d.x + matrix[0, 1] * d.y + matrix[0, 2] * d.z,
        matrix[1, 0] * d.x + matrix[1, 1] * d.y + matrix[1, 2] * d.z,
        matrix[2, 0] * d.x + matrix[2, 1] * d.y + matrix[2, 2] * d.z,
    )


@function
def transform_normal(inverse, n):
    """A normal under the map whose *inverse* is given (the inverse's transpose applies); not normalised."""
    return vec3(
        inverse[0, 0] * n.x + inverse[1, 0] * n.y + inverse[2, 0] * n.z,
        inverse[0, 1] * n.x + inverse[1, 1] * n.y + inverse[2, 1] * n.z,
        inverse[0, 2] * n.x + inverse[1, 2] * n.y + inverse[2, 2] * n.z,
    )
