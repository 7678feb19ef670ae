"""Small modules with kernels, and processes that use them with a cache of their own.

The processes are forks of one that has imported Numba and compiled something, which takes longer than what
they do.
"""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[3]
LOW = """
from surefoot.kernels import allocating_kernel
FACTOR = 2.0

@allocating_kernel
def big(x):
    {body}
    return x * FACTOR

@allocating_kernel
def other(x):
    return x + 1.0
"""
HIGH = """
import low
from surefoot.kernels import allocating_kernel
from low import big

@allocating_kernel
def top(x):
    return big(x) + 1.0

@allocating_kernel
def apart(x):
    return low.other(x)
"""
COUNT = """
import json, sys
from numba.core import event
from surefoot.compile_notice import _Listener
from surefoot.kernels import dependencies
dependencies.PACKAGES = ("low", "high")
compiled = []
class Listener(event.Listener):
    def on_start(self, e):
        kernel = e.data["dispatcher"].py_func
        if kernel.__module__ in ("low", "high"):
            compiled.append(kernel.__name__)
    def on_end(self, e):
        pass
event.register("numba:compile", Listener())
import high
"""
ASK = f"""
{COUNT}
answer = [high.top(3.0), high.apart(3.0)]
module = high.top.overloads[high.top.signatures[0]].library._final_module
called = [f.is_declaration for f in module.functions if "3big" in f.name]
print(json.dumps([answer, compiled, called]))
"""
# more than LLVM would copy into a caller by itself
BODY = "\n    ".join(f"x = x + {k}.5 if x < {k}.25 * x * x else x - {k}.125 / (x + 7.0)" for k in range(40))

_FORKS = """
import json, os, sys
import numba
from numba.core import config
import surefoot.compile_notice, surefoot.kernels.loading
numba.njit(lambda x: x + 1.0)(1.0)
sys.dont_write_bytecode = True
for line in sys.stdin:
    scripts, children = json.loads(line), []
    for number, (place, script) in enumerate(scripts):
        child = os.fork()
        if child == 0:
            sys.path.insert(0, place)
            config.CACHE_DIR = os.path.join(place, "kept")
            sys.stdout = open(os.path.join(place, f"answer-{number}"), "w")
            exec(script, {})
            sys.stdout.close()
            os._exit(0)
        children.append(child)
    codes = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children]
    print(json.dumps(codes), flush=True)
"""


class Processes:
    """Runs scripts, each in a new process that knows the modules ``low`` and ``high`` of a folder."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-B", "-c", _FORKS],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask_at_once(self, place: Path, scripts: Sequence[str]) -> list[Any]:
        """What processes that run at the same time print, read as JSON."""
        assert self._process.stdin is not None and self._process.stdout is not None
        print(json.dumps([[str(place), each] for each in scripts]), file=self._process.stdin, flush=True)
        codes = json.loads(self._process.stdout.readline())
        assert codes == [0] * len(scripts)
        return [json.loads((place / f"answer-{k}").read_text()) for k in range(len(scripts))]

    def ask(self, place: Path, script: str = ASK) -> Any:
        """What one process prints."""
        return self.ask_at_once(place, [script])[0]

    def end(self) -> None:
        self._process.communicate()
