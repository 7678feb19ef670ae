"""Bundles: many arrays and numbers that compiled code takes as one pointer.

Numba counts a use whenever an array is taken out of one of its own structs, which costs more than what most
kernels do with it. A `Bundle` is memory that says where its arrays are and how long; it does not change, and
what is taken out of it is not counted: whoever calls a kernel keeps the bundle, and the bundle its arrays.

A structured array in it gives each of its fields as an array of its own. So kernels read columns, and what
they read of one row lies in one line of the cache.
"""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import from_dtype, types
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import NativeValue, infer_getattr, lower_getattr_generic, register_model, unbox
from numba.np.arrayobj import populate_array

__all__ = ["Bundle", "BundleType", "aligned", "rows"]

_LINE = 64  # [bytes] of a line of the cache


class BundleType(types.Type):
    """What is in a bundle, by name: Numba types of numbers and of contiguous arrays, see also `rows`.

    A number takes one word of its memory, an array one for where it is and one for each of its dimensions.
    """

    def __init__(self, **fields: Any) -> None:
        self.fields = fields
        self.first = {}  # word of each field
        self.columns = {}  # name: (field, its type) of the columns of structured arrays
        self.words = 0
        for name, kind in fields.items():
            self.first[name] = self.words
            self.words += 1
            if isinstance(kind, types.Array):
                self.words += kind.ndim
                if isinstance(kind.dtype, types.Record):
                    for column, place in kind.dtype.fields.items():
                        self.columns[column] = name, _column(place.type)
        super().__init__(f"Bundle({', '.join(f'{name}: {kind}' for name, kind in fields.items())})")


def rows(dtype: np.dtype) -> types.Array:
    """The type of a structured array (n,) whose fields kernels read as arrays."""
    return types.Array(from_dtype(dtype), 1, "C")


def _column(kind: Any) -> types.Array:
    nested = isinstance(kind, types.NestedArray)
    return types.Array(kind.dtype if nested else kind, 1 + (kind.ndim if nested else 0), "A")


class Bundle:
    """Numbers and arrays under the names that kernels, and attributes of it, give them by."""

    def __init__(self, kind: BundleType, **values: Any) -> None:
        self.__dict__.update(values)
        memory = np.zeros(kind.words, np.int64)
        for name, field in kind.fields.items():
            value, at = values.pop(name), kind.first[name]
            if isinstance(field, types.Array):
                if (
                    value.dtype != _dtype_of(field)
                    or value.ndim != field.ndim
                    or not value.flags.c_contiguous
                ):
                    raise TypeError(f"{name}: {value.dtype} {value.shape}, expected a contiguous {field}")
                memory[at] = value.ctypes.data
                memory[at + 1 : at + 1 + value.ndim] = value.shape
            else:
                memory[at : at + 1].view(_dtype_of(field))[0] = value
        if values:
            raise TypeError(f"{', '.join(values)}: expected {', '.join(kind.fields)}")
        self._numba_type_ = kind
        self._memory = memory
        self.address = memory.ctypes.data
        """Where compiled code finds it."""


def _dtype_of(kind: Any) -> np.dtype:
    scalar = kind.dtype if isinstance(kind, types.Array) else kind
    return scalar.dtype if isinstance(scalar, types.Record) else np.dtype(scalar.name)


def aligned(count: int, dtype: np.dtype) -> np.ndarray:
    """A structured array (count,) of zeros that begins where a line of the cache does."""
    size = count * dtype.itemsize
    memory = np.zeros(size + _LINE, np.uint8)
    skip = -memory.ctypes.data % _LINE
    return memory[skip : skip + size].view(dtype)


@register_model(BundleType)
class _Model(models.OpaqueModel):
    pass


@unbox(BundleType)
def _unbox(kind, value, c):
    address = c.pyapi.object_getattr_string(value, "address")
    pointer = c.pyapi.long_as_voidptr(address)
    c.pyapi.decref(address)
    return NativeValue(pointer)


@infer_getattr
class _Attributes(AttributeTemplate):
    key = BundleType

    def generic_resolve(self, kind, name):
        return kind.columns[name][1] if name in kind.columns else kind.fields.get(name)


@lower_getattr_generic(BundleType)
def _read(context, builder, bundle, pointer, name):
    words = builder.bitcast(pointer, ir.IntType(64).as_pointer())

    def word(index, kind):
        at = builder.gep(words, [ir.Constant(ir.IntType(32), index)])
        value = builder.load(builder.bitcast(at, kind.as_pointer()))
        value.set_metadata("invariant.load", builder.module.add_metadata([]))
        return value

    def constant(value):
        return context.get_constant(types.intp, value)

    field, kind = bundle.columns.get(name, (name, bundle.fields.get(name)))
    first = bundle.first[field]
    if not isinstance(kind, types.Array):
        return word(first, context.get_value_type(kind))
    item = context.get_abi_sizeof(context.get_data_type(kind.dtype))
    data = word(first, ir.IntType(8).as_pointer())
    shape = [word(first + 1, ir.IntType(64))]
    if field == name:
        shape += [word(first + 1 + i, ir.IntType(64)) for i in range(1, kind.ndim)]
        strides = [constant(item)]
        for extent in reversed(shape[1:]):
            strides.insert(0, builder.mul(strides[0], extent))
    else:
        record = bundle.fields[field].dtype
        place = record.fields[name]
        inner = getattr(place.type, "shape", ())
        data = builder.gep(data, [ir.Constant(ir.IntType(32), place.offset)])
        shape += [constant(extent) for extent in inner]
        steps = [item * int(np.prod(inner[i + 1 :])) for i in range(len(inner))]
        strides = [constant(step) for step in (record.size, *steps)]
    array = context.make_array(kind)(context, builder)
    data = builder.bitcast(data, context.get_data_type(kind.dtype).as_pointer())
    populate_array(array, data, shape, strides, constant(item), meminfo=None)
    return array._getvalue()
