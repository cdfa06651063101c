"""What a render hands to its outputs: plain arrays, already normalised, and how they were seen."""

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class FilmImage:
    """Mean image over `iterations`; every array is (height, width, ...) of the cropped window, row 0 at the top.

    Matrices are 4 x 4 and act on column vectors. Normalised device coordinates run from (0, 0) at the top left of
    the uncropped image to (1, 1) at the bottom right, as OpenEXR defines `worldToNDC`.
    """

    rgb: Any  # (h, w, 3) float64, linear sRGB (D65)
    iterations: int  # paths per pixel in the mean
    resolution: tuple[int, int] | None = None  # width, height of the uncropped image; None: that of `rgb`
    crop: tuple[int, int, int, int] | None = None  # x0, x1, y0, y1 in pixels, half-open; None: all of it
    variance: Any = None  # (h, w, 3), of the mean
    spectral: Any = None  # (h, w, n_bands), W m^-2 sr^-1 nm^-1
    band_centres: Any = None  # (n_bands,), nm
    aovs: dict = field(default_factory=dict)  # name -> (h, w, c) float32
    rejected: tuple = ()  # (x, y, iteration) of non-finite contributions that were dropped, the first of them
    rejected_count: int = 0  # of all of them
    world_to_camera: Any = None  # (4, 4)
    world_to_ndc: Any = None  # (4, 4)

    @property
    def window(self):
        """`(x0, y0, full_width, full_height)`, pixels: where the arrays lie in the uncropped image."""
        height, width = self.rgb.shape[:2]
        full_width, full_height = self.resolution or (width, height)
        x0, _, y0, _ = self.crop or (0, width, 0, height)
        return x0, y0, full_width, full_height
