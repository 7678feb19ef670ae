"""The ``surefoot`` command."""

import signal
import sys
from collections.abc import Callable
from typing import Annotated, Any

import typer
from typer import exceptions as typer_exceptions

from runtime.cli.declared.kernels import cache
from runtime.cli.declared.levels import bake, obstacles, path
from runtime.cli.declared.missions import check, run, schema
from runtime.cli.declared.motions import postures, record
from runtime.cli.declared.playtests import playtest, replay
from runtime.cli.declared.servers import dis, serve
from runtime.cli.declared.skills import OnSkills, clip, evaluate, sample, train
from runtime.cli.declared.views import export, film, view
from runtime.cli.starting import after, inputs
from surefoot import __version__
from surefoot.errors import SurefootError

app = typer.Typer(
    no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None,
    help="Navigation and locomotion for game characters. "
    "Exit codes: 0: it worked or passed, 1: it did not, 2: wrong input.",
)  # fmt: skip
_INTERRUPTED = 130
"""Exit code after Ctrl-C."""


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"surefoot {__version__}")
        raise typer.Exit


@app.callback()
def _surefoot(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None:
    pass


def _refuse(message: str) -> int:
    print(f"surefoot: {' '.join(message.split())}", file=sys.stderr)
    return 2


for _command in (
    bake, cache, obstacles, path, run, check, schema, view, export, film, serve, dis,
    playtest, replay, train, evaluate, sample, clip, postures, record,
):  # fmt: skip
    app.command(cls=OnSkills if _command in (train, evaluate) else None)(_command)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line. Exits with 0, 1 or 2; 130 when interrupted."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    inputs.clear()
    with after:
        code = _exit_code(arguments)
    if code == _INTERRUPTED:  # typer turns Ctrl-C into an exit of its own
        print("surefoot: interrupted; no half-written files are left", file=sys.stderr)
    sys.exit(code)


def _exit_code(arguments: list[str] | None) -> int:
    try:
        command: Callable[..., Any] = typer.main.get_command(app)
        code = command(arguments, prog_name="surefoot", standalone_mode=False) or 0
    except (KeyboardInterrupt, typer.Abort):
        code = _INTERRUPTED
    except typer.Exit as leave:
        code = leave.exit_code
    except typer_exceptions.TyperException as error:
        code = _refuse(f"{error.format_message()} (see surefoot --help)")
    except SurefootError as error:
        code = _refuse(str(error))
    except OSError as error:
        code = _refuse(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    return code
