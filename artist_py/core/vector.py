"""`Vec3` and `Spectrum` as values with operators: LLVM vectors in kernels, small Python twins outside.

`Vec3` has three float64 lanes (a fourth is padding and never read); `Spectrum` has one float32 lane per wavelength.
`+ - * /` work lane by lane and with scalars, so that kernels read like the papers.
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
    box,
    lower_builtin,
    lower_getattr,
    models,
    register_model,
    typeof_impl,
    unbox,
)

INT32 = ir.IntType(32)


# --- the Python twins ---------------------------------------------------------------------------------------------


class Lanes:
    """Base of the Python twins: a few numbers and lane-wise operators."""

    __slots__ = ("values",)
    dtype = np.float64

    def __init__(self, values):
        self.values = np.asarray(values, self.dtype)

    def _with(self, values):
        return type(self)(values)

    def __add__(self, other):
        return self._with(self.values + _operand(other, self))

    def __sub__(self, other):
        return self._with(self.values - _operand(other, self))

    def __mul__(self, other):
        return self._with(self.values * _operand(other, self))

    def __truediv__(self, other):
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._with(self.values / _operand(other, self))

    def __rsub__(self, other):
        return self._with(_operand(other, self) - self.values)

    def __rtruediv__(self, other):
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._with(_operand(other, self) / self.values)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self):
        return self._with(-self.values)

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(format(value, '.9g') for value in self.values)})"

    def __array__(self, dtype=None, copy=None):
        return np.array(self.values, dtype=dtype)


class Vec3(Lanes):
    """A point or direction of three float64."""

    __slots__ = ()
    x = property(lambda self: float(self.values[0]))
    y = property(lambda self: float(self.values[1]))
    z = property(lambda self: float(self.values[2]))


class Spectrum(Lanes):
    """One float32 per wavelength of the path."""

    __slots__ = ()
    dtype = np.float32


def _operand(other, like):
    return other.values if isinstance(other, Lanes) else like.dtype(other)


# --- the numba type -----------------------------------------------------------------------------------------------


class LanesType(types.Type):
    """numba's view of both: `lanes` numbers of `bits` bits."""

    def __init__(self, lanes, bits):
        self.lanes, self.bits = lanes, bits
        super().__init__(name="Vec3" if bits == 64 else f"Spectrum{lanes}")

    @property
    def scalar(self):
        return types.float64 if self.bits == 64 else types.float32

    @property
    def vector(self):
        """The LLVM type; a `Vec3` is padded to four lanes."""
        element = ir.DoubleType() if self.bits == 64 else ir.FloatType()
        return ir.VectorType(element, 4 if self.bits == 64 else self.lanes)


VEC3 = LanesType(3, 64)


def spectrum_type(lanes):
    """The numba type of a spectrum of `lanes` wavelengths."""
    return LanesType(lanes, 32)


@register_model(LanesType)
class LanesModel(models.PrimitiveModel):
    """A lanes value is one LLVM vector."""

    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, fe_type.vector)


@typeof_impl.register(Vec3)
def _typeof_vec3(value, context):
    return VEC3


@typeof_impl.register(Spectrum)
def _typeof_spectrum(value, context):
    return spectrum_type(len(value.values))


