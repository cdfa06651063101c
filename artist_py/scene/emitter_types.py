"""What a scene file may say of light that no shape emits: one frozen dataclass per type of [[emitters]]."""

from artist_py.scene.fields import Array, FilePath, Flag, Node, Number, Text, key, node
from artist_py.scene.messages import expected
from artist_py.scene.shape_types import Vector
from artist_py.scene.spectrum_fields import SpectrumField
from artist_py.scene.spectrum_types import Spectrum
from artist_py.scene.transforms import direction, normalized, point, step

_not_negative = Number(at_least=0)


def _given_twice(emitter, *names):
    """The problem of two keys that say the same."""
    given = [name for name in names if getattr(emitter, name) is not None]
    if len(given) > 1:
        yield given[1], f"expected one of {' and '.join(names)}, found both"


@node
class Emitter(Node):
    """What every one of the [[emitters]] can say."""

    name: str | None = key(Text(), None)


@node
class PointEmitter(Emitter):
    """type = "point": a point that emits alike into all directions; nothing can hit it."""

    position: Vector = key(point)
    spectrum: Spectrum = key(SpectrumField())  # of the intensity, W sr^-1 nm^-1
    intensity: float | None = key(_not_negative, None)  # multiplies the spectrum; the default is 1
    power: float | None = key(_not_negative, None)  # instead: W in all directions, from 300 to 780 nm

    def problems(self):
        yield from _given_twice(self, "intensity", "power")


@node
class SpotEmitter(PointEmitter):
    """type = "spot": a point that emits into a cone."""

    look_at: Vector = key(point)  # on the axis of the cone
    angle: float = key(Number(above=0, at_most=180))  # degrees between the axis and the edge of the cone
    falloff: float | None = key(_not_negative, None)  # degrees; from here on it dims; default: angle

    def axis(self):
        """From the position to what is looked at, not normalised."""
        return tuple(b - a for a, b in zip(self.position, self.look_at, strict=True))

    def problems(self):
        yield from super().problems()
        if normalized(self.axis()) is None:
            yield "look_at", expected("another point than position", self.look_at)
        if self.falloff is not None and self.falloff > self.angle:
            yield "falloff", expected(f"falloff <= angle = {self.angle:.12g}", self.falloff)


@node
class DirectionalEmitter(Emitter):
    """type = "directional": parallel light, or with an angle the disk of a sun."""

    direction: Vector = key(direction)  # in which light travels
    spectrum: Spectrum = key(SpectrumField())  # of the irradiance across the light, W m^-2 nm^-1
    irradiance: float | None = key(_not_negative, None)  # multiplies the spectrum; the default is 1
    illuminance: float | None = key(_not_negative, None)  # instead: lux
    angle: float = key(Number(at_least=0, below=180), 0.0)  # degrees across the disk; 0: nothing can hit it
    visible: bool = key(Flag(), True)  # false: the camera does not see the disk

    def problems(self):
        yield from _given_twice(self, "irradiance", "illuminance")
        if normalized(self.direction) is None:
            yield "direction", expected("a direction that is not zero", self.direction)


@node
class EnvironmentEmitter(Emitter):
    """type = "environment": light from everywhere around the scene, the same or that of an image.

    The image is a latitude-longitude one in linear sRGB. Before the transform its first row is up (z), its middle
    column is looked at along y, and its columns go to the right.
    """

    spectrum: Spectrum | None = key(SpectrumField(), None)  # of the radiance
    radiance: float | None = key(_not_negative, None)  # multiplies the spectrum; the default is 1
    luminance: float | None = key(_not_negative, None)  # instead: cd/m2
    image: str | None = key(FilePath(), None)  # EXR, HDR or PFM, instead of a spectrum
    scale: float = key(_not_negative, 1.0)  # multiplies
    transform: tuple = key(Array(step, expected="an array of steps"), ())  # turns the image; rotations only
    visible: bool = key(Flag(), True)  # false: the camera does not see it

    def problems(self):
        if (self.spectrum is None) == (self.image is None):
            found = "neither" if self.image is None else "both"
            yield None, f"expected either a spectrum or an image, found {found}"
        yield from _given_twice(self, "radiance", "luminance")
        if self.image is not None:
            for name in ("radiance", "luminance"):
                if getattr(self, name) is not None:
                    yield name, "belongs to a spectrum; an image takes a scale"


EMITTERS = {
    "point": PointEmitter,
    "spot": SpotEmitter,
    "directional": DirectionalEmitter,
    "environment": EnvironmentEmitter,
}
