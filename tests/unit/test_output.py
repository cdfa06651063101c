"""Output files: what is in them, that equal ones are equal, and that nothing is ever left half done."""

import json
import os
import re
import stat
import subprocess
import sys
import textwrap
from dataclasses import replace

import numpy as np
import OpenImageIO as oiio
import pytest

from artist_py.errors import OutputError
from artist_py.film.image import FilmImage
from artist_py.film.output import check_output, write_image
from artist_py.film.reading import read_image
from artist_py.film.sidecar import write_sidecar

WIDTH, HEIGHT = 40, 30


@pytest.fixture
def film():
    """A film with everything in it, cropped from 100 x 80 pixels."""
    rng = np.random.default_rng(3)
    matrix = np.arange(16.0).reshape(4, 4)
    return FilmImage(
        rgb=rng.random((HEIGHT, WIDTH, 3)),
        iterations=12,
        resolution=(100, 80),
        crop=(10, 10 + WIDTH, 20, 20 + HEIGHT),
        variance=rng.random((HEIGHT, WIDTH, 3)),
        spectral=rng.random((HEIGHT, WIDTH, 2)),
        band_centres=np.array([550.0, 632.5]),
        aovs={
            "normal": rng.random((HEIGHT, WIDTH, 3)).astype(np.float32),
            "depth": rng.random((HEIGHT, WIDTH, 1)).astype(np.float32),
            "material": np.full((HEIGHT, WIDTH, 1), 70_000, np.float32),
        },
        world_to_camera=matrix,
        world_to_ndc=matrix + 1,
    )


def plain_film(values):
    """A film of nothing but colour."""
    return FilmImage(rgb=np.asarray(values, dtype=float), iterations=1)


def in_child(code, *arguments):
    """Run `code` in a process of its own; fails with its error output unless it succeeds."""
    script = textwrap.dedent(code)
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


