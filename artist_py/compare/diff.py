"""How two image files differ, by one of the metrics."""

from typing import Any, NamedTuple

import numpy as np

from artist_py.compare import metrics
from artist_py.compare.pair import linear_rgb
from artist_py.compare.z_test import normal_tail, symmetric_tail, z_test
from artist_py.errors import OptionError

MAPS = {
    "relmse": metrics.relative_squared_error,
    "smape": metrics.symmetric_error,
    "mse": metrics.squared_error,
}
METRICS = (*MAPS, "flip", "de2000", "z")
FALSE_ALARM = 1e-3
NORMAL_NOTE = (
    "the images are not of one integrator with equally many iterations, and their values are taken as normal: with few "
    "iterations, false alarms are more frequent than stated"
)


class Difference(NamedTuple):
    """What a metric says of two images."""

    metric: str
    value: float  # what a threshold is compared with: the largest of `parts`, or the p-value
    parts: dict  # name of a channel group or band -> value of the metric
    map: Any  # (h, w): error of each pixel, |z| for z; zero where a pixel is not finite
    worst: tuple  # x, y of the largest in the map, pixels of the array
    n_bad: int  # pixels that are not finite
    note: str = ""  # what the value rests on, for the user

    @property
    def worst_value(self):
        """The map's largest value."""
        return float(self.map[self.worst[1], self.worst[0]])

    def is_above(self, threshold):
        """Whether the images differ by more than allowed; for z, whether p is below the false alarm probability."""
        if self.n_bad:
            return True
        return self.value < threshold if self.metric == "z" else not self.value <= threshold


def difference(pair, metric):
    """The `Difference` of a `Pair`. OptionError if the images lack what the metric needs."""
    if metric in MAPS:
        return _difference_of_values(pair, metric)
    if pair.image.rgb is None or pair.reference.rgb is None:
        raise OptionError(f"metric {metric} compares colours: both images need channels R, G and B")
    return {"flip": _flip, "de2000": _de2000, "z": _z}[metric](pair)


def _difference_of_values(pair, metric):
    error, ok, parts, maps = MAPS[metric], ~pair.bad, {}, []
    a, b = pair.image, pair.reference
    if a.rgb is not None and b.rgb is not None:
        maps.append(error(linear_rgb(a), linear_rgb(b)))
        parts["RGB"] = _mean(maps[-1], ok)
        parts |= {name: _mean(maps[-1][..., i], ok) for i, name in enumerate("RGB")}
    for wavelength in pair.wavelengths:
        maps.append(error(a.bands[wavelength], b.bands[wavelength])[..., None])
        parts[f"{wavelength:g} nm"] = _mean(maps[-1], ok)
    value = max(value for name, value in parts.items() if name not in {"R", "G", "B"})
    return _result(pair, metric, value, parts, np.concatenate(maps, axis=2).mean(axis=2))


def _flip(pair):
    from artist_py.compare.flip import flip_map

    errors = flip_map(pair.image.rgb, pair.reference.rgb, is_display=pair.image.is_display)
    return _of_map(pair, "flip", errors)


def _de2000(pair):
    from artist_py.compare.color_difference import color_difference

    ok = ~pair.bad[..., None]
    images = [np.where(ok, linear_rgb(each), 0.0) for each in (pair.image, pair.reference)]
    return _of_map(pair, "de2000", color_difference(*images))


def _z(pair):
    """Pixels that are not finite are left out; the rest decides."""
    for each in (pair.image, pair.reference):
        if each.variance is None:
            raise OptionError(
                f"{each.path}: has no variance.R, .G and .B: metric z needs images made with --aov variance"
            )
    a, b = pair.image, pair.reference
    arrays = [np.asarray(each, np.float64) for each in (a.rgb, a.variance, b.rgb, b.variance)]
    bad = pair.bad | ~(np.isfinite(arrays[1]).all(axis=2) & np.isfinite(arrays[3]).all(axis=2))
    for array in arrays:
        array[bad] = 0.0
    tail = _tail(a, b)
    test = z_test(*arrays, tail=tail)
    parts = {
        "p": test.p,
        **{f"largest |z| of {name}": np.abs(test.z[..., i]).max() for i, name in enumerate("RGB")},
    }
    result = _result(pair._replace(bad=bad), "z", test.p, parts, np.abs(test.z).max(axis=2))
    return result._replace(note=NORMAL_NOTE if tail is normal_tail else "")


def _tail(a, b):
    """What is known to hold for the two: equal effort of one integrator needs no normal values."""
    integrator, iterations = a.samples
    is_equal = a.samples == b.samples and integrator is not None and (iterations or 0) > 1
    return symmetric_tail(iterations) if is_equal else normal_tail


def _of_map(pair, metric, errors):
    value = _mean(errors, ~pair.bad)
    return _result(pair, metric, value, {"RGB": value}, errors)


def _result(pair, metric, value, parts, errors):
    errors = np.where(pair.bad, 0.0, errors)
    y, x = np.unravel_index(np.argmax(errors), errors.shape)
    parts = {name: float(part) for name, part in parts.items()}
    return Difference(metric, float(value), parts, errors, (int(x), int(y)), int(np.count_nonzero(pair.bad)))


def _mean(errors, ok):
    """Mean over the good pixels; 0 if there are none, which `n_bad` tells."""
    return float(errors[ok].mean()) if ok.any() else 0.0
