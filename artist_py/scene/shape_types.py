"""What a scene file may say of a shape: one frozen dataclass per type, one field per key; see `graph.py`."""

from artist_py.scene.fields import (
    Array,
    Choice,
    FilePath,
    Flag,
    Node,
    Number,
    Reference,
    Table,
    Text,
    Variant,
    key,
    node,
    numbers,
)
from artist_py.scene.messages import expected
from artist_py.scene.spectrum_fields import SpectrumField
from artist_py.scene.spectrum_types import Spectrum
from artist_py.scene.transforms import COORDINATE_LIMIT, are_parallel, direction, normalized, point, step

Vector = tuple[float, float, float]

distance = Number(above=0, limit=COORDINATE_LIMIT)
transform = Array(step, expected="an array of steps")
_not_negative = Number(at_least=0)


@node
class Emission(Node):
    """What a surface emits; at most one of radiance, luminance and power says how much."""

    spectrum: Spectrum = key(SpectrumField())
    radiance: float | None = key(_not_negative, None)  # multiplies the spectrum; the default is 1
    luminance: float | None = key(_not_negative, None)  # cd/m2 of the surface
    power: float | None = key(_not_negative, None)  # W of the whole shape, from 300 to 780 nm
    sides: str = key(Choice(("front", "both")), "front")
    visible: bool = key(Flag(), True)  # false: the camera sees the shape, but not that it emits

    def problems(self):
        given = [name for name in ("radiance", "luminance", "power") if getattr(self, name) is not None]
        if len(given) > 1:
            yield given[1], f"expected one of radiance, luminance and power, found {' and '.join(given)}"


class EmissionField:
    """A spectrum, which is the radiance, or a table of `Emission`."""

    expected = "a spectrum or a table with a spectrum"
    keys = frozenset({"spectrum", "radiance", "luminance", "power", "sides", "visible"})

    def __call__(self, value, at):
        if isinstance(value, dict) and not self.keys.isdisjoint(value):
            return Table(Emission)(value, at)
        return Emission(spectrum=SpectrumField()(value, at), where=at)


@node
class Shape(Node):
    """What every shape can say."""

    name: str | None = key(Text(), None)
    material: str | None = key(Reference("materials"), None)  # default: black, for what emits
    transform: tuple = key(transform, ())  # steps, in the order in which they are applied
    emission: Emission | None = key(EmissionField(), None)
    reverse: bool = key(Flag(), False)  # the normal points to the other side

    def problems(self):
        if self.material is None and self.emission is None:
            yield "material", "missing, expected a material, since the shape does not emit"
        yield from self.degeneracies()

    def degeneracies(self):
        """(key, message) of what makes the shape have no area or no extent."""
        return ()


@node
class Sphere(Shape):
    """The normal points outwards."""

    center: Vector = key(point)
    radius: float = key(distance)


@node
class Rectangle(Shape):
    """A parallelogram; the normal is edge 0 x edge 1."""

    corner: Vector = key(point)
    edges: tuple[Vector, Vector] = key(Array(direction, 2, expected="two edges [[x, y, z], [x, y, z]]"))

    def degeneracies(self):
        if are_parallel(*self.edges):
            yield "edges", expected("two edges that are neither parallel nor zero", self.edges)


@node
class Box(Shape):
    """Along the axes, by two corners, or by centre and size; the normals point outwards."""

    min: Vector | None = key(point, None)
    max: Vector | None = key(point, None)
    center: Vector | None = key(point, None)
    size: Vector | None = key(numbers(3, "[x, y, z]", distance), None)

    def bounds(self):
        """The two corners (min, max)."""
        if self.min is not None:
            return self.min, self.max
        pairs = list(zip(self.center, self.size, strict=True))
        return tuple(c - s / 2 for c, s in pairs), tuple(c + s / 2 for c, s in pairs)

    def degeneracies(self):
        given = {name for name in ("min", "max", "center", "size") if getattr(self, name) is not None}
        if given not in ({"min", "max"}, {"center", "size"}):
            found = " and ".join(sorted(given)) or "neither"
            yield None, f"expected min and max, or center and size, found {found}"
        elif any(low >= high for low, high in zip(*self.bounds(), strict=True)):
            yield ("max" if self.max else "size"), expected("max above min in x, y and z", self.bounds()[1])


@node
class Disk(Shape):
    """A round plate."""

    center: Vector = key(point)
    normal: Vector = key(direction)
    radius: float = key(distance)

    def degeneracies(self):
        if normalized(self.normal) is None:
            yield "normal", expected("a direction that is not zero", self.normal)


@node
class Cylinder(Shape):
    """Around the axis from base to top; the normal points outwards."""

    base: Vector = key(point)
    top: Vector = key(point)
    radius: float = key(distance)
    caps: bool = key(Flag(), True)

    def degeneracies(self):
        if is_same(self.base, self.top):
            yield "top", expected("another point than base", self.top)


@node
class Cone(Shape):
    """Around the axis from base to apex; the normal points outwards."""

    base: Vector = key(point)
    apex: Vector = key(point)
    radius: float = key(distance)  # at the base
    cap: bool = key(Flag(), True)

    def degeneracies(self):
        if is_same(self.base, self.apex):
            yield "apex", expected("another point than base", self.apex)


@node
class Mesh(Shape):
    """Triangles from a PLY, OBJ, glTF or GLB file; counter-clockwise corners are seen from the front."""

    file: str = key(FilePath())
    smooth: bool | None = key(Flag(), None)  # default: the normals of the file, where it has some


@node
class GroovedSphere(Shape):
    """A sphere with `grooves` rings cut into it around the axis, as a mesh; see `meshes.grooved_sphere`."""

    center: Vector = key(point)
    radius: float = key(distance)  # outside the grooves
    depth: float = key(Number(at_least=0, below=1), 0.1)  # of a groove, in radii
    grooves: int = key(Number(at_least=0, at_most=1000, whole=True), 8)
    axis: Vector = key(direction, (0.0, 0.0, 1.0))
    segments: int = key(Number(at_least=8, at_most=4096, whole=True), 128)  # around the axis

    def degeneracies(self):
        if normalized(self.axis) is None:
            yield "axis", expected("a direction that is not zero", self.axis)


def is_same(a, b):
    """Whether two points are too near each other to tell a direction."""
    return normalized(tuple(y - x for x, y in zip(a, b, strict=True))) is None


SHAPES = {
    "sphere": Sphere,
    "rectangle": Rectangle,
    "box": Box,
    "disk": Disk,
    "cylinder": Cylinder,
    "cone": Cone,
    "mesh": Mesh,
    "grooved-sphere": GroovedSphere,
}
shape = Variant(SHAPES)
