"""Rows of eight slots as one value each, which the processor adds and multiplies at once.

A compiled loop over rows is written once, for arrays of shape (rows,) and (rows, SLOTS): ``load`` takes a row
of one, a number or eight of them, ``store`` writes it, and + - * work on both. Left to itself the compiler
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
    """Eight neighbours, from the number 8 i on."""
    return array.reshape(-1)[SLOTS * i : SLOTS * i + SLOTS] + 0.0


def store_eight(array: Any, i: int, values: Any) -> None:
    """Write eight neighbours."""
    array.reshape(-1)[SLOTS * i : SLOTS * i + SLOTS] = values


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
        assert array.layout == "C" and array.ndim in (1, 2)
        return _EIGHT if eight or array.ndim == 2 else types.float64

    def _place(context: Any, builder: Any, kinds: Any, kind: Any, array: Any, i: Any) -> Any:
        """Pointer to a row."""
        data = context.make_array(kinds[0])(context, builder, array).data
        row = _VECTOR if kind == _EIGHT else ir.DoubleType()
        return builder.gep(builder.bitcast(data, row.as_pointer()), [i])

    def _loading(eight: bool) -> Any:
        def made(_: Any, array: Any, i: Any) -> Any:
            kind = _kind(array, eight)

            def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
                return builder.load(_place(context, builder, types_.args, kind, *arguments), align=8)

            return typing.signature(kind, array, types.intp), generate

        return extending.intrinsic(made)

    def _storing(eight: bool) -> Any:
        def made(_: Any, array: Any, i: Any, values: Any) -> Any:
            kind = _kind(array, eight)

            def generate(context: Any, builder: Any, types_: Any, arguments: Any) -> Any:
                place = _place(context, builder, types_.args, kind, *arguments[:2])
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

    load, load_eight = _loading(False), _loading(True)
    store, store_eight = _storing(False), _storing(True)
    number = extending.intrinsic(_number)

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

    for _symbol, _name in ((operator.add, "fadd"), (operator.sub, "fsub"), (operator.mul, "fmul")):
        _define(_symbol, _name)
