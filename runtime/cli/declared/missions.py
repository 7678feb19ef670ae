"""``surefoot run``, ``check`` and ``schema``: missions."""

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import (
    BroadcastOption,
    DisListenOption,
    DisNameOption,
    DisOption,
    DisOriginOption,
    JsonOption,
    MulticastOption,
    dis_line,
)
from runtime.cli.starting import begin, finish, reads


def run(
    mission: Annotated[Path, typer.Argument(callback=reads, help="Mission file (YAML).")],
    out: Annotated[Path | None, typer.Option(help="Folder for the trace, plot, film strip and page.")] = None,
    dis: DisOption = None,
    dis_listen: DisListenOption = None,
    dis_name: DisNameOption = "1:1:1",
    dis_origin: DisOriginOption = (0.0, 0.0, 0.0),
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run a mission as fast as possible and print what happened; in real time with --dis."""
    commands = begin()
    line = dis_line(dis, dis_listen, dis_name, dis_origin, multicast, broadcast)
    finish(commands.run_mission_file(mission, out, line), as_json)


def check(
    mission: Annotated[Path, typer.Argument(callback=reads, help="Mission file (YAML).")],
    as_json: JsonOption = False,
) -> None:
    """Check a mission without running it: its file, its level, and that every place can be reached."""
    finish(begin().check_mission_file(mission), as_json)


def schema(
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Output file for the schema; default: standard output."),
    ] = None,
) -> None:
    """Write the JSON schema of mission files, which editors use to check and complete them."""
    begin().write_schema(output)