class TestExr:
    """The OpenEXR file."""

    def test_channels_survive(self, tmp_path, film):
        """Every channel comes back as float32, colour first."""
        write_image(tmp_path / "a.exr", film)
        stored = read_image(tmp_path / "a.exr")
        assert stored.names[:3] == ("R", "G", "B")
        assert np.array_equal(stored.rgb, film.rgb.astype(np.float32))
        assert np.array_equal(stored.layer("normal"), film.aovs["normal"])
        assert np.array_equal(stored.layer("depth"), film.aovs["depth"])
        assert np.array_equal(stored.layer("material"), film.aovs["material"])
        variance = [stored.names.index(f"variance.{name}") for name in "RGB"]
        assert np.array_equal(stored.pixels[..., variance], film.variance.astype(np.float32))

    def test_spectral_layout(self, tmp_path, film):
        """Names and attributes follow Fichet, Pacanowski and Wilkie 2021, so that their readers find the bands."""
        write_image(tmp_path / "a.exr", film)
        stored = read_image(tmp_path / "a.exr")
        spectral = re.compile(
            r"S(\d)\.(\d*,?\d*(?:[Ee][+-]?\d+)?)(?:Y|Z|E|P|T|G|M|k|h|da|d|c|m|u|n|p)?(?:m|Hz)"
        )
        bands = {name: match for name in stored.names if (match := spectral.fullmatch(name))}
        assert sorted(bands) == ["S0.550,000000nm", "S0.632,500000nm"]
        for i, name in enumerate(sorted(bands)):
            assert np.array_equal(
                stored.pixels[..., stored.names.index(name)], film.spectral[..., i].astype(np.float32)
            )
        assert stored.metadata["spectralLayoutVersion"] == "1.0"
        assert stored.metadata["emissiveUnits"] == "W.m^-2.sr^-1.nm^-1"

    def test_nothing_spectral_without_bands(self, tmp_path, film):
        """A file without bands does not say that it has some."""
        write_image(tmp_path / "a.exr", replace(film, spectral=None, band_centres=None))
        assert "spectralLayoutVersion" not in read_image(tmp_path / "a.exr").metadata

    def test_crop_is_the_data_window(self, tmp_path, film):
        """A crop stands where it was cut out of the whole image."""
        write_image(tmp_path / "a.exr", film)
        assert read_image(tmp_path / "a.exr").window == (10, 20, 100, 80)
        spec = oiio.ImageInput.open(str(tmp_path / "a.exr")).spec()
        assert (spec.width, spec.height, spec.full_x, spec.full_y) == (WIDTH, HEIGHT, 0, 0)

    def test_metadata(self, tmp_path, film):
        """Attributes have the names and types that other programs look for; OpenEXR's matrices act on rows."""
        metadata = {
            "artist:seed": 7,
            "artist:big": 2**40,
            "whiteLuminance": 72983.0,
            "artist:settings": {"ü": [1, None]},
        }
        write_image(tmp_path / "a.exr", film, metadata)
        stored = read_image(tmp_path / "a.exr").metadata
        assert stored["samplesPerPixel"] == 12
        assert stored["artist:iterations"] == 12
        assert stored["artist:seed"] == 7
        assert stored["artist:big"] == str(2**40)
        assert stored["whiteLuminance"] == 72983.0
        assert json.loads(stored["artist:settings"]) == {"ü": [1, None]}
        assert stored["compression"] == "zip"
        assert re.fullmatch(r"artist \d+\.\d+\.\d+", stored["Software"])
        assert np.allclose(stored["chromaticities"], (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290))
        assert np.array_equal(np.reshape(stored["worldToCamera"], (4, 4)), film.world_to_camera.T)
        assert np.array_equal(np.reshape(stored["worldToNDC"], (4, 4)), film.world_to_ndc.T)

    @pytest.mark.parametrize("extension", ["exr", "png"])
    def test_equal_images_are_equal_files(self, tmp_path, film, extension):
        """No time of writing, name or process gets into the bytes."""
        first, second = tmp_path / f"a.{extension}", tmp_path / f"b.{extension}"
        write_image(first, film)
        write_image(second, film)
        assert first.read_bytes() == second.read_bytes()
        assert read_image(first).metadata["DateTime"] == "1970:01:01 00:00:00"

    def test_large_and_special_values(self, tmp_path):
        """Values that half floats cannot hold stay what they are."""
        values = np.array([[[1e6, 1e-20, -3.0], [np.inf, np.nan, 0.0]]])
        write_image(tmp_path / "a.exr", plain_film(values))
        assert np.array_equal(read_image(tmp_path / "a.exr").rgb, values.astype(np.float32), equal_nan=True)


