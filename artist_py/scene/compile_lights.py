"""The [[emitters]] to emitter records: points, spots, directional light, suns and environments."""

import math

import numpy as np

from artist_py.errors import SceneError
from artist_py.scene import tables
from artist_py.scene.emitter_types import DirectionalEmitter, EnvironmentEmitter, SpotEmitter
from artist_py.scene.images import ImageRows, cell_means, load_environment, solid_angles
from artist_py.scene.scales import POWER_RANGE, ratio
from artist_py.scene.spectra import integrate, luminance, rgb_basis, tabulate
from artist_py.scene.transforms import matrix
from artist_py.scene.where import problem

ROTATION_TOLERANCE = 1e-6
DISK_MARGIN = 1.0 + 1e-5  # what is rounded to float32 must not stick out of the disk around the scene

UNHITTABLE = {
    tables.POINT_EMITTER: "point",
    tables.SPOT_EMITTER: "spot",
    tables.DIRECTIONAL_EMITTER: "directional",
}
# What methods without hits of such emitters cannot do where there are mirrors, smooth metal or glass.
BLIND_TO = {
    "pt": (
        "by way of smooth glass, metal or mirrors (caustics)",
        '"bpt" finds those seen directly, "vcm", "ppm" and "bpm" all',
    ),
    "lt": ("on what is seen through smooth glass, metal or mirrors", '"vcm", "ppm" and "bpm" do'),
    "bpt": (
        "by way of smooth glass, metal or mirrors (caustics) on what is itself seen through such",
        '"vcm", "ppm" and "bpm" do',
    ),
}


class LightCompiler:
    """Fills one row per emitter without a surface; `powers` in render units, `light` the same per nm."""

    def __init__(self, emitters, space, spectra, warn):
        self.space, self.spectra, self.warn = space, spectra, warn
        self.radius = space.radius * space.scale * DISK_MARGIN
        self.images, self.problems = ImageRows(), []
        self.light = np.zeros(spectra.last - spectra.first)
        # What rays can hit comes last, so that it is found there.
        ordered = sorted(emitters, key=lambda emitter: _kind(emitter) >= tables.SUN_EMITTER)
        self.rows, self.powers = np.zeros(len(ordered), tables.emitter_dtype), np.zeros(len(ordered))
        for i, emitter in enumerate(ordered):
            self.rows[i]["kind"] = _kind(emitter)
            try:
                self.powers[i] = self._fill(self.rows[i], emitter)
            except SceneError as error:
                self.problems.extend(error.problems)

    @property
    def n_background(self):
        """How many of the last rows are suns and environments."""
        return int((self.rows["kind"] >= tables.SUN_EMITTER).sum())

    def _fill(self, row, emitter):
        """Fill a row; returns the emitter's power."""
        row["two_sided"], row["image"], row["area"] = 1, -1, 1.0
        row["visible"] = getattr(emitter, "visible", True)
        if isinstance(emitter, EnvironmentEmitter):
            self._fill_disk(row)
            return self._fill_environment(row, emitter)
        if isinstance(emitter, DirectionalEmitter):
            self._fill_disk(row)
            return self._fill_directional(row, emitter)
        return self._fill_point(row, emitter)

    def _fill_disk(self, row):
        row["radius"], row["area"] = self.radius, math.pi * self.radius**2

    def _add(self, row, emitter, scale, extent):
        """Store spectrum and scale; returns the power, which is the integral over wavelength times `extent`."""
        table = tabulate(emitter.spectrum, self.spectra.first, self.spectra.last, "emission")
        row["spectrum"], row["scale"] = self.spectra.light_row(table), scale
        self.light += scale * extent * table
        return scale * extent * integrate(table)

    def _fill_point(self, row, emitter):
        row["origin"] = self.space.scale * (np.array(emitter.position) - self.space.centre)
        row["cone"], solid_angle = 2.0, 4.0 * math.pi
        if isinstance(emitter, SpotEmitter):
            axis = np.array(emitter.axis())
            row["normal"] = axis / np.linalg.norm(axis)
            row["cone"] = one_minus_cos(emitter.angle)
            row["inner_cone"] = one_minus_cos(emitter.angle if emitter.falloff is None else emitter.falloff)
            # The mean of the smooth step is 1/2.
            solid_angle = math.pi * (row["cone"] + row["inner_cone"])
        scale = 1.0 if emitter.intensity is None else emitter.intensity
        if emitter.power is not None:
            full = tabulate(emitter.spectrum, *POWER_RANGE, "emission")
            scale = ratio(emitter, "power", emitter.power, solid_angle * integrate(full))
        # Intensity over distance squared is the same in all units only if lengths scale in both.
        return self._add(row, emitter, scale * self.space.scale**2, solid_angle)

    def _fill_directional(self, row, emitter):
        towards = -np.array(emitter.direction)
        row["normal"] = towards / np.linalg.norm(towards)
        scale = 1.0 if emitter.irradiance is None else emitter.irradiance
        if emitter.illuminance is not None:
            full = tabulate(emitter.spectrum, *POWER_RANGE, "emission")
            scale = ratio(emitter, "illuminance", emitter.illuminance, luminance(full, POWER_RANGE[0]))
        row["cone"] = one_minus_cos(0.5 * emitter.angle)
        # Irradiance across the light is the integral of the cosine over the disk.
        projected = math.pi * math.sin(math.radians(0.5 * emitter.angle)) ** 2 if emitter.angle > 0.0 else 1.0
        return self._add(row, emitter, scale / projected, projected * row["area"])

    def _fill_environment(self, row, emitter):
        row["edge0"], row["edge1"], row["normal"] = _axes(emitter).T
        if emitter.image is not None:
            return self._fill_image(row, emitter)
        scale = 1.0 if emitter.radiance is None else emitter.radiance
        if emitter.luminance is not None:
            full = tabulate(emitter.spectrum, *POWER_RANGE, "emission")
            scale = ratio(emitter, "luminance", emitter.luminance, luminance(full, POWER_RANGE[0]))
        return self._add(row, emitter, scale * emitter.scale, 4.0 * math.pi * row["area"])

    def _fill_image(self, row, emitter):
        texels = load_environment(emitter, self.warn)
        basis = rgb_basis(self.spectra.first, self.spectra.last, "emission")
        row["spectrum"], row["green"], row["blue"] = (self.spectra.light_row(each) for each in basis)
        row["scale"] = emitter.scale
        weights = texels @ basis.sum(axis=1)
        row["image"] = self.images.add(texels, weights)
        angles = solid_angles(*weights.shape)[:, None]
        extent = emitter.scale * row["area"]
        sums = [float((cell_means(texels[..., i].astype(float)) * angles).sum()) for i in range(3)]
        self.light += extent * (np.array(sums) @ basis)
        return extent * float((cell_means(weights) * angles).sum())


