"""Whole scenes, of the folder `scenes` that comes with the sources: those in which something fluoresces."""

from pathlib import Path

from artist_py.stress.case import ALL, Case, SameAs
from artist_py.stress.own import BLURRED, MERGES_ALONE, MERGING_BLURS

FEW_PHOTONS = "Of a lamp in the open most photons never come to where the eye looks."
SCENES = Path(__file__).parents[3] / "scenes"


def gallery_case(name, shows, scenes=SCENES, noisier=()):
    """A case of a scene of that name, which is left out where the folder is not there."""
    path = scenes / f"{name}.toml"
    absent = f"{path} is not there: scenes come with the sources, not with the installed package"
    return Case(
        name,
        shows,
        path,
        SameAs("pt", bias=MERGES_ALONE),
        left_out={} if path.exists() else dict.fromkeys(ALL, absent),
        precision=0.02,
        noisier=dict(noisier),
        rounding=BLURRED,
        why=f"{MERGING_BLURS} {FEW_PHOTONS}" if noisier else MERGING_BLURS,
        most=2048,
        least=256,  # all pixels share sets of wavelengths, and 16 of these seldom have the worst among them
    )


CASES = (
    gallery_case("fluorescent_spheres", "Grooved balls of two dyes: light goes to and fro within a groove."),
    gallery_case("fluorescent_room", "A room whose walls and things all fluoresce: up to eleven events."),
    gallery_case(
        "black_light",
        "Ultraviolet through glass on dyes: caustics that only dyes make visible.",
        noisier=dict.fromkeys(MERGES_ALONE, 0.05),
    ),
    gallery_case("cascade", "Light of one narrow band, which most of what is seen has left twice."),
    gallery_case("highlighters", "Brighter than white paper: dyes in daylight that has ultraviolet."),
)
