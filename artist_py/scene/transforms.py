"""How a shape is placed: steps, applied in the order they are written, and the 4x4 matrix they make."""

import math
from dataclasses import dataclass

from artist_py.scene.fields import Array, Forms, Node, Number, Table, failure, key, node, numbers
from artist_py.scene.messages import expected

COORDINATE_LIMIT = 1e18  # Embree treats what is farther away than 1.844e18 as infinitely far
coordinate = Number(limit=COORDINATE_LIMIT)
point = numbers(3, "a point [x, y, z]", coordinate)
direction = numbers(3, "a direction [x, y, z]", coordinate)


def cross(a, b):
    """a x b of two triples."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def normalized(a):
    """A triple scaled to length 1, or None when it has no direction."""
    length = math.hypot(*a)
    return tuple(x / length for x in a) if length > 1 / COORDINATE_LIMIT else None


def are_parallel(a, b):
    """Whether two triples span no plane: one is zero, or the sine of their angle is below 1e-9."""
    a, b = normalized(a), normalized(b)
    return a is None or b is None or math.hypot(*cross(a, b)) < 1e-9


@node
class Translate(Node):
    """Move by the vector, scene units."""

    translate: tuple[float, float, float] = key(numbers(3, "a vector [x, y, z]", coordinate))

    def matrix(self):
        x, y, z = self.translate
        return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


@node
class Rotate(Node):
    """Turn around the axis through the origin, counter-clockwise seen from its tip: [x, y, z, degrees]."""

    rotate: tuple[float, float, float, float] = key(numbers(4, "[x, y, z, degrees]", coordinate))

    def problems(self):
        if normalized(self.rotate[:3]) is None:
            yield "rotate", expected("an axis that is not zero", self.rotate[:3])

    def matrix(self):
        x, y, z = normalized(self.rotate[:3])
        c, s = cosine_sine(self.rotate[3])
        t = 1 - c  # Rodrigues
        return [
            [c + t * x * x, t * x * y - s * z, t * x * z + s * y, 0],
            [t * x * y + s * z, c + t * y * y, t * y * z - s * x, 0],
            [t * x * z - s * y, t * y * z + s * x, c + t * z * z, 0],
            [0, 0, 0, 1],
        ]


@dataclass(frozen=True)
class Factors:
    """One factor for all axes, or one per axis."""

    expected = "a factor or three factors"

    def __call__(self, value, at):
        if isinstance(value, list | tuple):
            factors = numbers(3, self.expected, coordinate)(value, at)
        else:
            factors = (coordinate(value, at),) * 3
        if any(abs(factor) * COORDINATE_LIMIT < 1 for factor in factors):
            raise failure(at, expected("factors other than zero", value))
        return factors


@node
class Scale(Node):
    """Stretch along the axes, from the origin; a negative factor mirrors."""

    scale: tuple[float, float, float] = key(Factors())

    def matrix(self):
        x, y, z = self.scale
        return [[x, 0, 0, 0], [0, y, 0, 0], [0, 0, z, 0], [0, 0, 0, 1]]


@node
class View(Node):
    """A place to stand, a point to look at, and what is up there."""

    origin: tuple[float, float, float] = key(point, name="from")
    target: tuple[float, float, float] = key(point, name="to")
    up: tuple[float, float, float] = key(direction, (0.0, 0.0, 1.0))

    def direction(self):
        """From the origin to the target, not normalised."""
        return tuple(b - a for a, b in zip(self.origin, self.target, strict=True))

    def problems(self):
        if normalized(self.direction()) is None:
            yield "to", expected("another point than from", self.target)
        elif are_parallel(self.direction(), self.up):
            yield "up", expected("a direction not parallel to the view", self.up)


@node
class LookAt(Node):
    """Move the origin to `from` and turn local z to point to `to`, local y to the side of `up`."""

    look_at: View = key(Table(View))

    def matrix(self):
        z = normalized(self.look_at.direction())
        x = normalized(cross(normalized(self.look_at.up), z))
        y = cross(z, x)
        return [[*row] for row in zip(x, y, z, self.look_at.origin, strict=True)] + [[0, 0, 0, 1]]


@node
class Matrix(Node):
    """Any affine map: four rows, applied to columns [x, y, z, 1]."""

    rows: tuple[tuple[float, ...], ...] = key(
        Array(numbers(4, "a row of 4 numbers", coordinate), 4, expected="4 rows of 4 numbers"), name="matrix"
    )

    def problems(self):
        if self.rows[3] != (0.0, 0.0, 0.0, 1.0):
            yield "matrix", expected("a last row [0, 0, 0, 1]", self.rows[3])
        elif self.is_singular():
            yield "matrix", "expected a matrix that can be inverted, found one that flattens space"

    def is_singular(self):
        """Whether the columns, as directions, lie in one plane."""
        columns = [normalized(column) for column in zip(*self.rows[:3], strict=True)][:3]
        if None in columns:
            return True
        return abs(sum(a * b for a, b in zip(cross(columns[0], columns[1]), columns[2], strict=True))) < 1e-12

    def matrix(self):
        return [list(row) for row in self.rows]


step = Forms(
    {"translate": Translate, "rotate": Rotate, "scale": Scale, "look_at": LookAt, "matrix": Matrix},
    "a step of a transform",
)


def cosine_sine(degrees):
    """Cosine and sine of an angle in degrees; exact at the multiples of 90."""
    turn = math.fmod(degrees, 360.0)
    if turn % 90.0 == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(turn // 90.0) % 4]
    return math.cos(math.radians(turn)), math.sin(math.radians(turn))


def matrix(steps):
    """Local to world of a list of steps, f64 (4, 4), applied to columns [x, y, z, 1]."""
    import numpy as np

    product = np.eye(4)
    for item in steps:
        product = np.array(item.matrix(), dtype=np.float64) @ product
    return product
