"""How a scene describes a reflectance that varies over a surface: one frozen dataclass per form of description.

Nothing is loaded here, `textures.py` does that. Textures lie on the surface coordinates (u, v) of the shapes; see
`bsdf/reflectance.py`.
"""

from artist_py.scene.fields import Array, Choice, FilePath, Forms, Node, Number, key, node, numbers
from artist_py.scene.spectrum_fields import SPECTRUM_FORMS, SpectrumField
from artist_py.scene.spectrum_types import Spectrum

_reflectance = SpectrumField(Number(at_least=0, at_most=1))
_repeat = numbers(2, "[along u, along v]", Number(above=0, at_most=65536))


@node
class Image(Node):
    """A picture from a file; v = 1 is its top. Where it repeats, it goes on from one edge to the opposite one.

    Pictures in whole numbers (8 or 16 bits) are taken as encoded by sRGB, pictures in floating point as linear.
    """

    path: str = key(FilePath(), name="image")
    scale: float = key(Number(at_least=0), 1.0)  # multiplies the linear values
    repeat: tuple[float, float] = key(_repeat, (1.0, 1.0))  # pictures from 0 to 1 along u and v
    interpolation: str = key(Choice(("bilinear", "nearest")), "bilinear")


@node
class Checkerboard(Node):
    """Squares of two reflectances in turns; the first one lies next to (0, 0)."""

    colors: tuple[Spectrum, Spectrum] = key(
        Array(_reflectance, 2, expected="two spectra [first, second]"), name="checkerboard"
    )
    repeat: tuple[float, float] = key(_repeat, (8.0, 8.0))  # squares from 0 to 1 along u and v


Texture = Image | Checkerboard
_forms = {**SPECTRUM_FORMS.classes, "image": Image, "checkerboard": Checkerboard}
reflectance = SpectrumField(_reflectance.bounds, Forms(_forms, SpectrumField.expected))
