"""What a texture is at a point: texels, interpolation, repetition, colours; compiled and as plain Python."""

import numpy as np
import pytest
from scipy import ndimage

from artist_py.bsdf.reflectance import checker, image_value, reflectance_at, textured_reflectance
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum, lane
from artist_py.jit import kernel
from artist_py.scene.spectra import rgb_basis, tabulate
from artist_py.scene.spectrum_types import Rgb
from artist_py.scene.tables import (
    ABSORBER,
    CHECKERBOARD,
    CONDUCTOR,
    DIELECTRIC,
    DIFFUSE,
    IMAGE,
    MIRROR,
    OREN_NAYAR,
    PASS_THROUGH,
    THIN_DIELECTRIC,
    Spectra,
    Textures,
    material_dtype,
    texture_dtype,
)

FIRST, LAST = 380, 780
LANES = 4
WAVELENGTHS = Spectrum([420.0, 500.5, 560.0, 700.0])
WHITE, DARK, BASIS = 0, 1, 2
SPECTRA = Spectra(
    None,
    Table(
        np.vstack(
            [
                np.ones(LAST - FIRST),
                np.linspace(0.1, 0.3, LAST - FIRST),
                rgb_basis(FIRST, LAST, "reflectance"),
            ]
        ).astype(np.float32)
    ),
    float(FIRST),
)
RNG = np.random.default_rng(1)
GREY = RNG.integers(0, 65536, (5, 7, 1)).astype(np.uint16)
COLOUR = RNG.integers(0, 65536, (4, 3, 3)).astype(np.uint16)
# Places of all kinds: inside, on edges, far away, and where a fraction is rounded up to 1.
PLACES = [
    *RNG.uniform(-3, 3, (200, 2)).tolist(),
    *([a, b] for a in (0.0, 1.0, -1.0, -1e-20, 1 - 2.0**-53, 3e38, -3e38) for b in (0.0, 0.5, 1.0, -1e-20)),
]


def values_of(texels):
    """Reflectances that the texels stand for."""
    return (texels / 65535.0) ** 2


def textures(*, kind=IMAGE, texels=GREY, repeat=(1, 1), is_nearest=0, spectra=(WHITE, DARK, 0), offset=11):
    """`Textures` of one texture, which does not stand first in the pool."""
    records = np.zeros(1, texture_dtype).view(np.recarray)
    records.kind, records.is_nearest, records.offset = kind, is_nearest, offset
    records.repeat_u, records.repeat_v = repeat
    records.height, records.width, records.channels = texels.shape
    records.spectra = (BASIS, BASIS + 1, BASIS + 2) if texels.shape[2] == 3 else spectra
    pool = np.concatenate([np.full(offset, 12345, np.uint16), texels.ravel()])
    return Textures(Table(records), Table(pool))


def material(kind=DIFFUSE, texture=0, reflectance=DARK):
    """A table of one material."""
    table = np.zeros(1, material_dtype).view(np.recarray)
    table.kind, table.texture, table.reflectance = kind, texture, reflectance
    return Table(table)


@kernel
def reflectance_rows(textures, materials, spectra, wavelengths, places, out):
    for i in range(len(places)):
        value = reflectance_at(textures, materials[0], spectra, wavelengths, places[i, 0], places[i, 1])
        for j in range(LANES):
            out[i, j] = lane(value, j)


def looked_up(textures, materials, places):
    """Reflectances (n, C), compiled."""
    out = np.full((len(places), LANES), np.nan)
    reflectance_rows(textures, materials, SPECTRA, WAVELENGTHS, np.array(places, float), out)
    return out


def value_at(found, u, v, channel=0):
    """Value of a channel of the only texture at (u, v) of its own unit square."""
    texture = found.records[0]
    return image_value(found.texels, texture, u * texture.width, (1 - v) * texture.height, channel)


class TestImages:
    """Interpolation of texels."""

    @pytest.mark.parametrize("texels", [GREY, COLOUR], ids=["grey", "colour"])
    @pytest.mark.parametrize("is_nearest", [0, 1])
    def test_texels_are_exact_at_their_centres(self, texels, is_nearest):
        found, expected = textures(texels=texels, is_nearest=is_nearest), values_of(texels)
        height, width, channels = texels.shape
        for (row, column, channel), value in np.ndenumerate(expected):
            u, v = (column + 0.5) / width, 1 - (row + 0.5) / height
            assert value_at(found, u, v, channel) == pytest.approx(value, rel=1e-12, abs=1e-12)
        assert channels in {1, 3}

    def test_bilinear_values_are_those_of_scipy(self):
        places = np.array(PLACES[:200])
        x = places[:, 0] * GREY.shape[1] - 0.5
        y = (1 - places[:, 1]) * GREY.shape[0] - 0.5
        expected = ndimage.map_coordinates(values_of(GREY)[..., 0], [y, x], order=1, mode="grid-wrap")
        found = looked_up(textures(), material(), places)
        np.testing.assert_allclose(found, np.repeat(expected[:, None], LANES, 1), atol=1e-6)

    def test_nearest_values_are_those_of_the_texel_around(self):
        places = np.array(PLACES[:200])
        column = np.floor(places[:, 0] * GREY.shape[1]).astype(int) % GREY.shape[1]
        row = np.floor((1 - places[:, 1]) * GREY.shape[0]).astype(int) % GREY.shape[0]
        found = looked_up(textures(is_nearest=1), material(), places)
        np.testing.assert_allclose(found[:, 0], values_of(GREY)[row, column, 0], rtol=1e-6)

    @pytest.mark.parametrize("is_nearest", [0, 1])
    @pytest.mark.parametrize("texels", [GREY, GREY[:1, :1], COLOUR], ids=["grey", "one", "colour"])
    def test_every_place_is_inside(self, is_nearest, texels):
        """What lies before the image in the pool would be found out: the least and greatest texel are bounds."""
        found = looked_up(textures(texels=texels, is_nearest=is_nearest), material(), PLACES)
        values = values_of(texels)
        if texels.shape[2] == 1:
            assert values.min() - 1e-6 <= found.min() and found.max() <= values.max() + 1e-6
        assert found.min() >= 0.0 and found.max() <= 1.0 + 1e-6

    def test_the_border_goes_on_at_the_opposite_one(self):
        found, values = textures(), values_of(GREY)[..., 0]
        v = 1 - 0.5 / 5
        assert value_at(found, 0.0, v) == pytest.approx(0.5 * (values[0, 0] + values[0, -1]))
        assert value_at(found, 1.0, v) == pytest.approx(0.5 * (values[0, 0] + values[0, -1]))
        assert value_at(found, 0.5 / 7, 1.0) == pytest.approx(0.5 * (values[0, 0] + values[-1, 0]))

    @pytest.mark.parametrize("is_nearest", [0, 1])
    def test_repeat_divides_the_square(self, is_nearest):
        places = np.array(PLACES[:200])
        once = looked_up(textures(is_nearest=is_nearest), material(), places)
        repeated = textures(repeat=(4, 0.5), is_nearest=is_nearest)
        np.testing.assert_allclose(looked_up(repeated, material(), places / [4, 0.5]), once, atol=1e-6)


