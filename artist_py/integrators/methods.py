"""The bidirectional methods as subsets of one set of techniques (theory 1.9)."""

from dataclasses import dataclass

from ..transport.mis import Counts
from .bidirectional import Method, Techniques


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


def method_of(name, n_pixels, merge_area):
    """The `Method` of a name, for `n_pixels` pairs of subpaths and a merge area in render-space units squared."""
    subset = METHODS[name]
    present = {field: getattr(subset, field) or None for field in Techniques._fields}
    counts = Counts(
        float(subset.hit),
        float(subset.nee),
        float(subset.connect),
        float(subset.light_image),
        n_pixels * merge_area if subset.merge else 0.0,
    )
    return Method(Techniques(**present), counts, float(n_pixels), subset.hit)
