"""The bidirectional methods as subsets of one set of techniques (theory 1.9)."""

from dataclasses import dataclass

from ..transport.mis import Counts
from .pair import Method, Techniques


@dataclass(frozen=True)
class Subset:
    """Which techniques a method uses."""

    nee: bool = False
    connect: bool = False
    light_image: bool = False
    merge: bool = False
    merge_once: bool = False
    hit: bool = False

    @property
    def light_paths(self):
        """Whether it needs light subpaths at all."""
        return self.connect or self.light_image or self.merge


METHODS = {
    "lt": Subset(light_image=True),
    "bpt": Subset(hit=True, nee=True, connect=True, light_image=True),
    "ppm": Subset(merge=True, merge_once=True),
    "bpm": Subset(merge=True),
    "vcm": Subset(hit=True, nee=True, connect=True, light_image=True, merge=True),
}


def has_lens_hits(integrator, camera):
    """Whether the method has light that hits the lens as a technique.

    Not so for cameras that are far away: nothing would hit those, and nearly nothing needs to.
    """
    is_lens = camera.lens is not None and camera.clip is None
    return is_lens and integrator in METHODS and METHODS[integrator].light_image


def method_of(name, n_pixels, light_paths, offset, merge_area, power=False, lens=False):
    """The `Method` of a name, for so many pixels, light subpaths per pixel and a merge area in render-space units^2.

    `power` chooses the power heuristic (beta = 2), `lens` light that hits the lens. `offset` in [0, 1) says which
    pixels get one more light subpath than others, where `light_paths` is not whole.
    """
    n_light_paths = n_pixels * light_paths
    subset = METHODS[name]
    present = {field: getattr(subset, field) or None for field in Techniques._fields}
    counts = Counts(
        # What a method without hits finds by them nevertheless, lens hits find as well.
        float(subset.hit or lens),
        float(subset.nee),
        light_paths if subset.connect else 0.0,
        light_paths if subset.light_image else 0.0,
        n_light_paths * merge_area if subset.merge else 0.0,
        True if power else None,
        light_paths if lens else None,
    )
    return Method(
        Techniques(**present), counts, float(n_pixels), n_light_paths, light_paths, offset, subset.hit
    )
