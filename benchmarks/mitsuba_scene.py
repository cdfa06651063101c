"""A benchmark scene in Mitsuba's terms: the few shapes and materials that the benchmarks' scenes use."""

from pathlib import Path

import numpy as np
import tomli


def mitsuba_scene(path):
    """Mitsuba's dictionary for a scene file, ready for JSON: transforms are `{"matrix": rows}`."""
    table = read_merged(Path(path))
    shapes = {shape["name"]: mitsuba_shape(shape, table) for shape in table["shapes"]}
    render = table["render"]
    integrator = {
        "type": "path",
        "max_depth": render["max_path_length"],
        # Both count the same: the edge after this many may be the first that roulette denies.
        "rr_depth": render["roulette_length"],
    }
    return {"type": "scene", "integrator": integrator, "sensor": mitsuba_sensor(table), **shapes}


def read_merged(path):
    """The table of a scene file and those it includes."""
    table = tomli.loads(path.read_text(encoding="utf-8"))
    for name in table.pop("include", ()):
        included = read_merged(path.parent / name)
        for key, value in table.items():
            if isinstance(value, list):
                included[key] = included.get(key, []) + value
            else:
                included[key] = included.get(key, {}) | value
        table = included
    return table


def mitsuba_sensor(table):
    """A pinhole camera and a film with a box filter."""
    camera, (width, height) = table["camera"], table["film"]["resolution"]
    return {
        "type": "perspective",
        "fov": camera["field_of_view"],
        "fov_axis": "smaller",
        "to_world": {"matrix": look_at(camera)},
        "sampler": {"type": "independent"},
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
    }


def look_at(camera):
    """Camera to world, as Mitsuba has it: x to the left, y up, z forward."""
    position = np.array(camera["position"], float)
    forward = unit(np.array(camera["look_at"], float) - position)
    left = unit(np.cross(camera["up"], forward))
    return affine(left, np.cross(forward, left), forward, position)


def mitsuba_shape(shape, table):
    """One shape with its material and emission."""
    result = GEOMETRY[shape["type"]](shape)
    result["bsdf"] = mitsuba_bsdf(table["materials"][shape["material"]], table["spectra"])
    if "emission" in shape:
        # Our diffuse surfaces reflect on both sides. Of the others only the front is ever seen.
        result["bsdf"] = {"type": "twosided", "bsdf": result["bsdf"]}
        result["emitter"] = {
            "type": "area",
            "radiance": mitsuba_spectrum(table["spectra"][shape["emission"]]),
        }
    return result


def _rectangle(shape):
    (a, b), corner = np.array(shape["edges"], float), np.array(shape["corner"], float)
    return {
        "type": "rectangle",
        "to_world": {"matrix": affine(a / 2, b / 2, unit(np.cross(a, b)), corner + (a + b) / 2)},
    }


def _cube(shape):
    (step,) = shape["transform"]
    return {"type": "cube", "to_world": {"matrix": step["matrix"]}}


def _sphere(shape):
    return {"type": "sphere", "center": shape["center"], "radius": shape["radius"]}


GEOMETRY = {"rectangle": _rectangle, "box": _cube, "sphere": _sphere}


def mitsuba_bsdf(material, spectra):
    """A diffuse or a smooth dielectric surface."""
    if material["type"] == "diffuse":
        return {"type": "diffuse", "reflectance": mitsuba_spectrum(spectra[material["reflectance"]])}
    return {"type": "dielectric", "int_ior": material["ior"], "ext_ior": 1.0}


def mitsuba_spectrum(spectrum):
    """Samples, linear between them."""
    return {
        "type": "irregular",
        "wavelengths": ", ".join(map(str, spectrum["wavelengths"])),
        "values": ", ".join(map(str, spectrum["values"])),
    }


def unit(v):
    """`v` at length 1."""
    return v / np.linalg.norm(v)


def affine(x, y, z, origin):
    """Rows of the 4x4 matrix with these columns."""
    return np.vstack([np.column_stack([x, y, z, origin]), [0, 0, 0, 1]]).tolist()
