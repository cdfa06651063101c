"""What a scene may say of a material that fluoresces."""

from artist_py.scene.fields import (
    Array,
    Choice,
    FilePath,
    Flag,
    Forms,
    Node,
    Number,
    Table,
    key,
    node,
    numbers,
)
from artist_py.scene.spectrum_fields import SpectrumField
from artist_py.scene.spectrum_types import Spectrum

share = SpectrumField(Number(at_least=0, at_most=1))
_relative = SpectrumField(Number(at_least=0))
_yield = Number(at_least=0, at_most=1)
_bell = numbers(2, "a wavelength and a standard deviation in nm", Number(above=0))


@node
class Dye(Node):
    """One dye: what it absorbs, and what it gives off instead."""

    absorption: Spectrum = key(share)  # share of the light, by wavelength
    emission: Spectrum = key(_relative)  # power per nm, on any scale
    quantum_yield: float = key(_yield, 1.0)  # photons given off per photon absorbed


@node
class MatrixFile(Node):
    """A measured reradiation (Donaldson) matrix: a column per wavelength of excitation, a row per one of emission."""

    path: str = key(FilePath(), name="file")
    unit: str = key(Choice(("per nm", "per band")), "per nm")  # of the values off the diagonal
    scale: float = key(Number(at_least=0), 1.0)  # multiplies what is off the diagonal
    anti_stokes: bool = key(Flag(), False)  # true: keep what is given off at shorter wavelengths


@node
class TwoGaussians(Node):
    """Bell curves of excitation and of emission, each a wavelength and a standard deviation, nm."""

    excitation: tuple[float, float] = key(_bell)
    emission: tuple[float, float] = key(_bell)
    strength: float = key(_yield, 0.5)  # share of the power given off again, at the peak of the excitation


Reradiation = MatrixFile | TwoGaussians
reradiation = Forms(
    {"file": MatrixFile, "excitation": TwoGaussians},
    "a table with the file of a matrix, or excitation and emission",
)
dyes = Array(Table(Dye), at_least=1, expected="one dye or more")
