"""How a scene describes a spectrum or a refractive index: one frozen dataclass per form of the description.

Nothing is evaluated here; `spectra.py` tabulates these. Wavelengths are in nm, every `scale` multiplies the values.
"""

from dataclasses import dataclass, field

from artist_py.scene.where import Where


@dataclass(frozen=True)
class Constant:
    """The same value at every wavelength; of a spectrum (its unit is the key's) or of a refractive index."""

    value: float
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Rgb:
    """A smooth spectrum that has this linear sRGB colour, three floats."""

    rgb: tuple[float, float, float]
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Named:
    """A spectrum or refractive index known by name: an illuminant ("D65"), or, as an index, a glass ("N-BK7")."""

    name: str
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Blackbody:
    """Planck's law at `temperature`, K."""

    temperature: float
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Gaussian:
    """A bell curve: `shape` is its centre and standard deviation, nm; `peak` its height."""

    shape: tuple[float, float]
    peak: float = 1.0
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Lines:
    """Spectral lines: (wavelength nm, weight) each, boxes of `width` nm whose integral is the weight."""

    lines: tuple[tuple[float, float], ...]
    width: float = 0.1
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Sampled:
    """Values at increasing wavelengths, nm, joined by straight lines; of a spectrum or of a refractive index."""

    wavelengths: tuple[float, ...]
    values: tuple[float, ...]
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class File:
    """Samples from a text file: wavelengths, nm, in its first column, values in column `column` (1 = the next one).

    `path` is already joined to the folder of the scene file that names it.
    """

    path: str
    column: int = 1
    scale: float = 1.0
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Cauchy:
    """Refractive index n = A + B / l^2 + C / l^4 + ..., l in micrometres."""

    coefficients: tuple[float, ...]
    where: Where | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True)
class Sellmeier:
    """Refractive index n^2 = 1 + sum of B l^2 / (l^2 - C), l in micrometres; terms are (B, C in um^2)."""

    terms: tuple[tuple[float, float], ...]
    where: Where | None = field(default=None, compare=False, repr=False)


Spectrum = Constant | Rgb | Named | Blackbody | Gaussian | Lines | Sampled | File
RefractiveIndex = Constant | Named | Cauchy | Sellmeier | Sampled | File

ILLUMINANTS = (
    *("A", "B", "C", "D50", "D55", "D60", "D65", "D75", "E"),
    *(f"FL{i}" for i in range(1, 13)),
    *("LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"),
    *(f"HP{i}" for i in range(1, 6)),
)
