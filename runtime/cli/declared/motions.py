"""``surefoot postures`` and ``record``: recorded motion."""

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import JsonOption
from runtime.cli.starting import begin, finish, reads


def postures(
    file: Annotated[Path, typer.Argument(callback=reads, help="Posture file (.yaml).")],
    film: Annotated[
        Path | None, typer.Option(help="Output file for a picture of all postures and arcs (.png).")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Check a posture graph: what cannot be reached, does not meet, floats, sinks or bends too far."""
    begin()
    from runtime.cli.posture_commands import show_postures

    finish(show_postures(file, film), as_json)


def record(
    source: Annotated[
        Path | None,
        typer.Argument(callback=reads, help="Posture file (.yaml); with --list, recorded motions (.npz)."),
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output file for the motions (.npz).")
    ] = Path("motions.npz"),
    listed: Annotated[
        bool, typer.Option("--list", help="List the clips of a file, or of the package, and their origins.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Record the person's motions, from its simulation and from a posture graph, at three levels of
    detail."""
    if source is None and not listed:
        raise typer.BadParameter("name a posture file, or list what the package has with --list")
    begin()
    from runtime.cli.record_commands import list_motions, record_motions

    if listed:
        result = list_motions(source)
    else:
        assert source is not None
        result = record_motions(source, output)
    finish(result, as_json)
