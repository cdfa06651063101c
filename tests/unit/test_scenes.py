"""The scenes in scenes/ can be read, and show what their comments say; the mesh of one of them is sound."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import artist_py
from artist_py import data
from artist_py.errors import SceneError
from artist_py.film.color import RGB_TO_XYZ
from artist_py.scene.compile import validate
from artist_py.scene.meshes import load_mesh
from artist_py.scene.reader import read_scene
from artist_py.scene.spectra import tabulate
from artist_py.scene.spectrum_types import Named

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
NAMES = sorted(path.stem for path in SCENES.glob("*.toml"))
FIRST_NM, LAST_NM = 380, 780


def path_of(name):
    """The file of a scene; skips the test where the scene needs a mesh that was not made."""
    if name == "mesh" and not (SCENES / "generated" / "knot.ply").exists():
        pytest.skip("python scripts/make_mesh.py was not run")
    return SCENES / f"{name}.toml"


@pytest.mark.parametrize("name", NAMES)
def test_scene_is_valid(name):
    validate(read_scene(path_of(name)))


@pytest.mark.parametrize("name", NAMES)
def test_scene_begins_by_saying_what_it_shows(name):
    first = (SCENES / f"{name}.toml").read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("# ") and len(first) > 30


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_scene_renders(name):
    scene = artist_py.load_scene(path_of(name), {"film.resolution": [16, 16]})
    film = artist_py.render(scene, iterations=4).film
    assert film.rejected == ()
    assert np.isfinite(film.rgb).all() and film.rgb.max() > 0


# --- what scenes show ---------------------------------------------------------------------------------------------


def color_of(reflectance, illuminant):
    """XYZ of a reflectance (bins,) under a light, where a reflectance of 1 has Y = 1."""
    observer = data.observer_bins("CIE 1931 2", FIRST_NM, LAST_NM)
    light = tabulate(Named(illuminant), FIRST_NM, LAST_NM, "emission")
    return observer @ (light * reflectance) / (observer[1] @ light)


@pytest.mark.slow
def test_colorchecker_has_the_colors_of_its_patches():
    scene = artist_py.load_scene(SCENES / "colorchecker.toml")
    rgb = artist_py.render(scene, iterations=8).film.rgb
    focal_length = 0.5 * rgb.shape[0] / np.tan(np.radians(0.5 * scene.graph.camera.field_of_view))
    patches = [shape for shape in scene.graph.shapes if (shape.material or "card") != "card"]
    assert len(patches) == 24
    for patch in patches:
        (x, y, _), distance = patch.corner, scene.graph.camera.position[2]
        column = int(rgb.shape[1] / 2 + (x + 0.5) * focal_length / distance)
        row = int(rgb.shape[0] / 2 - (y + 0.5) * focal_length / distance)
        seen = rgb[row - 20 : row + 20, column - 20 : column + 20].reshape(-1, 3)
        table = tabulate(Named(f"ColorChecker {patch.material}"), FIRST_NM, LAST_NM, "reflectance")
        expected = np.linalg.solve(RGB_TO_XYZ, color_of(table, "D65"))
        error = seen.std(axis=0) / 20  # of the mean of 1600 pixels, of which filters make neighbours alike
        assert (error < 0.005).all() and (np.abs(seen.mean(axis=0) - expected) < 5 * error + 1e-4).all(), (
            patch.material
        )


def test_metamer_is_grey_in_daylight_only():
    spectrum = read_scene(SCENES / "lights.toml").materials["other_grey"].reflectance
    other = tabulate(spectrum, FIRST_NM, LAST_NM, "reflectance")
    grey = np.full(LAST_NM - FIRST_NM, 0.45)
    assert color_of(other, "D65") == pytest.approx(color_of(grey, "D65"), rel=1e-4)
    for illuminant in ("A", "FL11", "LED-B3"):
        difference = color_of(other, illuminant) / color_of(grey, illuminant) - 1
        assert np.abs(difference).max() > 0.05


def test_cornell_paints_are_the_measured_ones():
    materials = read_scene(SCENES / "cornell_box.toml").materials
    # Of the data published by the Cornell University Program of Computer Graphics, at 528 and 532 nm.
    between = {"white": (0.733, 0.725), "red": (0.059, 0.059), "green": (0.481, 0.462)}
    for name, ends in between.items():
        reflectance = tabulate(materials[name].reflectance, 530, 531, "reflectance")[0]
        assert min(ends) - 1e-9 <= reflectance <= max(ends) + 1e-9


# --- the pool ---------------------------------------------------------------------------------------------------------


def test_water_of_the_pool_is_closed():
    """Up to the corners that its sharp edges have twice; light that enters the water leaves it again."""
    mesh = load_mesh(SCENES / "meshes" / "pool_water.ply")
    assert mesh.warnings == () and mesh.normals is not None
    _, index = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = index.reshape(-1)[mesh.faces]
    edges = np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)])
    forward, backward = ({tuple(edge) for edge in pairs.tolist()} for pairs in (edges, edges[:, ::-1]))
    assert len(forward) == len(edges)
    unpaired = {tuple(sorted(edge)) for edge in forward - backward}
    # Only the seams between strips of the sides and the two triangles below, which lie on straight lines, are apart.
    bottom = {i for edge in unpaired for i in edge}
    lowest = np.unique(mesh.vertices, axis=0)[sorted(bottom)][:, 2]
    assert (lowest == lowest.min()).all()


def test_water_of_the_pool_is_what_the_script_makes(tmp_path):
    committed = (SCENES / "meshes" / "pool_water.ply").read_bytes()
    code = "import pathlib, sys; sys.path.insert(0, sys.argv[1]); import make_pool; "
    code += "make_pool.TARGET = pathlib.Path(sys.argv[2]); make_pool.main()"
    command = [sys.executable, "-c", code, ROOT / "scripts", tmp_path / "water.ply"]
    subprocess.run(command, check=True, capture_output=True)
    made, expected = load_mesh(tmp_path / "water.ply"), load_mesh(SCENES / "meshes" / "pool_water.ply")
    assert len((tmp_path / "water.ply").read_bytes()) == len(committed)
    np.testing.assert_allclose(made.vertices, expected.vertices, atol=1e-6)
    assert np.array_equal(made.faces, expected.faces)


# --- the mesh -----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def knot(tmp_path_factory):
    """(path, Mesh) of a small knot, made by the script."""
    path = tmp_path_factory.mktemp("mesh") / "folder" / "knot.ply"
    script = [sys.executable, ROOT / "scripts" / "make_mesh.py"]
    subprocess.run([*script, "--along", "240", "--around", "30", "-o", path], check=True)
    return path, load_mesh(path)


def test_knot_is_closed_and_turned_outwards(knot):
    mesh = knot[1]
    assert mesh.warnings == () and len(mesh.faces) == 2 * 240 * 30
    edges = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)]).astype(np.int64)
    forward, backward = ({tuple(edge) for edge in pairs} for pairs in (edges, edges[:, ::-1]))
    assert len(forward) == len(edges) and forward == backward
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    length = 2 * np.pi * np.hypot(2 * 1.0, 3 * 0.42)  # of the centre line, roughly
    assert volume == pytest.approx(np.pi * 0.22**2 * length, rel=0.15)


def test_knot_has_normals_that_fit_its_faces(knot):
    mesh = knot[1]
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1, abs=1e-6)
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    faces /= np.linalg.norm(faces, axis=1, keepdims=True)
    for corner in range(3):
        cosines = np.einsum("ij,ij->i", faces, mesh.normals[mesh.faces[:, corner]])
        assert cosines.min() > 0 and np.mean(cosines) > 0.9


def test_knot_of_the_scene_has_384_000_triangles(tmp_path):
    command = [sys.executable, ROOT / "scripts" / "make_mesh.py", "-o", tmp_path / "knot.ply"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.endswith("knot.ply: 384000 triangles\n")
    header = (tmp_path / "knot.ply").read_bytes()[:300].split(b"end_header")[0]
    assert b"element face 384000" in header


def test_missing_mesh_is_named_with_its_line(tmp_path):
    lines = (SCENES / "mesh.toml").read_text(encoding="utf-8").splitlines(keepends=True)
    line = next(i for i, text in enumerate(lines, start=1) if text.startswith("file ="))
    assert "python scripts/make_mesh.py" in lines[line - 1]
    (tmp_path / "mesh.toml").write_text("".join(lines), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        validate(read_scene(tmp_path / "mesh.toml"))
    (problem,) = caught.value.problems
    assert problem.line == line and problem.message.endswith("knot.ply: no such file")


def test_generator_refuses_too_few_points():
    command = [sys.executable, ROOT / "scripts" / "make_mesh.py", "--around", "2"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "3 points or more" in done.stderr
