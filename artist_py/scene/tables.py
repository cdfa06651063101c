"""The contract between the scene compiler and the kernels: what a compiled scene looks like in memory.

Kernels work in *render space*: the scene moved to the origin and scaled by a power of two so that its bounding radius
lies in [1, 2); float32 geometry is then as precise for a scene far from the origin as for one at it.
A field that is `None` is absent from the scene and its code is not compiled.
"""

from typing import NamedTuple

import numpy as np

from ..core.table import Table

# Placement kinds: how a hit's position and normal are found from Embree's primitive.
TRIANGLES, SMOOTH_TRIANGLES, PARALLELOGRAMS, QUADRICS = range(4)

# Quadric kinds, each in its canonical frame (see geometry/quadrics.py).
SPHERE, DISK, CYLINDER, CONE = range(4)

# BSDF kinds: first those with a density, then those of delta lobes only, of these last what transmits; those up to
# CONDUCTOR have a reflectance. ABSORBER is black from both sides and ends every path.
DIFFUSE, OREN_NAYAR, PHONG, PLASTIC = range(4)
MIRROR, CONDUCTOR, DIELECTRIC, THIN_DIELECTRIC, PASS_THROUGH, ABSORBER = range(4, 10)

# Emitter kinds: how a point on the emitter is sampled. Those without a surface come last, of them those at infinity,
# and of these those that rays can hit.
TRIANGLE_EMITTER, PARALLELOGRAM_EMITTER, SPHERE_EMITTER, QUADRIC_EMITTER = range(4)
POINT_EMITTER, SPOT_EMITTER, DIRECTIONAL_EMITTER, SUN_EMITTER, ENVIRONMENT_EMITTER = range(4, 9)

# Texture kinds.
IMAGE, CHECKERBOARD = range(2)

NO_EMITTER = -1

vertex_dtype = np.dtype([("position", "f4", 3), ("normal", "f4", 3), ("uv", "f4", 2)], align=True)

# One row per parallelogram, from the float32 corners that Embree has.
parallelogram_dtype = np.dtype(
    [
        ("corner", "f8", 3),
        ("edge0", "f8", 3),
        ("edge1", "f8", 3),
        ("normal", "f8", 3),  # unit, edge0 x edge1
        ("extent", "f8"),  # of the edges, see geometry/surface.py
    ],
    align=True,
)

quadric_dtype = np.dtype(
    [
        (
            "object_to_world",
            "f8",
            (3, 4),
        ),  # canonical frame to render space (or to the instanced object's frame)
        ("world_to_object", "f8", (3, 4)),
        ("kind", "i8"),
    ],
    align=True,
)

# One row per (instance, shape): instance 0 holds the shapes that stand directly in the scene.
placement_dtype = np.dtype(
    [
        ("kind", "i4"),
        ("material", "i4"),
        ("emitter", "i4"),  # index of the emitter of primitive 0, or NO_EMITTER
        ("first", "i4"),  # index of primitive 0 in its pool (triangles, parallelograms or quadrics)
        ("flip", "f4"),  # -1 turns the normals round
    ],
    align=True,
)

instance_dtype = np.dtype(
    [
        ("object_to_world", "f8", (3, 4)),
        ("world_to_object", "f8", (3, 4)),
        ("first_placement", "i4"),
    ],
    align=True,
)

material_dtype = np.dtype(
    [
        ("kind", "i4"),
        ("two_sided", "i4"),  # 1: the back scatters like the front; 0: it is black
        ("reflectance", "i4"),  # row of the spectra, [0, 1]
        ("eta", "i4"),  # row: conductor's real index of refraction, or the dispersive dielectric's
        ("absorption", "i4"),  # row: conductor's imaginary index of refraction
        ("specular", "i4"),  # row: Phong lobe's reflectance along the normal
        ("is_dispersive", "i4"),
        ("is_sharp", "i4"),  # 1: its lobe is too narrow to be merged at
        ("medium", "i4"),  # dielectric: its row in `Scene.media`, from 1
        ("texture", "i4"),  # row of the textures that replaces `reflectance`, or -1
        ("fluorescence", "i4"),  # row of the tables of `Fluorescence`, or -1
        ("ior", "f8"),  # index of refraction of a dielectric or a coat where it does not depend on wavelength
        ("transmittance", "f8"),  # plastic: share of diffuse light from outside that enters the coat
        ("roughness", "f8"),  # Oren-Nayar: standard deviation of facet slopes' angle, radians
        ("exponent", "f8"),  # Phong: n of cos^n
        (
            "glow",
            "f8",
        ),  # of a fluorescent material: share of the scene's light that it gives off at other wavelengths
    ],
    align=True,
)

