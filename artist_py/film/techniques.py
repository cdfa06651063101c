"""Images of single techniques: which there are, their sums over iterations, and what they add up to."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from artist_py.film.color import RGB_TO_XYZ

# hit: the eye's path hits an emitter; nee: next-event estimation; vc: two subpaths are connected; lt: a light's path
# is connected to the lens; lens: a light's path hits the lens; vm: two subpaths are merged.
KINDS = ("hit", "nee", "vc", "lt", "lens", "vm")
LONGEST = 8  # longer paths share an image per kind, unless more is asked for


@dataclass(frozen=True)
class Technique:
    """How paths of `length` edges are found; `length` is None for all paths that are too long to be told apart.

    The light subpath has `s` vertices and the eye subpath `t`; they are merged at the path's vertex `m`, counted from
    the light, which is 0. What does not apply is None.
    """

    kind: str
    length: int | None
    s: int | None = None
    t: int | None = None
    m: int | None = None

    @property
    def name(self):
        """Name of the technique among those of its length, such as `vc_s2_t3`: a layer of the file."""
        if self.kind == "vc" and self.s is not None:
            return f"vc_s{self.s}_t{self.t}"
        return self.kind if self.m is None else f"vm_m{self.m}"

    @property
    def title(self):
        """Its name in words, such as `connect 2+3`: s light and t eye vertices."""
        if self.kind == "vc":
            return "connect" if self.s is None else f"connect {self.s}+{self.t}"
        if self.kind == "vm":
            return "merge" if self.m is None else f"merge at {self.m}"
        return {"hit": "hit", "nee": "next event", "lt": "light image", "lens": "lens hit"}[self.kind]


def techniques_of(kinds, max_path_length, longest=LONGEST):
    """All techniques of these kinds, by length, those for paths longer than `longest` last."""
    found = []
    for length in range(1, min(max_path_length, longest) + 1):
        found += [each for each in _of_length(length) if each.kind in kinds]
    if max_path_length > longest:
        found += [Technique(kind, None) for kind in KINDS if kind in kinds]
    return tuple(found)


def _of_length(k):
    """Theory 1.2: for k = 1 an emitter is seen directly, by being hit or by hitting the lens."""
    hit, lens = Technique("hit", k, 0, k + 1), Technique("lens", k, k + 1, 0)
    if k == 1:
        return [hit, lens]
    connections = [Technique("vc", k, s, k + 1 - s) for s in range(2, k)]
    merges = [Technique("vm", k, m=m) for m in range(1, k)]
    return [hit, Technique("nee", k, 1, k), *connections, Technique("lt", k, k, 1), lens, *merges]


@dataclass
class TechniqueFilm:
    """Sums over iterations, float64 (n, h, w, 3): what techniques bring with their MIS weights, and what alone."""

    techniques: tuple
    height: int
    width: int
    rejected_count: int = (
        0  # values that were finite only with their weights, and are missing in `unweighted`
    )

    def __post_init__(self):
        shape = (len(self.techniques), self.height, self.width, 3)
        self.weighted, self.unweighted = np.zeros(shape), np.zeros(shape)

    def images(self, iterations):
        """The means, as `TechniqueImages`; they take the place of the sums, since there may be many."""
        self.weighted /= max(iterations, 1)
        self.unweighted /= max(iterations, 1)
        return TechniqueImages(self.techniques, self.weighted, self.unweighted, self.rejected_count)


@dataclass(frozen=True)
class TechniqueImages:
    """Mean images of all techniques, linear sRGB, float64 (n, h, w, 3) in the order of `techniques`.

    The sum of `weighted` is the rendered image; each of `unweighted` is what the image of its path length looks like to
    this technique alone, without the paths that it cannot find. (Where longer paths share an image, it is the sum of
    several such estimates.)
    """

    techniques: tuple
    weighted: Any
    unweighted: Any
    rejected_count: int = 0

    @property
    def lengths(self):
        """Path lengths, and None at the end if there are longer paths without images of their own."""
        return list(dict.fromkeys(technique.length for technique in self.techniques))

    def rows(self, length):
        """Rows of the techniques of one length."""
        return [i for i, technique in enumerate(self.techniques) if technique.length == length]

    def sum(self, kinds=KINDS):
        """What techniques of these kinds bring together, weighted; (h, w, 3)."""
        total = np.zeros(self.weighted.shape[1:])
        for technique, image in zip(self.techniques, self.weighted, strict=True):
            if technique.kind in kinds:
                total += image
        return total

    def pictures(self):
        """`{name: (h, w, 3)}`: the parts of the image by kind of technique.

        `merging` and `connection` (to emitters, light subpaths and lens, and hits) add up to the whole image;
        `path_tracing` is the share of the latter that path tracing with next-event estimation has, too.
        `false_colour` shows the luminance of merging in red, and that of connection in blue.
        """
        merging, connection = self.sum(("vm",)), self.sum(("hit", "nee", "vc", "lt", "lens"))
        return {
            "merging": merging,
            "connection": connection,
            "path_tracing": self.sum(("hit", "nee")),
            "false_colour": false_colour(merging, connection),
        }


def false_colour(red, blue):
    """Luminance of one image in the red channel and of another in the blue one, (h, w, 3)."""
    red, blue = (image @ RGB_TO_XYZ[1] for image in (red, blue))
    return np.stack([red, np.zeros_like(red), blue], axis=-1)