def _kind(emitter):
    if isinstance(emitter, EnvironmentEmitter):
        return tables.ENVIRONMENT_EMITTER
    if isinstance(emitter, DirectionalEmitter):
        return tables.SUN_EMITTER if emitter.angle > 0.0 else tables.DIRECTIONAL_EMITTER
    return tables.SPOT_EMITTER if isinstance(emitter, SpotEmitter) else tables.POINT_EMITTER


def one_minus_cos(degrees):
    """1 - cos, exact for small angles."""
    return 2.0 * math.sin(0.5 * math.radians(degrees)) ** 2


def _axes(emitter):
    """Axes of the image as columns (3, 3), in the world."""
    axes = np.array(matrix(emitter.transform), float)[:3, :3] if emitter.transform else np.eye(3)
    if not np.allclose(axes.T @ axes, np.eye(3), rtol=0, atol=ROTATION_TOLERANCE):
        message = "expected rotations only, since an environment has neither a place nor a size"
        raise SceneError([problem(emitter, "transform", message)])
    return axes


def method_warnings(integrator, scene):
    """What of a scene's light an integrator cannot find, in words; a list."""
    if integrator not in BLIND_TO or scene.emitters is None:
        return []
    kinds = set(scene.emitters.records.array["kind"][scene.emitters.records.array["pdf_select"] > 0].tolist())
    points = [name for kind, name in UNHITTABLE.items() if kind in kinds]
    needs = scene.needs
    if not points or not (needs.mirror or needs.conductor or needs.dielectric or needs.thin_dielectric):
        return []
    lost, others = BLIND_TO[integrator]
    return [f'"{integrator}" cannot find light of {" and ".join(points)} emitters {lost}; {others}']
