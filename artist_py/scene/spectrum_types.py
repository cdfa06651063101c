"""How a scene describes a spectrum or a refractive index: one frozen dataclass per form of description.

Nothing is evaluated here, `spectra.py` tabulates these. Wavelengths are in nm, `scale` multiplies the values.
"""

from dataclasses import dataclass
from itertools import pairwise

from artist_py.scene.fields import Array, FilePath, Node, Number, Text, key, numbers
from artist_py.scene.messages import expected

_wavelength = Number(above=0)  # nm
_scale = Number(at_least=0)


@dataclass(frozen=True)
class Constant(Node):
    """The same value at every wavelength: of a spectrum (its unit is the key's) or of a refractive index."""

    value: float
    scale: float = 1.0


@dataclass(frozen=True)
class Rgb(Node):
    """A smooth spectrum that has this linear sRGB colour."""

    rgb: tuple[float, float, float] = key(numbers(3, "[red, green, blue]", Number(at_least=0)))
    scale: float = key(_scale, 1.0)


@dataclass(frozen=True)
class Named(Node):
    """Known by name: as a spectrum "D65" or a patch of the ColorChecker, as a refractive index a glass."""

    name: str = key(Text(), name="illuminant")
    scale: float = key(_scale, 1.0)


@dataclass(frozen=True)
class Blackbody(Node):
    """Planck's law: the radiance of a black body of `kelvin` degrees."""

    kelvin: float = key(Number(above=0), name="blackbody")
    scale: float = key(_scale, 1.0)


@dataclass(frozen=True)
class Gaussian(Node):
    """A bell curve: `shape` is its centre and its standard deviation, nm; `peak` its height."""

    shape: tuple[float, float] = key(
        numbers(2, "a wavelength and a standard deviation in nm", _wavelength), name="gaussian"
    )
    peak: float = key(Number(at_least=0), 1.0)
    scale: float = key(_scale, 1.0)

    @property
    def center(self):
        return self.shape[0]

    @property
    def sigma(self):
        return self.shape[1]


@dataclass(frozen=True)
class Lines(Node):
    """Spectral lines: (wavelength nm, weight) each, boxes of `width` nm whose integral is the weight."""

    lines: tuple[tuple[float, float], ...] = key(
        Array(numbers(2, "a line [nm, weight]", Number(at_least=0)), at_least=1, expected="one line or more")
    )
    width: float = key(Number(above=0), 0.1)
    scale: float = key(_scale, 1.0)


@dataclass(frozen=True)
class Sampled(Node):
    """Values at increasing wavelengths, nm, joined by straight lines."""

    wavelengths: tuple[float, ...] = key(
        Array(_wavelength, at_least=2, expected="two or more wavelengths in nm")
    )
    values: tuple[float, ...] = key(Array(Number(at_least=0), expected="one value per wavelength"))
    scale: float = key(_scale, 1.0)

    def problems(self):
        if len(self.values) != len(self.wavelengths):
            yield "values", f"expected {len(self.wavelengths)}, one per wavelength, found {len(self.values)}"
        for before, after in pairwise(self.wavelengths):
            if before >= after:
                yield "wavelengths", expected(f"a wavelength above {before:.12g}, since they increase", after)
                break


@dataclass(frozen=True)
class File(Node):
    """Samples from a text file: wavelengths, nm, in its first column, values `column` columns further on."""

    path: str = key(FilePath(), name="file")
    column: int = key(Number(at_least=1, whole=True), 1)
    scale: float = key(_scale, 1.0)


@dataclass(frozen=True)
class Cauchy(Node):
    """Refractive index n = A + B / l^2 + C / l^4 + ..., l in micrometres."""

    coefficients: tuple[float, ...] = key(
        Array(Number(), at_least=1, expected="one coefficient or more"), name="cauchy"
    )


@dataclass(frozen=True)
class Sellmeier(Node):
    """Refractive index n^2 = 1 + sum of B l^2 / (l^2 - C), l in micrometres; the terms are (B, C in um^2)."""

    terms: tuple[tuple[float, float], ...] = key(
        Array(numbers(2, "a term [B, C]"), at_least=1, expected="one term [B, C] or more"), name="sellmeier"
    )


Spectrum = Constant | Rgb | Named | Blackbody | Gaussian | Lines | Sampled | File
RefractiveIndex = Constant | Named | Cauchy | Sellmeier | Sampled | File
