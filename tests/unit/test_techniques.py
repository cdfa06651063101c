"""Images of techniques: which there are, how they are kept, and how they are shown."""

from types import SimpleNamespace

import numba
import numpy as np
import pytest
from kernel_code import code_of

from artist_py.cli.main import main
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum
from artist_py.errors import OptionError, OutputError
from artist_py.film.accumulation import add_technique_rows
from artist_py.film.contact_sheet import GAP, WIDTH, contact_sheet
from artist_py.film.image import FilmImage
from artist_py.film.reading import read_image
from artist_py.film.technique_files import check_techniques, write_techniques
from artist_py.film.techniques import KINDS, Technique, TechniqueImages, techniques_of
from artist_py.film.tonemap import ToneMapping
from artist_py.integrators.methods import ALL, Samples
from artist_py.integrators.path_tracing import trace_paths
from artist_py.samplers.memory import memory_estimate
from artist_py.samplers.render_job import RenderSettings, render
from artist_py.samplers.stochastic import StochasticSampler
from artist_py.samplers.techniques import TechniqueRecorder, kinds_of, technique_rows, techniques_of_render
from artist_py.scene.compile import compile_scene
from artist_py.scene.reader import read_scene_text
from artist_py.scene.tables import Spectra
from artist_py.transport.recording import HIT, TECHNIQUES, VC, VM, Place, record

SCENE = """
camera = { type = "pinhole", position = [0, -4, 0], look_at = [0, 0, 0] }
film = { resolution = [8, 6] }
shapes = [{ type = "sphere", center = [0, 0, 0], radius = 1, emission = 1 }]
"""
H, W = 3, 4


class TestWhichThereAre:
    """Theory 1.2."""

    def test_of_a_length(self):
        names = [each.name for each in techniques_of(KINDS, 4) if each.length == 4]
        assert names == [
            "hit", "nee", "vc_s2_t3", "vc_s3_t2", "lt", "lens", "vm_m1", "vm_m2", "vm_m3"
        ]  # fmt: skip

    @pytest.mark.parametrize("length", range(2, 9))
    def test_vertices(self, length):
        """All but merges have a light and an eye subpath that make up the k + 1 vertices, s from 0 to k + 1."""
        found = [each for each in techniques_of(KINDS, 8) if each.length == length]
        assert [each.s for each in found if each.kind != "vm"] == list(range(length + 2))
        assert all(each.s + each.t == length + 1 for each in found if each.kind != "vm")
        assert [each.m for each in found if each.kind == "vm"] == list(range(1, length))

    def test_emitters_that_are_seen(self):
        assert techniques_of(KINDS, 1) == (Technique("hit", 1, 0, 2), Technique("lens", 1, 2, 0))

    def test_longer_paths_share(self):
        techniques = techniques_of(("hit", "vm"), 30, 2)
        assert [(each.length, each.name) for each in techniques[-2:]] == [(None, "hit"), (None, "vm")]
        assert techniques_of(KINDS, 30, 30)[-1] == Technique("vm", 30, m=29)

    def test_of_methods(self):
        assert TECHNIQUES == KINDS
        pinhole, lens, far = (
            SimpleNamespace(lens=lens, clip=clip) for lens, clip in ((None, None), (1, None), (1, 9.0))
        )
        assert kinds_of("pt", lens, ALL) == ("hit", "nee")
        assert kinds_of("ppm", lens, ALL) == ("hit", "vm")
        assert kinds_of("lt", lens, ALL) == ("hit", "lt", "lens")
        assert kinds_of("vcm", lens, ALL) == KINDS
        assert kinds_of("vcm", pinhole, ALL) == kinds_of("vcm", far, ALL) == ("hit", "nee", "vc", "lt", "vm")
        with pytest.raises(OptionError, match="reference"):
            kinds_of("reference", pinhole, ALL)
        few = Samples(next_event=0, connections=0, light_image=0)
        assert kinds_of("vcm", lens, few) == ("hit", "vm")


class TestRows:
    """Where kernels find the image of a technique."""

    @pytest.mark.parametrize("longest", [1, 3, 12])
    def test_every_contribution_has_its_image(self, longest):
        techniques = techniques_of(KINDS, 6, longest)
        rows = technique_rows(techniques)
        last, reached = rows.shape[1] - 1, set()
        for length in range(2, 7):
            for eye in range(1, length):
                for kind in (VC, VM):
                    if kind == VC and eye == length - 1:
                        continue  # next-event estimation
                    row = rows[kind, min(length, last), min(eye, last)]
                    technique = techniques[row]
                    reached.add(row)
                    assert technique.kind == TECHNIQUES[kind]
                    if length <= longest:
                        place = technique.t == eye + 1 if kind == VC else technique.m == length - eye
                        assert technique.length == length and place
                    else:
                        assert technique.length is None
        assert reached == {i for i, each in enumerate(techniques) if each.kind in {"vc", "vm"}}


