"""What a compiled scene holds and needs, and what its kernels leave out and why, in words."""

import numpy as np

from artist_py.scene import tables
from artist_py.scene.compile_materials import KINDS
from artist_py.scene.identity import settings as effective_settings

# field of `tables.Needs`: (what it is, why it is left out)
FEATURES = {
    "diffuse": ("Lambertian reflection", "no diffuse material"),
    "oren_nayar": ("rough diffuse reflection", "no oren-nayar material"),
    "phong": ("Phong's lobe", "no phong material"),
    "plastic": ("diffuse reflection under a clear coat", "no plastic material"),
    "mirror": ("ideal mirrors", "no mirror material"),
    "conductor": ("smooth metals, complex Fresnel", "no conductor material"),
    "dielectric": ("smooth glass, refraction", "no dielectric material"),
    "thin_dielectric": ("thin panes", "no thin-dielectric material"),
    "pass_through": ("surfaces that light ignores", 'no material of type "none"'),
    "lobes": ("a choice between lobes", "no material has more than one lobe"),
    "sharp": ("materials that are not merged at", "no lobe is too narrow for merging"),
    "dispersion": (
        "refraction by wavelength, lane densities",
        "no index of refraction depends on wavelength",
    ),
    "media": ("a stack of nested dielectrics", "no two shapes of glass touch, and the camera is in air"),
    "triangles": ("triangle meshes", "no mesh"),
    "smooth_triangles": ("interpolated normals", "no mesh has vertex normals"),
    "parallelograms": ("rectangles and boxes", "no rectangle and no box"),
    "quadrics": ("exact spheres, disks, cylinders, cones", "no exact shape"),
    "instances": ("instances", "no instance"),
    "triangle_emitters": ("sampling of emitting triangles", "no mesh emits"),
    "parallelogram_emitters": ("sampling of emitting rectangles", "no rectangle or box emits"),
    "sphere_emitters": ("sampling of spheres by solid angle", "no sphere emits"),
    "quadric_emitters": ("sampling of other exact shapes", "no disk, cylinder or cone emits"),
    "surfaceless_emitters": ("emitters without a surface", "all light comes from shapes"),
    "point_emitters": ("points that emit", "no point emitter"),
    "spot_emitters": ("points that emit into a cone", "no spot emitter"),
    "distant_emitters": ("directional light and suns", "no directional emitter"),
    "environments": ("light from everywhere around", "no environment"),
    "environment_images": ("environments from images", "no environment has an image"),
    "hidden_emitters": ("emitters that the camera does not see", "every emitter is visible"),
    "one_sided": ("materials that are black from behind", "every material is two-sided"),
    "textures": ("reflectances that vary over surfaces", "no material has a texture"),
    "fluorescence": ("light given off at other wavelengths, sets of wavelengths", "no material fluoresces"),
    "coated_dyes": ("fluorescence under a clear coat", "no fluorescent material has a coat"),
    "shared_wavelengths": ("one set of wavelengths per iteration", "every path has its own wavelengths"),
}

EMITTER_NAMES = (
    "triangles",
    "parallelograms",
    "spheres",
    "other exact shapes",
    "points",
    "spots",
    "directional",
    "suns",
    "environments",
)


def describe(compiled, memory):
    """`{title: [(name, value), ...]}`, all text; `memory` maps what is stored to bytes."""
    return {
        "Geometry": _geometry(compiled),
        "Lights": _lights(compiled),
        "Materials": _materials(compiled),
        **({"Textures": _textures(compiled)} if compiled.scene.textures else {}),
        "Needed": _features(compiled, needed=True),
        "Left out": _features(compiled, needed=False),
        "Memory": _memory(memory),
        "Settings": list(_flat(effective_settings(compiled.graph))),
    }


def _geometry(compiled):
    geometry, space = compiled.scene.geometry, compiled.space
    counts = {
        "triangles": len(geometry.triangles),
        "parallelograms": len(geometry.parallelograms),
        "exact shapes": 0 if geometry.quadrics is None else len(geometry.quadrics),
        "instances": 0 if geometry.instances is None else len(geometry.instances),
        "placed shapes": len(geometry.placements),
    }
    rows = [(name, f"{count:,}") for name, count in counts.items() if count]
    centre = ", ".join(f"{x:.6g}" for x in space.centre)
    rows += [("centre", centre), ("bounding radius", f"{space.radius:.6g} scene units")]
    return [*rows, ("built in", f"{compiled.seconds:.2f} s")]


def _lights(compiled):
    emitters = compiled.scene.emitters
    if emitters is None:
        return [("emitters", "none: the image will be black")]
    records = emitters.records.array
    rows = [(name, f"{np.sum(records['kind'] == kind):,}") for kind, name in enumerate(EMITTER_NAMES)]
    rows = [row for row in rows if row[1] != "0"]
    chance = records["pdf_select"]
    rows.append(("chosen by power", f"probabilities from {chance.min():.3g} to {chance.max():.3g}"))
    return rows


def _materials(compiled):
    words = {kind: cls.__name__ for cls, kind in reversed(KINDS.items())}
    rows = compiled.scene.materials.array[1:]
    used = rows["kind"]
    counts = [(words[kind], int(np.sum(used == kind))) for kind in sorted(set(used.tolist()))]
    counts += (
        [("of these fluorescent", int(np.sum(rows["fluorescence"] >= 0)))] if compiled.fluorescence else []
    )
    unused = len(compiled.graph.materials) - len(used)
    found = [(name, str(count)) for name, count in counts]
    return found + ([("defined but not used", str(unused))] if unused else [])


def _textures(compiled):
    colours = {1: "grey", 3: "RGB"}
    rows = [
        (image.path, f"{image.width} x {image.height}, {colours[image.channels]}, {_size(image.nbytes)}")
        for image in compiled.texture_images
    ]
    boards = int(np.sum(compiled.scene.textures.records.array["kind"] == tables.CHECKERBOARD))
    return rows + ([("checkerboards", str(boards))] if boards else [])


def _size(size):
    return f"{size / 2**20:.1f} MiB" if size >= 2**20 else f"{size / 2**10:.1f} KiB"


def _features(compiled, needed):
    needs = compiled.scene.needs
    assert set(FEATURES) == set(tables.Needs._fields)  # noqa: S101 - a feature without words would be left out silently
    items = [
        (name.replace("_", " "), *FEATURES[name]) for name in FEATURES if bool(getattr(needs, name)) == needed
    ]
    camera = compiled.camera
    if bool(camera.lens) == needed:
        items.append(("lens", "depth of field", "the camera is a pinhole"))
    if (compiled.pixel_filter.weights is not None) == needed:
        items.append(("filter weights", "a filter with negative lobes", "the filter is its own density"))
    return [(name, what if needed else f"{why}") for name, what, why in items]


def _memory(memory):
    rows = [(name, f"{size / 2**20:.1f} MiB") for name, size in memory.items() if size]
    return [
        *rows,
        ("in all", f"{sum(memory.values()) / 2**20:.1f} MiB, and about 200 MiB for Python and kernels"),
    ]


def _flat(table, prefix=""):
    """Dotted keys and values of nested tables."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", str(value)
