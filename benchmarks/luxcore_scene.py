"""A benchmark scene in LuxCore's terms, in grey: reflectances and radiance at one wavelength."""

import numpy as np
import trimesh

from .mitsuba_scene import read_merged

SPHERE_SUBDIVISIONS = 5  # LuxCore has no spheres: 20480 triangles with interpolated normals


def luxcore_scene(path, wavelength, size, max_path_length):
    """`{"meshes", "scene", "config"}` for renderer_luxcore.py, of the scene file at `wavelength` (nm)."""
    table = read_merged(path)
    camera = table["camera"]
    scene = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": camera["position"],
        "scene.camera.lookat.target": camera["look_at"],
        "scene.camera.up": camera["up"],
        "scene.camera.fieldofview": camera["field_of_view"],
        "scene.camera.autovolume.enable": False,
    }
    meshes = {}
    for shape in table["shapes"]:
        name = shape["name"].replace(" ", "_")
        meshes[name] = mesh_of(shape)
        scene |= material_of(name, shape, table, wavelength)
        scene[f"scene.objects.{name}.shape"] = name
        scene[f"scene.objects.{name}.material"] = name
    config = {
        "film.width": size,
        "film.height": size,
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "sampler.type": "RANDOM",
        "native.threads.count": 1,
        # Roulette makes the images of the bidirectional engines too bright.
        "path.russianroulette.cap": 1.0,
        "path.russianroulette.depth": 64,
        **{f"path.pathdepth.{kind}": max_path_length for kind in ("total", "diffuse", "glossy", "specular")},
        "path.maxdepth": max_path_length,
        "light.maxdepth": max_path_length,
    }
    return {"meshes": meshes, "scene": scene, "config": config}


def mesh_of(shape):
    """Points, triangles and, for a sphere, normals."""
    mesh = MESHES[shape["type"]](shape)
    normals = mesh.vertex_normals.tolist() if shape["type"] == "sphere" else None
    return {"points": mesh.vertices.tolist(), "triangles": mesh.faces.tolist(), "normals": normals}


def _rectangle(shape):
    (a, b), corner = np.array(shape["edges"], float), np.array(shape["corner"], float)
    return trimesh.Trimesh([corner, corner + a, corner + a + b, corner + b], [[0, 1, 2], [0, 2, 3]])


def _box(shape):
    (step,) = shape["transform"]
    box = trimesh.creation.box(bounds=[shape["min"], shape["max"]])
    return box.apply_transform(np.array(step["matrix"]))


def _sphere(shape):
    sphere = trimesh.creation.icosphere(SPHERE_SUBDIVISIONS, shape["radius"])
    return sphere.apply_translation(shape["center"])


MESHES = {"rectangle": _rectangle, "box": _box, "sphere": _sphere}


def material_of(name, shape, table, wavelength):
    """Properties of a shape's material, with its emission."""
    material, prefix = table["materials"][shape["material"]], f"scene.materials.{name}"
    if material["type"] == "dielectric":
        return {
            f"{prefix}.type": "glass",
            f"{prefix}.kr": [1.0] * 3,
            f"{prefix}.kt": [1.0] * 3,
            f"{prefix}.interiorior": float(material["ior"]),
            f"{prefix}.exteriorior": 1.0,
        }
    result = {
        f"{prefix}.type": "matte",
        f"{prefix}.kd": [at(table["spectra"][material["reflectance"]], wavelength)] * 3,
    }
    if "emission" in shape:
        radiance = at(table["spectra"][shape["emission"]], wavelength)
        result |= {f"{prefix}.emission": [radiance] * 3, f"{prefix}.emission.gain.normalizebycolor": False}
    return result


def at(spectrum, wavelength):
    """A sampled spectrum at `wavelength`, linear between its samples."""
    return float(np.interp(wavelength, spectrum["wavelengths"], spectrum["values"]))
