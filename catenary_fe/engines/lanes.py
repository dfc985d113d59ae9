"""Rows of eight slots as one value each, which the processor adds and multiplies at once.

A compiled loop over rows is written once, for arrays of shape (rows,) and (rows, SLOTS): ``load`` takes a row
of one, a number or eight of them, ``store`` writes it, and + - * / work on both. Left to itself the compiler
makes vectors of neighbours only where it can prove that no store changes what is loaded next.
"""

from __future__ import annotations

import operator
from importlib import import_module
from typing import Any

import numpy as np

from catenary_fe.engines.arrays import SLOTS, Floats
from catenary_fe.engines.compiled import numba


def aligned(shape: tuple[int, ...]) -> Floats:
    """Zeros, of which no eight are in two lines of the processor's cache."""
    size = int(np.prod(shape))
    room = np.zeros(size + SLOTS)
    first = -room.ctypes.data // room.itemsize % SLOTS
    return room[first : first + size].reshape(shape)


# what these are where nothing is compiled, as in mutation testing


def load(array: Any, i: int) -> Any:
    """A row of an array."""
    return array[i] + 0.0


def store(array: Any, i: int, values: Any) -> None:
    """Write a row of an array."""
    array[i] = values


def load_eight(array: Any, i: int) -> Any:
    """Eight neighbours, from the number i on."""
    return array.reshape(-1)[i : i + SLOTS] + 0.0


def store_eight(array: Any, i: int, values: Any) -> None:
    """Write eight neighbours."""
    array.reshape(-1)[i : i + SLOTS] = values


def root(values: Any) -> Any:
    """Square root."""
    return np.sqrt(values)


def gather(values: Any, numbers: Any, i: int) -> Any:
    """Values by eight neighbouring numbers, from the number i on; 0 where these are below 0."""
    at = numbers.reshape(-1)[i : i + SLOTS]
    return np.where(at >= 0, values[at], 0.0)


def follow(eight: Any, value: float) -> Any:
    """The second of eight numbers to the last, then this one."""
    return np.append(eight[1:], value)


def lead(eight: Any) -> Any:
    """Nothing, then the first of eight numbers to the last but one."""
    return np.append(0.0, eight[:-1])


def last(eight: Any) -> Any:
    """The last of eight numbers."""
    return eight[-1]


def add_to(values: Any, numbers: Any, i: int, eight: Any) -> None:
    """Add eight numbers to values by eight neighbouring numbers, from i on; not where these are below 0."""
    for at, value in zip(numbers.reshape(-1)[i : i + SLOTS], eight, strict=True):
        if at >= 0:
            values[at] += value


def number(array: Any, value: float) -> Any:
    """The same number in all slots of a row of an array."""
    return array[0] * 0.0 + value


