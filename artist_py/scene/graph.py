"""What a scene file may say: one frozen dataclass per table, one field per key, its default and its unit.

Lengths are in scene units, angles in degrees, wavelengths in nm, radiance in W m^-2 sr^-1 nm^-1. A key
without a default must be given. The converters (`fields.py`) say what a value may be, `problems` what keys
may not say together. Shapes are in `shape_types.py`, emitters without a shape in `emitter_types.py`, spectra
in `spectrum_types.py`, textures in `texture_types.py`, transforms in `transforms.py`.
"""

import math

from artist_py.scene.emitter_types import EMITTERS, Emitter
from artist_py.scene.fields import (
    Array,
    Choice,
    Dictionary,
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
from artist_py.scene.fluorescent_types import Dye, Reradiation, dyes, reradiation, share
from artist_py.scene.messages import expected, show
from artist_py.scene.shape_types import SHAPES, Shape, Vector, distance, shape, transform
from artist_py.scene.spectrum_fields import IndexField, MetalField, SpectrumField
from artist_py.scene.spectrum_types import Constant, RefractiveIndex, Spectrum
from artist_py.scene.texture_types import Texture
from artist_py.scene.texture_types import reflectance as _reflectance
from artist_py.scene.transforms import are_parallel, direction, normalized, point

FILTER_RADIUS = {"box": 0.5, "tent": 1.0, "gaussian": 1.5, "blackman-harris": 1.5, "mitchell": 2.0}  # pixels
INTEGRATORS = ("pt", "lt", "bpt", "ppm", "bpm", "vcm", "reference")
MERGES = ("ppm", "bpm", "vcm", "reference")  # those that merge paths, and care for each other's wavelengths
ROTATES = ("lt", "bpt", "ppm", "bpm", "vcm")  # those that trace paths from lights
ONLY_TECHNIQUE = {"lt": "light_image", "ppm": "merging", "bpm": "merging"}  # in [render.samples]
LONGEST_STORED = 1000  # edges of subpaths whose vertices are stored
# cd/m2 of a flat spectrum of radiance 1: 683.002 lm/W times the integral of ybar.
WHITE_LUMINANCE = {"CIE 1931 2": 72983.4866019817, "CIE 1964 10": 79680.2951650147}

_count = Number(at_least=1, whole=True)
_share = SpectrumField(Number(at_least=0, at_most=1))
_radiance = SpectrumField(Number(at_least=0))
_coat = Number(at_least=1, at_most=10)
_positive_spectrum = SpectrumField(Number(above=0))


@node
class Film(Node):
    """[film]: the image."""

    resolution: tuple[int, int] = key(
        numbers(2, "[width, height]", Number(at_least=1, at_most=65536, whole=True)), (512, 512)
    )  # pixels
    crop: tuple[int, int, int, int] | None = key(
        numbers(4, "[x0, x1, y0, y1]", Number(at_least=0, whole=True)), None
    )  # pixels; x1 and y1 are the first ones left out; default: the whole image
    filter: str = key(Choice(tuple(FILTER_RADIUS)), "blackman-harris")
    filter_radius: float = key(Number(above=0, at_most=32), None)  # pixels; default: as FILTER_RADIUS
    white_luminance: float = key(Number(above=0), None)  # cd/m2 with Y = 1; default: as WHITE_LUMINANCE
    observer: str = key(Choice(tuple(WHITE_LUMINANCE)), "CIE 1931 2")

    def __post_init__(self):
        if self.filter_radius is None:
            object.__setattr__(self, "filter_radius", FILTER_RADIUS[self.filter])
        if self.white_luminance is None:
            object.__setattr__(self, "white_luminance", WHITE_LUMINANCE[self.observer])

    def problems(self):
        if self.crop is not None:
            (x0, x1, y0, y1), (width, height) = self.crop, self.resolution
            if not (x0 < x1 <= width and y0 < y1 <= height):
                yield "crop", expected(f"0 <= x0 < x1 <= {width} and 0 <= y0 < y1 <= {height}", self.crop)


@node
class Pinhole(Node):
    """[camera] type = "pinhole": everything is sharp."""

    position: Vector = key(point)
    look_at: Vector = key(point)  # the point in the middle of the image
    up: Vector = key(direction, (0.0, 0.0, 1.0))
    field_of_view: float = key(Number(above=0, below=180), 45.0)  # degrees, across the shorter side

    def view(self):
        """From the position to what is looked at, not normalised."""
        return tuple(b - a for a, b in zip(self.position, self.look_at, strict=True))

    def problems(self):
        if normalized(self.view()) is None:
            yield "look_at", expected("another point than position", self.look_at)
        elif are_parallel(self.view(), self.up):
            yield "up", expected("a direction not parallel to the view", self.up)


@node
class ThinLens(Pinhole):
    """[camera] type = "thin-lens": sharp in one plane."""

    aperture_radius: float = key(distance)  # scene units
    focus_distance: float = key(distance, None)  # scene units, along the view; default: to look_at
    blades: int = key(Number(at_least=0, at_most=64, whole=True), 0)  # corners of the aperture; 0: round
    blade_rotation: float = key(Number(), 0.0)  # degrees

    def __post_init__(self):
        if self.focus_distance is None:
            object.__setattr__(self, "focus_distance", math.hypot(*self.view()))

    def problems(self):
        yield from super().problems()
        if self.blades in (1, 2):
            yield "blades", expected("0 for a round aperture, or blades >= 3", self.blades)


CAMERAS = {"pinhole": Pinhole, "thin-lens": ThinLens}


@node
class Merging(Node):
    """[render.merging]: photons."""

    radius: float | None = key(Number(above=0), None)  # in bounding radii of the scene; default: 0.003
    radius_pixels: float | None = key(Number(above=0), None)  # instead: pixels, at the distance of look_at
    alpha: float = key(Number(above=0, at_most=1), 0.75)  # how the radius shrinks; 1: it does not
    schedule: str = key(
        Choice(("knaus-zwicker", "smallvcm")), "knaus-zwicker"
    )  # exact, or r n^((alpha - 1) / 2)
    kernel: str = key(Choice(("constant", "epanechnikov")), "constant")
    min_normal_cosine: float = key(
        Number(at_least=0, at_most=1), 0.4
    )  # between the surfaces of photon and vertex
    light_paths: float = key(Number(at_least=0.01, at_most=64), 1.0)  # per pixel
    correlation: str = key(
        Choice(("none", "vcm+")), "none"
    )  # whether weights know that merges at one place share their photons
    wavelength_tolerance: float = key(Number(above=0), 5.0)  # nm, with wavelengths = "rotate"
    tolerance_exponent: float = key(
        Number(at_least=0, at_most=1), 0.0
    )  # s: in iteration n it is that tolerance times n^-s

    def __post_init__(self):
        if self.radius is None and self.radius_pixels is None:
            object.__setattr__(self, "radius", 0.003)

    def problems(self):
        if self.radius_pixels is not None and self.radius is not None:
            yield "radius_pixels", "expected either radius or radius_pixels, found both"


@node
class Samples(Node):
    """[render.samples]: how many samples of each technique are taken; 0 leaves it out."""

    next_event: int | None = key(
        Number(at_least=0, at_most=1024, whole=True), None
    )  # shadow rays per eye vertex; default: 1
    connections: float | None = key(
        Number(at_least=0), None
    )  # light paths that an eye path is connected to, on average; default: all of its pixel
    light_image: float | None = key(
        Number(at_least=0, at_most=1), None
    )  # share of the light paths that the camera sees; default: all
    merging: float | None = key(
        Number(at_least=0, at_most=1), None
    )  # share of the light paths that are photons; default: all


@node
class BruteForce(Node):
    """[render.reference]: the brute-force integrator "reference", for a few pixels."""

    mode: str = key(
        Choice(("vcm", "bdpt", "bdpm")), "vcm"
    )  # all techniques, none that merges, only those that merge
    light_samples: int | None = key(
        Number(at_least=0, whole=True), None
    )  # light subpaths; default: one per pixel
    eye_samples: int = key(_count, 1)  # eye subpaths per pixel
    min_path_length: int = key(_count, 1)  # edges; shorter paths are left out


def _wavelength_problem(integrator, wavelengths):
    """Why an integrator cannot have wavelengths of this kind, or `None`."""
    allowed = ['"shared"']
    if integrator not in MERGES:
        allowed.append('"independent"')
    if integrator in ROTATES:
        allowed.append('"rotate"')
    if show(wavelengths) in allowed:
        return None
    reason = "merges paths" if integrator in MERGES else "traces no paths from lights"
    return f"expected {' or '.join(allowed)}, since {integrator} {reason}, found {show(wavelengths)}"


@node
class Render(Node):
    """[render]: how the image is computed."""

    integrator: str = key(Choice(INTEGRATORS), "pt")
    iterations: int = key(_count, 64)  # one path per pixel each
    time: float | None = key(Number(above=0), None)  # seconds after which no iteration starts
    error: float | None = key(Number(above=0), None)  # relMSE at which it is good enough
    max_path_length: int = key(_count, 12)  # edges
    roulette_length: int = key(Number(at_least=0, whole=True), 4)  # edges before Russian roulette
    seed: int = key(Number(at_least=0, whole=True, limit=2**63 - 1), 1)
    wavelengths: str = key(
        Choice(("independent", "shared", "rotate")), None
    )  # default: shared by methods that merge
    hero_count: int = key(Choice((1, 4, 8)), 4)  # wavelengths per path
    wavelength_range: tuple[int, int] | None = key(
        numbers(2, "[first, last]", Number(at_least=300, at_most=830, whole=True)), None
    )  # nm; default: 380 to 780, or from 300 where the scene needs it
    wavelength_sets: int | None = key(
        Number(at_least=1, at_most=4, whole=True), None
    )  # of shared wavelengths, where materials fluoresce; default: 3, or 4 where 3 would lose light
    sampler: str = key(Choice(("sobol", "independent")), "sobol")
    heuristic: str = key(Choice(("balance", "power")), "balance")  # of bidirectional methods; power: beta = 2
    samples: Samples = key(Table(Samples), Samples())
    merging: Merging = key(Table(Merging), Merging())
    reference: BruteForce = key(Table(BruteForce), BruteForce())

    def __post_init__(self):
        if self.wavelengths is None:
            object.__setattr__(self, "wavelengths", "shared" if self.integrator in MERGES else "independent")

    def problems(self):
        if problem := _wavelength_problem(self.integrator, self.wavelengths):
            yield "wavelengths", problem
        if self.integrator == "reference" and self.merging.correlation != "none":
            message = f'expected correlation = "none" with reference, found {show(self.merging.correlation)}'
            yield "merging", message
        if self.integrator != "pt" and self.max_path_length > LONGEST_STORED:
            message = (
                f"expected at most {LONGEST_STORED} with {self.integrator}, found {self.max_path_length}"
            )
            yield "max_path_length", message
        yield from self._problems_of_samples()
        if self.wavelength_range is not None and self.wavelength_range[0] >= self.wavelength_range[1]:
            yield "wavelength_range", expected("first < last", self.wavelength_range)

    def _problems_of_samples(self):
        only, most = ONLY_TECHNIQUE.get(self.integrator), self.merging.light_paths
        if only and getattr(self.samples, only) == 0:
            yield f"samples.{only}", f"expected more than 0, since {self.integrator} has nothing else"
        if self.integrator != "reference" and (self.samples.connections or 0) > most:
            wanted = f"at most merging.light_paths = {show(most)}"
            yield "samples.connections", expected(wanted, self.samples.connections)


@node
class Material(Node):
    """What every material that reflects can say."""

    two_sided: bool = key(Flag(), True)  # false: the back is black


@node
class Diffuse(Material):
    """type = "diffuse": Lambert."""

    reflectance: Spectrum | Texture = key(_reflectance, Constant(0.5))


@node
class OrenNayar(Material):
    """type = "oren-nayar": rough matte."""

    reflectance: Spectrum | Texture = key(_reflectance, Constant(0.5))
    roughness: float = key(Number(at_least=0, at_most=90), 20.0)  # degrees, sigma of the facets' slopes


@node
class Phong(Material):
    """type = "phong": matte, and glossy about the mirrored direction."""

    reflectance: Spectrum | Texture = key(_reflectance, Constant(0.5))  # of the matte part
    specular: Spectrum = key(_share, Constant(0.2))  # of the glossy part, seen along the normal
    exponent: float = key(Number(at_least=0, at_most=1e6), 30.0)  # of the cosine: the larger, the sharper


@node
class Plastic(Material):
    """type = "plastic": matte under a smooth clear coat."""

    reflectance: Spectrum | Texture = key(_reflectance, Constant(0.5))  # of what is under the coat
    ior: float = key(_coat, 1.5)  # of the coat, over that of what surrounds it


@node
class Fluorescent(Material):
    """type = "fluorescent": Lambert, and light given off at longer wavelengths than it was absorbed at.

    With `coat_ior` it is the base of plastic.
    """

    reflectance: Spectrum | None = key(share, None)  # default: the diagonal of a measured matrix, else 0
    absorption: Spectrum | None = key(share, None)  # of a dye: share of the light, by wavelength
    emission: Spectrum | None = key(_radiance, None)  # of the dye: power per nm, on any scale
    quantum_yield: float = key(Number(at_least=0, at_most=1), 1.0)  # of the dye: photons per photon absorbed
    dyes: tuple[Dye, ...] | None = key(dyes, None)  # instead, or besides
    reradiation: Reradiation | None = key(reradiation, None)  # instead, or besides
    coat_ior: float | None = key(_coat, None)  # of a clear coat over it, as that of plastic; default: no coat

    def all_dyes(self):
        """The dyes, that of the material's own keys first."""
        own = (
            Dye(
                absorption=self.absorption,
                emission=self.emission,
                quantum_yield=self.quantum_yield,
                where=self.where,
            ),
        )
        return (own if self.absorption is not None else ()) + (self.dyes or ())

    def problems(self):
        if self.absorption is None and self.emission is not None:
            yield "absorption", "missing, expected a spectrum, since there is emission"
        elif self.absorption is not None and self.emission is None:
            yield "emission", "missing, expected a spectrum, since there is absorption"
        elif self.absorption is None and self.dyes is None and self.reradiation is None:
            yield "absorption", "missing, expected absorption and emission, dyes, or reradiation"


@node
class Mirror(Material):
    """type = "mirror": reflects the same share at every angle."""

    reflectance: Spectrum | Texture = key(_reflectance, Constant(1.0))


@node
class Conductor(Material):
    """type = "conductor": smooth metal, by name or by its complex refractive index eta + i k."""

    metal: str | None = key(MetalField(), None)
    eta: Spectrum | None = key(_positive_spectrum, None)
    k: Spectrum | None = key(_radiance, None)
    reflectance: Spectrum | Texture = key(_reflectance, Constant(1.0))  # multiplies

    def problems(self):
        if self.metal is None and self.eta is None and self.k is None:
            yield "metal", "missing, expected a metal, or eta and k"
        elif self.metal is not None and (self.eta is not None or self.k is not None):
            yield "metal", "expected either metal or eta and k, found both"
        elif self.metal is None and self.k is None:
            yield "k", "missing, expected a spectrum, since there is eta"
        elif self.metal is None and self.eta is None:
            yield "eta", "missing, expected a spectrum, since there is k"


@node
class Dielectric(Node):
    """type = "dielectric": smooth glass, water."""

    ior: RefractiveIndex = key(IndexField(), Constant(1.5))
    priority: int = key(Number(whole=True), 0)  # the highest wins


@node
class ThinDielectric(Node):
    """type = "thin-dielectric": a pane without thickness."""

    ior: RefractiveIndex = key(IndexField(), Constant(1.5))


@node
class PassThrough(Node):
    """type = "none": light goes through as if nothing were there."""


MATERIALS = {
    "diffuse": Diffuse,
    "oren-nayar": OrenNayar,
    "phong": Phong,
    "plastic": Plastic,
    "fluorescent": Fluorescent,
    "mirror": Mirror,
    "conductor": Conductor,
    "dielectric": Dielectric,
    "thin-dielectric": ThinDielectric,
    "none": PassThrough,
}
TYPE_NAMES = {
    cls: name for classes in (CAMERAS, MATERIALS, SHAPES, EMITTERS) for name, cls in classes.items()
}


@node
class Object(Node):
    """[objects.NAME]: shapes to be placed any number of times."""

    shapes: tuple[Shape, ...] = key(Array(shape, at_least=1, expected="one shape or more"))


@node
class Instance(Node):
    """[[instances]]: an object, placed."""

    object: str = key(Reference("objects"))
    name: str | None = key(Text(), None)
    transform: tuple = key(transform, ())
    material: str | None = key(Reference("materials"), None)  # instead of those of the object's shapes


@node
class Scene(Node):
    """A scene file, or a whole scene: the file together with all that it includes."""

    include: tuple[str, ...] = key(Array(FilePath(), expected="paths of scene files"), ())
    film: Film = key(Table(Film), Film())
    camera: Pinhole | ThinLens | None = key(Variant(CAMERAS), None)
    render: Render = key(Table(Render), Render())
    spectra: dict[str, Spectrum] = key(Dictionary(SpectrumField()), None)
    materials: dict[str, Node] = key(Dictionary(Variant(MATERIALS)), None)
    objects: dict[str, Object] = key(Dictionary(Table(Object)), None)
    shapes: tuple[Shape, ...] = key(Array(shape, expected="an array of tables"), ())
    instances: tuple[Instance, ...] = key(Array(Table(Instance), expected="an array of tables"), ())
    emitters: tuple[Emitter, ...] = key(Array(Variant(EMITTERS), expected="an array of tables"), ())

    def __post_init__(self):
        for name in ("spectra", "materials", "objects"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, {})
