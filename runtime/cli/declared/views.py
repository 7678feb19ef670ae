"""``surefoot view``, ``export`` and ``film``: what a run looks like."""

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import (
    CharacterOption,
    FollowOption,
    JsonOption,
    MappingOption,
    TraceArgument,
)
from runtime.cli.starting import begin_view, finish, reads


def view(
    source: Annotated[
        str,
        typer.Argument(
            callback=reads,
            help="Trace (.npz), mission (.yaml), which is run first, or a server's address (ws://…).",
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file for the page (.html).")] = Path(
        "view.html"
    ),
    follow: Annotated[
        str | None, typer.Option(help="Agent that the camera follows; default: the camera stands still.")
    ] = None,
    live: Annotated[bool, typer.Option(help="Run the mission in real time and watch it live.")] = False,
    world: Annotated[
        str | None, typer.Option(help="With a server: the world to watch; default: the only one.")
    ] = None,
    token: Annotated[
        str, typer.Option(envvar="SUREFOOT_TOKEN", help="With a server: its token, if it needs one.")
    ] = "",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the live page; 0: any free port.")] = 0,
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Write a page that replays a run in a browser, without server or network; or watch a world of `surefoot
    serve` live."""
    commands = begin_view()
    served = source.startswith(("ws://", "wss://"))
    if character is not None and (live or served):
        raise typer.BadParameter(
            "a live view shows people as they are; leave out --character", param_hint="--character"
        )
    if served:
        finish(commands.watch_served(source, world, token, port), as_json)
    elif live:
        finish(commands.watch_mission(Path(source), port), as_json)
    else:
        finish(commands.write_view(Path(source), output, follow, character, mapping), as_json)


def export(
    source: TraceArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.glb).")] = Path("run.glb"),
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Export a run as animated glTF for Blender, Godot, three.js and other tools."""
    finish(begin_view().export_gltf(source, output, character, mapping), as_json)


def film(
    source: TraceArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.mp4).")] = Path("run.mp4"),
    follow: FollowOption = None,
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Render a run as a video. Needs no GPU or display, but about half a second for each frame."""
    finish(begin_view().write_video(source, output, follow, character, mapping), as_json)