@unbox(LanesType)
def _unbox(typ, obj, c):
    values = c.pyapi.object_getattr_string(obj, "values")
    vector = ir.Constant(typ.vector, None)
    for i in range(typ.lanes):
        index = c.pyapi.long_from_longlong(ir.Constant(ir.IntType(64), i))
        item = c.pyapi.object_getitem(values, index)
        number = c.pyapi.number_float(item)
        value = c.pyapi.float_as_double(number)
        if typ.bits == 32:
            value = c.builder.fptrunc(value, ir.FloatType())
        vector = c.builder.insert_element(vector, value, INT32(i))
        for each in (index, item, number):
            c.pyapi.decref(each)
    c.pyapi.decref(values)
    return NativeValue(vector, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@box(LanesType)
def _box(typ, val, c):
    numbers = []
    for i in range(typ.lanes):
        value = c.builder.extract_element(val, INT32(i))
        if typ.bits == 32:
            value = c.builder.fpext(value, ir.DoubleType())
        numbers.append(c.pyapi.float_from_double(value))
    values = c.pyapi.tuple_pack(numbers)
    twin = c.pyapi.unserialize(c.pyapi.serialize_object(Vec3 if typ.bits == 64 else Spectrum))
    result = c.pyapi.call_function_objargs(twin, [values])
    for each in (*numbers, values, twin):
        c.pyapi.decref(each)
    return result


# --- operators ----------------------------------------------------------------------------------------------------


def _splat(context, builder, typ, value, from_type):
    """`value` in every lane of `typ`."""
    value = context.cast(builder, value, from_type, typ.scalar)
    vector = builder.insert_element(ir.Constant(typ.vector, ir.Undefined), value, INT32(0))
    zeros = ir.Constant(ir.VectorType(INT32, typ.vector.count), None)
    return builder.shuffle_vector(vector, ir.Constant(typ.vector, ir.Undefined), zeros)


class _ArithmeticTemplate(AbstractTemplate):
    def generic(self, args, kws):
        if len(args) != 2:
            return None
        a, b = args
        if isinstance(a, LanesType) and (a == b or isinstance(b, types.Number)):
            return signature(a, a, b)
        if isinstance(b, LanesType) and isinstance(a, types.Number):
            return signature(b, a, b)
        return None


# Lane-wise operators may be contracted to fused multiply-adds, like the scalar ones of a kernel.
_FLAGS = ("nsz", "arcp", "contract", "afn", "reassoc")


def _register_operator(python_operator, instruction):
    infer_global(python_operator)(
        type(f"_Template_{instruction}", (_ArithmeticTemplate,), {"key": python_operator})
    )

    def lower(context, builder, sig, args):
        result = sig.return_type
        operands = [
            arg if isinstance(typ, LanesType) else _splat(context, builder, result, arg, typ)
            for arg, typ in zip(args, sig.args, strict=True)
        ]
        return getattr(builder, instruction)(*operands, flags=_FLAGS)

    for scalar in (types.Number, types.Float, types.Integer):
        lower_builtin(python_operator, LanesType, scalar)(lower)
        lower_builtin(python_operator, scalar, LanesType)(lower)
    lower_builtin(python_operator, LanesType, LanesType)(lower)


for _operator, _instruction in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    _register_operator(_operator, _instruction)


@infer_global(operator.neg)
class _NegateTemplate(AbstractTemplate):
    def generic(self, args, kws):
        return signature(args[0], args[0]) if isinstance(args[0], LanesType) else None


@lower_builtin(operator.neg, LanesType)
def _lower_negate(context, builder, sig, args):
    return builder.fneg(args[0])


@infer_getattr
class _ComponentTemplate(AttributeTemplate):
    key = LanesType

    def generic_resolve(self, value, attr):
        return value.scalar if value.bits == 64 and attr in ("x", "y", "z") else None


def _register_component(name, index):
    @lower_getattr(LanesType, name)
    def lower(context, builder, typ, value):
        return builder.extract_element(value, INT32(index))


for _index, _name in enumerate("xyz"):
    _register_component(_name, _index)


# --- primitives ---------------------------------------------------------------------------------------------------


def primitive(resolve):
    """Decorator pair: a Python function that kernels call as LLVM.

    `resolve(*types)` gives the return type, or None; the decorated function receives
    `(context, builder, return type, argument types, arguments)` and returns the LLVM value.
    """

    def decorate(python_function, lower):
        template = type(
            f"_Template_{python_function.__name__}",
            (AbstractTemplate,),
            {"generic": lambda self, args, kws: _signature(resolve, args)},
        )
        infer_global(python_function)(template)

        def lowering(context, builder, sig, args):
            return lower(context, builder, sig.return_type, sig.args, args)

        lower_builtin(python_function, types.VarArg(types.Any))(lowering)
        return python_function

    return decorate


def _signature(resolve, args):
    result = resolve(*args)
    return None if result is None else signature(result, *args)


def _lanes(result=None):
    """Resolver: the first argument has lanes; the result is `result(first)`, by default the same type."""

    def resolve(first, *rest):
        if not isinstance(first, LanesType):
            return None
        return result(first) if result else first

    return resolve


def vec3(x, y, z):
    """The vector (x, y, z)."""
    return Vec3((x, y, z))


def _lower_vec3(context, builder, result, arg_types, args):
    vector = ir.Constant(result.vector, None)
    for i, (arg, typ) in enumerate(zip(args, arg_types, strict=True)):
        vector = builder.insert_element(vector, context.cast(builder, arg, typ, types.float64), INT32(i))
    return vector


primitive(lambda *args: VEC3 if len(args) == 3 else None)(vec3, _lower_vec3)


def splat(like, value):
    """`value` in every lane of a new spectrum with as many lanes as `like`."""
    return type(like)(np.full(len(like.values), value))


primitive(_lanes())(splat, lambda cx, b, result, typs, args: _splat(cx, b, result, args[1], typs[1]))


def lane(values, index):
    """Lane `index` as a float."""
    return values.values[index]


def _index32(context, builder, value, typ):
    return context.cast(builder, value, typ, types.int32)


primitive(_lanes(lambda first: first.scalar))(
    lane, lambda cx, b, result, typs, args: b.extract_element(args[0], _index32(cx, b, args[1], typs[1]))
)


def with_lane(values, index, value):
    """A copy of `values` with lane `index` replaced."""
    copy = values.values.copy()
    copy[index] = value
    return type(values)(copy)


primitive(_lanes())(
    with_lane,
    lambda cx, b, result, typs, args: b.insert_element(
        args[0], cx.cast(b, args[2], typs[2], result.scalar), _index32(cx, b, args[1], typs[1])
    ),
)


def lane_count(values):
    """Number of lanes, a compile-time constant."""
    return len(values.values)


primitive(_lanes(lambda first: types.intp))(
    lane_count, lambda cx, b, result, typs, args: ir.Constant(ir.IntType(64), typs[0].lanes)
)


def _reduce(combine):
    """Lowering that folds all lanes pairwise with `combine(builder, a, b)`."""

    def lower(context, builder, result, arg_types, args):
        items = [builder.extract_element(args[0], INT32(i)) for i in range(arg_types[0].lanes)]
        while len(items) > 1:
            pairs = [combine(builder, items[i], items[i + 1]) for i in range(0, len(items) - 1, 2)]
            items = pairs + ([items[-1]] if len(items) % 2 else [])
        return items[0]

    return lower


def _call_intrinsic(name):
    def combine(builder, *operands):
        typ = operands[0].type
        suffix = f"v{typ.count}{_suffix(typ.element)}" if isinstance(typ, ir.VectorType) else _suffix(typ)
        callee = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(typ, [typ] * len(operands)), f"llvm.{name}.{suffix}"
        )
        return builder.call(callee, operands)

    return combine