if not numba.config.DISABLE_JIT:
    # as numba's functions, their types are not complete
    ir: Any = import_module("llvmlite.ir")
    types: Any = import_module("numba.core.types")
    typing: Any = import_module("numba.core.typing.templates")
    extending: Any = import_module("numba.extending")

    class _Lanes(types.Type):  # type: ignore[misc]
        """Eight numbers."""

        def __init__(self) -> None:
            super().__init__(name="Lanes")

    _EIGHT, _VECTOR = _Lanes(), ir.VectorType(ir.DoubleType(), SLOTS)

    @extending.register_model(_Lanes)
    class _Model(extending.models.PrimitiveModel):  # type: ignore[misc]
        def __init__(self, manager: Any, kind: Any) -> None:
            super().__init__(manager, kind, _VECTOR)

    def _kind(array: Any, eight: bool) -> Any:
        assert array.layout == "C" and array.ndim in (1, 2) and (eight or array.dtype == types.float64)
        return _EIGHT if eight or array.ndim == 2 else types.float64

    def _place(context: Any, builder: Any, kinds: Any, kind: Any, eight: bool, array: Any, i: Any) -> Any:
        """Pointer to a row, or to eight neighbours from a number on."""
        data = context.make_array(kinds[0])(context, builder, array).data
        row = _VECTOR if kind == _EIGHT else ir.DoubleType()
        if eight:
            return builder.bitcast(builder.gep(data, [i]), row.as_pointer())
        return builder.gep(builder.bitcast(data, row.as_pointer()), [i])

    def _loading(eight: bool) -> Any:
        def made(_: Any, array: Any, i: Any) -> Any:
            kind = _kind(array, eight)

            def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
                if array.dtype == types.float32:
                    data = context.make_array(array)(context, builder, arguments[0]).data
                    single = ir.VectorType(ir.FloatType(), SLOTS).as_pointer()
                    place = builder.bitcast(builder.gep(data, [arguments[1]]), single)
                    return builder.fpext(builder.load(place, align=4), _VECTOR)
                return builder.load(_place(context, builder, types_.args, kind, eight, *arguments), align=8)

            return typing.signature(kind, array, types.intp), generate

        return extending.intrinsic(made)

    def _storing(eight: bool) -> Any:
        def made(_: Any, array: Any, i: Any, values: Any) -> Any:
            kind = _kind(array, eight)

            def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
                place = _place(context, builder, types_.args, kind, eight, *arguments[:2])
                builder.store(arguments[2], place, align=8)
                return context.get_dummy_value()

            return typing.signature(types.none, array, types.intp, kind), generate

        return extending.intrinsic(made)

    def _spread(builder: Any, value: Any) -> Any:
        """Eight times the same, unless it is eight already."""
        if value.type == _VECTOR:
            return value
        nothing = ir.Constant(_VECTOR, ir.Undefined)
        first = builder.insert_element(nothing, value, ir.Constant(ir.IntType(32), 0))
        return builder.shuffle_vector(
            first, nothing, ir.Constant(ir.VectorType(ir.IntType(32), SLOTS), [0] * SLOTS)
        )

    def _number(_: Any, array: Any, value: Any) -> Any:
        kind = _kind(array, False)

        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            return _spread(builder, arguments[1]) if kind == _EIGHT else arguments[1]

        return typing.signature(kind, array, types.float64), generate

    def _root(_: Any, values: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            kind = arguments[0].type
            made = ir.FunctionType(kind, [kind])
            name = "llvm.sqrt.v8f64" if kind == _VECTOR else "llvm.sqrt.f64"
            function = builder.module.globals.get(name) or ir.Function(builder.module, made, name)
            return builder.call(function, arguments)

        return typing.signature(values, values), generate

    def _lane(n: int) -> Any:
        return ir.Constant(ir.IntType(32), n)

    def _numbers(context: Any, builder: Any, kinds: Any, numbers: Any, i: Any) -> Any:
        """Of each of eight neighbouring numbers: it, and whether it is not below 0."""
        data = context.make_array(kinds[1])(context, builder, numbers).data
        for n in range(SLOTS):
            at = builder.load(builder.gep(data, [builder.add(i, ir.Constant(i.type, n))]))
            yield n, at, builder.icmp_signed(">=", at, ir.Constant(at.type, 0))

    def _gather(_: Any, values: Any, numbers: Any, i: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            data = context.make_array(types_.args[0])(context, builder, arguments[0]).data
            found, nothing = ir.Constant(_VECTOR, ir.Undefined), ir.Constant(ir.DoubleType(), 0.0)
            for n, at, is_one in _numbers(context, builder, types_.args, *arguments[1:]):
                place = builder.select(is_one, at, ir.Constant(at.type, 0))
                value = builder.load(builder.gep(data, [builder.sext(place, ir.IntType(64))]))
                found = builder.insert_element(found, builder.select(is_one, value, nothing), _lane(n))
            return found

        return typing.signature(_EIGHT, values, numbers, types.intp), generate

    def _add_to(_: Any, values: Any, numbers: Any, i: Any, eight: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            data = context.make_array(types_.args[0])(context, builder, arguments[0]).data
            for n, at, is_one in _numbers(context, builder, types_.args, *arguments[1:3]):
                with builder.if_then(is_one, likely=True):
                    place = builder.gep(data, [builder.sext(at, ir.IntType(64))])
                    value = builder.extract_element(arguments[3], _lane(n))
                    builder.store(builder.fadd(builder.load(place), value), place)
            return context.get_dummy_value()

        return typing.signature(types.none, values, numbers, types.intp, _EIGHT), generate

    def _shifted(builder: Any, eight: Any, value: Any, order: list[int]) -> Any:
        """Eight numbers in another order, in which the ninth is a value."""
        other = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), value, _lane(0))
        return builder.shuffle_vector(eight, other, ir.Constant(ir.VectorType(ir.IntType(32), SLOTS), order))

    def _follow(_: Any, eight: Any, value: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            return _shifted(builder, arguments[0], arguments[1], [*range(1, SLOTS + 1)])

        return typing.signature(_EIGHT, _EIGHT, types.float64), generate

    def _lead(_: Any, eight: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            nothing = ir.Constant(ir.DoubleType(), 0.0)
            return _shifted(builder, arguments[0], nothing, [SLOTS, *range(SLOTS - 1)])

        return typing.signature(_EIGHT, _EIGHT), generate

    def _last(_: Any, eight: Any) -> Any:
        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            return builder.extract_element(arguments[0], _lane(SLOTS - 1))

        return typing.signature(types.float64, _EIGHT), generate

    load, load_eight = _loading(False), _loading(True)
    store, store_eight = _storing(False), _storing(True)
    number, root = extending.intrinsic(_number), extending.intrinsic(_root)
    gather, add_to = extending.intrinsic(_gather), extending.intrinsic(_add_to)
    follow, lead, last = (extending.intrinsic(made) for made in (_follow, _lead, _last))

    class _Operator(typing.AbstractTemplate):  # type: ignore[misc]
        """Of eight and eight, or of eight and a number."""

        def generic(self, arguments: Any, names: Any) -> Any:
            if len(arguments) == 2 and _EIGHT in arguments:
                return typing.signature(_EIGHT, *(a if a == _EIGHT else types.float64 for a in arguments))
            return None

    def _define(symbol: Any, name: str) -> None:
        typing.infer_global(symbol)(type(f"_{name}", (_Operator,), {}))

        def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
            both = [_spread(builder, value) for value in arguments]
            return getattr(builder, name)(*both, flags=("contract",))

        for kinds in ((_Lanes, _Lanes), (_Lanes, types.Float), (types.Float, _Lanes)):
            extending.lower_builtin(symbol, *kinds)(generate)

    for _symbol, _name in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
        _define(getattr(operator, _symbol), _name)