class TestRecording:
    """`record`, as plain Python."""

    @pytest.fixture
    @staticmethod
    def recorder():
        return TechniqueRecorder(techniques_of(KINDS, 6, 3), H, W)

    @staticmethod
    def add(recorder, technique, length, eye_length, value, weight):
        wavelengths, weights = Spectrum([500.0, 600.0]), Spectrum([1.0, 2.0])
        spectra = Spectra(Table(np.array([[1, 0], [0, 1], [1, 1]], np.float32)), None, 380.0)
        place = Place(1, 2, wavelengths, weights)
        record(recorder.tables, spectra, place, technique, length, eye_length, Spectrum(value), weight)

    def test_with_weight_and_without(self, recorder):
        for _ in range(2):
            self.add(recorder, VC, 3, 1, [0.25, 0.5], 0.25)
        row = next(i for i, each in enumerate(recorder.film.techniques) if each.name == "vc_s2_t2")
        np.testing.assert_allclose(recorder.tables.weighted.array[row, 1, 2], [0.5, 2.0, 2.5])
        np.testing.assert_allclose(recorder.tables.unweighted.array[row, 1, 2], [2.0, 8.0, 10.0])
        assert np.count_nonzero(recorder.tables.weighted.array) == 3

    def test_longer_paths(self, recorder):
        self.add(recorder, VM, 4, 1, [1.0, 0.0], 1.0)
        self.add(recorder, VM, 6, 5, [1.0, 0.0], 1.0)
        row = recorder.film.techniques.index(Technique("vm", None))
        np.testing.assert_allclose(recorder.tables.weighted.array[row, 1, 2], [2.0, 0.0, 2.0])

    def test_nothing_without_weight(self, recorder):
        self.add(recorder, HIT, 1, 1, [0.0, 0.0], 0.0)
        assert not recorder.tables.unweighted.array.any()

    def test_sums_leave_out_what_the_film_rejects(self, recorder):
        image = np.zeros((H, W, 3), np.float32)
        image[0, 1, 2] = np.nan
        weighted, unweighted = recorder.tables.weighted.array, recorder.tables.unweighted.array
        weighted[:], unweighted[:] = 1.0, 2.0
        weighted[0, 0, 1], unweighted[2, 2, 3, 1] = np.nan, np.inf
        kernel, arguments = recorder.add_job(image, 0, H)
        assert kernel is add_technique_rows
        assert kernel(*arguments) == 1  # the infinite one; what was not a number is of a rejected pixel
        film = recorder.film
        assert np.all(film.weighted[:, 0, 1] == 0) and np.all(film.unweighted[:, 0, 1] == 0)
        assert film.unweighted[2, 2, 3].tolist() == [2, 0, 2]
        assert film.weighted.sum() == len(film.techniques) * 3 * (H * W - 1)
        assert not weighted.any() and not unweighted.any()
        kernel(*arguments)
        images = film.images(4)
        assert images.weighted[0, 1, 1, 0] == 0.25 and images.unweighted[0, 1, 1, 0] == 0.5


@pytest.fixture(scope="module")
def compiled():
    """A glowing ball."""
    return compile_scene(read_scene_text(SCENE))


class TestRenders:
    """From settings to images."""

    def test_only_where_wanted(self, compiled):
        assert render(compiled, RenderSettings(iterations=1)).techniques is None

    def test_memory(self, compiled):
        settings = RenderSettings(iterations=1, techniques=True)
        n_images = len(techniques_of_render(compiled, 8))
        assert n_images == 1 + 7 * 2 + 2
        stored = TechniqueRecorder(techniques_of_render(compiled, 8), 6, 8)
        arrays = [*stored.tables[:2], stored.film.weighted, stored.film.unweighted]
        assert memory_estimate(compiled, settings)["techniques"] == sum(each.nbytes for each in arrays)
        assert memory_estimate(compiled, RenderSettings(iterations=1))["techniques"] == 0
        bounded = RenderSettings(
            iterations=1, techniques=True, max_memory_bytes=sum(a.nbytes for a in arrays)
        )
        with pytest.raises(OptionError, match="--max-memory"):
            render(compiled, bounded)

    @pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
    def test_no_code_without(self, compiled):
        """The LLVM names every function that was compiled for a kernel, also where it was inlined."""
        film = TechniqueRecorder(techniques_of_render(compiled, 8), 6, 8).film
        code = {}
        for wanted in (True, False):
            recorder = TechniqueRecorder(film.techniques, 6, 8) if wanted else None
            with StochasticSampler(compiled, _film(), 1, recorder) as sampler:
                code[wanted] = code_of(trace_paths, sampler._arguments(0, np.zeros(4, np.int64)))
        assert "add_to_technique" in code[True]
        assert "add_to_technique" not in code[False]


