"""Where a camera ray starts: at the pinhole, or on a thin lens with a round or bladed aperture; and what meets it."""

import math

from ..core.vector import dot
from ..core.warp import square_to_disk, square_to_triangle
from ..jit import function


@function
def sample_aperture(lens, u, v):
    """Uniform point (x, y) of the aperture, in units of the lens radius; area pi or that of the polygon."""
    if lens.blades == 0:
        return square_to_disk(u, v)
    scaled = u * lens.blades
    blade = min(int(scaled), lens.blades - 1)
    b1, b2 = square_to_triangle(scaled - blade, v)
    angle1 = lens.rotation + 2.0 * math.pi * blade / lens.blades
    angle2 = lens.rotation + 2.0 * math.pi * (blade + 1) / lens.blades
    return b1 * math.cos(angle1) + b2 * math.cos(angle2), b1 * math.sin(angle1) + b2 * math.sin(angle2)


@function
def aperture_area(lens):
    """Area of the aperture, render-space units squared."""
    if lens.blades == 0:
        return math.pi * lens.radius * lens.radius
    return 0.5 * lens.blades * math.sin(2.0 * math.pi / lens.blades) * lens.radius * lens.radius


@function
def is_in_aperture(lens, x, y):
    """Whether the point (x, y), in units of the lens radius, lies in the aperture."""
    if x * x + y * y > 1.0:
        return False
    if lens.blades == 0:
        return True
    # The polygon is its inscribed circle and what the blades leave beyond it: the distance along the nearest blade's
    # normal, which stands half-way between two corners.
    half = math.pi / lens.blades
    angle = (math.atan2(y, x) - lens.rotation) % (2.0 * half)
    return math.sqrt(x * x + y * y) * math.cos(angle - half) <= math.cos(half)


@function
def through_lens(lens, camera, direction, u, v):
    """`(origin, direction)` of a ray; `direction` has length 1 along the axis, so that focus lies at that multiple."""
    if lens is None:
        return camera.position, direction
    x, y = sample_aperture(lens, u, v)
    right = camera.right * (lens.radius * x / math.sqrt(dot(camera.right, camera.right)))
    down = camera.down * (lens.radius * y / math.sqrt(dot(camera.down, camera.down)))
    shift = right + down
    return camera.position + shift, direction - shift * (1.0 / lens.focus_distance)
