"""Scenes with nothing in them, and input that must be refused with a clear message."""

from artist_py.stress.case import Case, Radiance, Refusal
from artist_py.stress.meshes import write_ply
from artist_py.stress.scenes import VIEW, furnace, look, scene, shape

BLACK = "the image will be black"
WALL = shape("sphere", "grey", center=[0, 0, 0], radius=1, reverse=True)


def refused(name, shows, text, tables, **more):
    """A case that must not be rendered."""
    return Case(name, shows, tables, Refusal(text), integrators=("vcm",), **more)


CASES = (
    Case("empty", "No shape and no light.", scene([], VIEW, aside=None), Radiance(0), warning=BLACK),
    Case("no-emitter", "Walls and no light.", scene([WALL], VIEW, aside=None), Radiance(0), warning=BLACK),
    Case(
        "environment-alone",
        "No shape, and light from everywhere.",
        scene([], VIEW, emitters=[{"type": "environment", "spectrum": 1}], aside=None),
        Radiance(1),
    ),
    Case(
        "point-alone",
        "No shape, and a point that lights nothing.",
        scene([], VIEW, emitters=[{"type": "point", "position": [0, 1, 0], "spectrum": 1}], aside=None),
        Radiance(0),
    ),
    refused("field-of-view-0", "No view.", "field_of_view", furnace(camera=look([0, 0, 0], [0, 1, 0], 0))),
    refused(
        "field-of-view-180",
        "A view of half a turn.",
        "field_of_view",
        furnace(camera=look([0, 0, 0], [0, 1, 0], 180)),
    ),
    refused(
        "ior-0", "No refractive index.", "ior", furnace(materials={"glass": {"type": "dielectric", "ior": 0}})
    ),
    refused(
        "reflectance-1.001", "More light than there was.", "reflectance", furnace(albedo=1.001, emission=1)
    ),
    refused("emission-negative", "Light below nothing.", "emission", furnace(emission=-1)),
    refused(
        "radius-0",
        "A ball that is none.",
        "radius",
        furnace([shape("sphere", "grey", center=[0, 0, 0], radius=0)]),
    ),
    refused(
        "one-sample",
        "A spectrum of one sample.",
        "wavelengths",
        furnace(
            materials={"wall": {"type": "diffuse", "reflectance": {"wavelengths": [550], "values": [0.5]}}}
        ),
    ),
    refused("path-length-0", "No edge.", "max_path_length", furnace(render={"max_path_length": 0})),
    refused("alpha-0", "A radius that is lost at once.", "alpha", furnace(render={"merging": {"alpha": 0}})),
    refused(
        "wavelength-range-empty",
        "No light at all.",
        "wavelength_range",
        furnace(render={"wavelength_range": [550, 550]}),
    ),
    refused(
        "mesh-not-finite",
        "A vertex at infinity.",
        "finite",
        furnace([shape("mesh", "grey", file="bad.ply")]),
        files=(("bad.ply", write_ply, ([[0, 0, 0], [1, 0, 0], [0, float("inf"), 0]], [[0, 1, 2]])),),
    ),
    refused(
        "mesh-empty",
        "A mesh without faces.",
        "face",
        furnace([shape("mesh", "grey", file="bad.ply")]),
        files=(("bad.ply", write_ply, ([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [])),),
    ),
    refused(
        "emitter-without-area",
        "A lamp that is a line.",
        "has an area",
        furnace([shape("mesh", file="bad.ply", emission=1)]),
        files=(("bad.ply", write_ply, ([[0.0, 0, 0], [1, 0, 0], [0.5, 0, 0]], [[0, 1, 2]])),),
    ),
)
