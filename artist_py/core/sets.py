"""Spectra over several sets of wavelengths, and matrices from one set to the next: what fluorescence needs.

With M sets of C wavelengths each a spectrum has M C lanes, set by set. What an eye subpath carries is a matrix, what
each column of it (a wavelength of set 0, or a channel of the film) gets per radiance at each of all M C wavelengths: a
spectrum of M C times as many lanes as there are columns, wavelength by wavelength, all columns together. Everything
here is worked out for the numbers of lanes at compile time; with one set and no matrix nothing of it is left.
"""

import numpy as np
from llvmlite import ir
from numba.core import types

from .table import TableType, element_pointer
from .vector import _FLAGS, INT32, LanesType, primitive, spectrum_type


def _shuffle(builder, vector, lanes):
    """The lanes `lanes` of an LLVM vector."""
    if list(lanes) == list(range(vector.type.count)):
        return vector
    mask = ir.Constant(ir.VectorType(INT32, len(lanes)), list(lanes))
    return builder.shuffle_vector(vector, ir.Constant(vector.type, ir.Undefined), mask)


def _are_spectra(*args):
    return all(isinstance(arg, LanesType) and arg.bits == 32 for arg in args)


# --- lanes ----------------------------------------------------------------------------------------------------------


def first_lanes(values, like):
    """The first lanes of `values`, as many as `like` has."""
    return type(values)(values.values[: len(like.values)])


primitive(lambda values, like: like if _are_spectra(values, like) and values.lanes >= like.lanes else None)(
    first_lanes, lambda cx, b, result, typs, args: _shuffle(b, args[0], range(result.lanes))
)


def lanes_after(values, skipped, like):
    """As many lanes of `values` as `like` has, those that follow on the first ones, as many as `skipped` has."""
    first = len(skipped.values)
    return type(values)(values.values[first : first + len(like.values)])


def _resolve_after(values, skipped, like):
    if not _are_spectra(values, skipped, like) or values.lanes < skipped.lanes + like.lanes:
        return None
    return like


primitive(_resolve_after)(
    lanes_after,
    lambda cx, b, result, typs, args: _shuffle(
        b, args[0], range(typs[1].lanes, typs[1].lanes + result.lanes)
    ),
)


def widened(values, like):
    """The lanes of `values`, and then zeros, as many lanes as `like` has."""
    return type(values)(np.pad(values.values, (0, len(like.values) - len(values.values))))


def placed(values, skipped, like):
    """As many lanes as `like` has: `values` after as many as `skipped` has, and zero elsewhere."""
    lanes, first = np.zeros(len(like.values)), len(skipped.values)
    lanes[first : first + len(values.values)] = values.values
    return type(values)(lanes)


def _lower_placed(context, builder, result, arg_types, args):
    return _among_zeros(builder, args[0], arg_types[1].lanes, result)


def _among_zeros(builder, vector, first, result):
    """An LLVM vector of zeros but for `vector` from lane `first` on."""
    count, total = vector.type.count, result.lanes
    # LLVM joins what is of one length.
    long = _shuffle(builder, vector, [min(i, count - 1) for i in range(total)])
    mask = [total + i - first if 0 <= i - first < count else i for i in range(total)]
    zeros = ir.Constant(result.vector, [0.0] * total)
    return builder.shuffle_vector(zeros, long, ir.Constant(ir.VectorType(INT32, total), mask))


primitive(lambda values, like: like if _are_spectra(values, like) and values.lanes <= like.lanes else None)(
    widened, lambda cx, b, result, typs, args: _among_zeros(b, args[0], 0, result)
)


primitive(
    lambda values, skipped, like: (
        like if _are_spectra(values, skipped, like) and values.lanes + skipped.lanes <= like.lanes else None
    )
)(placed, _lower_placed)


def tiled(values, like):
    """The lanes of `values` again and again, until there are as many as `like` has."""
    return type(values)(np.resize(values.values, len(like.values)))


primitive(
    lambda values, like: like if _are_spectra(values, like) and like.lanes % values.lanes == 0 else None
)(
    tiled,
    lambda cx, b, result, typs, args: _shuffle(b, args[0], [i % typs[0].lanes for i in range(result.lanes)]),
)


def diagonal(matrix, like):
    """The diagonal of a square matrix of as many rows as `like` has lanes."""
    return type(matrix)(matrix.values[:: len(like.values) + 1])


primitive(
    lambda matrix, like: like if _are_spectra(matrix, like) and matrix.lanes == like.lanes**2 else None
)(
    diagonal,
    lambda cx, b, result, typs, args: _shuffle(b, args[0], range(0, typs[0].lanes, result.lanes + 1)),
)


def given(value, default):
    """`value`, or `default` where it is `None`; the two may be of different types."""
    return default if value is None else value


def chosen(part, without, with_it):
    """`with_it`, or `without` where `part` is `None`.

    It is not a branch of its own: what stands around it is compiled as if the choice had never been.
    """
    return without if part is None else with_it


def _is_absent(typ):
    return isinstance(typ, types.NoneType)


primitive(lambda value, default: default if _is_absent(value) else value)(
    given, lambda cx, b, result, typs, args: args[1] if _is_absent(typs[0]) else args[0]
)
primitive(lambda part, without, with_it: without if _is_absent(part) else with_it)(
    chosen, lambda cx, b, result, typs, args: args[1] if _is_absent(typs[0]) else args[2]
)


