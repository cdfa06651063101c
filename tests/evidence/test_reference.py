"""References: their own error, what the cache keeps, and that two integrators must agree.

Statistical tests have fixed seeds and fail a right program with probability below 1e-4 each; there are 3.
"""

import json
import math
import threading
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from room import write_room

import artist_py
from artist_py.errors import OptionError
from artist_py.evidence import reference as module
from artist_py.evidence.entries import Entry, compile_entry
from artist_py.evidence.reference import (
    BATCHES,
    Batches,
    Reference,
    block_means,
    cached_path,
    check_agreement,
    is_below,
    joined,
    load_batches,
    make_reference,
    own_error,
    read_reference,
    render_batches,
    save_batches,
    write_reference,
)
from artist_py.film.image import FilmImage
from artist_py.film.output import write_image

SHAPE = 16, 24, 3


@pytest.fixture
def room(tmp_path, monkeypatch):
    """Function from an integrator to the compiled room; references are cached in the test's folder."""
    monkeypatch.setattr(module, "cache_root", lambda: tmp_path / "cache")
    return partial(_compile, write_room(tmp_path))


def _compile(path, integrator):
    return compile_entry(path, Entry(integrator, integrator, ()))


def batches(integrator, rng, mean, sigma, count=BATCHES):
    """Batches of normal values about `mean`."""
    made = Batches(integrator, iterations=4, seconds=1.0)
    for _ in range(count):
        made.add(mean + sigma * rng.standard_normal(SHAPE))
    return made


class TestOwnError:
    """What a reference says of itself."""

    def test_against_the_truth(self):
        """The error against the truth is what the batches' spread says, within 5 standard errors of both."""
        truth = np.full(SHAPE, 0.5)
        made = joined([batches("pt", np.random.default_rng(1), truth, 0.2)])
        measured = np.mean((made.rgb - truth) ** 2 / (truth**2 + 0.001))
        n = truth.size
        assert measured == pytest.approx(0.04 / BATCHES / 0.251, rel=5 * math.sqrt(2 / n))
        assert made.relmse == pytest.approx(measured, rel=5 * math.sqrt(2 / n + 2 / n / (BATCHES - 1)))

    def test_two_integrators_are_better_than_one(self):
        """Weighted by how good each is, with the variance of that."""
        rng, truth = np.random.default_rng(2), np.full(SHAPE, 0.5)
        good, bad = batches("pt", rng, truth, 0.1), batches("bpt", rng, truth, 0.3)
        both = joined([good, bad])
        expected = 1 / (1 / 0.1**2 + 1 / 0.3**2) / BATCHES
        assert both.variance.mean() == pytest.approx(expected, rel=0.1)
        assert both.relmse < joined([good]).relmse
        assert both.origin["integrators"] == ["pt", "bpt"]
        assert both.origin["is_unbiased"] is True

    def test_marks(self):
        """An error of twice the reference's is half the reference's own."""
        reference = Reference(np.ones(SHAPE), np.full(SHAPE, 1.001e-3))
        assert reference.relmse == pytest.approx(1e-3)
        assert not is_below(2.01e-3, reference)
        assert is_below(1.99e-3, reference)
        assert own_error(3e-3, reference) == pytest.approx(2e-3)
        assert math.isnan(own_error(0.5e-3, reference))
        unknown = Reference(np.ones(SHAPE), None)
        assert not is_below(0.0, unknown)
        assert own_error(3e-3, unknown) == 3e-3


class TestAgreement:
    """Two integrators."""

    def test_they_agree(self):
        """Of 20 pairs of equal expectation none is rejected; each is with probability 1e-3 at most."""
        rng, truth = np.random.default_rng(3), np.random.default_rng(4).random(SHAPE)
        for _ in range(20):
            check_agreement(batches("pt", rng, truth, 0.2), batches("bpt", rng, truth, 0.1))

    def test_light_that_one_misses(self):
        """A spot that only one integrator finds, 1.5 standard errors in each pixel, shows in the blocks."""
        rng, truth = np.random.default_rng(5), np.full(SHAPE, 0.5)
        missing = truth.copy()
        missing[8:16, 8:16] += 1.5 * math.sqrt(2) * 0.1 / math.sqrt(BATCHES)
        with pytest.raises(OptionError, match=r"by pt and bpt do not agree: p = .* worst at x 8, y 8"):
            check_agreement(batches("pt", rng, missing, 0.1), batches("bpt", rng, truth, 0.1))

    def test_renders(self, room):
        """Path tracing and bidirectional path tracing of the room."""
        made = make_reference(room, ["pt", "bpt"], 1.0, threads=2)
        assert made.origin["batches"][0] >= module.FEWEST_BATCHES
        assert 0 < made.relmse < 1

    def test_block_means(self):
        """Whole blocks and what is left of them."""
        image = np.arange(10 * 5 * 3, dtype=float).reshape(10, 5, 3)
        means = block_means(image, 4)
        assert means.shape == (3, 2, 3)
        np.testing.assert_allclose(means[1, 0], image[4:8, :4].mean(axis=(0, 1)))
        np.testing.assert_allclose(means[2, 1], image[8:, 4:].mean(axis=(0, 1)))


