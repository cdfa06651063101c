"""What options may look like, and what they mean."""

import click
import pytest

from artist_py.cli.options import AovNames, ByteSize, Duration, Exposure, Integers, Setting, WhitePoint
from artist_py.errors import OptionError


class TestValues:
    """What options may look like."""

    @pytest.mark.parametrize(
        ("kind", "text", "value"),
        [
            (Duration(), "30s", 30),
            (Duration(), "2m", 120),
            (Duration(), "1h30m", 5400),
            (Duration(), "1h2m3.5s", 3723.5),
            (Duration(), "0.5h", 1800),
            (Duration(), "90", 90),
            (ByteSize(), "4GiB", 4 * 2**30),
            (ByteSize(), "500MB", 5 * 10**8),
            (ByteSize(), "1.5 GiB", 3 * 2**29),
            (ByteSize(), "1000000", 10**6),
            (Integers("WxH", "x", ""), "640x480", [640, 480]),
            (Integers("a,b,c,d", ",", ""), "1, 2,3,4", [1, 2, 3, 4]),
            (AovNames(), "normal, depth", ("normal", "depth")),
            (Setting(), "render.seed = 3", ("render.seed", "3")),
            (Setting(), 'spectra.a="b=c"', ("spectra.a", '"b=c"')),
            (Exposure(), "-1.5", -1.5),
            (Exposure(), "auto", "auto"),
            (WhitePoint(), "D65", (0.3127, 0.3290)),
            (WhitePoint(), "0.3,0.4", (0.3, 0.4)),
        ],
    )
    def test_good(self, kind, text, value):
        """Texts and what they mean; a converted value stays what it is."""
        assert kind.convert(text, None, None) == value
        assert kind.convert(kind.convert(text, None, None), None, None) == value

    @pytest.mark.parametrize(
        ("kind", "texts"),
        [
            (Duration(), ["", "0", "0s", "-3s", "3 days", "s", "1.2.3s", "m30", "inf", "nan"]),
            (ByteSize(), ["", "0", "GiB", "-1GiB", "4 XB", "4gib", "0.1"]),
            (Integers("WxH", "x", ""), ["", "x", "1x", "1x2x3", "1.5x2", "1*2"]),
            (AovNames(), ["", "normal,", "all"]),
            (Setting(), ["", "a"]),
            (Exposure(), ["", "nan", "AUTO"]),
            (WhitePoint(), ["", "1", "0,0", "0.5,0.6", "a,b", "0.1,0.2,0.3", "nan,nan"]),
        ],
    )
    def test_bad(self, kind, texts):
        """Everything else is refused."""
        for text in texts:
            with pytest.raises((click.BadParameter, OptionError)):
                kind.convert(text, None, None)
