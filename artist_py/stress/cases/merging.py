"""Settings of merging at their ends."""

from artist_py.stress.case import Case, Radiance, Sane
from artist_py.stress.scenes import furnace


def merged(**settings):
    """A furnace with these settings of merging."""
    return furnace(render={"merging": {"radius": 0.05, "light_paths": 4, **settings}})


CASES = (
    Case(
        "radius-1e-8",
        "No photon is ever near: merging brings nothing, and the rest goes on.",
        merged(radius=1e-8),
        Radiance(1),
        integrators=("vcm",),
    ),
    Case(
        "radius-1e-8-merging-alone",
        "The same where there is nothing but merging.",
        merged(radius=1e-8),
        Sane(),
        integrators=("ppm", "bpm"),
        why="In 1e13 paths one merges: the image is that of the light that is seen directly.",
    ),
    Case(
        "radius-1",
        "Every photon is near, in the first iterations.",
        merged(radius=1.0),
        Sane(),
        integrators=("ppm", "bpm", "vcm"),
        why="A radius as large as the scene is bias and nothing else; that it shrinks helps, slowly.",
    ),
    Case(
        "alpha-0.01",
        "The radius shrinks as fast as may be: 1/sqrt(n).",
        merged(alpha=0.01, radius=0.2),
        Radiance(1),
        integrators=("ppm", "bpm", "vcm"),
    ),
    Case(
        "alpha-1",
        "The radius stays.",
        merged(alpha=1.0),
        Radiance(1),
        integrators=("ppm", "bpm", "vcm"),
    ),
    Case(
        "light-paths-0.01",
        "Two light paths for an image.",
        merged(light_paths=0.01, radius=0.2),
        Radiance(1),
        integrators=("lt", "bpt", "vcm", "bpm", "ppm"),
        precision=0.02,
    ),
    Case(
        "light-paths-64",
        "Sixteen thousand light paths for 256 pixels.",
        merged(light_paths=64.0),
        Radiance(1),
        integrators=("lt", "bpt", "ppm", "bpm", "vcm"),
    ),
    Case(
        "epanechnikov",
        "The other kernel.",
        merged(kernel="epanechnikov", radius=0.1),
        Radiance(1),
        integrators=("ppm", "bpm", "vcm"),
        quick=False,
    ),
)