class TestCache:
    """References on the disk."""

    def test_grows(self, room):
        """What is there counts, and is not rendered again; more time adds batches of the same length."""
        compiled, path = room("pt"), cached_path(room("pt"), "pt")
        make_reference(room, ["pt"], 0.05, threads=1)
        first = load_batches(path, "pt")
        assert first.moments.count >= module.FEWEST_BATCHES
        assert first.seconds >= 0.05
        make_reference(room, ["pt"], 0.05, threads=1)
        assert load_batches(path, "pt").moments.count == first.moments.count
        grown = load_batches(path, "pt")
        render_batches(compiled, grown, 1.5 * first.seconds, threads=1)
        assert grown.moments.count > first.moments.count
        assert grown.iterations == first.iterations
        # The same as if all had been rendered at once, but for the rounding of what was stored.
        whole = Batches("pt", iterations=first.iterations)
        while whole.moments.count < grown.moments.count:
            render_batches(compiled, whole, whole.seconds + 1e-9, threads=1)
        if whole.moments.count == grown.moments.count:
            np.testing.assert_allclose(grown.moments.mean, whole.moments.mean, rtol=1e-6)
            np.testing.assert_allclose(grown.moments.variance, whole.moments.variance, rtol=1e-3, atol=1e-12)

    def test_what_names_them(self, tmp_path, room):
        """The integrator; where it has bias, what that depends on."""
        path = write_room(
            tmp_path, "other.toml", ("max_path_length = 4", "max_path_length = 4\nmerging.alpha = 0.9")
        )
        for integrator, is_same in (("pt", True), ("bpt", True), ("vcm", False)):
            mine, other = (
                cached_path(_compile(each, integrator), integrator) for each in (tmp_path / "room.toml", path)
            )
            assert (mine == other) == is_same
        assert cached_path(room("pt"), "pt") != cached_path(room("bpt"), "bpt")

    def test_fresh(self, room):
        """On demand nothing is taken from the cache."""
        made = make_reference(room, ["pt"], 0.03, threads=1)
        again = make_reference(room, ["pt"], 0.03, threads=1, is_fresh=True)
        assert made.origin["batches"][0] > 0
        assert again.origin["batches"][0] > 0

    def test_other_kernels(self, room, monkeypatch):
        """References of other sources do not count: they may be of before a mistake was mended."""
        make_reference(room, ["pt"], 0.02, threads=1)
        path = cached_path(room("pt"), "pt")
        assert load_batches(path, "pt").moments.count > 0
        monkeypatch.setattr(module, "source_digest", lambda: "other")
        assert load_batches(path, "pt").moments.count == 0

    def test_stopped(self, room):
        """An interrupted reference is kept, and no use yet."""
        made, stop = Batches("pt", iterations=1), threading.Event()
        observer = SimpleNamespace(note=lambda _: made.moments.count == 2 and stop.set())
        observer.compiling = observer.compiled = observer.warning = lambda *_: None
        render_batches(room("pt"), made, 100.0, 1, observer, stop)
        assert made.moments.count == 2
        save_batches(cached_path(room("pt"), "pt"), made, room("pt"))
        with pytest.raises(OptionError, match="the reference by pt was interrupted"):
            make_reference(room, ["pt"], 100.0, threads=1, stop=stop)


class TestFiles:
    """`--reference`."""

    def test_round_trip(self, room, tmp_path):
        """The image, its error and its origin survive."""
        compiled = room("pt")
        made = make_reference(room, ["pt"], 0.02, threads=1)
        path = tmp_path / "reference.exr"
        write_reference(path, made.rgb, made.variance, made.summary(), compiled)
        read = read_reference(path, compiled)
        np.testing.assert_allclose(read.rgb, made.rgb, rtol=1e-6)
        assert read.relmse == pytest.approx(made.relmse, rel=1e-4)
        assert read.origin["integrators"] == ["pt"]
        json.dumps(read.summary())

    def test_any_image(self, room, tmp_path):
        """Without variance its error is unknown."""
        path = tmp_path / "theirs.exr"
        write_image(path, FilmImage(rgb=np.ones((10, 12, 3)), iterations=1))
        read = read_reference(path, room("pt"))
        assert read.relmse is None
        assert read.origin == {"file": "theirs.exr"}

    def test_errors(self, room, tmp_path):
        """Another size, another scene, values that are not finite."""
        path = tmp_path / "theirs.exr"
        write_image(path, FilmImage(rgb=np.ones((9, 12, 3)), iterations=1))
        with pytest.raises(
            OptionError, match="shows 12 x 9 pixels from 0, 0 of 12 x 9, and the scene 12 x 10"
        ):
            read_reference(path, room("pt"))
        image = FilmImage(rgb=np.ones((10, 12, 3)), iterations=1)
        write_image(path, image, {"artist:pictureHash": "0"})
        with pytest.raises(OptionError, match="another scene"):
            read_reference(path, room("pt"))
        image.rgb[0, 0, 0] = np.nan
        write_image(path, image)
        with pytest.raises(OptionError, match="not finite"):
            read_reference(path, room("pt"))

    def test_seeds_are_their_own(self):
        """No two batches share a seed, and none is a small number that a scene might have."""
        seeds = {module.batch_seed(name, batch) for name in ("pt", "bpt") for batch in range(100)}
        assert len(seeds) == 200
        assert min(seeds) > 10**6
        assert max(seeds) < 2**63


def test_artist_render_takes_the_seed(room):
    """Seeds of batches are within what a scene may say."""
    compiled = artist_py.render(module.with_seed(room("pt"), module.batch_seed("pt", 0)), iterations=1)
    assert compiled.film.iterations == 1
