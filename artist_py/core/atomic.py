"""One counter shared by threads."""

from numba.core import types

from .table import TableType, element_pointer
from .vector import primitive


def fetch_and_add(counters, index, amount):
    """`counters[index]` (a `Table` of int64) before `amount` is added to it, in one indivisible step."""
    before = counters[index]
    counters[index] += amount
    return before


def _lower(context, builder, result, arg_types, args):
    amount = context.cast(builder, args[2], arg_types[2], types.int64)
    place = element_pointer(context, builder, arg_types[0], args[0], arg_types[1], args[1])
    return builder.atomic_rmw("add", place, amount, "seq_cst")


def _resolve(counters, index, amount):
    is_counter = isinstance(counters, TableType) and counters.dtype == types.int64
    return types.int64 if is_counter else None


primitive(_resolve)(fetch_and_add, _lower)
