"""A process that runs the uses whose names it reads: ``python -m runtime.warmup.helper``.

It writes a line for each kernel that it compiles, "used" with the name of its file for each that it has used,
and "done" after each use. It ends with its parent, and
where it cannot keep what it compiles: that is then done by its parent, for itself.
"""

import gc
import os
import sys
from queue import SimpleQueue
from threading import Thread


def main() -> None:
    told = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what the uses print
    asked: SimpleQueue[str] = SimpleQueue()
    Thread(target=_read, args=(asked,), daemon=True).start()
    from runtime.warmup.first_uses import FIRST_USES
    from surefoot.compile_notice import counted
    from surefoot.kernels.cache import used
    from surefoot.kernels.folder import unwritten
    from surefoot.preparing import Preparing

    gc.disable()  # nearly all that compiling makes stays: looking through it takes a tenth of the time
    Preparing.going_on = True
    with counted(lambda count: print("compiled", file=told)):
        while True:
            FIRST_USES[asked.get()]()
            if unwritten():
                os._exit(1)
            for name in used():
                print(f"used {name}", file=told)
            print("done", file=told)


def _read(asked: SimpleQueue[str]) -> None:
    for line in sys.stdin:
        asked.put(line.strip())
    os._exit(0)


if __name__ == "__main__":
    main()
