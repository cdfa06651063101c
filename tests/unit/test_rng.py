"""Random numbers: stratified where promised, uniform, and independent of each other.

Fixed seeds; a correct generator fails one statistical test by chance with probability 1e-4; there are 30.
"""

import math

import numba
import numpy as np
import pytest
from scipy import stats

from artist_py.core import rng
from artist_py.core.rng import TO_UNIT, mix64, random_number, random_pair, reverse_bits, stream_of, wrap32
from artist_py.core.table import Table
from artist_py.jit import kernel

FALSE_ALARM = 1e-4
STRATIFIED = 12
SEEDS = (1, 2, 2**63 - 1)
needs_speed = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="takes many numbers")


@kernel
def fill(seed, parity, first, stratified, pairs, pixels, out):
    """Pairs of numbers by (pixel, iteration of this parity, pair), and the single number beside them."""
    for i in range(pixels.shape[0]):
        for j in range(out.shape[1]):
            stream = stream_of(seed, 2 * (first + j) + parity, pixels[i], stratified)
            for k in range(pairs.shape[0]):
                out[i, j, k, 0], out[i, j, k, 1] = random_pair(stream, pairs[k])
                out[i, j, k, 2] = random_number(stream, pairs[k])


def numbers(*, seed=1, parity=0, first=0, stratified=STRATIFIED, pairs=(0,), pixels=(0,), count=1):
    """Array (pixels, count, pairs, 3); `count` iterations of one parity, from number `first` on."""
    pairs, pixels = np.asarray(pairs, np.int64), np.asarray(pixels, np.int64)
    out = np.empty((len(pixels), count, len(pairs), 3))
    with np.errstate(over="ignore"):  # of plain Python
        fill(seed, parity, first, stratified, Table(pairs), Table(pixels), Table(out))
    return out


# --- stratification -----------------------------------------------------------------------------------------------


def is_stratified(points, bits):
    """Whether each elementary interval of area 2^-bits has one of these 2^bits points, in all shapes."""
    for split in range(bits + 1):
        columns, rows = 2**split, 2 ** (bits - split)
        cell = (points[:, 0] * columns).astype(int) * rows + (points[:, 1] * rows).astype(int)
        if len(np.unique(cell)) != len(points):
            return False
    return True


@needs_speed
@pytest.mark.parametrize("parity", [0, 1])
@pytest.mark.parametrize("seed", SEEDS)
def test_every_pair_is_a_0_2_sequence(seed, parity):
    """Each aligned block of 2^m iterations of one parity fills all elementary intervals, for every pair and pixel."""
    for first, bits in ((0, 1), (0, 2), (0, 5), (0, 8), (0, 10), (32, 5), (2**20, 6), (2**20 + 192, 6)):
        points = numbers(
            seed=seed,
            parity=parity,
            first=first,
            pairs=range(STRATIFIED),
            pixels=[0, 1, 77, 10**6],
            count=2**bits,
        )
        for pixel in points:
            assert all(is_stratified(pixel[:, pair], bits) for pair in range(STRATIFIED))


def test_only_the_first_pairs_are_stratified():
    points = numbers(pairs=[STRATIFIED - 1, STRATIFIED, 500], count=256)[0]
    assert [is_stratified(points[:, k], 8) for k in range(3)] == [True, False, False]
    assert not is_stratified(numbers(stratified=0, count=256)[0, :, 0], 8)


def test_second_dimension_is_pascals_triangle():
    """The direction numbers of Sobol's second dimension: binomial coefficients modulo 2."""
    for column in range(32):
        row = sum((math.comb(column, k) % 2) << (31 - k) for k in range(column + 1))
        assert int(rng._pascal(np.uint32(1 << (31 - column)))) == row


@needs_speed
def test_pairs_are_shuffled_against_each_other():
    """Over the 256 iterations of a pixel, one pair's numbers tell nothing of another's: 45 joint tables of 16 x 16.

    Stratified in themselves, the pairs have fixed margins, which leaves 15 x 15 degrees of freedom.
    """
    pairs = range(10)
    points = numbers(pairs=pairs, pixels=range(200), count=256)
    cell = (points[..., :2] * 16).astype(int)
    for a in pairs:
        for b in range(a):
            for axis in (0, 1):
                table = np.zeros((16, 16))
                np.add.at(table, (cell[..., a, axis].ravel(), cell[..., b, axis].ravel()), 1)
                deviation = ((table - 200) ** 2 / 200).sum()
                assert stats.chi2.sf(deviation, 225) > FALSE_ALARM / 90, (a, b, axis, deviation)


# --- uniformity ---------------------------------------------------------------------------------------------------

PIXELS = np.arange(100_000)


@needs_speed
@pytest.mark.parametrize("pair", [0, 3, STRATIFIED + 5])
@pytest.mark.parametrize("number", [0, 5, 1000])
def test_uniform_over_pixels(pair, number):
    """Pairs on 32 x 32 cells; also of their lowest bits, which scrambling reaches last, and of single numbers."""
    points = numbers(first=number, pairs=[pair], pixels=PIXELS)[:, 0, 0]
    assert points.min() >= 0.0 and points.max() < 1.0
    low = (points / TO_UNIT % 2**10) / 2**10
    for values in (points, low):
        for a, b in ((0, 1), (0, 2)):
            table, _, _ = np.histogram2d(values[:, a], values[:, b], bins=32, range=[[0, 1], [0, 1]])
            assert stats.chisquare(table.ravel()).pvalue > FALSE_ALARM / 4


