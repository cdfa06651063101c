"""Rendering the pictures of each kind; what is returned goes into their captions."""

from contextlib import suppress

import numpy as np

import artist_py
from artist_py.compare.metrics import relmse, smape
from artist_py.evidence.entries import with_seed
from artist_py.film.color import RGB_TO_XYZ, decode_srgb, encode_srgb
from artist_py.film.contact_sheet import contact_sheet
from artist_py.film.output import write_display
from artist_py.film.replacing import replacing
from artist_py.film.tonemap import ToneMapping
from artist_py.samplers.render_job import RenderSettings
from artist_py.samplers.snapshots import snapshots
from artist_py.scene.reader import read_scene

COLOURS = 128  # of pyramids
REFERENCE_SEED = 0x5EED  # a reference by the method that it judges must not share its noise


def paint(picture, folder, threads):
    """Write the PNG files of a picture; `{"files": {name: [width, height]}, ...}` with what captions say."""
    return PAINTERS[picture.kind](picture, Canvas(folder, picture), threads)


class Canvas:
    """Where the files of a picture go, and how bright they are."""

    def __init__(self, folder, picture):
        self.folder, self.names, self.sizes = folder, picture.files, {}
        settings = picture.settings
        self.mapping = ToneMapping(settings.get("exposure", 0.0), settings.get("operator", "srgb"))

    def write(self, role, rgb, mapping=None):
        """Write linear RGB (h, w, 3) as the file of that role."""
        write_display(self.folder / self.names[role], rgb, mapping or self.mapping)
        self.sizes[self.names[role]] = [rgb.shape[1], rgb.shape[0]]


def compiled_scene(picture, integrator=None, size=None):
    """The scene at the size of the picture, or at `size`, with the picture's own settings of keys, `set`."""
    settings = picture.settings
    overrides = {"film.resolution": size or picture_size(picture), **settings.get("set", {})}
    integrator = integrator or settings.get("integrator")
    if integrator:
        overrides["render.integrator"] = integrator
    return artist_py.load_scene(picture.scene, overrides)


def picture_size(picture, share=1.0):
    """Width and height, pixels, of which the longer one is the picture's longest side divided by `share`."""
    width, height = read_scene(picture.scene, ()).film.resolution
    scale = picture.settings["longest_side"] / (share * max(width, height))
    return [max(1, round(scale * width)), max(1, round(scale * height))]


def rendered(compiled, cpu_seconds, threads):
    """A `Snapshot` after so many CPU seconds of all threads, at the end of an iteration."""
    return list(snapshots(compiled, RenderSettings(threads=threads), [cpu_seconds], "cpu"))[-1]


def facts(snapshot):
    """What a render took, and its estimate of its own error, a relMSE."""
    known = {
        "cpu_seconds": round(snapshot.cpu_seconds, 1),
        "iterations": snapshot.iterations,
        "own_relmse": snapshot.noise,
    }
    with suppress(TypeError):
        known["own_relmse"] = float(f"{snapshot.noise:.3g}")
    return known


def paint_scene(picture, canvas, threads):
    """A scene as its file says."""
    compiled = compiled_scene(picture)
    snapshot = rendered(compiled, picture.settings["cpu_seconds"], threads)
    canvas.write("", snapshot.film.rgb)
    return {"files": canvas.sizes, "integrator": compiled.graph.render.integrator, **facts(snapshot)}


def paint_zoom(picture, canvas, threads):
    """A window of a scene, rendered with as many pixels as whole pictures have."""
    x0, x1, y0, y1 = picture.settings["window"]
    width, height = picture_size(picture, max(x1 - x0, y1 - y0))
    edges = [round(x0 * width), round(x1 * width), round(y0 * height), round(y1 * height)]
    overridden = picture._replace(
        settings={**picture.settings, "set": {**picture.settings.get("set", {}), "film.crop": edges}}
    )
    compiled = compiled_scene(overridden, size=[width, height])
    snapshot = rendered(compiled, picture.settings["cpu_seconds"], threads)
    canvas.write("", snapshot.film.rgb)
    return {"files": canvas.sizes, "integrator": compiled.graph.render.integrator, **facts(snapshot)}


def paint_equal_time(picture, canvas, threads):
    """The same picture by several methods, each with the same time, and a reference that took longer."""
    settings, rows = picture.settings, {}
    compiled = with_seed(compiled_scene(picture, settings["reference"]), REFERENCE_SEED)
    reference = rendered(compiled, settings["reference_seconds"], threads)
    canvas.write("-reference", reference.film.rgb)
    for integrator in settings["integrators"]:
        snapshot = rendered(compiled_scene(picture, integrator), settings["cpu_seconds"], threads)
        canvas.write(f"-{integrator}", snapshot.film.rgb)
        errors = {each.__name__: each(snapshot.film.rgb, reference.film.rgb) for each in (relmse, smape)}
        rows[integrator] = {
            **facts(snapshot),
            **{name: float(f"{error:.3g}") for name, error in errors.items()},
        }
    about = {"integrator": settings["reference"], **facts(reference)}
    return {"files": canvas.sizes, "rows": rows, "reference": about}


def paint_techniques(picture, canvas, threads):
    """Merging in red and connection in blue; and every technique with its weight."""
    settings = picture.settings
    result = artist_py.render(
        compiled_scene(picture),
        iterations=settings["iterations"],
        threads=threads,
        techniques=True,
        technique_length=settings["longest_path"],
    )
    images = result.techniques
    parts = images.pictures()
    canvas.write("-map", parts["false_colour"])
    sheet = contact_sheet(images, True, canvas.mapping)
    canvas.write("-pyramid", with_levels(sheet, settings["levels"]), ToneMapping())
    reduce_colours(canvas.folder / canvas.names["-pyramid"], COLOURS)
    merged, connected = (float(np.mean(parts[name] @ RGB_TO_XYZ[1])) for name in ("merging", "connection"))
    return {
        "files": canvas.sizes,
        "integrator": settings["integrator"],
        "iterations": settings["iterations"],
        "cpu_seconds": round(result.statistics["cpu_seconds"], 1),
        "own_relmse": float(f"{result.statistics['error_estimate']:.3g}"),
        "merged_share": round(merged / (merged + connected), 4),
    }


def with_levels(rgb, levels):
    """Linear RGB in [0, 1] of which each channel has so many levels, evenly spaced where sRGB encodes them."""
    return decode_srgb(np.round(encode_srgb(rgb) * (levels - 1)) / (levels - 1))


def reduce_colours(path, count):
    """Write a PNG anew with a palette of so many colours, without dithering: half of its bytes."""
    from PIL import Image

    with replacing(path) as temporary, Image.open(path) as image:
        reduced = image.quantize(count, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        reduced.save(temporary, format="PNG", optimize=True)


PAINTERS = {
    "scene": paint_scene,
    "zoom": paint_zoom,
    "equal_time": paint_equal_time,
    "techniques": paint_techniques,
}
