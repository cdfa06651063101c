"""Values of command-line options: what a user may write, and what it means."""

import math
import re

import click

from artist_py.film.channels import AOV_CHANNELS
from artist_py.scene.messages import nearest, show

SECONDS = {"h": 3600, "m": 60, "s": 1}
BYTES = {
    "": 1,
    "k": 10**3,
    "M": 10**6,
    "G": 10**9,
    "T": 10**12,
    "Ki": 2**10,
    "Mi": 2**20,
    "Gi": 2**30,
    "Ti": 2**40,
}


class Duration(click.ParamType):
    """A time such as 30s, 2m or 1h30m; seconds. A plain number is seconds."""

    name = "duration"
    _pattern = re.compile(r"(?:(?P<h>[\d.]+)h)?(?:(?P<m>[\d.]+)m(?:in)?)?(?:(?P<s>[\d.]+)s?)?")

    def convert(self, value, param, ctx):
        """Seconds, > 0."""
        if isinstance(value, float):
            return value
        match = self._pattern.fullmatch(value.strip())
        try:
            seconds = sum(SECONDS[unit] * float(number) for unit, number in match.groupdict("0").items())
        except (AttributeError, ValueError):
            self.fail(f"{value!r} is not a duration, such as 30s, 2m or 1h30m", param, ctx)
        if seconds <= 0:
            self.fail(f"{value!r} is not longer than nothing", param, ctx)
        return seconds


class ByteSize(click.ParamType):
    """An amount of memory such as 4GiB or 500MB; bytes."""

    name = "size"
    _pattern = re.compile(r"(?P<number>\d+(?:\.\d*)?)\s*(?P<unit>[KMGT]i|[kMGT]|)B?")

    def convert(self, value, param, ctx):
        """Bytes, > 0."""
        if isinstance(value, int):
            return value
        match = self._pattern.fullmatch(value.strip())
        n_bytes = int(float(match["number"]) * BYTES[match["unit"]]) if match else 0
        if n_bytes <= 0:
            self.fail(f"{value!r} is not an amount of memory, such as 4GiB or 500MB", param, ctx)
        return n_bytes


class Integers(click.ParamType):
    """So many integers with a separator between them, such as 640x480."""

    def __init__(self, metavar, separator, example):
        self.name = metavar
        self._separator = separator
        self._count = metavar.count(separator) + 1
        self._example = example

    def get_metavar(self, param, ctx):
        """Text that stands for the value in `--help`."""
        return self.name

    def convert(self, value, param, ctx):
        """List of integers."""
        parts = value if isinstance(value, list) else value.split(self._separator)
        try:
            numbers = [int(part) for part in parts]
        except ValueError:
            numbers = []
        if len(numbers) != self._count:
            self.fail(f"{value!r} is not {self.name}, such as {self._example}", param, ctx)
        return numbers


class AovNames(click.ParamType):
    """Names of auxiliary outputs with commas between them."""

    name = "names"

    def convert(self, value, param, ctx):
        """Tuple of names, each known."""
        names = value if isinstance(value, tuple) else tuple(part.strip() for part in value.split(","))
        for name in names:
            if name not in AOV_CHANNELS:
                self.fail(f"there is no output {show(name)}{nearest(name, AOV_CHANNELS)}", param, ctx)
        return names


class Setting(click.ParamType):
    """An override `key=value`: dotted TOML key, TOML value; the reader of scenes judges both."""

    name = "key=value"

    def convert(self, value, param, ctx):
        """`(key, value)`, texts."""
        if isinstance(value, tuple):
            return value
        key, equals, text = value.partition("=")
        if not equals:
            self.fail(f"{value!r} is not key=value, such as render.max_path_length=8", param, ctx)
        return key.strip(), text.strip()


class Number(click.FloatRange):
    """A finite number within a range."""

    def convert(self, value, param, ctx):
        """Float."""
        return _finite(self, super().convert(value, param, ctx), param, ctx)


class Exposure(click.ParamType):
    """Exposure in stops, or `auto`."""

    name = "stops|auto"

    def get_metavar(self, param, ctx):
        """Text that stands for the value in `--help`."""
        return self.name

    def convert(self, value, param, ctx):
        """Float, or the text `auto`."""
        return value if value == "auto" else _finite(self, click.FLOAT.convert(value, param, ctx), param, ctx)


def _finite(kind, number, param, ctx):
    if not math.isfinite(number):
        kind.fail(f"{number} is not finite", param, ctx)
    return number


class WhitePoint(click.ParamType):
    """A CIE illuminant's name, or a chromaticity x,y."""

    name = "name|x,y"

    def get_metavar(self, param, ctx):
        """Text that stands for the value in `--help`."""
        return self.name

    def convert(self, value, param, ctx):
        """Chromaticity (x, y)."""
        from artist_py.film.tonemap import white_point

        if isinstance(value, tuple):
            return value
        if "," not in value:
            return white_point(value)
        try:
            x, y = (float(part) for part in value.split(","))
        except ValueError:
            x = y = 0.0
        if not (x > 0 and y > 0 and x + y < 1):
            self.fail(f"{value!r} is not a chromaticity x,y, such as 0.3127,0.3290", param, ctx)
        return x, y


def display_options(command):
    """Add the options of an image that is tone-mapped."""
    for option in (
        click.option("--bits", type=click.Choice([8, 16]), default=8, help="Bits per channel of a .png."),
        click.option(
            "--exposure", type=Exposure(), default=0.0, help="Exposure of a .png: factors of two, or auto."
        ),
    ):
        command = option(command)
    return command
