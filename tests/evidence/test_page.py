"""The page and the plots: complete, self-contained, and working in a real browser."""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pytest
from browser import find_browser, open_browser

from artist_py.errors import OptionError
from artist_py.evidence import plots
from artist_py.evidence.convergence import Convergence, Row
from artist_py.evidence.entries import Entry
from artist_py.evidence.page import Pictures, write_page
from artist_py.evidence.plots import write_plots
from artist_py.evidence.reference import Reference
from artist_py.evidence.tables import convergence_table

SIZE = 24, 32
MARKS = [1.0, 2.0, 4.0]
NAMES = ("pt", "vcm:hero_count=8", "</script><b>&")  # the last as a user might, to see whether it is escaped
COLORS = {"pt": (1.0, 0.0, 0.0), "vcm:hero_count=8": (0.0, 0.0, 1.0), "</script><b>&": (0.5, 0.5, 0.5)}


def made_up(names=NAMES, repeats=3):
    """A comparison whose images are red, blue and grey, with errors that fall."""
    rows, images = [], {}
    for number, name in enumerate(names):
        for repeat in range(repeats):
            for mark in MARKS:
                error = 0.1 * (number + 1) * (1 + 0.1 * repeat) / mark
                below = number == 0 and mark == MARKS[-1]
                rows.append(
                    Row(name, repeat, repeat, mark, mark, 2 * mark, int(10 * mark), 1000, 50_000, 30_000, 2**28, 2**24,
                        error, error - 0.01, error**0.5, 0.9 * error, below, 0, 0.99)
                )  # fmt: skip
                images[name, mark] = np.tile(np.float32(COLORS[name]), (*SIZE, 1)) * np.float32(mark / 4)
    about = {
        "picture": {"max_path_length": 8}, "width": SIZE[1], "height": SIZE[0], "threads": 2,
        "processor": "a processor", "software": "artist",
    }  # fmt: skip
    reference = Reference(
        np.full((*SIZE, 3), 0.5), np.full((*SIZE, 3), 0.01 * 0.251), {"file": "reference.exr"}
    )
    entries = [Entry(name, "pt", ()) for name in names]
    return Convergence("room <1>.toml", entries, "wall", MARKS, reference, about, rows, {}, images)


def no_flip(image, reference):
    """An evaluator that is not there."""
    raise OptionError("FLIP needs flip-evaluator")


def half(image, reference):
    """An evaluator that finds half."""
    return np.full(SIZE, 0.5, np.float32)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Path of the page."""
    path = tmp_path_factory.mktemp("page") / "index.html"
    assert write_page(path, made_up(), flip=half) == []
    return path


class TestPlots:
    """PNG and SVG."""

    def test_files(self, tmp_path):
        """Both are whole, and equal comparisons are equal files."""
        write_plots(tmp_path, made_up())
        first = (tmp_path / "plot.svg").read_bytes()
        assert first.rstrip().endswith(b"</svg>")
        assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
        write_plots(tmp_path, made_up())
        assert (tmp_path / "plot.svg").read_bytes() == first

    def test_what_is_drawn(self):
        """Each entry's medians on both panels, at the seconds they took; hollow where below the reference."""
        figure = plots.draw(made_up())
        for panel, metric in zip(figure.axes, ("relmse", "smape"), strict=True):
            assert (panel.get_xscale(), panel.get_yscale()) == ("log", "log")
            curves = [
                line for line in panel.lines if len(line.get_xdata()) == 3 and line.get_linewidth() == 1.6
            ]
            assert len(curves) == 3
            assert list(curves[0].get_xdata()) == MARKS
            middle = np.array([0.1 * 1.1 / mark for mark in MARKS])
            np.testing.assert_allclose(curves[0].get_ydata(), middle if metric == "relmse" else middle**0.5)
            hollow = [
                line for line in panel.lines if line.get_markerfacecolor() == "none" and len(line.get_xdata())
            ]
            assert [list(line.get_xdata()) for line in hollow] == [[4.0]]
            assert any(text.get_text() == "error of the reference" for text in panel.texts)

    @pytest.mark.parametrize("length", [0, 30, 55])
    def test_legend_is_within_the_figure(self, length):
        """However long the settings are that entries are named by."""
        run = made_up()
        names = {entry.label: entry.label + ":setting=" + length * "8" for entry in run.entries}
        run.entries = [Entry(names[entry.label], "pt", ()) for entry in run.entries]
        run.rows = [row._replace(entry=names[row.entry]) for row in run.rows]
        figure = plots.draw(run)
        figure.draw_without_rendering()
        [legend] = figure.legends
        shown, whole = legend.get_window_extent(), figure.bbox
        assert whole.x0 <= shown.x0 and shown.x1 <= whole.x1 and shown.y0 >= whole.y0

    def test_one_render_of_one_entry(self, tmp_path):
        """Nothing to spread, and an axis of iterations."""
        run = made_up(NAMES[:1], repeats=1)
        run.axis = "iterations"
        write_plots(tmp_path, run)

    def test_no_matplotlib(self, tmp_path, monkeypatch):
        """The message says how to get it, and no file is left."""
        monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
        with pytest.raises(OptionError, match=r"plots: matplotlib is not installed.*artist-py\[report\]"):
            write_plots(tmp_path, made_up())
        assert list(tmp_path.iterdir()) == []


