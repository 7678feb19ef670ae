"""What is kept is loaded ahead, so that no first call has to."""

from tests.surefoot.kernels.processes import COUNT

LOADED = f"""
{COUNT}
from surefoot.kernels.loading import load_kept
count = len(load_kept())
before = [len(kernel.signatures) for kernel in (high.top, high.apart, high.low.big, high.low.other)]
print(json.dumps([count, before, high.top(3.0), compiled]))
"""


def test_kernels_of_imported_modules_are_loaded_once_each_and_not_compiled(place, processes):
    """``high.big`` is the kernel of ``low`` by another name."""
    nothing = [0, [0, 0, 0, 0], 7.0, ["top", "big"]]
    assert processes.ask(place, LOADED) == nothing
    assert processes.ask(place)[1] == ["apart", "other"]
    assert processes.ask(place, LOADED) == [4, [1, 1, 1, 1], 7.0, []]
