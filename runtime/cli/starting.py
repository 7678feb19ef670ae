"""What every command does first and last: import what it needs, and print its result."""

import gc
import importlib.util
import json
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import typer

inputs: list[str | Path] = []
"""Files that the command reads; it never writes to any of them (`surefoot.files.inputs`)."""


after = ExitStack()
"""Cleanup to run when the command ends."""


def reads(value: Any) -> Any:
    """Callback of every argument and option that names an input file."""
    inputs.extend(value if isinstance(value, list) else [] if value is None else [value])
    return value


def begin() -> Any:
    """The module `runtime.cli.commands`; from now on nothing is written to what the command reads."""
    commands = loaded()
    from surefoot.files.inputs import keep_inputs

    after.enter_context(keep_inputs(inputs))
    return commands


def loaded() -> Any:
    """The module `runtime.cli.commands`, imported when a command needs it.

    The imported modules live until exit, so they are frozen out of garbage collection: scanning them would
    take as long as the imports. MuJoCo need not look for a display, because no command draws with it. Ctrl-C
    waits until the imports are done: extension modules drop it while loading, or turn it into an ImportError.
    """
    os.environ.setdefault("MUJOCO_GL", "disable")
    gc.disable()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        with _told_that_it_loads():
            from runtime.cli import commands
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    gc.freeze()
    gc.enable()
    return commands


@contextmanager
def _told_that_it_loads() -> Iterator[None]:
    """Say that modules are loading: on a terminal every time; elsewhere only on the first start, which is
    slowest because Python has yet to compile them."""
    begin, end = "", ""
    if "runtime.cli.commands" not in sys.modules:
        if sys.stderr.isatty():
            begin, end = "loading ...", "\r\x1b[2K"
        elif not Path(
            importlib.util.cache_from_source(str(Path(__file__).with_name("commands.py")))
        ).exists():
            begin = "loading for the first time: up to half a minute\n"
    print(begin, end="", file=sys.stderr, flush=True)
    yield
    print(end, end="", file=sys.stderr, flush=True)


def begin_view() -> Any:
    """The module `runtime.cli.view_commands`, as `begin`."""
    begin()
    from runtime.cli import view_commands

    return view_commands


def finish(result: Any, as_json: bool) -> None:
    """Print a command's result and exit with 0 if it held, else 1."""
    if as_json:
        print(json.dumps(result.values, indent=1))
    else:
        result.show()
    if not result.held:
        raise typer.Exit(1)
