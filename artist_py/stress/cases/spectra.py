"""Spectra of lines, of nothing, and of what no eye sees."""

from artist_py.stress.case import Case, Radiance
from artist_py.stress.scenes import furnace

BLACK = "the image will be black"
VISIBLE = [380, 780]
WITH_ULTRAVIOLET = [300, 780]
WHITE_LUMINANCE = 72983.4866019817  # cd/m2 of a flat spectrum of radiance 1


def lit_by(spectrum, wavelength_range=VISIBLE, **emission):
    """A furnace in all colours; its walls emit `spectrum`."""
    lamp = {"spectrum": spectrum, **emission}
    return furnace(emission=lamp, render={"wavelength_range": wavelength_range})


def lines(*wavelengths):
    """Lines of 0.1 nm."""
    return {"lines": [[wavelength, 1.0] for wavelength in wavelengths], "width": 0.1}


HALF = {"luminance": 0.5 * WHITE_LUMINANCE}

CASES = (
    Case("flat", "All colours alike.", lit_by(0.5), Radiance(1)),
    Case("line", "One line of 0.1 nm.", lit_by(lines(546.1), **HALF), Radiance(1)),
    Case("two-lines", "Two at the ends of what is seen.", lit_by(lines(400.3, 690.7), **HALF), Radiance(1)),
    Case("line-at-779.95", "One line at the very end.", lit_by(lines(779.95), **HALF), Radiance(1)),
    Case(
        "ultraviolet",
        "Nothing but 301 nm, which no eye sees.",
        lit_by(lines(301.0), WITH_ULTRAVIOLET),
        Radiance(0),
    ),
    Case(
        "ultraviolet-unrendered",
        "The same, where 301 nm are not rendered.",
        lit_by(lines(301.0)),
        Radiance(0),
        warning=BLACK,
    ),
    Case("no-light", "Lamps that emit nothing.", lit_by(0.0), Radiance(0), warning=BLACK),
    Case(
        "one-bin-of-830",
        "The last nanometre there is.",
        lit_by(0.5, [829, 830]),
        Radiance(1),
    ),
)
