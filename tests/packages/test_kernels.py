"""Kernels that count no references must not handle arrays that somebody owns."""

import sys

import pytest
from numba.core import types
from numba.core.dispatcher import Dispatcher

import runtime
from surefoot.kernels.dependencies import PACKAGES


def _holds_array(kind: types.Type) -> bool:
    if isinstance(kind, types.BaseTuple):
        return any(_holds_array(part) for part in kind)
    return isinstance(kind, types.Array)


def _returned(dispatcher: Dispatcher) -> list[types.Type]:
    """What the compiled versions of a kernel return, those in the cache included."""
    for signature in dispatcher._cache.kept_signatures(dispatcher.targetctx):
        dispatcher.compile(signature)
    return [overload.signature.return_type for overload in dispatcher.overloads.values()]


@pytest.fixture(scope="module")
def kernels() -> set[Dispatcher]:
    runtime.prepare()
    return {
        thing
        for name, module in list(sys.modules.items())
        if name.partition(".")[0] in PACKAGES
        for thing in vars(module).values()
        if isinstance(thing, Dispatcher)
    }


def test_kernels_without_counting_get_and_give_no_new_arrays(kernels: set[Dispatcher]) -> None:
    gives = {each: any(map(_holds_array, _returned(each))) for each in kernels}
    assert sum(gives.values()) > 20
    uncounted = [each for each in kernels if not each.targetoptions["_nrt"]]
    assert len(uncounted) > 200
    for each in uncounted:
        function = each.py_func
        assert not gives[each], f"{function.__module__}.{function.__name__} returns an array"
        for name in function.__code__.co_names:
            called = function.__globals__.get(name)
            if isinstance(called, Dispatcher):
                assert not gives[called], f"{function.__name__} gets an array from {name}"
