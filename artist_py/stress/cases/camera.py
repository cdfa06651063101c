"""Cameras and images at the ends of what they can be."""

from artist_py.stress.case import Case, Radiance
from artist_py.stress.scenes import furnace, look

FLAT = "at 89.99 degrees no photon falls into pixels so narrow"
NARROW = "no photon ever falls into the eye's narrow view"


def seen(field_of_view=60.0, render=(), **film):
    """A furnace, through a camera of that field of view, on that film."""
    camera = look([0.3, -0.3, 0.1], [-0.1, 0.6, 0.2], field_of_view)
    return furnace(camera=camera, film=film, render=render)


def one_pixel(name, shows, **film):
    """A case of an image of one pixel, with many light paths for it."""
    many = {"merging": {"radius": 0.1, "light_paths": 64}}
    is_part = "crop" in film
    return Case(
        name,
        shows,
        seen(render=many, **film),
        Radiance(1),
        left_out={"lt": NARROW} if is_part else {},
        precision=0.05,
        least=512,
    )


CASES = (
    Case(
        "field-of-view-0.01",
        "The narrowest view.",
        seen(0.01),
        Radiance(1),
        precision=0.03,
        left_out={"lt": NARROW},
    ),
    Case("field-of-view-179", "The widest.", seen(179.0), Radiance(1)),
    Case(
        "field-of-view-179.99",
        "Beyond reason.",
        seen(179.99),
        Radiance(1),
        left_out={"lt": FLAT},
    ),
    Case(
        "lens-wide",
        "A lens nearly as wide as the room, focused on its own front.",
        furnace(
            camera=look([0, 0, 0], [0, 1, 0.1], type="thin-lens", aperture_radius=0.9, focus_distance=1e-3)
        ),
        Radiance(1),
        quick=False,
    ),
    one_pixel("pixels-1x1", "One pixel.", resolution=[1, 1]),
    Case(
        "pixels-1x10000",
        "A column of ten thousand pixels, whose ends are seen at 89.99 degrees.",
        seen(resolution=[1, 10_000]),
        Radiance(1),
        left_out={"lt": FLAT},
    ),
    Case(
        "pixels-10000x1",
        "A row of them.",
        seen(resolution=[10_000, 1]),
        Radiance(1),
        left_out={"lt": FLAT},
    ),
    one_pixel("crop-1x1", "One pixel of many.", resolution=[64, 64], crop=[17, 18, 40, 41]),
    one_pixel(
        "crop-corner",
        "The last pixel, with a filter that reaches over the edge.",
        resolution=[64, 64],
        crop=[63, 64, 63, 64],
        filter="blackman-harris",
    ),
    one_pixel(
        "crop-of-65536",
        "One pixel of the largest image there is.",
        resolution=[65536, 65536],
        crop=[30000, 30001, 30000, 30001],
    ),
    Case(
        "filter-radius-32",
        "A filter larger than the image.",
        seen(filter="gaussian", filter_radius=32),
        Radiance(1),
    ),
)