class TestColours:
    """From values to spectra."""

    @pytest.mark.parametrize("colour", [(1, 1, 1), (0, 0, 0), (0.8, 0.3, 0.05), (0, 0, 1)])
    def test_rgb_is_the_spectrum_of_that_rgb(self, colour):
        texels = np.rint(np.sqrt(colour) * 65535).astype(np.uint16).reshape(1, 1, 3)
        found = looked_up(textures(texels=texels), material(), [[0.3, 0.7]])[0]
        table = tabulate(Rgb(rgb=tuple(map(float, colour))), FIRST, LAST, "reflectance")
        expected = table[(np.asarray(WAVELENGTHS) - FIRST).astype(int)]
        np.testing.assert_allclose(found, expected, atol=5e-5)

    def test_grey_is_flat(self):
        found = looked_up(textures(), material(), PLACES)
        np.testing.assert_array_equal(found, np.repeat(found[:, :1], LANES, 1))

    def test_squares_of_a_checkerboard_take_turns(self):
        found = textures(kind=CHECKERBOARD, repeat=(4, 3))
        for row in range(-3, 6):
            for column in range(-4, 8):
                u, v = (column + 0.25) / 4, (row + 0.75) / 3
                assert checker(found.records[0], u, v) == (row + column) % 2
        white, dark = looked_up(found, material(), [[0.1, 0.1], [0.3, 0.1]])
        np.testing.assert_array_equal(white, 1.0)
        np.testing.assert_allclose(dark, SPECTRA.dense[DARK][(np.asarray(WAVELENGTHS) - FIRST).astype(int)])

    def test_places_far_away_belong_to_one_of_the_squares(self):
        found = looked_up(textures(kind=CHECKERBOARD, repeat=(65536, 65536)), material(), PLACES)
        is_white = found[:, 0] == 1.0
        assert is_white.any() and (~is_white).any()
        np.testing.assert_allclose(
            found[~is_white], np.broadcast_to(found[~is_white][0], (sum(~is_white), 4))
        )


class TestMaterials:
    """Who has a texture, and who is not asked."""

    @pytest.mark.parametrize("kind", [DIFFUSE, OREN_NAYAR, MIRROR, CONDUCTOR])
    def test_kinds_with_a_reflectance(self, kind):
        textured = looked_up(textures(), material(kind), [[0.4, 0.4]])
        expected = textured_reflectance(textures(), textures().records[0], SPECTRA, WAVELENGTHS, 0.4, 0.4)
        np.testing.assert_allclose(textured[0], expected, rtol=1e-6)
        plain = looked_up(textures(), material(kind, texture=-1), [[0.4, 0.4]])
        np.testing.assert_array_equal(plain, looked_up(None, material(kind), [[0.4, 0.4]]))

    @pytest.mark.parametrize("kind", [DIELECTRIC, THIN_DIELECTRIC, PASS_THROUGH, ABSORBER])
    def test_nothing_is_read_for_kinds_without_one(self, kind):
        """Reading would fail: there is nothing to read from."""
        table = material(kind)
        assert not np.any(reflectance_at(Textures(None, None), table[0], None, WAVELENGTHS, 0.1, 0.2))
        assert not np.any(looked_up(textures(), table, [[0.1, 0.2]]))

    @pytest.mark.parametrize(
        "found",
        [
            textures(),
            textures(is_nearest=1),
            textures(texels=COLOUR, repeat=(2, 3)),
            textures(kind=CHECKERBOARD, repeat=(8, 8)),
            None,
        ],
        ids=["bilinear", "nearest", "colour", "checkerboard", "none"],
    )
    def test_compiled_values_agree_with_python(self, found):
        table = material()
        expected = [
            np.asarray(reflectance_at(found, table[0], SPECTRA, WAVELENGTHS, u, v)) for u, v in PLACES
        ]
        np.testing.assert_allclose(looked_up(found, table, PLACES), expected, rtol=1e-5, atol=1e-7)