def _film():
    from artist_py.film.accumulation import Film

    return Film(6, 8)


@pytest.fixture
def images():
    """Images of random numbers."""
    techniques = techniques_of(KINDS, 4, 3)
    random = np.random.default_rng(1)
    shape = (len(techniques), H, W, 3)
    return TechniqueImages(techniques, random.random(shape), random.random(shape))


class TestPictures:
    """What they are to show."""

    def test_parts_of_the_image(self, images):
        pictures = images.pictures()
        np.testing.assert_allclose(pictures["merging"] + pictures["connection"], images.weighted.sum(axis=0))
        hits = [i for i, each in enumerate(images.techniques) if each.kind in {"hit", "nee"}]
        np.testing.assert_allclose(pictures["path_tracing"], images.weighted[hits].sum(axis=0))

    def test_false_colour(self, images):
        colours = images.pictures()["false_colour"]
        luminance = [0.2126, 0.7152, 0.0722]
        np.testing.assert_allclose(colours[..., 0], images.pictures()["merging"] @ luminance, rtol=1e-3)
        np.testing.assert_allclose(colours[..., 2], images.pictures()["connection"] @ luminance, rtol=1e-3)
        assert not colours[..., 1].any()

    def test_files(self, images, tmp_path):
        film = FilmImage(images.sum(), 5, resolution=(10, 8), crop=(2, 2 + W, 1, 1 + H))
        directory = tmp_path / "x.techniques"
        for _ in range(2):  # into an existing directory, too
            write_techniques(directory, images, film, {"artist:seed": 3})
        stored = read_image(directory / "length_02.exr")
        assert stored.window == (2, 1, 10, 8)
        assert stored.metadata["artist:seed"] == 3
        for row in images.rows(2):
            name = images.techniques[row].name
            np.testing.assert_allclose(stored.layer(f"{name}.weighted"), images.weighted[row], rtol=1e-6)
            np.testing.assert_allclose(stored.layer(f"{name}.unweighted"), images.unweighted[row], rtol=1e-6)
        np.testing.assert_allclose(stored.rgb, images.weighted[images.rows(2)].sum(axis=0), rtol=1e-6)

    def test_a_file_stands_in_the_way(self, images, tmp_path):
        (tmp_path / "x.techniques").write_text("mine")
        with pytest.raises(OutputError, match=r"x\.techniques"):
            check_techniques(tmp_path / "x.techniques")
        with pytest.raises(OutputError, match=r"x\.techniques"):
            write_techniques(tmp_path / "x.techniques", images, FilmImage(images.sum(), 1), {})
        assert (tmp_path / "x.techniques").read_text() == "mine"

    def test_options(self, tmp_path, capsys):
        (tmp_path / "scene.toml").write_text(SCENE)
        assert main(["render", str(tmp_path / "scene.toml"), "--technique-length", "3"]) == 2
        assert "--technique-length needs --techniques" in capsys.readouterr().err


class TestContactSheet:
    """Rows of path lengths, columns of techniques."""

    def test_images_stand_in_a_pyramid(self):
        techniques = techniques_of(KINDS, 3)
        weighted = np.zeros((len(techniques), 8, 8, 3))
        weighted[[each.name == "lt" for each in techniques], ..., 1] = 0.5
        sheet = contact_sheet(TechniqueImages(techniques, weighted, weighted), True, ToneMapping())
        assert sheet.min() >= 0 and sheet.max() <= 1
        lit = (sheet[..., 1] >= 0.5) & (sheet[..., 0] == 0)
        step = (sheet.shape[0] - GAP) // 3
        for row, n_lit, last in ((0, 0, 0), (1, 2, 3.8), (2, 2, 4.3)):
            # The sum and the light image; of its row, which is centred above 5 columns, only lens hits come after it.
            below = lit[GAP + row * step : GAP + row * step + WIDTH]
            assert below.sum() == n_lit * WIDTH * WIDTH
            if n_lit:
                assert np.flatnonzero(below.any(axis=0))[-1] == GAP + round(last * (WIDTH + GAP)) + WIDTH - 1

    def test_text(self, images):
        """Shares stand below weighted images only."""
        sheets = [contact_sheet(images, is_weighted, ToneMapping()) for is_weighted in (True, False)]
        step = (sheets[0].shape[0] - GAP) // 4
        bright = [(sheet[step - GAP - 16 : step - GAP + 6] > 0.3).sum() for sheet in sheets]
        assert bright[0] > bright[1] > 0