emitter_dtype = np.dtype(
    [
        ("kind", "i4"),
        ("spectrum", "i4"),  # row of the spectra, W m^-2 sr^-1 nm^-1 once scaled
        ("two_sided", "i4"),
        ("quadric", "i4"),
        ("visible", "i4"),  # 0: not seen straight from the camera
        ("image", "i4"),  # environment: row of the images, or -1
        ("green", "i4"),  # environment with an image: rows of the spectra; `spectrum` is that of red
        ("blue", "i4"),
        ("media", "i8"),  # the dielectrics that it stands in, see transport/media.py
        ("scale", "f8"),
        ("pdf_select", "f8"),  # probability of choosing this emitter, discrete
        (
            "area",
            "f8",
        ),  # render-space units squared; point and spot: 1; at infinity: of the disk around the scene
        (
            "origin",
            "f8",
            3,
        ),  # triangle and parallelogram: a corner; sphere: its centre; point and spot: where it is
        ("edge0", "f8", 3),  # environment: edge0, edge1 and normal are the axes of its image
        ("edge1", "f8", 3),
        (
            "normal",
            "f8",
            3,
        ),  # unit; faces: on the emitting side; spot: its axis; directional and sun: towards the light
        ("radius", "f8"),  # sphere; at infinity: that of the disk around the scene
        ("cone", "f8"),  # spot and sun: 1 - cos of the half angle
        ("inner_cone", "f8"),  # spot: the same of the part that is not dimmed
        ("flip", "f8"),  # sphere and quadric: -1 where the inner side is the front
    ],
    align=True,
)

# What fills space: row 0 is the vacuum, then one row per dielectric material.
medium_dtype = np.dtype(
    [
        ("priority", "i4"),  # where dielectrics overlap the highest fills the space
        ("eta", "i4"),  # row of the spectra if dispersive, else -1
        ("ior", "f8"),
    ],
    align=True,
)

texture_dtype = np.dtype(
    [
        ("kind", "i4"),
        ("spectra", "i4", 3),  # rows: of the image's channels, or of the checkerboard's two colours
        ("channels", "i4"),  # image: 1 (grey) or 3 (RGB)
        ("is_nearest", "i4"),  # image: 1: no interpolation
        ("width", "i4"),  # image: texels
        ("height", "i4"),
        ("offset", "i8"),  # image: its first texel in the pool; row by row from the top, channels together
        ("repeat_u", "f8"),  # images, or squares of the checkerboard, from 0 to 1 along u
        ("repeat_v", "f8"),  # and along v
    ],
    align=True,
)

# A latitude-longitude image, see emitters/environment.py.
image_dtype = np.dtype(
    [
        ("width", "i8"),
        ("height", "i8"),
        ("first_texel", "i8"),
        ("first_row", "i8"),
    ],
    align=True,
)

alias_dtype = np.dtype([("probability", "f8"), ("alias", "i8")], align=True)


class Geometry(NamedTuple):
    """Where things are; `embree` is the address of the committed RTCScene."""

    embree: int
    first_instance: int  # geometry ID of instance 0 in the top scene
    placements: Table  # placement_dtype
    vertices: Table  # vertex_dtype, shared with Embree
    triangles: Table  # uint32 (n, 3) into vertices, shared with Embree
    parallelograms: Table  # parallelogram_dtype
    quadrics: Table | None  # quadric_dtype
    instances: Table | None  # instance_dtype


class Spectra(NamedTuple):
    """All spectra of the scene, one row each; exactly one of `resolved` and `dense` is present."""

    resolved: Table | None  # float32 (rows, C): at this iteration's shared wavelengths
    dense: Table | None  # float32 (rows, bins): averages over 1 nm bins
    first: float  # nm, lower edge of bin 0


class EnvironmentImages(NamedTuple):
    """Latitude-longitude images, and how their texels are drawn: see emitters/environment.py."""

    records: Table  # image_dtype
    texels: Table  # float32 (n, 3), linear sRGB
    columns: Table  # float64 (n,): within a row, the probability of all texels up to and with this one
    rows: Table  # float64: the same of the rows of an image


class Emitters(NamedTuple):
    """What emits; `alias` is absent when there is one emitter only."""

    records: Table  # emitter_dtype
    alias: Table | None  # alias_dtype
    background: (
        int | None
    )  # rows from here on are what rays find that leave the scene; absent where there is nothing
    images: EnvironmentImages | None


class Textures(NamedTuple):
    """What materials vary over surfaces."""

    records: Table  # texture_dtype
    texels: Table | None  # uint16 (n,), see bsdf/reflectance.py; absent where no texture is an image


class ColourControl(NamedTuple):
    """What makes up for the chance in which wavelengths the film sees (theory 3.9), see bsdf/fluorescence.py."""

    # Per row of `Fluorescence` and lane (j, c): of light at wavelength j of set 1, what reaches channel c of the film
    # by all wavelengths less what does by those of set 0; float32 (rows, C 3).
    table: Table
    set: object  # Spectrum of C zeros
    colour: object  # of 3
    matrix: object  # of C 3
    block: object  # of 3 3: what an eye subpath's matrix has after the rows of all wavelengths


