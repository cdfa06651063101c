"""Counter-based random numbers: a pure function of (seed, stream, pixel, index, dimension), with no state to advance.

The first pairs of dimensions come from an Owen-scrambled Sobol (0,2)-sequence, padded: every pair of dimensions is a
two-dimensional sequence of its own, whose points are visited in an order shuffled for that pair (Burley 2020, Practical
Hash-based Owen Scrambling; the hash is Laine and Karras 2011 with the constants of Vegdahl 2021). Later pairs are
independent numbers, which cost less. Images so depend neither on threads nor on the order of tiles.
"""

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import types

from ..jit import function
from .vector import primitive

TO_UNIT = 2.0**-32
_U32 = np.uint32
_U64 = np.uint64


class Stream(NamedTuple):
    """The random numbers of one path."""

    key: int  # uint64: hash of seed, stream and pixel
    reversed_index: int  # uint32: bits of the sample index in reverse
    stratified_pairs: int  # how many pairs of dimensions are Sobol points


def reverse_bits(value):
    """The 32 bits of `value` in reverse order."""
    return _U32(int(f"{int(value) & 0xFFFFFFFF:032b}"[::-1], 2))


def _lower_reverse_bits(context, builder, result, arg_types, args):
    return builder.bitreverse(context.cast(builder, args[0], arg_types[0], types.uint32))


primitive(lambda value: types.uint32 if isinstance(value, types.Integer) else None)(
    reverse_bits, _lower_reverse_bits
)


def wrap32(value):
    """`value` modulo 2^32 as uint32."""
    return _U32(int(value) & 0xFFFFFFFF)


primitive(lambda value: types.uint32 if isinstance(value, types.Integer) else None)(
    wrap32,
    lambda cx, b, result, typs, args: b.trunc(cx.cast(b, args[0], typs[0], types.uint64), ir.IntType(32)),
)


@function
def mix64(value):
    """Bijective hash of 64 bits (the finaliser of Steele, Lea and Flood 2014, constants of Stafford's variant 13)."""
    value = (value ^ (value >> _U64(30))) * _U64(0xBF58476D1CE4E5B9)
    value = (value ^ (value >> _U64(27))) * _U64(0x94D049BB133111EB)
    return value ^ (value >> _U64(31))


@function
def stream_of(seed, iteration, pixel, stratified_pairs):
    """The numbers of the path through `pixel` in `iteration`.

    Even and odd iterations are two independent randomisations, so that half the squared difference of their images
    estimates the error of their mean, gain of stratification included.
    """
    key = mix64(_U64(seed) + _U64(0x9E3779B97F4A7C15) * _U64(iteration & 1))
    key = mix64(key ^ (_U64(pixel) * _U64(0xD1B54A32D192ED03)))
    return Stream(key, reverse_bits(iteration >> 1), stratified_pairs)


@function
def _owen_hash(value, seed):
    """Scrambles upwards: each bit is flipped by a hash of the bits below it."""
    value = wrap32(value ^ wrap32(value * _U32(0x3D20ADEA)))
    value = wrap32(value + seed)
    value = wrap32(value * ((seed >> _U32(16)) | _U32(1)))
    value = wrap32(value ^ wrap32(value * _U32(0x05526C56)))
    return wrap32(value ^ wrap32(value * _U32(0x53A22864)))


@function
def _pascal(bits):
    """Second Sobol dimension from the first, both as binary fractions.

    The generator matrix is Pascal's triangle modulo 2: a Taylor shift t -> 1 + x of the index polynomial, by halving.
    """
    bits = wrap32(bits ^ wrap32(bits << _U32(16)))
    bits = wrap32(bits ^ (wrap32(bits << _U32(8)) & _U32(0xFF00FF00)))
    bits = wrap32(bits ^ (wrap32(bits << _U32(4)) & _U32(0xF0F0F0F0)))
    bits = wrap32(bits ^ (wrap32(bits << _U32(2)) & _U32(0xCCCCCCCC)))
    return wrap32(bits ^ (wrap32(bits << _U32(1)) & _U32(0xAAAAAAAA)))


@function
def random_pair(stream, pair):
    """Two numbers in [0, 1): pair `pair` of the path's dimensions."""
    key = mix64(stream.key + _U64(pair) * _U64(0x9E3779B97F4A7C15))
    if pair >= stream.stratified_pairs:
        bits = mix64(key ^ _U64(stream.reversed_index))
        return wrap32(bits) * TO_UNIT, wrap32(bits >> _U64(32)) * TO_UNIT
    first = _owen_hash(stream.reversed_index, wrap32(key))
    second = _pascal(first)
    seed = mix64(key)
    first = reverse_bits(_owen_hash(reverse_bits(first), wrap32(seed)))
    second = reverse_bits(_owen_hash(reverse_bits(second), wrap32(seed >> _U64(32))))
    return first * TO_UNIT, second * TO_UNIT


@function
def lattice_point(u, v, w):
    """The next of the points in the unit cube that follow each other evenly from any random one, as uniform as that.

    Kronecker's sequence of the powers of 1/g, where g is the real root of g^4 = g + 1 (Roberts 2018).
    """
    return (u + 0.8191725133961645) % 1.0, (v + 0.6710436067037893) % 1.0, (w + 0.5497004779019703) % 1.0


@function
def random_number(stream, pair):
    """One number in [0, 1), independent of all pairs: for decisions that stratification does not help."""
    bits = mix64(mix64(stream.key ^ _U64(stream.reversed_index)) + _U64(pair) * _U64(0xD1342543DE82EF95))
    return wrap32(bits >> _U64(32)) * TO_UNIT
