"""`Table`: a numpy array as kernels see it, an address and a shape.

numba's own arrays carry a reference count, and every function that receives one may touch it; threads then fight for
that one cache line. A table has none: whoever calls the kernel keeps the array alive. It is read and written with all
its indices at once (`table[i, j]`), unchecked; a row of a structured table is a record (`table[i].field`).
"""

import operator

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import (
    AbstractTemplate,
    AttributeTemplate,
    infer_getattr,
    infer_global,
    signature,
)
from numba.extending import (
    NativeValue,
    lower_builtin,
    lower_getattr,
    models,
    register_model,
    typeof_impl,
    unbox,
)
from numba.np.numpy_support import from_dtype

INT64 = ir.IntType(64)


class Table:
    """The Python twin; `array` is C-contiguous. Indexing it in Python is indexing the array."""

    __slots__ = ("address", "array", "dtype", "shape")

    def __init__(self, array):
        array = np.ascontiguousarray(array)
        self.address, self.dtype, self.shape = array.ctypes.data, array.dtype, array.shape
        self.array = array.view(np.recarray) if array.dtype.names else array

    def __getitem__(self, index):
        return self.array[index]

    def __setitem__(self, index, value):
        self.array[index] = value

    def __len__(self):
        return self.shape[0]

    def __array__(self, dtype=None, copy=None):
        return np.array(self.array, dtype=dtype) if copy else np.asarray(self.array, dtype=dtype)

    @property
    def nbytes(self):
        """Size of the array, bytes."""
        return self.array.nbytes


class TableType(types.Type):
    """numba's view: element type and number of dimensions."""

    def __init__(self, dtype, ndim):
        self.dtype, self.ndim = dtype, ndim
        self.shape = types.UniTuple(types.intp, ndim)
        super().__init__(name=f"Table({dtype}, {ndim})")


@register_model(TableType)
class TableModel(models.StructModel):
    """An address and the shape."""

    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, [("address", types.uintp), ("shape", fe_type.shape)])


@typeof_impl.register(Table)
def _typeof(value, context):
    return TableType(from_dtype(value.dtype), len(value.shape))


@unbox(TableType)
def _unbox(typ, obj, c):
    table = cgutils.create_struct_proxy(typ)(c.context, c.builder)
    address, shape = (c.pyapi.object_getattr_string(obj, name) for name in ("address", "shape"))
    table.address = c.pyapi.long_as_ulonglong(address)
    table.shape = c.unbox(typ.shape, shape).value
    for each in (address, shape):
        c.pyapi.decref(each)
    return NativeValue(table._getvalue(), is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))  # noqa: SLF001 - numba's own way


@infer_getattr
class _ShapeTemplate(AttributeTemplate):
    key = TableType

    def resolve_shape(self, table):
        return table.shape


@lower_getattr(TableType, "shape")
def _lower_shape(context, builder, typ, value):
    return cgutils.create_struct_proxy(typ)(context, builder, value=value).shape


def _index_types(table, index):
    """Types of all indices, or `None` if there are not as many as dimensions."""
    found = list(index) if isinstance(index, types.BaseTuple) else [index]
    is_full = len(found) == table.ndim and all(isinstance(each, types.Integer) for each in found)
    return found if is_full else None


@infer_global(operator.getitem)
class _GetTemplate(AbstractTemplate):
    def generic(self, args, kws):
        table, index = args
        if isinstance(table, TableType) and _index_types(table, index):
            return signature(table.dtype, table, index)
        return None


@infer_global(operator.setitem)
class _SetTemplate(AbstractTemplate):
    def generic(self, args, kws):
        table, index, value = args
        if (
            isinstance(table, TableType)
            and _index_types(table, index)
            and isinstance(value, types.Number | types.Boolean)
        ):
            return signature(types.none, table, index, table.dtype)
        return None


def element_pointer(context, builder, typ, value, index_type, index):
    """Address of an element, as a pointer to what its type is in memory."""
    table = cgutils.create_struct_proxy(typ)(context, builder, value=value)
    kinds = _index_types(typ, index_type)
    indices = (
        cgutils.unpack_tuple(builder, index, len(kinds))
        if isinstance(index_type, types.BaseTuple)
        else [index]
    )
    shape = cgutils.unpack_tuple(builder, table.shape, typ.ndim)
    offset = ir.Constant(INT64, 0)
    for size, kind, each in zip(shape, kinds, indices, strict=True):
        offset = builder.add(builder.mul(offset, size), context.cast(builder, each, kind, types.int64))
    if isinstance(typ.dtype, types.Record):
        element = context.get_value_type(typ.dtype)
        base = builder.inttoptr(table.address, element)
    else:
        base = builder.inttoptr(table.address, context.get_data_type(typ.dtype).as_pointer())
    return builder.gep(base, [offset])


def _lower_get(context, builder, sig, args):
    typ, index_type = sig.args
    pointer = element_pointer(context, builder, typ, args[0], index_type, args[1])
    if isinstance(typ.dtype, types.Record):
        return pointer
    return context.unpack_value(builder, typ.dtype, pointer)


def _lower_set(context, builder, sig, args):
    typ, index_type, _ = sig.args
    pointer = element_pointer(context, builder, typ, args[0], index_type, args[1])
    context.pack_value(builder, typ.dtype, args[2], pointer)
    return context.get_dummy_value()


for _index in (types.Integer, types.BaseTuple):
    lower_builtin(operator.getitem, TableType, _index)(_lower_get)
    lower_builtin(operator.setitem, TableType, _index, types.Any)(_lower_set)
