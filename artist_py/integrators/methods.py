"""The bidirectional methods as subsets of one set of techniques (theory 1.9), and how often each is sampled."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from ..transport.mis import Counts
from ..transport.shares import Chosen, Share
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


class Samples(NamedTuple):
    """Samples of each technique, as [render.samples] has them; `None`: as many as there are, and one shadow ray."""

    next_event: int | None = None  # shadow rays per eye vertex
    connections: float | None = None  # light subpaths that an eye subpath is connected to, on average
    light_image: float | None = None  # share of the light subpaths that the camera sees
    merging: float | None = None  # share of the light subpaths in the photon map


ALL = Samples()


def subset_of(integrator, samples):
    """The method's `Subset` without the techniques of which no samples are taken."""
    subset = METHODS[integrator]
    return replace(
        subset,
        nee=subset.nee and samples.next_event != 0,
        connect=subset.connect and samples.connections != 0,
        light_image=subset.light_image and samples.light_image != 0,
        merge=subset.merge and samples.merging != 0,
    )


def has_lens_hits(subset, camera):
    """Whether light that hits the lens is a technique.

    Not so for cameras that are far away: nothing would hit those, and nearly nothing needs to.
    """
    return subset.light_image and camera.lens is not None and camera.clip is None


def shares_of(subset, light_paths, samples):
    """Shares of the light subpaths, so many per pixel, that are connected, splatted and merged with."""
    connected = 1.0 if samples.connections is None else min(samples.connections / light_paths, 1.0)
    splatted, merged = (1.0 if share is None else share for share in (samples.light_image, samples.merging))
    return connected * subset.connect, splatted * subset.light_image, merged * subset.merge


def share_of(share, offset):
    """The `Share`, or None for all."""
    return Share(share, float(offset)) if share < 1.0 else None


def method_of(
    name, n_pixels, light_paths, offset, merge_area, power=False, lens=False, samples=ALL, offsets=(0, 0, 0)
):
    """The `Method` of a name, for so many pixels, light subpaths per pixel and a merge area in render-space units^2.

    `power` chooses the power heuristic (beta = 2), `lens` light that hits the lens. `offset` in [0, 1) says which
    pixels get one more light subpath than others, where `light_paths` is not whole; `offsets` which light subpaths
    are connected, splatted and merged with, where that is a share of them.
    """
    n_light_paths = n_pixels * light_paths
    subset = subset_of(name, samples)
    present = {field: getattr(subset, field) or None for field in Techniques._fields}
    shares = shares_of(subset, light_paths, samples)
    connected, splatted, merged = shares
    shadow_rays = 1 if samples.next_event is None else samples.next_event
    counts = Counts(
        # What a method without hits finds by them nevertheless, lens hits find as well.
        float(subset.hit or lens),
        float(shadow_rays if subset.nee else 0),
        connected * light_paths,
        splatted * light_paths,
        merged * n_light_paths * merge_area,
        True if power else None,
        splatted * light_paths if lens else None,
    )
    return Method(
        Techniques(**present),
        counts,
        float(n_pixels),
        n_light_paths,
        light_paths,
        offset,
        subset.hit,
        shadow_rays if shadow_rays > 1 else None,
        Chosen(*map(share_of, shares, offsets)),
        splatted * n_light_paths,
        merged * n_light_paths,
    )
