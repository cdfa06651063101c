"""The same scenes in other units, and far from the origin."""

from artist_py.stress.case import Case, Radiance
from artist_py.stress.cases.lights import ball_lamp
from artist_py.stress.scenes import furnace, integrating_sphere, moved, shape

BALLS = (
    shape("sphere", "white", center=[-0.4, 0.2, -0.4], radius=0.3),
    shape("sphere", "glass", center=[-0.1, 0.5, 0.2], radius=0.2),
    shape("sphere", "mirror", center=[0.3, 0.5, -0.2], radius=0.2),
)
FAR = (1e5, -1e5, 1e5)
PLACES = {
    "scale-1e-5": (1e-5, (0, 0, 0)),
    "scale-1e-3": (1e-3, (0, 0, 0)),
    "scale-1e3": (1e3, (0, 0, 0)),
    "scale-1e6": (1e6, (0, 0, 0)),
    "offset-1e5": (1.0, FAR),
    "scale-1e-5-offset-1": (1e-5, (1.0, 1.0, -1.0)),
}

CASES = tuple(
    case
    for name, (scale, offset) in PLACES.items()
    for case in (
        Case(
            f"{name}-things",
            "White, glass and a mirror in a furnace: what leaks or shades itself is seen.",
            moved(furnace(BALLS), scale, offset),
            Radiance(1),
            rounding=2e-4,
            why="A white ball brings paths of all lengths; 0.5^60 is not the limit then.",
        ),
        Case(
            f"{name}-lamp",
            "A small lamp in an integrating sphere.",
            moved(integrating_sphere([ball_lamp(0.1)]), scale, offset),
            Radiance(1),
        ),
    )
)
