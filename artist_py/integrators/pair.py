"""What the kernels of bidirectional methods share: the method, the stores, and one bundle of everything."""

from typing import NamedTuple

import numpy as np

from ..core.table import Table
from ..core.vector import Spectrum
from ..jit import function
from ..scene.tables import Camera, Filter, Scene
from ..transport.mis import Counts
from ..transport.photon_density import PhotonDensity
from ..transport.recording import TechniqueTables
from ..transport.roulette import Limits
from ..transport.sensing import Sensing
from ..transport.shares import Chosen
from ..transport.vertices import Pool
from .path_tracing import Pass

# Pairs of random dimensions of a subpath: three for its start, then a block for every vertex.
FIRST_VERTEX = 3
EMITTER, BSDF, CHOICE, SENSOR, PAIRS_PER_VERTEX = range(5)
# Single random numbers (core/rng.py): one for the emitter, one per vertex for roulette, one per splat for its pixel.
EMITTER_CHOICE, ROULETTE, PIXEL_CHOICE = 0, 0, 1 << 20
LIGHT_SEED = 0x4C49474854  # makes the random numbers of light subpaths others than those of eye subpaths

path_dtype = np.dtype(
    [
        ("first_vertex", "i8"),
        ("first_splat", "i8"),
        ("n_vertices", "i4"),
        ("n_splats", "i4"),
        ("pixel", "i8"),
    ],
    align=True,
)


class Techniques(NamedTuple):
    """What a method uses: `True`, or `None` for what is not compiled."""

    nee: bool | None
    connect: bool | None
    light_image: bool | None
    merge: bool | None
    merge_once: bool | None  # merge at the first vertex that is not specular, and end there (photon mapping)
    light_paths: bool | None


class Method(NamedTuple):
    """A method's techniques and how many samples of each it takes."""

    techniques: Techniques
    counts: Counts
    n_pixels: float  # eye subpaths per iteration
    n_light_paths: float  # light subpaths per iteration, on average
    light_paths: float  # per pixel
    offset: float  # in [0, 1): which pixels get one more where `light_paths` is not whole
    hits_everything: bool  # hitting an emitter is a technique like the others; else only where no other can
    shadow_rays: int | None  # per eye vertex; absent where it is one
    chosen: Chosen  # light subpaths, by what is done with them
    n_image_paths: float  # of them, those that the camera sees
    n_photon_paths: float  # and those that are merged with
    density: PhotonDensity | None = None  # absent where weights take merges for independent samples


class Stores(NamedTuple):
    """Where subpaths leave what is needed later; absent where nobody needs it."""

    light: Pool | None
    eye: Pool | None
    splats: Pool | None
    paths: Table  # path_dtype, one row per light subpath
    resume: Table  # int64 (threads, 2): tile (or -1) and pixel in it at which records ran short
    techniques: TechniqueTables | None  # where contributions are also kept by technique
    # float64: the number that places the wavelengths of each pixel's subpaths, where merges have to bring them in line
    offsets: Table | None = None


class Setup(NamedTuple):
    """Everything that an iteration's kernels read, and where they write."""

    scene: Scene
    camera: Camera
    pixel_filter: Filter
    sensing: Sensing
    limits: Limits
    work: Pass
    method: Method
    stores: Stores


class Walk(NamedTuple):
    """What tracing a subpath has brought and cost."""

    radiance: Spectrum
    rays: int
    shadow_rays: int


@function
def light_paths_of(method, index):
    """`(first, end)` of the light subpaths that belong to pixel `index` of the window.

    With an offset that is uniform in [0, 1) every pixel has `light_paths` of them on average.
    """
    first = int(index * method.light_paths + method.offset)
    return first, int((index + 1) * method.light_paths + method.offset)
