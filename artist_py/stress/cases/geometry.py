"""Triangles that are no good: on top of each other, without area, needles; and very many."""

from artist_py.stress.case import Case, Radiance
from artist_py.stress.meshes import write_rubble, write_sphere
from artist_py.stress.scenes import box_furnace, furnace, look, shape

RUBBLE = ("plain", "duplicates", "coplanar", "slivers", "degenerate")
EDGES = {
    "ppm": "photons beyond the edges of so many small triangles are missing",
    "bpm": "photons beyond the edges of so many small triangles are missing",
}


def strewn(material, radius=1e-3, **more):
    """Rubble of a lossless material in a furnace."""
    return furnace(
        [shape("mesh", material, file="rubble.ply", smooth=False)],
        look([0.3, -0.8, 0.1], [-0.1, 0.6, 0.1]),
        render={"max_path_length": 200, "merging": {"radius": radius, "light_paths": 4}},
        **more,
    )


def rubble(*kinds):
    """The `files` of a case."""
    return (("rubble.ply", write_rubble, (7, kinds)),)


DOUBLE = shape("box", "wall", min=[-1, -1, -1], max=[1, 1, 1], reverse=True)
TWICE_BLACK = shape("rectangle", "white", corner=[-0.5, 0.3, -0.5], edges=[[1, 0, 0], [0, 0, 1]])

CASES = (
    *(
        Case(
            f"{kind}-triangles",
            shows,
            strewn("white"),
            Radiance(1),
            files=rubble(kind),
            left_out=EDGES,
        )
        for kind, shows in (
            ("duplicates", "Each triangle four times in one place."),
            ("coplanar", "Triangles that overlap in one plane."),
            ("slivers", "Needles of aspect 1e7."),
        )
    ),
    Case(
        "degenerate-triangles",
        "Points and lines among triangles.",
        strewn("white"),
        Radiance(1),
        files=rubble("plain", "degenerate"),
        left_out=EDGES,
    ),
    Case(
        "mirror-rubble",
        "All of that as mirrors.",
        strewn("mirror", 0.05),
        Radiance(1),
        files=rubble(*RUBBLE),
    ),
    Case(
        "coincident-plates",
        "Two white plates in one place, one the other way round.",
        furnace(
            [TWICE_BLACK, {**TWICE_BLACK, "reverse": True}],
            render={"merging": {"radius": 0.005, "light_paths": 4}},
        ),
        Radiance(1),
        left_out={"ppm": "photons beyond the plates' edges are missing", "bpm": "as ppm"},
    ),
    Case(
        "coincident-walls",
        "Every wall twice; one emits.",
        box_furnace([DOUBLE], render={"merging": {"radius": 0.005, "light_paths": 4}}),
        Radiance(1),
        left_out={"ppm": "photons beyond the walls' edges are missing", "bpm": "as ppm"},
    ),
    Case(
        "thin-box",
        "A white box of a millionth of its size across.",
        furnace(
            [shape("box", "white", min=[-0.4, 0.3, -0.4], max=[0.4, 0.3 + 1e-6, 0.4])],
            render={"merging": {"radius": 0.005, "light_paths": 4}},
        ),
        Radiance(1),
        left_out={"ppm": "photons beyond the box's edges are missing", "bpm": "as ppm"},
    ),
    Case(
        "thin-cone",
        "A needle of glass and one of white.",
        furnace(
            [
                shape("cone", "white", base=[-0.2, 0.3, -0.5], apex=[-0.1, 0.4, 0.5], radius=1e-5),
                shape("cylinder", "glass", base=[0.1, 0.3, -0.5], top=[0, 0.4, 0.5], radius=1e-5),
            ]
        ),
        Radiance(1),
        left_out={"ppm": "photons beside the needles are missing", "bpm": "as ppm"},
    ),
    Case(
        "triangles-1e5",
        "A white ball of 1e5 triangles.",
        furnace([shape("mesh", "white", file="ball.ply")], look([0.3, -0.8, 0.1], [-0.1, 0.6, 0.1])),
        Radiance(1),
        files=(("ball.ply", write_sphere, (224, 224, 0.4)),),
    ),
    Case(
        "triangles-1e7",
        "A white ball of 1e7 triangles.",
        furnace([shape("mesh", "white", file="ball.ply")], look([0.3, -0.8, 0.1], [-0.1, 0.6, 0.1])),
        Radiance(1),
        files=(("ball.ply", write_sphere, (2236, 2236, 0.4)),),
        quick=False,
        seconds=900.0,
    ),
)