class TestWholeOrNothing:
    """Failures leave what was there, and nothing else."""

    @pytest.mark.parametrize(
        ("name", "message"),
        [
            ("missing/a.exr", r"there is no directory '.*missing'"),
            ("folder.exr", "is a directory"),
            ("a.jpg", r"unknown extension '.jpg'; images are written as .exr or .png"),
            ("a", "no extension"),
            ("file.txt/a.exr", "there is no directory"),
            ("read-only.exr", "is read-only"),
            ("\udcff.exr", "not valid UTF-8"),
            ("x" * 300 + ".exr", "too long"),
        ],
    )
    @pytest.mark.parametrize(
        "action", [check_output, lambda path: write_image(path, plain_film(np.ones((2, 2, 3))))]
    )
    def test_unusable_paths(self, tmp_path, monkeypatch, action, name, message):
        """The message names the path and what is wrong, both before the render and when it is written."""
        (tmp_path / "folder.exr").mkdir()
        (tmp_path / "file.txt").touch()
        (tmp_path / "read-only.exr").touch()
        # Whoever runs the tests may be allowed everything.
        monkeypatch.setattr(os, "access", lambda path, _mode: path.name != "read-only.exr")
        before = sorted(os.listdir(tmp_path))
        with pytest.raises(OutputError, match=message) as caught:
            action(tmp_path / name)
        assert name in str(caught.value)
        assert sorted(os.listdir(tmp_path)) == before

    def test_no_permission(self, tmp_path):
        """A folder that may not be written to is named before the render."""
        code = """
            import os, sys
            from artist_py.film.output import check_output, write_image
            from artist_py.errors import OutputError
            if os.geteuid() == 0:
                os.seteuid(65534)
            try:
                check_output(sys.argv[1])
            except OutputError as error:
                print(error)
        """
        folder = tmp_path / "closed"
        folder.mkdir(mode=0o555)
        assert in_child(code, folder / "a.exr").strip().endswith("Permission denied")

    @pytest.mark.parametrize("extension", ["exr", "png"])
    def test_full_disk(self, tmp_path, extension):
        """However much fits, a file that does not fit is an error; the old one stays, and no other is left."""
        code = """
            import resource, sys
            from pathlib import Path
            import numpy as np
            from artist_py.errors import OutputError
            from artist_py.film.image import FilmImage
            from artist_py.film.output import write_image
            path = Path(sys.argv[1])
            film = FilmImage(rgb=np.random.default_rng(1).random((30, 40, 3)), iterations=1)
            write_image(path, film)
            size = path.stat().st_size
            path.write_bytes(b"old")
            failures = 0
            limits = [0, 1, 100, size // 2, *range(size - 3000, size, 500), size - 100, size - 1]
            for limit in limits:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
                try:
                    write_image(path, film)
                except OutputError as error:
                    failures += str(error).startswith(f"{path}: cannot be written: ")
                resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
                assert path.read_bytes() == b"old", limit
                assert len(list(path.parent.iterdir())) == 1, limit
            assert failures == len(limits)
            write_image(path, film)
            assert path.stat().st_size == size
        """
        in_child(code, tmp_path / f"a.{extension}")

    def test_an_error_of_any_kind_leaves_nothing(self, tmp_path, film):
        """An unknown output is not in the file, and there is no file."""
        with pytest.raises(KeyError):
            write_image(tmp_path / "a.exr", replace(film, aovs={"unheard": film.rgb}))
        with pytest.raises(TypeError):
            write_sidecar(tmp_path / "a.json", {"what": object()})
        assert os.listdir(tmp_path) == []

    def test_names_of_all_scripts(self, tmp_path, film):
        """Paths need not be ASCII, nor free of what means something to a shell or an image library."""
        for name in ("Übung 画像.exr", "a?b#c*%04d.exr", "-x'\".png", "UPPER.EXR"):
            write_image(tmp_path / name, film)
            assert read_image(tmp_path / name).rgb.shape == (HEIGHT, WIDTH, 3)
        assert len(os.listdir(tmp_path)) == 4

    def test_permissions_and_links(self, tmp_path, film):
        """A new file gets what the umask gives; a symbolic link still points to what was replaced."""
        write_image(tmp_path / "a.exr", film)
        (tmp_path / "plain").touch()
        assert stat.S_IMODE((tmp_path / "a.exr").stat().st_mode) == stat.S_IMODE(
            (tmp_path / "plain").stat().st_mode
        )
        (tmp_path / "folder").mkdir()
        (tmp_path / "link.exr").symlink_to(tmp_path / "folder" / "b.exr")
        write_image(tmp_path / "link.exr", film)
        assert (tmp_path / "link.exr").is_symlink()
        assert read_image(tmp_path / "folder" / "b.exr").window == film.window


def test_sidecar(tmp_path):
    """NumPy's numbers and arrays, and numbers that JSON does not know."""
    path = tmp_path / "ü.b.json"
    write_sidecar(
        path, {"a": np.float32(0.5), "b": [np.nan, np.int64(3), np.arange(2)], "c": {1: float("inf")}}
    )
    assert json.loads(path.read_text(encoding="utf-8")) == {
        "a": 0.5,
        "b": [None, 3, [0, 1]],
        "c": {"1": None},
    }
