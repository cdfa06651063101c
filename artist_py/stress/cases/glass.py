"""Glass: extreme indices, nested and overlapping bodies, light that never gets out, and eyes inside."""

from artist_py.stress.case import Case, Radiance, Sane
from artist_py.stress.scenes import furnace, look, shape

IORS = {"1+1e-7": 1 + 1e-7, "1": 1.0, "4": 4.0, "0.75": 0.75, "0.1": 0.1, "100": 100.0}
BALL = shape("sphere", "odd", center=[-0.05, 0.2, 0.1], radius=0.4)
SLAB = shape("box", "odd", min=[-0.5, 0.2, -0.5], max=[0.5, 0.6, 0.6])


def in_glass(things, camera=None, edges=100, **more):
    """Things in a furnace whose walls are black and emit 1, so that only glass scatters."""
    view = {"camera": camera} if camera else {}
    return furnace(things, albedo=0.0, render={"max_path_length": edges}, **view, **more)


def odd(ior):
    """The material "odd"."""
    return {"odd": {"type": "dielectric", "ior": ior}}


NESTED = [
    shape("sphere", "glass", center=[-0.05, 0.2, 0.1], radius=0.4),
    shape("sphere", "dense", center=[-0.05, 0.2, 0.1], radius=0.25),
    shape("sphere", "glass", center=[-0.05, 0.2, 0.1], radius=0.1),
]
OVERLAPPING = [
    shape("sphere", "glass", center=[-0.25, 0.2, 0.1], radius=0.3),
    shape("sphere", "dense", center=[0.05, 0.2, 0.1], radius=0.3),
    shape("box", "glass", min=[-0.3, 0, -0.1], max=[0.1, 0.4, 0.2]),
]
INSIDE = look([0.02, -0.03, 0], [0.5, 1, 0.3])

CASES = (
    *(
        Case(
            f"ior-{name}",
            "A ball and a slab of glass, which a furnace hides.",
            in_glass(
                [BALL, {**SLAB, "material": "glass"}], edges=400 if ior > 10 else 100, materials=odd(ior)
            ),
            Radiance(1),
            rounding=1e-4,
            why="Hundreds of products of float32 numbers.",
        )
        for name, ior in IORS.items()
    ),
    Case("nested-glass", "A bubble in a ball in a ball.", in_glass(NESTED), Radiance(1), rounding=1e-4),
    Case(
        "overlapping-glass",
        "Bodies that overlap, by priority.",
        in_glass(OVERLAPPING),
        Radiance(1),
        rounding=1e-4,
    ),
    Case(
        "duplicate-glass",
        "The same ball of glass twice in one place.",
        in_glass([BALL, BALL], materials=odd(1.5)),
        Radiance(1),
        rounding=1e-4,
    ),
    Case(
        "coincident-glass",
        "Balls of two glasses in one place.",
        in_glass([BALL, {**BALL, "material": "glass"}], materials=odd(1.3)),
        Sane(),
        why="Of two surfaces in one place a ray meets one: it leaves bodies that it has not entered.",
    ),
    Case(
        "diffuse-in-furnace-with-glass",
        "Glass between grey walls: paths of all kinds, with all techniques.",
        furnace(NESTED),
        Radiance(1),
        rounding=1e-4,
    ),
    Case(
        "trap-ball",
        "A ray along the surface inside a ball of glass never gets out.",
        in_glass(
            [shape("sphere", "glass", center=[0, 0, 0], radius=0.5)], look([0.475, 0, 0], [0.475, 1, 0], 5)
        ),
        Radiance(0),
    ),
    Case(
        "trap-cube",
        "Neither does one along the diagonal of a cube of index 2.",
        in_glass(
            [shape("box", "odd", min=[-0.5, -0.5, -0.5], max=[0.5, 0.5, 0.5])],
            look([0.1, 0.05, 0], [1.1, 1.05, 1], 5),
            materials=odd(2.0),
        ),
        Radiance(0),
    ),
    Case(
        "camera-in-glass",
        "An eye in glass sees n^2 times the radiance.",
        in_glass([shape("sphere", "glass", center=[0, 0, 0], radius=0.5)], INSIDE),
        Radiance(2.25),
        rounding=1e-4,
    ),
    Case(
        "camera-in-nested-glass",
        "An eye in the inner of two glasses.",
        in_glass(
            [
                shape("sphere", "glass", center=[0, 0, 0], radius=0.5),
                shape("sphere", "dense", center=[0, 0, 0], radius=0.25),
            ],
            INSIDE,
        ),
        Radiance(3.24),
        rounding=1e-4,
    ),
)