def _suffix(element):
    return "f64" if isinstance(element, ir.DoubleType) else "f32"


def lane_sum(values):
    """Sum of all lanes."""
    return values.values.sum(dtype=values.dtype)


def lane_max(values):
    """Largest lane."""
    return values.values.max()


def lane_min(values):
    """Smallest lane."""
    return values.values.min()


primitive(_lanes(lambda first: first.scalar))(lane_sum, _reduce(lambda b, x, y: b.fadd(x, y, flags=_FLAGS)))
primitive(_lanes(lambda first: first.scalar))(lane_max, _reduce(_call_intrinsic("maxnum")))
primitive(_lanes(lambda first: first.scalar))(lane_min, _reduce(_call_intrinsic("minnum")))


def maximum(a, b):
    """Lane-wise maximum of two spectra or vectors."""
    return type(a)(np.fmax(a.values, b.values))


def square_root(a):
    """Lane-wise square root."""
    return type(a)(np.sqrt(a.values))


def reciprocal(a):
    """Lane-wise 1 / a."""
    return 1.0 / a


primitive(_lanes())(maximum, lambda cx, b, result, typs, args: _call_intrinsic("maxnum")(b, *args))
primitive(_lanes())(square_root, lambda cx, b, result, typs, args: _call_intrinsic("sqrt")(b, *args))
primitive(_lanes())(
    reciprocal,
    lambda cx, b, result, typs, args: b.fdiv(
        _splat(cx, b, result, ir.Constant(ir.DoubleType(), 1.0), types.float64), args[0]
    ),
)


def dot(a, b):
    """Inner product of two vectors."""
    return float(a.values @ b.values)


def cross(a, b):
    """Vector product."""
    return Vec3(np.cross(a.values, b.values))


def _lower_dot(context, builder, result, arg_types, args):
    product = builder.fmul(*args, flags=_FLAGS)
    x, y, z = (builder.extract_element(product, INT32(i)) for i in range(3))
    return builder.fadd(builder.fadd(x, y, flags=_FLAGS), z, flags=_FLAGS)


def _lower_cross(context, builder, result, arg_types, args):
    def rotate(vector, order):
        mask = ir.Constant(ir.VectorType(INT32, 4), order)
        return builder.shuffle_vector(vector, ir.Constant(vector.type, ir.Undefined), mask)

    a, b = args
    left = builder.fmul(rotate(a, [1, 2, 0, 3]), rotate(b, [2, 0, 1, 3]), flags=_FLAGS)
    right = builder.fmul(rotate(a, [2, 0, 1, 3]), rotate(b, [1, 2, 0, 3]), flags=_FLAGS)
    return builder.fsub(left, right, flags=_FLAGS)


primitive(lambda a, b: types.float64 if a == b == VEC3 else None)(dot, _lower_dot)
primitive(lambda a, b: VEC3 if a == b == VEC3 else None)(cross, _lower_cross)
