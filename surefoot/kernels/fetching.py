"""Memory that is asked for before it is needed.

What a query reads of a large level is seldom in the processor's cache. A kernel that has to look at one place
to know the next one waits for one line of memory after the other; asked for ahead, they come at the same
time.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

__all__ = ["fetch"]

_READ, _KEEP, _DATA = 0, 3, 1  # what LLVM's prefetch is told


@intrinsic
def fetch(typing: Any, array: Any, row: Any) -> Any:
    """Ask for the line of memory where row ``row`` of ``array`` begins. Any number will do: nothing is
    read."""
    if not isinstance(array, types.Array) or not isinstance(row, types.Integer):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        whole = context.make_array(array)(context, builder, arguments[0])
        at = context.cast(builder, arguments[1], row, types.intp)
        step = builder.extract_value(whole.strides, 0)
        place = builder.bitcast(whole.data, ir.IntType(8).as_pointer())
        place = builder.gep(place, [builder.mul(at, step)])
        word = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [place.type, word, word, word])
        call = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(call, [place, *(ir.Constant(word, told) for told in (_READ, _KEEP, _DATA))])
        return context.get_dummy_value()

    return types.void(array, row), generate