def repeated(values, like):
    """Each lane of `values` as often as the matrix `like` has columns."""
    return type(values)(np.repeat(values.values, len(like.values) // len(values.values)))


def _lower_repeated(context, builder, result, arg_types, args):
    lanes, columns = arg_types[0].lanes, result.lanes // arg_types[0].lanes
    return _shuffle(builder, args[0], [i for i in range(lanes) for _ in range(columns)])


primitive(
    lambda values, like: like if _are_spectra(values, like) and like.lanes % values.lanes == 0 else None
)(repeated, _lower_repeated)


def row_of(table, row, like):
    """Row `row` of a table of float32, of as many columns as `like` has lanes."""
    return type(like)(table.array[row])


def _lower_row_of(context, builder, result, arg_types, args):
    index = context.make_tuple(
        builder,
        types.UniTuple(types.intp, 2),
        (context.cast(builder, args[1], arg_types[1], types.intp), _zero()),
    )
    pointer = element_pointer(context, builder, arg_types[0], args[0], types.UniTuple(types.intp, 2), index)
    return builder.load(builder.bitcast(pointer, result.vector.as_pointer()), align=4)


def _zero():
    return ir.Constant(ir.IntType(64), 0)


primitive(lambda table, row, like: like if isinstance(table, TableType) and _are_spectra(like) else None)(
    row_of, _lower_row_of
)


# --- matrices -------------------------------------------------------------------------------------------------------


def received(sets, throughput, radiance):
    """What an eye subpath brings of `radiance` at its end, at the film's wavelengths.

    Where there are several sets (`sets` is not `None`) its throughput is a matrix, which sums over all wavelengths.
    """
    if sets is None:
        return throughput * radiance
    matrix = throughput.values.reshape(len(radiance.values), -1)
    return type(radiance)((matrix * radiance.values[:, None]).sum(axis=0, dtype=np.float32))


def _lower_received(context, builder, result, arg_types, args):
    _, throughput, radiance = args
    if _is_absent(arg_types[0]):
        return builder.fmul(throughput, radiance, flags=_FLAGS)
    total = None
    for i in range(arg_types[2].lanes):
        column = _shuffle(builder, throughput, range(i * result.lanes, (i + 1) * result.lanes))
        term = builder.fmul(column, _shuffle(builder, radiance, [i] * result.lanes), flags=_FLAGS)
        total = term if total is None else builder.fadd(total, term, flags=_FLAGS)
    return total


def _resolve_received(sets, throughput, radiance):
    if not _are_spectra(throughput, radiance):
        return None
    if _is_absent(sets):
        return radiance if throughput == radiance else None
    return spectrum_type(throughput.lanes // radiance.lanes)


primitive(_resolve_received)(received, _lower_received)


def at_film(start, light):
    """Light that arrives at the film: itself, or what it brings of it by `start`, the matrix of eye subpaths there."""
    return light if start is None else received(True, start, light)


primitive(
    lambda start, light: light if _is_absent(start) else _resolve_received(types.boolean, start, light)
)(
    at_film,
    lambda cx, b, result, typs, args: (
        args[1]
        if _is_absent(typs[0])
        else _lower_received(cx, b, result, (types.boolean, *typs), (None, *args))
    ),
)


def from_next_set(coefficients, values, like):
    """Sum over the C wavelengths j of the *next* set (the first follows on the last) of coefficient times value.

    `values` has the M C lanes of `like`, or those of a matrix, whose columns then stay apart. Lane (j, m, k) of the
    M C C `coefficients` belongs to wavelength k of set m and j of set m + 1.
    """
    return _from_set(coefficients, values, like, 1)


def from_previous_set(coefficients, values, like):
    """The same with the set before; lane (j, m, k) belongs to wavelength k of set m and j of set m - 1."""
    return _from_set(coefficients, values, like, -1)


def _from_set(coefficients, values, like, step):
    lanes, heroes, columns = _counts(len(coefficients.values), len(values.values), len(like.values))
    by_source = coefficients.values.reshape(heroes, lanes, 1)
    total = np.zeros((lanes, columns), np.float32)
    for j in range(heroes):
        total += by_source[j] * values.values[_sources(lanes, heroes, columns, j, step)].reshape(
            lanes, columns
        )
    return type(values)(total.ravel())


def _counts(n_coefficients, n_values, lanes):
    """Lanes of a spectrum, wavelengths of a set, columns of the values."""
    return lanes, n_coefficients // lanes, n_values // lanes


def _sources(lanes, heroes, columns, j, step):
    """Where each lane finds its value at wavelength j of the set `step` further."""
    sets = lanes // heroes
    return [
        (((i // heroes + step) % sets) * heroes + j) * columns + column
        for i in range(lanes)
        for column in range(columns)
    ]


def _lowering(step):
    def lower(context, builder, result, arg_types, args):
        lanes, heroes, columns = _counts(*(typ.lanes for typ in arg_types))
        total = None
        for j in range(heroes):
            own = [j * lanes + i for i in range(lanes) for _ in range(columns)]
            value = _shuffle(builder, args[1], _sources(lanes, heroes, columns, j, step))
            term = builder.fmul(_shuffle(builder, args[0], own), value, flags=_FLAGS)
            total = term if total is None else builder.fadd(total, term, flags=_FLAGS)
        return total

    return lower


def _resolve_from_set(coefficients, values, like):
    return values if _are_spectra(coefficients, values, like) else None


primitive(_resolve_from_set)(from_next_set, _lowering(1))
primitive(_resolve_from_set)(from_previous_set, _lowering(-1))
