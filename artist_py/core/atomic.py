"""One counter shared by threads."""

from llvmlite import ir
from numba.core import types

from .vector import primitive


def fetch_and_add(counters, index, amount):
    """`counters[index]` (int64) before `amount` is added to it, in one indivisible step."""
    before = counters[index]
    counters[index] += amount
    return before


def _lower(context, builder, result, arg_types, args):
    array = context.make_array(arg_types[0])(context, builder, args[0])
    index = context.cast(builder, args[1], arg_types[1], types.int64)
    amount = context.cast(builder, args[2], arg_types[2], types.int64)
    place = builder.gep(builder.bitcast(array.data, ir.IntType(64).as_pointer()), [index])
    return builder.atomic_rmw("add", place, amount, "seq_cst")


def _resolve(counters, index, amount):
    is_counter = isinstance(counters, types.Array) and counters.dtype == types.int64
    return types.int64 if is_counter else None


primitive(_resolve)(fetch_and_add, _lower)
