"""The process that warms kernels up: it runs what it is told, says so, and ends with its parent."""

import os
import subprocess
import sys
import textwrap

HELPER = textwrap.dedent(
    """
    import sys
    from types import FunctionType, ModuleType, SimpleNamespace
    from numba.core.event import trigger_event
    from surefoot.preparing import Preparing
    uses = ModuleType("runtime.warmup.first_uses")
    sys.modules[uses.__name__] = uses  # the real ones import and compile everything

    def compiled(module):
        # as Numba tells of a kernel that it compiles
        function = FunctionType((lambda: None).__code__, {"__name__": module})
        with trigger_event("numba:compile", data={"dispatcher": SimpleNamespace(py_func=function)}):
            pass

    def theirs():
        print("text of a use")
        compiled("scipy.fft")

    def ours():
        assert Preparing.going_on
        compiled("navmesh.areas.line_costs")
        compiled("locomotion.body.hands")

    def unkept():
        import os
        from surefoot.kernels import folder
        os.replace = lambda *names: os.stat("/no such file")  # as on a full disk
        folder.write_whole(folder.cache_folder() / "one.kernel", b"1")

    uses.FIRST_USES = {"theirs": theirs, "ours": ours, "unkept": unkept}
    from runtime.warmup.helper import main
    main()
    """
)


def test_it_tells_what_it_compiles_and_when_it_is_done():
    """Kernels of other libraries are not counted."""
    helper = subprocess.Popen(
        [sys.executable, "-c", HELPER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        stderr=subprocess.PIPE,
    )  # fmt: skip
    assert helper.stdin is not None and helper.stdout is not None
    told = []
    for use in ("theirs", "ours"):
        print(use, file=helper.stdin, flush=True)
        while not told or told[-1] != "done":
            told.append(helper.stdout.readline().strip())
            assert told[-1]
        told[-1] = f"{use} done"
    assert told == ["theirs done", "compiled", "compiled", "ours done"]
    out, err = helper.communicate(timeout=60)  # closes its input, as a parent that ends
    assert out == "" and err == "text of a use\n" and helper.returncode == 0


def test_it_does_not_say_that_it_is_done_with_what_it_cannot_keep(tmp_path):
    """Its parent then does it for itself."""
    helper = subprocess.Popen(
        [sys.executable, "-c", HELPER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
    )  # fmt: skip
    assert helper.stdin is not None and helper.stdout is not None
    with helper.stdin:
        print("unkept", file=helper.stdin, flush=True)
        assert helper.stdout.read() == ""
    assert helper.wait(60) == 1 and not list((tmp_path / "surefoot").iterdir())