# --- independence -------------------------------------------------------------------------------------------------

BASE = {"pixels": PIXELS, "pairs": [2]}
OTHERS = {
    "next pixel": {"pixels": PIXELS + 1},
    "next row": {"pixels": PIXELS + 512},
    "next pair": {"pairs": [3]},
    "pair of the next vertex": {"pairs": [5]},
    "unstratified pair": {"pairs": [STRATIFIED]},
    "other parity": {"parity": 1},
    "next seed": {"seed": 2},
    "far seed": {"seed": 2**40 + 1},
}


@needs_speed
@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS)
def test_independent_over_pixels(other):
    """Joint tables of each number with each of the other's: 9 chi-squared tests and 9 of correlation."""
    mine, others = (numbers(**{**BASE, **more})[:, 0, 0] for more in ({}, other))
    for a in range(3):
        for b in range(3):
            table, _, _ = np.histogram2d(mine[:, a], others[:, b], bins=16, range=[[0, 1], [0, 1]])
            assert stats.chisquare(table.ravel()).pvalue > FALSE_ALARM / 18
            assert stats.pearsonr(mine[:, a], others[:, b]).pvalue > FALSE_ALARM / 18


@needs_speed
def test_unstratified_iterations_are_independent():
    """Without stratification, numbers of successive iterations share nothing either."""
    points = numbers(stratified=0, pairs=[0], pixels=range(500), count=201)[:, :, 0]
    before, after = points[:, :-1].reshape(-1, 3), points[:, 1:].reshape(-1, 3)
    for a in range(3):
        table, _, _ = np.histogram2d(before[:, a], after[:, a], bins=16, range=[[0, 1], [0, 1]])
        assert stats.chisquare(table.ravel()).pvalue > FALSE_ALARM / 3


@needs_speed
def test_parities_together_are_not_stratified():
    """Even and odd iterations are two randomisations, and not halves of one: as many cells hit twice as by chance.

    512 points in 512 cells, by two stratified halves: a cell is hit by both with probability 1 / 4 (each half fills
    half of the cells). Mean over 400 pixels; the standard deviation of one is below 11 (binomial).
    """
    points = [numbers(parity=parity, pixels=range(400), count=256)[:, :, 0] for parity in (0, 1)]
    both = np.concatenate(points, axis=1)
    cell = (both[..., 0] * 32).astype(int) * 16 + (both[..., 1] * 16).astype(int)
    empty = np.mean([512 - len(np.unique(pixel)) for pixel in cell])
    assert abs(empty - 128) < 11 / math.sqrt(400) * 3.9


# --- streams ------------------------------------------------------------------------------------------------------


def test_no_stream_repeats():
    """Keys of 64 bits differ between all seeds, parities and pixels: by chance two agree with probability 2e-8."""
    with np.errstate(over="ignore"):
        keys = [
            int(stream_of(seed, parity, pixel, 0).key)
            for seed in (*range(60), *(2**62 + np.arange(20)).tolist())
            for parity in (0, 1)
            for pixel in (*range(100), 65536**2 - 1)
        ]
    assert len(set(keys)) == len(keys)


@needs_speed
def test_iterations_of_a_stream_do_not_repeat():
    points = numbers(stratified=0, pairs=range(4), count=5000)[0].reshape(-1, 3)
    assert len(np.unique(points[:, 0] + points[:, 1] * 2**32)) == len(points)


def test_same_arguments_same_numbers():
    assert np.array_equal(numbers(seed=9, pixels=[5], count=7), numbers(seed=9, pixels=[5], count=9)[:, :7])


# --- the twins ----------------------------------------------------------------------------------------------------


def test_plain_python_draws_the_same():
    """Bit by bit."""
    with np.errstate(over="ignore"):
        for seed, parity, pair, pixel, stratified in [
            (1, 0, 0, 0, 12),
            (7, 1, 11, 99, 12),
            (2**63 - 1, 1, 40, 5, 0),
        ]:
            compiled = numbers(
                seed=seed, parity=parity, first=3, stratified=stratified, pairs=[pair], pixels=[pixel]
            )
            stream = stream_of(seed, 6 + parity, pixel, stratified)
            assert (*random_pair(stream, pair), random_number(stream, pair)) == tuple(compiled[0, 0, 0])


def test_bits():
    assert reverse_bits(1) == 2**31
    assert reverse_bits(0b1101) == 0b1011 << 28
    assert wrap32(2**32 + 5) == 5
    assert wrap32(-1) == 2**32 - 1


def test_mixing_avalanches():
    """Each of 64 input bits flips each output bit in half of 400 cases: 4096 shares, each within 5.5 sigma (2e-4)."""
    values = np.random.default_rng(3).integers(0, 2**64, 400, np.uint64)
    with np.errstate(over="ignore"):
        plain = mix64(values)
        for bit in range(64):
            changed = plain ^ mix64(values ^ np.uint64(1 << bit))
            flips = (changed[:, None] >> np.arange(64, dtype=np.uint64)) & np.uint64(1)
            assert np.abs(flips.sum(axis=0) - 200.0).max() < 5.5 * 10