class Fluorescence(NamedTuple):
    """Reradiation between the sets of wavelengths of an iteration, a row per fluorescent material (theory 3.2).

    With M sets of C wavelengths: `towards_eye` holds R(out, in) v(in) for lane (j, m, k), in being wavelength j of set
    m + 1 and out wavelength k of set m; `towards_light` the same numbers for lane (k, m + 1, j). See core/sets.py.
    """

    towards_eye: Table  # float32 (rows, C M C)
    towards_light: Table  # float32 (rows, C M C)
    survival: Table  # float64 (rows,): the most that is scattered at any of the wavelengths, at most 1
    # Spectra. Light has M C lanes, and 3 more with a control; eye subpaths have a matrix from these to columns.
    zero: object  # of as many zeros as light has lanes
    sets: object  # of M C zeros
    rows: object  # of as many zeros as the matrix has for these
    coefficients: object  # of C M C zeros
    matrix: object  # with which eye subpaths start: what the film sees of all lanes of light, per column
    white: object  # of light of radiance 1 at all wavelengths,
    colour: object  # and of one that is the same to the film by its control alone
    unit: object  # per column: 1 over what a path of throughput 1 brings it of that, for Russian roulette
    ratio: object | None  # r of theory (2.6) where all wavelengths mix; absent where no density depends on it
    control: ColourControl | None  # absent where columns are wavelengths


class Redistribution(NamedTuple):
    """Where fluorescence leads to from each wavelength, a row per fluorescent material; bins of 1 nm."""

    first: float  # nm, lower edge of bin 0
    shares: Table  # float32 (rows * bins * bins,): of all that is led on from a bin, what goes up to the end of another
    totals: Table  # float32 (rows, bins): the sum of R over where it leads to


class Reemission(NamedTuple):
    """What light subpaths with wavelengths of their own need, see transport/shifting.py."""

    emission: Redistribution  # from the wavelength of excitation
    matrix: Table  # R(out, in), 1 / nm, float32 (rows, bins, bins)
    nodes: Table  # float64 (n + 1,): where light subpaths begin, see core/wavelengths.py


class Needs(NamedTuple):
    """What the scene needs: `True`, or `None` for what is left out of its kernels."""

    diffuse: bool | None = None
    oren_nayar: bool | None = None
    phong: bool | None = None
    plastic: bool | None = None
    mirror: bool | None = None
    conductor: bool | None = None
    dielectric: bool | None = None
    thin_dielectric: bool | None = None
    pass_through: bool | None = None
    lobes: bool | None = None  # a material that chooses between lobes
    sharp: bool | None = None  # a material that is not merged at, though it has a density
    dispersion: bool | None = None  # a dielectric whose index depends on wavelength
    media: bool | None = None  # dielectrics inside or overlapping dielectrics
    triangles: bool | None = None
    smooth_triangles: bool | None = None
    parallelograms: bool | None = None
    quadrics: bool | None = None
    instances: bool | None = None
    triangle_emitters: bool | None = None
    parallelogram_emitters: bool | None = None
    sphere_emitters: bool | None = None
    quadric_emitters: bool | None = None
    surfaceless_emitters: bool | None = None  # any of the following four
    point_emitters: bool | None = None
    spot_emitters: bool | None = None
    distant_emitters: bool | None = None  # directional ones and suns
    environments: bool | None = None
    environment_images: bool | None = None
    hidden_emitters: bool | None = None  # an emitter that the camera does not see
    one_sided: bool | None = None  # a material that is black from behind
    textures: bool | None = None
    fluorescence: bool | None = None
    coated_dyes: bool | None = None  # a fluorescent material under a clear coat
    shared_wavelengths: bool | None = None


class Lens(NamedTuple):
    """A thin lens; `blades` = 0 is a round aperture."""

    radius: float  # render-space units
    focus_distance: float  # along the optical axis
    blades: int
    rotation: float  # radians


class Filter(NamedTuple):
    """Reconstruction filter as one inverse distribution per axis; see film/filters.py."""

    offsets: Table  # float64 (n + 1,), pixels from the pixel centre
    weights: Table | None  # float64 (n,); absent where the filter is its own density
    profile: Table  # float64: the filter's value over its width, 1 / pixel, for light that arrives anywhere


class Camera(NamedTuple):
    """A perspective camera in render space; film point (x, y) in pixels lies at `corner + x right + y down`."""

    position: object  # Vec3
    forward: object  # Vec3, unit
    right: object  # Vec3, one pixel to the right at distance 1 along `forward`
    down: object  # Vec3, one pixel down
    corner: object  # Vec3, the outer corner of pixel (0, 0), at distance 1 along `forward`
    lens: Lens | None
    clip: float | None  # far from the scene, rays start at this distance from its centre instead
    media: int  # the dielectrics that the camera stands in, see transport/media.py


class Scene(NamedTuple):
    """Everything a kernel may read."""

    geometry: Geometry
    materials: Table  # material_dtype
    spectra: Spectra
    emitters: Emitters | None
    media: Table | None  # medium_dtype; absent where no dielectric touches another
    textures: Textures | None
    needs: Needs
    fluorescence: Fluorescence | None = None  # of an iteration; absent where nothing fluoresces
    # Instead, where every path has wavelengths of its own: from the wavelength of emission, for eye subpaths.
    excitation: Redistribution | None = None
    reemission: Reemission | None = None  # the same for light subpaths
