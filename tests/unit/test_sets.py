"""Matrices between sets of wavelengths: the Python twins against sums written out, and kernels against the twins."""

import numpy as np
import pytest

from artist_py.core.sets import (
    at_film,
    chosen,
    diagonal,
    first_lanes,
    from_next_set,
    from_previous_set,
    given,
    lanes_after,
    placed,
    received,
    repeated,
    row_of,
    tiled,
    widened,
)
from artist_py.core.table import Table
from artist_py.core.vector import Spectrum
from artist_py.jit import kernel

SIZES = [(3, 4), (3, 1), (1, 4), (2, 2)]  # sets, wavelengths of each


def everything(coefficients, values, matrix, table, zero):
    """All operations once."""
    return (
        from_next_set(coefficients, values, zero),
        from_previous_set(coefficients, matrix, zero),
        received(zero, matrix, values),
        received(None, values, values),
        repeated(values, matrix),
        first_lanes(matrix, values),
        row_of(table, 1, coefficients),
        given(None, values),
        given(matrix, values),
        chosen(None, values, matrix),
        chosen(zero, values, matrix),
    )


compiled = kernel(everything)


def inputs(sets, count):
    rng = np.random.default_rng(sets * 10 + count)
    lanes = sets * count
    sizes = (lanes * count, lanes, lanes * count)
    table = Table(rng.random((2, lanes * count)).astype(np.float32))
    return *(Spectrum(rng.random(size)) for size in sizes), table, Spectrum(np.zeros(lanes))


@pytest.mark.parametrize(("sets", "count"), SIZES)
def test_light_goes_from_the_next_set(sets, count):
    """(3.2), written out: R[m, k, j] leads to wavelength k of set m from wavelength j of set m + 1."""
    _, values, _, _, zero = inputs(sets, count)
    rates = np.random.default_rng(1).random((sets, count, count))
    light = values.values.reshape(sets, count)
    expected = [
        [sum(rates[m, k, j] * light[(m + 1) % sets, j] for j in range(count)) for k in range(count)]
        for m in range(sets)
    ]
    found = from_next_set(Spectrum(rates.transpose(2, 0, 1).ravel()), values, zero)
    np.testing.assert_allclose(found.values, np.ravel(expected), rtol=1e-5)


@pytest.mark.parametrize(("sets", "count"), SIZES)
def test_importance_goes_the_other_way(sets, count):
    """(3.3) is the transpose of (3.2): what an eye subpath brings of light is the same either way round."""
    _, values, matrix, _, zero = inputs(sets, count)
    rates = np.random.default_rng(1).random((sets, count, count))
    towards_eye = Spectrum(rates.transpose(2, 0, 1).ravel())
    towards_light = Spectrum(np.roll(rates, 1, axis=0).transpose(1, 0, 2).ravel())
    light_first = received(zero, matrix, from_next_set(towards_eye, values, zero))
    eye_first = received(zero, from_previous_set(towards_light, matrix, zero), values)
    np.testing.assert_allclose(light_first.values, eye_first.values, rtol=1e-5)


@pytest.mark.parametrize(("sets", "count"), SIZES)
def test_kernels_do_the_same(sets, count):
    for found, twin in zip(compiled(*inputs(sets, count)), everything(*inputs(sets, count)), strict=True):
        assert len(found.values) == len(twin.values)
        np.testing.assert_allclose(found.values, twin.values, rtol=1e-5)


# --- what the control of colour needs -----------------------------------------------------------------------------


def lanes_of_control(light, matrix, square, colour, wavelengths):
    """All operations on a matrix of 7 rows, light of 7 lanes and 3 colours."""
    return (
        lanes_after(light, wavelengths, colour),
        lanes_after(light, colour, wavelengths),
        widened(wavelengths, light),
        widened(light, light),
        placed(colour, wavelengths, light),
        tiled(colour, square),
        diagonal(square, colour),
        at_film(None, light),
        at_film(matrix, light),
    )


def test_lanes_of_the_control():
    light, matrix, square, colour, wavelengths = (
        Spectrum(np.arange(1, size + 1)) for size in (7, 21, 9, 3, 4)
    )
    expected = (
        [5, 6, 7],
        [4, 5, 6, 7],
        [1, 2, 3, 4, 0, 0, 0],
        [1, 2, 3, 4, 5, 6, 7],
        [0, 0, 0, 0, 1, 2, 3],
        [1, 2, 3] * 3,
        [1, 5, 9],
        [1, 2, 3, 4, 5, 6, 7],
        np.arange(1, 8) @ np.arange(1, 22).reshape(7, 3),
    )
    arguments = light, matrix, square, colour, wavelengths
    for run in (lanes_of_control, kernel(lanes_of_control)):
        for found, numbers in zip(run(*arguments), expected, strict=True):
            np.testing.assert_array_equal(found.values, numbers)