class TestContent:
    """What the file holds."""

    def test_nothing_from_elsewhere(self, page):
        """No address but those of data, and of XML's name spaces."""
        text = page.read_text(encoding="utf-8")
        addresses = set(re.findall(r"https?://[^\"'\s<)]+", text))
        assert addresses <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
        for value in re.findall(r"(?:src|href|url)\s*[=(]\s*[\"']?([^\"')\s>]+)", text):
            assert value.startswith(("data:", "#", "data.pictures", "source"))

    def test_names_are_escaped(self, page):
        """A label is text, wherever it stands."""
        text = page.read_text(encoding="utf-8")
        assert "<b>&" not in text
        assert "room &lt;1&gt;" in text
        data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])
        assert data["entries"] == list(NAMES)

    def test_words(self, page):
        """Marks, errors with their range, the reference's own error, the coverage of the bands."""
        text = page.read_text(encoding="utf-8")
        for each in (
            "0.0275 *",
            "0.025 to 0.03",
            "its own relMSE 0.01",
            "probability of 75%",
            "<td>0.5</td>",
        ):
            assert each in text

    def test_images(self):
        """Tone-mapped pixels, and errors on the colours of heat."""
        pictures = Pictures(made_up(), 0.0, half)
        assert set(pictures.urls) == {
            "ref",
            *(f"image/{i}/{mark:g}" for i in range(3) for mark in MARKS),
            *(f"{kind}/{i}" for kind in ("error", "flip") for i in range(3)),
        }
        data = base64.b64decode(pictures.urls["image/0/4"].partition(",")[2])
        assert data.startswith(b"\x89PNG")

    def test_large_images_are_fewer(self, monkeypatch):
        """Only the last times of large images, so that the page stays small."""
        monkeypatch.setattr("artist_py.evidence.page.PIXELS_SHOWN", 2 * 3 * SIZE[0] * SIZE[1])
        assert Pictures(made_up(), "auto", half).marks == [2.0, 4.0]

    def test_without_flip(self, tmp_path):
        """The page says so, and why."""
        path = tmp_path / "index.html"
        assert write_page(path, made_up(), flip=no_flip) == ["FLIP needs flip-evaluator"]
        assert "FLIP was not measured: FLIP needs flip-evaluator" in path.read_text(encoding="utf-8")

    def test_table(self):
        """The same in the terminal."""
        header, lines = convergence_table(made_up())
        assert header == ["relMSE after", "1 s", "2 s", "4 s", "sMAPE", "mean", "slope", "speed against pt"]
        assert lines[0][:4] == ["pt", "0.11", "0.055", "0.0275 *"]
        assert lines[1][-1] == ""  # pt is below the reference there
        assert lines[1][-2].startswith("-1.1")


@pytest.mark.skipif(find_browser() is None, reason="there is no Chromium here")
def test_in_a_browser(page, tmp_path):
    """It loads without errors and asks for nothing else; the slider, the choices and the zoom do what they say."""
    with open_browser(find_browser()) as tab:
        tab.open(page)
        assert tab.errors == []
        assert {url for url in tab.requests if not url.startswith("data:")} == {Path(page).resolve().as_uri()}
        assert tab.evaluate("[...document.images].every(img => img.complete && img.naturalWidth > 0)")

        def colors():
            """Colour of what is seen at a fourth and at three fourths of the stage's width, from a screenshot."""
            return tab.evaluate(READ_STAGE % json.dumps(screenshot(tab)))

        def select(element, value):
            tab.evaluate(
                f"{{const e = at('{element}'); e.value = '{value}'; e.dispatchEvent(new Event('change'));}}"
            )

        select("right-entry", "1")
        assert colors() == [[255, 0, 0], [0, 0, 255]]  # red on the left, blue on the right
        x, y, width, height = tab.evaluate(STAGE)
        tab.drag((x + width / 2, y + height / 2), (x + 0.9 * width, y + height / 2))
        assert tab.evaluate("Number(at('divider').value)") == pytest.approx(90, abs=1)
        assert colors() == [[255, 0, 0], [255, 0, 0]]
        tab.evaluate("{const e = at('divider'); e.value = 10; e.dispatchEvent(new Event('input'));}")
        assert colors() == [[0, 0, 255], [0, 0, 255]]
        select("right-entry", "ref")
        assert colors() == [[188, 188, 188]] * 2  # 0.5 as sRGB code
        select("right-entry", "1")
        select("mark", "1")
        assert colors() == [[0, 0, 137]] * 2  # a fourth of the light
        assert "1 s, 10 iterations, relMSE 0.2" in tab.evaluate("at('right-tag').textContent")
        select("layer", "flip")
        assert tab.evaluate("at('mark').disabled")
        assert "FLIP 0.5" in tab.evaluate("at('right-tag').textContent")
        before = tab.evaluate(STAGE)[2]
        tab.evaluate("document.querySelector('#zooms button[data-zoom=\"2\"]').click()")
        assert tab.evaluate(STAGE)[2] == 2 * SIZE[1] != before
        assert tab.errors == []
        assert all(url.startswith(("data:", "file:")) for url in tab.requests)


STAGE = (
    "(() => { const e = at('stage'); e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect(); "
    "return [b.x, b.y, b.width, b.height]; })()"
)
READ_STAGE = """(async () => {
    const img = new Image(); img.src = %s; await img.decode();
    const canvas = document.createElement('canvas'); canvas.width = img.width; canvas.height = img.height;
    const context = canvas.getContext('2d'); context.drawImage(img, 0, 0);
    return [0.25, 0.75].map(share => [...context.getImageData(
        Math.round(share * img.width), Math.round(0.2 * img.height), 1, 1).data].slice(0, 3));
})()"""


def screenshot(tab):
    """The stage as it is on the screen, as a data URL."""
    x, y, width, height = tab.evaluate(STAGE)
    scrolled = tab.evaluate("[scrollX, scrollY]")
    clip = {"x": x + scrolled[0], "y": y + scrolled[1], "width": width, "height": height, "scale": 1}
    data = tab.call("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)["data"]
    return f"data:image/png;base64,{data}"
