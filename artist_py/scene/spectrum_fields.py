"""What may be written where a spectrum or a refractive index is expected."""

from dataclasses import dataclass

from artist_py.scene.fields import Forms, Number, Text, failure
from artist_py.scene.messages import expected, nearest, show
from artist_py.scene.spectrum_types import (
    Blackbody,
    Cauchy,
    Constant,
    File,
    Gaussian,
    Lines,
    Named,
    Rgb,
    Sampled,
    Sellmeier,
)

_SPECTRUM = "a spectrum: a number, a name or a table"
_INDEX = "a refractive index: a number, a name or a table"
NOT_NEGATIVE = Number(at_least=0)

_sampled = {"wavelengths": Sampled, "file": File}
_light = {"illuminant": Named, "blackbody": Blackbody, "gaussian": Gaussian, "lines": Lines}
SPECTRUM_FORMS = Forms({"rgb": Rgb, **_light, **_sampled}, _SPECTRUM)
_index_table = Forms({"cauchy": Cauchy, "sellmeier": Sellmeier, **_sampled}, _INDEX)


@dataclass(frozen=True)
class SpectrumField:
    """A number, the name of one of the [spectra] or of an illuminant, or a table; all values within `bounds`.

    What is known only after tabulation, such as the values in a file, is checked in `compile.py`.
    """

    bounds: Number = NOT_NEGATIVE
    forms: Forms = SPECTRUM_FORMS
    expected = _SPECTRUM

    def __call__(self, value, at):
        if isinstance(value, dict):
            spectrum = self.forms(value, at)
            if isinstance(spectrum, Named):
                _check_name(spectrum.name, at.at("illuminant"))
        elif isinstance(value, str):
            spectrum = _named(value, at)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            spectrum = Constant(self.bounds(value, at), where=at)
        else:
            raise failure(at, expected(self.expected, value))
        for number in _values(spectrum):
            if not self.bounds.allows(number * spectrum.scale):
                raise failure(at, expected(self.bounds.range(at), number * spectrum.scale))
        return spectrum


def _values(spectrum):
    """The values, before scaling, that the description tells by itself."""
    if isinstance(spectrum, Constant):
        return [spectrum.value]
    if isinstance(spectrum, Rgb):
        return spectrum.rgb
    if isinstance(spectrum, Gaussian):
        return [spectrum.peak]
    return spectrum.values if isinstance(spectrum, Sampled) else []


def _named(name, at):
    """The spectrum of the scene with this name, or an illuminant."""
    known = at.source.names.get("spectra", {})
    if name in known:
        return _resolved(known, name, at)
    _check_name(name, at, known)
    return Named(name, where=at)


def _resolved(known, name, at):
    """The spectrum that [spectra] has under a name; `known` maps it to that, at first to (value, place)."""
    entry = known[name]
    if entry is None:
        raise failure(at, f"{show(name)} is defined by itself")
    if isinstance(entry, tuple):
        known[name] = None
        try:
            entry = SpectrumField()(*entry)
        finally:
            known[name] = entry
    return entry


def given_names():
    """The spectra that a scene may name without defining them: the package's illuminants and reflectances."""
    from artist_py import data

    return data.names("illuminant") + data.names("reflectance")


def _check_name(name, at, others=()):
    if name not in given_names() and not at.source.names.get("incomplete"):
        raise failure(at, f"unknown spectrum {show(name)}{nearest(name, [*others, *given_names()])}")


@dataclass(frozen=True)
class IndexField:
    """A refractive index: a number, the name of a glass, or a table."""

    expected = _INDEX

    def __call__(self, value, at):
        if isinstance(value, str):
            return Named(_optics_name("glass", value, at), where=at)
        if isinstance(value, int | float) and not isinstance(value, bool):
            return Constant(Number(above=0)(value, at), where=at)
        return _index_table(value, at)


@dataclass(frozen=True)
class MetalField:
    """The name of a metal."""

    expected = "the name of a metal"

    def __call__(self, value, at):
        return _optics_name("metal", Text()(value, at), at)


def _optics_name(kind, name, at):
    """The name, if the package knows such a glass or metal."""
    from artist_py.scene import optics

    known = optics.glasses() if kind == "glass" else optics.metals()
    if name not in known:
        raise failure(at, f"unknown {kind} {show(name)}{nearest(name, known)}")
    return name
